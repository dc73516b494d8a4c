//! Link arguments: no start-up code, and the relocations kept, from which it is read what refers to what.

fn main() {
    println!("cargo:rustc-link-arg-bins=-e_start");
    println!("cargo:rustc-link-arg-bins=--gc-sections");
    println!("cargo:rustc-link-arg-bins=--emit-relocs");
}
