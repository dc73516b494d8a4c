//! The extension module `galpix._galpix`: what the Python package calls.
//!
//! The package in `galpix/` has the public names, their documentation and the checks of shapes and dtypes; here arrays
//! become the slices that `galpix-core` and `galpix-sim` take, and the interpreter is let go while they work.

mod arrays;
mod bits;
mod ddoc;
mod engine;
mod fill;
mod inpaint;
mod map;
mod metric;
mod names;
mod source;
mod update;

/// The functions of the module; `galpix/_galpix.pyi` has their types.
#[pyo3::pymodule]
mod _galpix {
    #[pymodule_export]
    use super::bits::{certify, derive, record, shown_off_px, smallest};
    #[pymodule_export]
    use super::ddoc::distortion;
    #[pymodule_export]
    use super::engine::extrapolate;
    #[pymodule_export]
    use super::fill::fill_mode;
    #[pymodule_export]
    use super::inpaint::inpaint;
    #[pymodule_export]
    use super::map::Map;
    #[pymodule_export]
    use super::metric::{flip, pooled_db, psnr, ssim, ssimulacra2};
    #[pymodule_export]
    use super::source::{Source, scenes, write_vectors};

    /// Adds the version.
    #[pymodule_init]
    fn init(module: &pyo3::Bound<'_, pyo3::types::PyModule>) -> pyo3::PyResult<()> {
        pyo3::types::PyModuleMethods::add(module, "__version__", env!("CARGO_PKG_VERSION"))
    }
}
