//! `galpix completions` and `galpix man`: the command line described for shells and for readers.

use std::io;
use std::path::{Path, PathBuf};

use clap::{Args, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man as Page;

use super::{Arguments, CliError, print, printed};
use crate::output::save::write_atomically;

/// Arguments of `galpix completions`.
#[derive(Debug, Args)]
pub struct Completions {
    /// The shell
    #[arg(value_enum, value_name = "SHELL")]
    shell: Shell,
}

impl Completions {
    /// Prints the completions.
    pub fn run(&self) -> Result<(), CliError> {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut Arguments::command(), "galpix", &mut text);
        print(String::from_utf8_lossy(&text).trim_end())
    }
}

/// Arguments of `galpix man`.
#[derive(Debug, Args)]
pub struct Man {
    /// Folder for galpix.1 and a page of each command [default: galpix.1 is printed]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Man {
    /// Prints or writes the pages.
    pub fn run(&self) -> Result<(), CliError> {
        let mut command = Arguments::command();
        command.build();
        match &self.out {
            None => printed(Page::new(command).render(&mut io::stdout())),
            Some(out) => pages(&command, out),
        }
    }
}

fn pages(command: &clap::Command, out: &Path) -> Result<(), CliError> {
    std::fs::create_dir_all(out).map_err(|error| CliError::unwritable(out, &error))?;
    for of in std::iter::once(command).chain(command.get_subcommands()) {
        let page = Page::new(of.clone());
        let path = out.join(page.get_filename());
        let mut text = Vec::new();
        let written = page.render(&mut text).and_then(|()| write_atomically(&path, &text));
        written.map_err(|error| CliError::unwritable(&path, &error))?;
    }
    print(&out.join("galpix.1").display().to_string())
}
