//! Makes the pictures of the documents anew, from the project's root: `cargo run --release -p galpix-sim --example
//! figures`.

use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/figures");
    std::fs::create_dir_all(&folder)?;
    for name in galpix_sim::figure::NAMES {
        let path = folder.join(format!("{name}.png"));
        galpix_sim::output::html::write_atomically(&path, &galpix_sim::figure::made(name)?)?;
        println!("{}", path.display());
    }
    Ok(())
}
