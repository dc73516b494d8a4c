//! The command `galpix`. Exit codes: 0 done, 2 unusable arguments or input, 1 anything else.

use std::process::ExitCode;

fn main() -> ExitCode {
    galpix_sim::cli::main()
}
