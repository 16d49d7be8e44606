//! A simulation that is advanced step by step.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, TryLockError};

use carom::record::History;
use carom::recording::Rows;
use carom::{GridReport, Setup, Simulation as Library, State};
use numpy::PyArray2;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde_json::Value as Json;

use crate::case::Case;
use crate::error::{CaseError, of_problems};
use crate::function::{Failure, functions, raised};
use crate::law::OwnLaw;
use crate::tables;
use crate::threads::thread_count;

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
    /// Materials whose laws are of the program, each with the count of numbers that it remembers.
    laws: Vec<String>,
}

impl Simulation {
    /// The state between two steps. Waiting for the end of a step could wait for ever: a function
    /// of the program, called within the step, may ask for it.
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
    fn new(
        py: Python<'_>,
        case: &Case,
        threads: Option<usize>,
        given: &Bound<'_, PyDict>,
        laws: &Bound<'_, PyDict>,
        fingerprints: HashMap<String, String>,
    ) -> PyResult<Self> {
        let (functions, failure) = functions(given)?;
        let names = functions.0.keys().cloned().collect();
        let mut own = Vec::new();
        for (material, object) in laws {
            let material: String = material.extract()?;
            own.push((material.clone(), OwnLaw::new(material, &object, failure.clone())?));
        }
        let mut remembered: Vec<String> =
            fingerprints.iter().map(|(material, of_law)| format!("{material}:{of_law}")).collect();
        remembered.sort();
        let spec = case.with(functions);
        let started = py.detach(|| {
            let setup = Setup::new(&spec).threads(thread_count(threads));
            let setup = own.into_iter().fold(setup, |setup, (material, law)| match law {
                OwnLaw::Elastic(law) => setup.material(&material, law),
                OwnLaw::WithMemory(law) => setup.material(&material, law),
            });
            let library = setup.start()?;
            let rows = Rows::new(&spec, &library);
            Ok(Inner { library, rows })
        });
        if let Some(error) = raised(&failure) {
            return Err(error);
        }
        let inner = started.map_err(|problems| of_problems(&case.document, &problems))?;
        Ok(Self { case: spec, inner: Mutex::new(inner), failure, given: names, laws: remembered })
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
        let report =
            advanced.map_err(|stopped| StoppedError::new_err(self.case.in_units(&stopped.to_string())))?;
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
    fn row(&self, py: Python<'_>) -> PyResult<Vec<f64>> {
        let inner = self.inner()?;
        // Laws in Python are called on other threads.
        Ok(py.detach(|| inner.rows.row(&inner.library)))
    }

    /// The active contact nodes, by column.
    fn contact<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let inner = self.inner()?;
        let contact = py.detach(|| inner.rows.contact(&inner.library));
        tables::contact(py, &contact, self.case.facts().contact_columns())
    }

    /// Units of these columns.
    fn contact_units(&self) -> PyResult<HashMap<&'static str, String>> {
        let inner = self.inner()?;
        let history = History::new(inner.rows.columns().to_vec(), Vec::new());
        Ok(tables::contact_units(&history, self.case.facts().contact_columns()))
    }

    /// The state as bytes, with the names of the functions and the laws, and the case.
    fn checkpoint<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let inner = self.inner()?;
        let all = (&self.given, &self.laws, self.resolved().to_string(), inner.library.state());
        let bytes = postcard::to_stdvec(&all);
        let bytes = bytes.map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Continues from a checkpoint of the same case with the same functions and laws.
    fn restore(&self, checkpoint: &[u8]) -> PyResult<()> {
        let wrong = |why: &str| PyValueError::new_err(format!("this is not a checkpoint: {why}"));
        let read: Result<((Vec<String>, Vec<String>, String, State), _), _> =
            postcard::take_from_bytes(checkpoint);
        let ((given, laws, case, state), rest) = read.map_err(|error| wrong(&error.to_string()))?;
        if !rest.is_empty() {
            return Err(wrong(&format!("{} bytes follow its end", rest.len())));
        }
        for (what, was, is) in [("functions", given, &self.given), ("laws", laws, &self.laws)] {
            if was != *is {
                let named =
                    |names: &[String]| if names.is_empty() { "none".into() } else { names.join(", ") };
                let was = named(&was);
                let is = named(is);
                return Err(CaseError::new_err(format!(
                    "the checkpoint was made with other {what}: {was}, and this simulation has: {is}\n\
                     try: give the same {what} again, or start from the beginning"
                )));
            }
        }
        let case: Json = serde_json::from_str(&case).map_err(|error| wrong(&error.to_string()))?;
        if let Some((key, was, is)) = difference("", &case, &self.resolved()) {
            return Err(PyValueError::new_err(format!(
                "the checkpoint is of another case: its {key} is {was}, and that of this simulation is {is}\n\
                 try: restore it in a simulation of its own case; another case starts from the directory of a \
                 run, [initial] from"
            )));
        }
        let mut inner = self.inner()?;
        let Inner { library, rows } = &mut *inner;
        library.restore(state).map_err(|other| PyValueError::new_err(other.to_string()))?;
        rows.begin(library);
        Ok(())
    }
}

impl Simulation {
    /// The case with all defaults.
    fn resolved(&self) -> Json {
        serde_json::to_value(&self.case).unwrap_or_default()
    }
}

/// The first key in which two cases differ, with both values.
fn difference(key: &str, was: &Json, is: &Json) -> Option<(String, String, String)> {
    let below = |part: &str| if key.is_empty() { part.to_owned() } else { format!("{key}.{part}") };
    match (was, is) {
        (Json::Object(a), Json::Object(b)) => a.keys().chain(b.keys()).find_map(|part| {
            let of = |map: &serde_json::Map<String, Json>| map.get(part).cloned().unwrap_or_default();
            difference(&below(part), &of(a), &of(b))
        }),
        (Json::Array(a), Json::Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).enumerate().find_map(|(i, (a, b))| difference(&below(&i.to_string()), a, b))
        }
        _ => (was != is).then(|| (key.to_owned(), was.to_string(), is.to_string())),
    }
}
