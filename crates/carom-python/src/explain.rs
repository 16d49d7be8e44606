//! Properties of time integrators.

use carom::case::read_scheme;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::{CaseError, of_case};
use crate::values::from_json;

/// The output of `carom explain KIND KEY=VALUE … --json`.
#[pyfunction]
pub(crate) fn explain<'py>(
    py: Python<'py>,
    kind: &str,
    parameters: Vec<String>,
) -> PyResult<Bound<'py, PyAny>> {
    let spec = read_scheme(kind, &parameters).map_err(|error| of_case(&error))?;
    if spec.is_static() {
        return Err(CaseError::new_err("`static` is not a time integrator: its steps are load steps"));
    }
    let integrator = spec.integrator().map_err(|error| CaseError::new_err(error.to_string()))?;
    json(py, &integrator.explain())
}

/// The output of `carom explain --json`.
#[pyfunction]
pub(crate) fn schemes(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    json(py, &carom::time::explain_all())
}

fn json<'py>(py: Python<'py>, value: &impl serde::Serialize) -> PyResult<Bound<'py, PyAny>> {
    let value = serde_json::to_value(value).map_err(|error| PyValueError::new_err(error.to_string()))?;
    from_json(py, &value)
}
