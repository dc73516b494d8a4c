//! The pictures in the documents are what the engine makes today.

use std::path::Path;

#[test]
fn the_figures_of_the_documents_are_what_the_engine_makes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/figures");
    let mut compared = 0;
    for entry in std::fs::read_dir(&folder).expect("docs/figures") {
        let path = entry.expect("an entry").path();
        let Some(scene) = path.file_stem().and_then(|stem| stem.to_str()) else { continue };
        let kept = std::fs::read(&path).expect("a figure");
        let made = galpix_sim::figure::made(scene).unwrap_or_else(|error| panic!("{error}"));
        assert!(
            kept == made,
            "docs/figures/{scene}.png is not what the engine makes today: look at what changed, then make it anew with \
             `cargo run --release -p galpix-sim --example figures`"
        );
        compared += 1;
    }
    assert!(compared == galpix_sim::figure::NAMES.len(), "only {compared} figures");
}
