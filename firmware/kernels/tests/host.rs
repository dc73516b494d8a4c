//! The host gives the same hash as the processors in the emulator.

use galpix_kernels::{HASH, ROWS, WORDS, check};

#[test]
fn all_states_are_right_and_have_the_hash_of_every_processor() {
    let (mut front, mut back, mut starts) = (vec![0; WORDS], vec![0; WORDS], vec![0; ROWS]);
    let hash = check(&mut front, &mut back, &mut starts);
    assert_eq!(hash.map(|hash| format!("{hash:08x}")), Ok(format!("{HASH:08x}")));
}
