//! Cases: read and checked, with the place of every key.

use std::path::PathBuf;

use carom::Setup;
use carom::case::{Case as Spec, Document, Functions, merged, read};
use carom::record::Source;
use carom::recording::{self, Progress, RunError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{of_case, of_problems, of_run};
use crate::function::{functions, raised};
use crate::record::Record;
use crate::threads::thread_count;
use crate::values::{from_json, from_table, to_document, to_toml};
use crate::watched::watched;

/// A case with its text and overrides.
#[pyclass(frozen, module = "carom._carom")]
pub(crate) struct Case {
    pub(crate) document: Document,
    pub(crate) spec: Spec,
}

impl Case {
    fn of(document: Document) -> PyResult<Self> {
        let spec = read(&document).map_err(|problems| of_problems(&document, &problems))?;
        Ok(Self { document, spec })
    }

    /// The case with functions of the program.
    pub(crate) fn with(&self, functions: Functions) -> Spec {
        Spec { functions, ..self.spec.clone() }
    }

    fn source(&self) -> Source {
        Source { text: self.document.text().to_owned(), sets: self.document.sets(), ..Source::default() }
    }
}

#[pymethods]
impl Case {
    #[staticmethod]
    fn open(path: PathBuf, sets: Vec<String>) -> PyResult<Self> {
        Self::of(Document::open(&path, &sets).map_err(|error| of_case(&error))?)
    }

    #[staticmethod]
    fn parse(name: &str, text: &str, sets: Vec<String>) -> PyResult<Self> {
        Self::of(Document::parse(name, text, &sets).map_err(|error| of_case(&error))?)
    }

    /// The case with other overrides.
    fn with_sets(&self, sets: Vec<String>) -> PyResult<Self> {
        let name = self.document.name();
        let text = self.document.text();
        Self::parse(name, text, sets)
    }

    /// The text of the case with other overrides applied; it is not checked.
    fn text_with(&self, sets: Vec<String>) -> PyResult<String> {
        merged(self.document.text(), &sets).map_err(|error| of_case(&error))
    }

    #[getter]
    fn name(&self) -> &str {
        self.document.name()
    }

    #[getter]
    fn text(&self) -> &str {
        self.document.text()
    }

    #[getter]
    fn title(&self) -> &str {
        &self.spec.title
    }

    /// The text with the overrides applied.
    fn merged(&self) -> PyResult<String> {
        merged(self.document.text(), &self.document.sets()).map_err(|error| of_case(&error))
    }

    /// The case as given, with the overrides applied.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let text = self.merged()?;
        let document: toml_edit::DocumentMut = text
            .parse()
            .map_err(|e: toml_edit::TomlError| crate::error::CaseError::new_err(e.to_string()))?;
        from_table(py, document.as_table())
    }

    /// The case with all defaults, as in `manifest.json`.
    fn resolved<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        from_json(py, &serde_json::to_value(&self.spec).unwrap_or_default())
    }

    /// Builds the model, and returns the warnings.
    fn check(&self, py: Python<'_>, given: &Bound<'_, PyDict>) -> PyResult<Vec<String>> {
        let (functions, _) = functions(given)?;
        let case = self.with(functions);
        let built = py.detach(|| {
            let simulation = Setup::new(&case).start()?;
            Ok(carom::warnings(&case, simulation.model()))
        });
        built
            .map(|warnings| warnings.iter().map(ToString::to_string).collect())
            .map_err(|problems| of_problems(&self.document, &problems))
    }

    /// Computes the case, in memory or into a directory. Returns the record and the exception of a
    /// signal handler, if there was one.
    fn run<'py>(
        &self,
        py: Python<'py>,
        out: Option<PathBuf>,
        threads: Option<usize>,
        page: bool,
        given: &Bound<'py, PyDict>,
        report: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Record, Option<PyErr>)> {
        let (functions, failure) = functions(given)?;
        let case = self.with(functions);
        let source = self.source();
        let (done, interrupted) = watched(py, report, |show, stop| {
            let mut observe = |p: &Progress| show((p.step, p.steps, p.time));
            match &out {
                Some(path) => recording::run(&case, source, path, thread_count(threads), &mut observe, stop)
                    .map(|_| None),
                None => recording::run_in_memory(&case, source, thread_count(threads), &mut observe, stop)
                    .map(|(_, record)| Some(record)),
            }
        })?;
        if let Some(error) = raised(&failure) {
            return Err(error);
        }
        let done = done.map_err(|error: RunError| of_run(&error, Some(&self.document)))?;
        let record = match (done, &out) {
            (Some(record), _) => Record::of_memory(py, record)?,
            (None, Some(path)) => Record::of_directory(py, path, page)?,
            (None, None) => unreachable!("a run is recorded somewhere"),
        };
        Ok((record, interrupted))
    }
}

/// A value as TOML, on one line.
#[pyfunction]
pub(crate) fn toml(value: &Bound<'_, PyAny>) -> PyResult<String> {
    Ok(to_toml(value)?.to_string())
}

/// A dictionary as a TOML document.
#[pyfunction]
pub(crate) fn toml_document(dict: &Bound<'_, PyDict>) -> PyResult<String> {
    Ok(to_document(dict)?.to_string())
}
