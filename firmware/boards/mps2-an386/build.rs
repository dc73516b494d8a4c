//! Link arguments, emitted here and not in a configuration file, which holds only where cargo is started beside it; and
//! what this was compiled by and for, for the report.

use std::env;
use std::process::Command;

fn main() {
    let folder = env::var("CARGO_MANIFEST_DIR").expect("set by cargo");
    println!("cargo:rustc-link-search={folder}");
    println!("cargo:rustc-link-arg-bins=--nmagic");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    println!("cargo:rerun-if-changed=memory.x");

    println!("cargo:rustc-env=GALPIX_TARGET={}", env::var("TARGET").expect("set by cargo"));
    let version = Command::new(env::var_os("RUSTC").expect("set by cargo")).arg("--version").output();
    let version = version.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    println!("cargo:rustc-env=GALPIX_RUSTC={}", version.expect("the compiler answers"));
}
