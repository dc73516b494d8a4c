//! One importer of `galpix` under libFuzzer. The environment variable `IMPORTER` names it; seeds are written into the
//! folder `SEEDS` first, if that is given. See `run.sh`.
//!
//! A case is one file of a small capture whose other files are right. The first byte of the input chooses the manifest,
//! the rest is the file.

#![no_main]

// The tests' own writers; those that no seed needs are left unused.
#[allow(dead_code)]
#[path = "../../../galpix-sim/src/source/capture/tests/encode.rs"]
mod encode;
mod importers;
mod seeds;

use std::sync::OnceLock;
use std::time::Duration;

use cpu_time::ThreadTime;
use importers::Importer;
use libfuzzer_sys::fuzz_target;

static IMPORTER: OnceLock<Importer> = OnceLock::new();

fn chosen() -> Importer {
    let name = std::env::var("IMPORTER").unwrap_or_default();
    let Some(importer) = Importer::named(&name) else {
        eprintln!("IMPORTER is \"{name}\": name one of {}", importers::NAMES.join(", "));
        std::process::exit(2);
    };
    if let Some(folder) = std::env::var_os("SEEDS") {
        for (index, seed) in importer.seeds().iter().enumerate() {
            std::fs::write(std::path::Path::new(&folder).join(format!("seed-{index}")), seed)
                .expect("a seed is written");
        }
    }
    importer
}

/// The most that a case may take, of the processor's time: the fuzzer's own clock counts what else the machine does.
const LONGEST: Duration = Duration::from_secs(1);

fuzz_target!(init: { IMPORTER.get_or_init(chosen); }, |bytes: &[u8]| {
    let started = ThreadTime::now();
    IMPORTER.get_or_init(chosen).read(bytes);
    let took = started.elapsed();
    assert!(took < LONGEST, "a case took {took:?}");
});
