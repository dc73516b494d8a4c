//! Names of Python as choices of Rust, and errors as exceptions.

use std::fmt::Display;

use galpix_core::inpaint::Gamma;
use galpix_core::{Colour, Rounding};
use galpix_sim::engine::fill::{Fill, Inpaint};
use galpix_sim::engine::{ScanOut, Scheme};
use galpix_sim::source::hidden::{Arrangement, Kind, RADIUS, SEPARATION, Strategy};
use pyo3::PyErr;
use pyo3::exceptions::PyValueError;

/// Makes a `ValueError` of an error, with its sentence.
pub fn value_error(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Returns the choice of a name.
///
/// *Errors:* `ValueError` with all names that there are.
fn choice<T: Copy>(argument: &str, given: &str, all: &[T], name: impl Fn(T) -> &'static str) -> Result<T, PyErr> {
    let names = || all.iter().map(|&choice| name(choice)).collect::<Vec<_>>().join(", ");
    let found = all.iter().copied().find(|&choice| name(choice) == given);
    found.ok_or_else(|| value_error(format!("`{argument}` is '{given}': give one of {}", names())))
}

/// Returns a rounding by its name.
pub fn rounding(name: &str) -> Result<Rounding, PyErr> {
    choice("rounding", name, &Rounding::ALL, Rounding::name)
}

/// Returns a fill by its name; an inpainting with this gamma, if there is one.
pub fn fill(name: &str, gamma: Option<&str>) -> Result<Fill, PyErr> {
    let fill = choice("fill", name, &Fill::all(), Fill::name)?;
    match (fill, gamma) {
        (_, None) => Ok(fill),
        (Fill::Inpaint(inpaint), Some(gamma)) => Ok(Fill::Inpaint(Inpaint { gamma: self::gamma(gamma)?, ..inpaint })),
        (Fill::Mode(_), Some(_)) => Err(value_error(format!(
            "`gamma` is for push-pull and metamer, and does nothing for '{name}': leave it out"
        ))),
    }
}

/// Returns a power of the validity by its name.
pub fn gamma(name: &str) -> Result<Gamma, PyErr> {
    choice("gamma", name, &Gamma::ALL, Gamma::name)
}

/// Returns a scheme by its name.
pub fn scheme(name: &str) -> Result<Scheme, PyErr> {
    choice("scheme", name, &[Scheme::Map, Scheme::Source], Scheme::name)
}

/// Returns a scan-out by its name.
pub fn scan_out(name: &str) -> Result<ScanOut, PyErr> {
    choice("scan_out", name, &[ScanOut::Nearest, ScanOut::SubCell], ScanOut::name)
}

/// Returns a colour format by its name.
pub fn colour(name: &str) -> Result<Colour, PyErr> {
    const ALL: [(Colour, &str); 4] =
        [(Colour::RGB888, "rgb888"), (Colour::RGB565, "rgb565"), (Colour::GRAY8, "gray8"), (Colour::GRAY4, "gray4")];
    choice("colour", name, &ALL, |(_, name)| name).map(|(colour, _)| colour)
}

/// Returns which hidden samples are handed over, as `galpix run --hidden` does: those that the disocclusion map covers.
pub fn hidden(name: &str, scheme: Scheme) -> Result<Strategy, PyErr> {
    let all = [
        (Kind::None, "none"),
        (Kind::Second { separation: SEPARATION }, "second"),
        (Kind::Ddoc { radius: RADIUS }, "ddoc"),
        (Kind::Unlimited, "unlimited"),
    ];
    let (kind, _) = choice("hidden", name, &all, |(_, name)| name)?;
    let arrangement = match scheme {
        Scheme::Map => Arrangement::Farther,
        Scheme::Source => Arrangement::Nearer,
    };
    Ok(if kind == Kind::None { Strategy::ONE } else { Strategy { kind, arrangement, culled: true } })
}
