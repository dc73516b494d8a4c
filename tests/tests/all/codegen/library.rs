//! A static library as a graph: sections that refer to sections.
//!
//! The compiler puts each function and each constant into a section of its own. Whatever code or data a section
//! mentions, by a call, a jump or an address, stands in its relocations. So everything that a call of a function can
//! ever run lies in the sections that its own section reaches, also what is only called through a pointer; there may be
//! more, never less.

use std::collections::{HashMap, HashSet, VecDeque};

use object::read::archive::ArchiveFile;
use object::{Object, ObjectSection, ObjectSymbol, RelocationTarget, SectionKind, SymbolKind};

/// Code or data that is loaded on the target.
pub struct Section {
    /// What it defines, demangled; its own name if nothing global.
    pub name: String,
    /// Its first symbol as the linker knows it.
    pub symbol: String,
    /// The member of the library that it comes from.
    pub member: String,
    /// Instructions; empty for data.
    pub code: Vec<u8>,
    /// Offsets at which literals begin (`true`) and end (`false`) within code, in order.
    pub literals: Vec<(usize, bool)>,
    mentions: Vec<Mention>,
}

enum Mention {
    Section(usize),
    Symbol(String),
}

/// All sections of a static library.
pub struct Library {
    /// In the order of the library.
    pub sections: Vec<Section>,
    defined: HashMap<String, usize>,
}

/// What an entry reaches.
pub struct Reach {
    /// Sections, nearest first, each with the path of names that leads there.
    pub sections: Vec<(usize, Vec<String>)>,
    /// Symbols that the library does not define, each with its path.
    pub undefined: Vec<(String, Vec<String>)>,
}

impl Library {
    /// Reads a static library of ELF objects.
    pub fn read(bytes: &[u8]) -> Result<Self, Box<dyn std::error::Error>> {
        let mut library = Self { sections: Vec::new(), defined: HashMap::new() };
        for member in ArchiveFile::parse(bytes)?.members() {
            let member = member?;
            let name = String::from_utf8_lossy(member.name()).into_owned();
            if name.ends_with(".o") {
                library.add(name, &object::File::parse(member.data(bytes)?)?)?;
            }
        }
        Ok(library)
    }

    fn add(&mut self, member: String, file: &object::File<'_>) -> Result<(), Box<dyn std::error::Error>> {
        let mut places = HashMap::new();
        for section in file.sections() {
            let code = section.kind() == SectionKind::Text;
            let loaded = code
                || matches!(
                    section.kind(),
                    SectionKind::Data
                        | SectionKind::ReadOnlyData
                        | SectionKind::ReadOnlyDataWithRel
                        | SectionKind::ReadOnlyString
                        | SectionKind::UninitializedData
                );
            if loaded {
                places.insert(section.index(), self.sections.len());
                self.sections.push(Section {
                    name: String::new(),
                    symbol: section.name()?.to_owned(),
                    member: member.clone(),
                    code: if code { section.uncompressed_data()?.into_owned() } else { Vec::new() },
                    literals: Vec::new(),
                    mentions: Vec::new(),
                });
            }
        }
        for symbol in file.symbols() {
            let Some(&place) = symbol.section_index().and_then(|index| places.get(&index)) else { continue };
            let (name, section) = (symbol.name()?, &mut self.sections[place]);
            match name.split('.').next() {
                // Mapping symbols: from here on literals, from here on instructions.
                Some("$d") => section.literals.push((symbol.address() as usize, true)),
                Some("$t" | "$a" | "$x") => section.literals.push((symbol.address() as usize, false)),
                _ if symbol.kind() == SymbolKind::Section || name.is_empty() || name.starts_with(".L") => {}
                _ => {
                    section.symbol = name.to_owned();
                    if symbol.is_global() {
                        self.defined.entry(name.to_owned()).or_insert(place);
                    }
                }
            }
        }
        for (index, &place) in &places {
            for (_, relocation) in file.section_by_index(*index)?.relocations() {
                let mention = match relocation.target() {
                    RelocationTarget::Symbol(symbol) => {
                        let symbol = file.symbol_by_index(symbol)?;
                        match symbol.section_index().and_then(|index| places.get(&index)) {
                            Some(&place) => Mention::Section(place),
                            None if symbol.is_undefined() && !symbol.name()?.is_empty() => {
                                Mention::Symbol(symbol.name()?.to_owned())
                            }
                            None => continue,
                        }
                    }
                    RelocationTarget::Section(section) => match places.get(&section) {
                        Some(&place) => Mention::Section(place),
                        None => continue,
                    },
                    _ => continue,
                };
                self.sections[place].mentions.push(mention);
            }
            let section = &mut self.sections[place];
            section.literals.sort_unstable();
            section.name = format!("{:#}", rustc_demangle::demangle(&section.symbol));
        }
        Ok(())
    }

    /// Returns the global symbols that begin with `prefix`, sorted.
    pub fn entries(&self, prefix: &str) -> Vec<String> {
        let mut names: Vec<_> = self.defined.keys().filter(|name| name.starts_with(prefix)).cloned().collect();
        names.sort();
        names
    }

    /// Returns everything that `entry` reaches, or nothing if it is not defined.
    pub fn reach(&self, entry: &str) -> Option<Reach> {
        let start = *self.defined.get(entry)?;
        let mut reach = Reach { sections: Vec::new(), undefined: Vec::new() };
        let (mut seen, mut missing) = (HashSet::from([start]), HashSet::new());
        let mut queue = VecDeque::from([(start, vec![self.sections[start].name.clone()])]);
        while let Some((place, path)) = queue.pop_front() {
            for mention in &self.sections[place].mentions {
                let to = match mention {
                    Mention::Section(to) => Some(*to),
                    Mention::Symbol(symbol) => self.defined.get(symbol).copied(),
                };
                let extended = |name: &str| path.iter().cloned().chain([name.to_owned()]).collect::<Vec<_>>();
                match (to, mention) {
                    (Some(to), _) if seen.insert(to) => queue.push_back((to, extended(&self.sections[to].name))),
                    (None, Mention::Symbol(symbol)) if missing.insert(symbol.clone()) => {
                        reach.undefined.push((symbol.clone(), extended(symbol)));
                    }
                    _ => {}
                }
            }
            reach.sections.push((place, path));
        }
        Some(reach)
    }
}
