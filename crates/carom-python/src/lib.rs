//! The compiled part of the Python package `carom`. It passes cases, records and states to Python
//! as plain data; the package in `python/carom` gives them their interface.

// Arguments that come from Python are owned.
#![allow(clippy::needless_pass_by_value)]

mod case;
mod error;
mod explain;
mod function;
mod law;
mod record;
mod simulation;
mod study;
mod tables;
mod threads;
mod values;
mod watched;

use pyo3::prelude::*;

#[pymodule]
mod _carom {
    use super::{Bound, PyModule, PyModuleMethods, PyResult};
    #[pymodule_export]
    use crate::case::{Case, toml, toml_document};
    #[pymodule_export]
    use crate::explain::{explain, schemes};
    #[pymodule_export]
    use crate::record::{Record, open, resume};
    #[pymodule_export]
    use crate::simulation::Simulation;
    #[pymodule_export]
    use crate::study::{study, study_arm, study_collect, study_plan, study_table};
    #[pymodule_export]
    use crate::threads::most_concurrent;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
