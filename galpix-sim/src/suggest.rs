//! What somebody may have meant by a name that is not there.

/// How like two names are at least, from 0 to 1.
const LIKE: f64 = 0.75;

/// Returns the candidate that is most like a name, if one is like it at all.
#[must_use]
pub fn similar<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let name = name.to_lowercase();
    let likeness = |candidate: &'c str| (strsim::jaro_winkler(&name, candidate), candidate);
    let best = candidates.into_iter().map(likeness).max_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 >= LIKE).then_some(best.1)
}

/// Returns ` (did you mean ...?)`, or nothing where no candidate is like the name.
#[must_use]
pub fn hint<'c>(name: &str, candidates: impl IntoIterator<Item = &'c str>) -> String {
    similar(name, candidates).map_or_else(String::new, |similar| format!(" (did you mean `{similar}`?)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_finds_its_name_and_anything_else_nothing() {
        let names = ["pillars", "crossing", "near-plane"];
        for (slip, meant) in [("pilars", "pillars"), ("Crossing", "crossing"), ("near_plane", "near-plane")] {
            assert_eq!(similar(slip, names), Some(meant));
        }
        assert_eq!((similar("zebra", names), similar("", names)), (None, None));
        assert_eq!(hint("crossing", names), " (did you mean `crossing`?)");
        assert_eq!(hint("zebra", names), "");
    }
}
