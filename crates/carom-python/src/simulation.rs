//! A simulation that is advanced step by step.

use std::sync::{Mutex, MutexGuard, TryLockError};

use carom::record::contact_axes;
use carom::recording::Rows;
use carom::{GridReport, Setup, Simulation as Library, State};
use numpy::PyArray2;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::case::Case;
use crate::error::{CaseError, of_problems};
use crate::function::{Failure, functions, raised};
use crate::tables;

pyo3::import_exception!(carom.errors, StoppedError);

struct Inner {
    library: Library,
    rows: Rows,
}

/// A simulation with the rows that a run would record.
#[pyclass(frozen, module = "carom._carom")]
pub(crate) struct Simulation {
    case: carom::case::Case,
    inner: Mutex<Inner>,
    failure: Failure,
    /// Names of the functions of the program.
    given: Vec<String>,
}

impl Simulation {
    /// The state between two steps. Waiting for the end of a step could wait for ever: a function of
    /// the program, called within the step, may ask for it.
    fn inner(&self) -> PyResult<MutexGuard<'_, Inner>> {
        match self.inner.try_lock() {
            Ok(inner) => Ok(inner),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(
                "the simulation is being advanced; its state is read between two steps",
            )),
        }
    }

    fn vectors<'py>(
        &self,
        py: Python<'py>,
        of: fn(&State) -> &Vec<f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let inner = self.inner()?;
        tables::rows(py, of(inner.library.state()).clone(), inner.library.model().dimension)
    }
}

#[pymethods]
impl Simulation {
    #[new]
    fn new(py: Python<'_>, case: &Case, threads: usize, given: &Bound<'_, PyDict>) -> PyResult<Self> {
        let (functions, failure) = functions(given)?;
        let names = functions.0.keys().cloned().collect();
        let spec = case.with(functions);
        let started = py.detach(|| {
            let library = Setup::new(&spec).threads(threads).start()?;
            let rows = Rows::new(&spec, &library);
            Ok(Inner { library, rows })
        });
        if let Some(error) = raised(&failure) {
            return Err(error);
        }
        let inner = started.map_err(|problems| of_problems(&case.document, &problems))?;
        Ok(Self { case: spec, inner: Mutex::new(inner), failure, given: names })
    }

    /// Advances to the next grid time: Newton iterations, rejected attempts, activations, releases,
    /// penetration.
    fn advance(&self, py: Python<'_>) -> PyResult<(u32, u32, u32, u32, f64)> {
        let mut guard = self.inner()?;
        let inner: &mut Inner = &mut guard;
        let advanced = py.detach(|| {
            let mut report = GridReport::default();
            let advanced = inner.library.advance(&mut report);
            inner.rows.advanced(&report);
            advanced.map(|()| report)
        });
        if let Some(error) = raised(&self.failure) {
            return Err(error);
        }
        let report = advanced.map_err(|stopped| StoppedError::new_err(stopped.to_string()))?;
        let GridReport { newton, rejected, activations, releases, penetration, .. } = report;
        Ok((newton, rejected, activations, releases, penetration.all))
    }

    #[getter]
    fn finished(&self) -> PyResult<bool> {
        Ok(self.inner()?.library.finished())
    }

    #[getter]
    fn step(&self) -> PyResult<u64> {
        Ok(self.inner()?.library.state().step)
    }

    #[getter]
    fn steps(&self) -> PyResult<u64> {
        Ok(self.inner()?.library.steps())
    }

    #[getter]
    fn time(&self) -> PyResult<f64> {
        Ok(self.inner()?.library.state().time)
    }

    #[getter]
    fn dt(&self) -> PyResult<f64> {
        Ok(self.inner()?.library.dt())
    }

    #[getter]
    fn y<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.vectors(py, |state| &state.y)
    }

    #[getter]
    fn v<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.vectors(py, |state| &state.v)
    }

    #[getter]
    fn a<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.vectors(py, |state| &state.a)
    }

    /// Reference positions.
    #[getter]
    fn reference<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let inner = self.inner()?;
        let model = inner.library.model();
        tables::rows(py, model.reference.clone(), model.dimension)
    }

    /// Name, first node, end node of every body.
    fn bodies(&self) -> PyResult<Vec<(String, usize, usize)>> {
        let inner = self.inner()?;
        let parts = inner.library.model().parts.iter();
        Ok(parts.map(|part| (part.name.clone(), part.nodes().start, part.nodes().end)).collect())
    }

    /// Names and units of the columns of a row.
    fn columns(&self) -> PyResult<Vec<(String, String)>> {
        Ok(self.inner()?.rows.columns().iter().map(|c| (c.name.clone(), c.unit.clone())).collect())
    }

    /// The row that a run would record now.
    fn row(&self) -> PyResult<Vec<f64>> {
        let inner = self.inner()?;
        Ok(inner.rows.row(&inner.library))
    }

    /// The active contact nodes, by column.
    fn contact<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let inner = self.inner()?;
        let axes = contact_axes(&serde_json::Value::Null);
        tables::contact(py, &inner.rows.contact(&self.case, &inner.library), axes)
    }

    /// The state as bytes, with the names of the functions.
    fn checkpoint<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let inner = self.inner()?;
        let bytes = postcard::to_stdvec(&(&self.given, inner.library.state()));
        let bytes = bytes.map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Continues from a checkpoint of the same case with the same functions.
    fn restore(&self, checkpoint: &[u8]) -> PyResult<()> {
        let read: Result<(Vec<String>, State), _> = postcard::from_bytes(checkpoint);
        let (given, state) =
            read.map_err(|error| PyValueError::new_err(format!("this is no checkpoint: {error}")))?;
        if given != self.given {
            let (was, is) = (given.join(", "), self.given.join(", "));
            return Err(CaseError::new_err(format!(
                "the checkpoint was made with other functions: {was}, and this simulation has: {is}\n\
                 try: give the same functions again, or start from the beginning"
            )));
        }
        self.inner()?.library.restore(state).map_err(|other| PyValueError::new_err(other.to_string()))
    }
}
