//! The files of a folder, those that differ in a number alone together.

use std::path::Path;

use super::super::error::CaptureError;

/// Most files that are looked at.
const MOST: usize = 20_000;

/// Files whose names differ in their last number alone.
#[derive(Clone, Debug)]
pub(super) struct Series {
    /// Before and after the number; a name without a number is all before it.
    pub before: String,
    pub after: String,
    /// In ascending numbers; at least one.
    pub members: Vec<Member>,
}

/// A file of a series.
#[derive(Clone, Debug)]
pub(super) struct Member {
    /// From the folder on.
    pub name: String,
    /// Its number, if it has one; with a fraction where the name has one.
    pub number: Option<f64>,
    /// Digits of the number.
    pub digits: usize,
}

impl Series {
    /// Returns the names of all members.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.members.iter().map(|member| member.name.as_str())
    }

    /// Returns the member of a number; of a series of one that one.
    pub fn at(&self, number: Option<f64>) -> Option<&Member> {
        if let [only] = &self.members[..] {
            return Some(only);
        }
        self.members.iter().find(|member| member.number == number)
    }

    /// Returns whether a word occurs in its names.
    pub fn says(&self, words: &[&str]) -> bool {
        let name = self.members[0].name.to_lowercase();
        words.iter().any(|word| name.contains(word))
    }

    /// Returns the pattern of its names, as the key `poses` has it.
    pub fn pattern(&self) -> String {
        format!("{}{{:0{}}}{}", self.before, self.members[0].digits, self.after)
    }
}

/// Returns the files of a folder and of the folders in it, without those that are hidden.
pub(super) fn list(folder: &Path) -> Result<Vec<Series>, CaptureError> {
    let mut names = Vec::new();
    collect(folder, "", 2, &mut names).map_err(|error| {
        CaptureError::new(folder, format!("cannot be listed ({error})"), "give a folder with the files of a capture")
    })?;
    if names.len() >= MOST {
        let what = format!("holds more than the {MOST} files that are looked at");
        return Err(CaptureError::new(folder, what, "give the folder of one sequence"));
    }
    names.sort();
    let mut series: Vec<Series> = Vec::new();
    for name in names {
        let (before, number, after) = parts(&name);
        let (number, digits) = (number.parse().ok(), number.len());
        let (before, after) = (before.to_owned(), after.to_owned());
        let member = Member { name, number, digits };
        match series.iter_mut().find(|series| series.before == before && series.after == after) {
            Some(series) => series.members.push(member),
            None => series.push(Series { before, after, members: vec![member] }),
        }
    }
    for series in &mut series {
        series.members.sort_by(|a, b| a.number.unwrap_or(0.0).total_cmp(&b.number.unwrap_or(0.0)));
    }
    Ok(series)
}

fn collect(folder: &Path, prefix: &str, levels: usize, names: &mut Vec<String>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let Ok(name) = entry.file_name().into_string() else { continue };
        if name.starts_with('.') || names.len() >= MOST {
            continue;
        }
        let kind = std::fs::metadata(entry.path())?;
        if kind.is_dir() && levels > 1 && name != "galpix-out" {
            collect(&entry.path(), &format!("{prefix}{name}/"), levels - 1, names)?;
        } else if kind.is_file() {
            names.push(format!("{prefix}{name}"));
        }
    }
    Ok(())
}

/// Returns what is before the last number of a name, the number with its fraction, and what is after it. The number of
/// a format's name ("mp4") is none.
fn parts(name: &str) -> (&str, &str, &str) {
    let stem = name.len() - name.rsplit_once('.').map_or(0, |(_, ending)| ending.len() + 1);
    let digit = |at: usize| name.as_bytes()[at].is_ascii_digit();
    let folder = name.rfind('/').map_or(0, |at| at + 1);
    let Some(last) = (folder..stem).rev().find(|&at| digit(at)) else { return (name, "", "") };
    let first = |last: usize| (folder..=last).rev().take_while(|&at| digit(at)).last().unwrap_or(last);
    let mut start = first(last);
    // A time stamp: digits, a point, digits.
    if start >= folder + 2 && name.as_bytes()[start - 1] == b'.' && digit(start - 2) {
        start = first(start - 2);
    }
    (&name[..start], &name[start..=last], &name[last + 1..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_has_its_last_number_with_its_fraction() {
        for (name, wanted) in [
            ("rgb/0001.png", ("rgb/", "0001", ".png")),
            ("frame-000079.color.jpg", ("frame-", "000079", ".color.jpg")),
            ("000000_10_flow.png", ("000000_", "10", "_flow.png")),
            ("rgb/1305031102.175304.png", ("rgb/", "1305031102.175304", ".png")),
            ("view.01/depth.exr", ("view.01/depth.exr", "", "")),
            ("a.h5", ("a.h5", "", "")),
            ("7", ("", "7", "")),
        ] {
            assert_eq!(parts(name), wanted, "{name}");
        }
    }
}
