//! The documents that `--json` prints: every one with the same head, what went wrong too.

use schemars::JsonSchema;
use serde::Serialize;

use super::call::command;
use super::{CliError, print};
use crate::study::{Headed, SCHEMA};

#[derive(Serialize, JsonSchema)]
pub struct Failure {
    error: Reason,
}

#[derive(Serialize, JsonSchema)]
struct Reason {
    exit_code: u8,
    message: String,
}

/// Prints one JSON document of a kind on standard output; `body` has keys.
pub fn print_json(kind: &'static str, body: &impl Serialize) -> Result<(), CliError> {
    let headed = Headed { schema: SCHEMA, kind, version: env!("CARGO_PKG_VERSION"), command: &command(), body };
    print(&serde_json::to_string_pretty(&headed).map_err(|error| CliError::Failed(error.to_string()))?)
}

/// Prints the document of a command that failed.
pub fn print_error(error: &CliError) -> Result<(), CliError> {
    print_json("error", &Failure { error: Reason { exit_code: error.code(), message: error.to_string() } })
}
