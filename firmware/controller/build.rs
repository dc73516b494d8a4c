//! The level of the log: `defmt` reads it while this crate is compiled.

use std::env;

fn main() {
    println!("cargo:rerun-if-env-changed=DEFMT_LOG");
    println!("cargo:rustc-env=DEFMT_LOG={}", env::var("DEFMT_LOG").unwrap_or_else(|_| "info".into()));
}
