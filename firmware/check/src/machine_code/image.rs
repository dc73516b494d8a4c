//! A linked program as a graph: functions and data that refer to each other.
//!
//! The linker is asked to keep the relocations (`--emit-relocs`): whatever code or data mentions, by a call, a jump or
//! an address, stands in them. So everything that a call can ever run is reached, also what is only called through a
//! pointer; there may be more, never less.

use object::read::elf::{ElfFile32, ElfSection32, FileHeader, SectionHeader};
use object::{Endianness, Object, ObjectSection, ObjectSymbol, RelocationTarget, SectionIndex, SymbolKind, elf};

use super::instructions::Machine;

/// A function.
pub struct Function {
    /// Its name, demangled.
    pub name: String,
    /// Where it begins.
    pub address: u64,
    /// Its machine code.
    pub code: Vec<u8>,
    /// Offsets at which literals begin (`true`) and end (`false`) within the code, in order.
    pub literals: Vec<(u64, bool)>,
    /// What it mentions.
    pub mentions: Vec<Mention>,
}

/// A constant or a variable; or a whole section of them, for what has no symbol of its own.
pub struct Data {
    /// Its name.
    pub name: String,
    /// Where it begins.
    pub address: u64,
    /// Its bytes.
    pub size: u64,
    /// What it mentions.
    pub mentions: Vec<Mention>,
}

/// What is mentioned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mention {
    /// Of [`Image::functions`].
    Function(usize),
    /// Of [`Image::data`].
    Data(usize),
    /// An address that belongs to neither.
    Unknown(u64),
}

/// A program.
pub struct Image {
    /// What it runs on.
    pub machine: Machine,
    /// In the order of addresses.
    pub functions: Vec<Function>,
    /// Those with symbols, then sections.
    pub data: Vec<Data>,
}

fn is_loaded(file: &ElfFile32<'_>, section: &ElfSection32<'_, '_>) -> bool {
    section.elf_section_header().sh_flags(file.endian()) & elf::SHF_ALLOC != 0
}

fn short(name: &str) -> &str {
    let without_types = name.split("::<").next().unwrap_or_default();
    without_types.rsplit("::").next().unwrap_or_default()
}

impl Function {
    /// The last part of the name, without its types, which not every way of mangling keeps.
    pub fn short_name(&self) -> &str {
        short(&self.name)
    }
}

impl Image {
    /// Reads a program of 32-bit Arm or RISC-V.
    ///
    /// *Errors:* another machine, or no relocations.
    pub fn read(bytes: &[u8]) -> Result<Self, Box<dyn std::error::Error>> {
        let file = ElfFile32::<Endianness>::parse(bytes)?;
        let machine = match file.elf_header().e_machine(file.endian()) {
            elf::EM_ARM => Machine::Thumb,
            elf::EM_RISCV => Machine::RiscV32,
            other => return Err(format!("machine {other} is neither Arm nor RISC-V").into()),
        };
        let mut image = Self { machine, functions: Vec::new(), data: Vec::new() };
        let mut whole = Vec::new();
        for section in file.sections().filter(|section| is_loaded(&file, section)) {
            if section.elf_section_header().sh_flags(file.endian()) & elf::SHF_EXECINSTR != 0 {
                image.add_functions(&file, section.index())?;
                continue;
            }
            let data = |name: &str, address, size| Data { name: name.to_owned(), address, size, mentions: Vec::new() };
            for symbol in file.symbols().filter(|symbol| symbol.section_index() == Some(section.index())) {
                if symbol.size() > 0 {
                    image.data.push(data(symbol.name()?, symbol.address(), symbol.size()));
                }
            }
            whole.push(data(section.name()?, section.address(), section.size()));
        }
        image.data.extend(whole);
        image.functions.sort_by_key(|function| function.address);
        if image.add_mentions(&file)? == 0 {
            return Err("there are no relocations: link with --emit-relocs".into());
        }
        Ok(image)
    }

    fn add_functions(&mut self, file: &ElfFile32<'_>, index: SectionIndex) -> Result<(), object::Error> {
        let section = file.section_by_index(index)?;
        let (bytes, start) = (section.data()?, section.address());
        let mut marks = Vec::new();
        for symbol in file.symbols().filter(|symbol| symbol.section_index() == Some(index)) {
            // Mapping symbols: from here on literals, from here on instructions.
            match symbol.name()?.split('.').next() {
                Some("$d") => marks.push((symbol.address(), true)),
                Some("$t" | "$a" | "$x") => marks.push((symbol.address(), false)),
                _ => {}
            }
        }
        marks.sort_unstable();
        for symbol in file.symbols().filter(|symbol| symbol.section_index() == Some(index)) {
            if symbol.kind() != SymbolKind::Text || symbol.size() == 0 {
                continue;
            }
            let address = self.machine.code_address(symbol.address());
            let range = (address - start) as usize..(address - start + symbol.size()) as usize;
            // Two names of one function are one function.
            if self.functions.iter().any(|other| other.address == address) {
                continue;
            }
            let literals = marks.iter().map(|&(at, literal)| (at.wrapping_sub(address), literal));
            self.functions.push(Function {
                name: format!("{:#}", rustc_demangle::demangle(symbol.name()?)),
                address,
                code: bytes.get(range).unwrap_or_default().to_vec(),
                literals: literals.filter(|&(at, _)| at < symbol.size()).collect(),
                mentions: Vec::new(),
            });
        }
        Ok(())
    }

    /// Reads the relocations; returns how many say something.
    fn add_mentions(&mut self, file: &ElfFile32<'_>) -> Result<usize, Box<dyn std::error::Error>> {
        let mut count = 0;
        for section in file.sections().filter(|section| is_loaded(file, section)) {
            for (at, relocation) in section.relocations() {
                let RelocationTarget::Symbol(index) = relocation.target() else { continue };
                let symbol = file.symbol_by_index(index)?;
                if symbol.is_undefined() {
                    continue;
                }
                let offset = at.wrapping_sub(section.address()) as usize;
                let word = section.data()?.get(offset..).and_then(|rest| rest.first_chunk::<4>());
                let target = match word {
                    // Arm keeps what is added to a symbol in the place itself, which the linker has overwritten, with
                    // the sum where the place is a whole word. Elsewhere the symbol is the thing itself.
                    Some(word) if relocation.has_implicit_addend() && symbol.kind() == SymbolKind::Section => {
                        u64::from(u32::from_le_bytes(*word))
                    }
                    _ if relocation.has_implicit_addend() => symbol.address(),
                    _ => symbol.address().wrapping_add_signed(relocation.addend()),
                };
                let mention = self.at(target);
                count += 1;
                match self.at(at) {
                    Mention::Function(place) => self.functions[place].mentions.push(mention),
                    Mention::Data(place) => self.data[place].mentions.push(mention),
                    Mention::Unknown(_) => {}
                }
            }
        }
        Ok(count)
    }

    /// What lies at an address.
    fn at(&self, address: u64) -> Mention {
        let code = self.machine.code_address(address);
        let after = self.functions.partition_point(|function| function.address <= code);
        if let Some(place) = after.checked_sub(1)
            && code - self.functions[place].address < self.functions[place].code.len() as u64
        {
            return Mention::Function(place);
        }
        let holds = |data: &Data| data.address <= address && address - data.address < data.size;
        self.data.iter().position(holds).map_or(Mention::Unknown(address), Mention::Data)
    }
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn a_name_is_short_with_and_without_types() {
        assert_eq!(short("galpix_proof::passes::proof_edge"), "proof_edge");
        assert_eq!(short("galpix_proof::passes::proof_edge::<core::L, galpix_core::Static<P>>"), "proof_edge");
        assert_eq!(short("memcpy"), "memcpy");
    }
}
