//! `galpix plan`.

use serde_json::Value;

use crate::{done, folder, json, refused};

#[test]
fn a_plan_says_what_is_not_needed() {
    let folder = folder();
    let still = json(folder.path(), &["plan", "still", "--max-error", "0.5", "--json"]);
    assert_eq!((&still["plan"]["motion"]["velocity"], &still["plan"]["depth_bits"]), (&Value::Bool(false), &0.into()));
    assert!(still["plan"]["code"].as_str().expect("Rust").contains("const LAYOUT: Layout = Layout::STILL;"));
    let text = done(folder.path(), &["plan", "drift", "--max-error", "0.5"]);
    for word in ["certified px", "measured px", "impl Profile for PlannedDrift", "full budget"] {
        assert!(text.contains(word), "{word:?} is not in {text}");
    }
    let page = crate::read(&folder.path().join("galpix-out/plan/plan.html"));
    assert!(page.contains("impl Profile for PlannedDrift") && page.contains(">certified px</td>"), "{page}");
    refused(folder.path(), &["plan", "ball", "--max-error", "0.00000001"], &["no budget certifies"]);
    refused(folder.path(), &["plan", "ball"], &["--max-error"]);
    refused(folder.path(), &["plan", "nowhere", "--max-error", "1"], &["nowhere", "galpix scenes"]);
}
