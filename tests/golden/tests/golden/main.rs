//! Not a bit of any golden vector has changed. HiddenLayer it the exhaustive tests of what no frame calls. All of it is
//! what a mutant of the core is run against.

mod resolve;

/// To accept a change of bits: `cargo run --release -- vectors --out target/vectors`, copy `target/vectors/hashes.txt`
/// over `tests/golden/hashes.txt`, and explain in the changelog why they changed.
#[test]
fn the_vectors_have_the_hashes_that_are_kept() {
    let kept = include_str!("../../hashes.txt");
    let made = galpix_vectors::hashes(&galpix_vectors::cases(0).unwrap());
    let different = kept.lines().zip(made.lines()).find(|(kept, made)| kept != made);
    assert_eq!(different, None, "bits have changed: (kept, made now)");
    assert_eq!(kept.lines().count(), made.lines().count(), "cases came or went");
    assert!(made.lines().count() > 500);
}
