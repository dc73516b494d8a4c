//! `galpix demo`, and `galpix` alone.

use std::collections::BTreeSet;
use std::path::Path;

use crate::{SCENES, done, entries, folder, output, text};

/// The report at `path`: whole, with all scenes, and without a word from elsewhere.
fn assert_page(path: &Path) {
    let page = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(page.starts_with("<!DOCTYPE html>") || page.starts_with("<!doctype html>"), "{}", &page[..40]);
    assert!(page.trim_end().ends_with("</html>"), "the page is whole");
    for scene in SCENES {
        assert!(page.contains(&format!("-{scene}\"")), "{scene} is not in the page");
    }
    for attribute in ["src", "href", "url(", "@import"] {
        for at in page.match_indices(attribute).map(|(at, _)| at + attribute.len()) {
            let target = page[at..].trim_start_matches(['=', '"', '\'', ' ']);
            let outside = ["http:", "https:", "//", "file:"].iter().any(|scheme| target.starts_with(scheme));
            assert!(!outside, "{attribute}: {}", target.chars().take(60).collect::<String>());
        }
    }
    let films = page.matches("src=\"data:image/png;base64,").count();
    assert!(films >= SCENES.len(), "{films} films");
}

fn assert_demo(folder: &Path, stdout: &str, out: &str) {
    let last = stdout.lines().last().expect("a last line");
    assert_eq!(Path::new(last), Path::new(out).join("report.html"));
    assert_page(&folder.join(last));
    for scene in SCENES {
        assert!(stdout.lines().any(|line| line.split_whitespace().next() == Some(scene)), "{scene}\n{stdout}");
    }
    assert_eq!(entries(&folder.join(out)), BTreeSet::from(["report.html".to_owned()]));
}

/// Returns the names and figures of a table; the last two columns are times.
fn without_times(stdout: &str) -> Vec<&str> {
    fn shorter(line: &str) -> &str {
        line.trim_end().rsplit_once(' ').map_or("", |(rest, _)| rest.trim_end())
    }
    stdout.lines().map(|line| shorter(shorter(line))).collect()
}

#[test]
fn demo_ends_with_the_path_of_its_report_and_is_what_galpix_does_by_itself() {
    let folder = folder();
    let demo = done(folder.path(), &["demo", "--out", "there/deeper"]);
    assert_demo(folder.path(), &demo, "there/deeper");
    let alone = output(folder.path(), &[]);
    assert_eq!(alone.status.code(), Some(0));
    assert!(text(&alone.stderr).lines().all(|line| line.starts_with("demo: ")), "{}", text(&alone.stderr));
    let alone = text(&alone.stdout);
    assert_demo(folder.path(), alone, "galpix-out");
    assert_eq!(without_times(&demo), without_times(alone));
}
