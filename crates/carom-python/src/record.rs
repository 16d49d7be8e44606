//! Records of runs: the history as arrays that are not copied, everything else as plain data.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use carom::record::{Column, FieldSet, History, MemoryRecord, Run, metrics};
use carom::recording::{self, Progress};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyIndexError, PyOSError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::error::{of_record, of_run};
use crate::function::{functions, raised};
use crate::tables;
use crate::threads::thread_count;
use crate::values::from_json;
use crate::watched::watched;

/// A metric: name, value, unit, meaning.
type Metric = (String, Option<f64>, String, String);

/// A run that has been read, or recorded in memory.
#[pyclass(frozen, module = "carom._carom")]
pub(crate) struct Record {
    /// Without the values of the history, which the arrays own.
    run: Run,
    columns: Vec<Py<PyArray1<f64>>>,
    /// Fields of a record in memory.
    fields: Option<Vec<FieldSet>>,
}

impl Record {
    fn of(py: Python<'_>, mut run: Run, fields: Option<Vec<FieldSet>>) -> PyResult<Self> {
        let values = std::mem::take(&mut run.history.values);
        let columns = values.into_iter().map(|values| Ok(tables::array(py, values)?.unbind()));
        let columns = columns.collect::<PyResult<_>>()?;
        Ok(Self { run, columns, fields })
    }

    pub(crate) fn of_memory(py: Python<'_>, record: MemoryRecord) -> PyResult<Self> {
        Self::of(py, record.run, Some(record.fields))
    }

    /// Reads a run directory; `page`: makes its figures and page first.
    pub(crate) fn of_directory(py: Python<'_>, path: &Path, page: bool) -> PyResult<Self> {
        let read = || {
            let made = if page { carom::report::report(path).map(drop) } else { Ok(()) };
            (made, Run::open(path))
        };
        let (made, run) = py.detach(read);
        made.map_err(|error| PyOSError::new_err(error.to_string()))?;
        Self::of(py, run.map_err(|error| of_record(&error))?, None)
    }

    /// The run with its history, which is copied.
    fn whole(&self, py: Python<'_>) -> PyResult<Run> {
        let values = self.columns.iter().map(|column| Ok(column.bind(py).to_vec()?));
        let history = History::new(self.run.history.columns.clone(), values.collect::<PyResult<_>>()?);
        Ok(Run { history, ..self.run.clone() })
    }
}

#[pymethods]
impl Record {
    /// The run directory; none for a record in memory.
    #[getter]
    fn directory(&self) -> Option<&Path> {
        self.fields.is_none().then_some(self.run.directory.as_path())
    }

    /// Name, unit, meaning of the columns of the history, and whether they are integers.
    #[getter]
    fn columns<'a>(&'a self) -> Vec<(&'a str, &'a str, &'a str, bool)> {
        let of = |c: &'a Column| (c.name.as_str(), c.unit.as_str(), c.description.as_str(), c.integer);
        self.run.history.columns.iter().map(of).collect()
    }

    /// The columns of the history.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Vec<Bound<'py, PyArray1<f64>>> {
        self.columns.iter().map(|column| column.bind(py).clone()).collect()
    }

    /// The active contact nodes of all rows, by column.
    fn contact<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables::contact(py, &self.run.contact, self.run.manifest.facts.contact_columns())
    }

    /// Units of these columns.
    fn contact_units(&self) -> HashMap<&'static str, String> {
        tables::contact_units(&self.run.history, self.run.manifest.facts.contact_columns())
    }

    /// The events.
    fn log<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        from_json(py, &serde_json::to_value(&self.run.log).unwrap_or_default())
    }

    /// The manifest.
    fn manifest<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        from_json(py, &serde_json::to_value(&self.run.manifest).unwrap_or_default())
    }

    /// Why the run stopped, if it did.
    fn stop<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        from_json(py, &serde_json::to_value(&self.run.stop).unwrap_or_default())
    }

    /// The warnings of the case and the record.
    fn warnings(&self) -> Vec<String> {
        self.run.manifest.warnings.iter().map(ToString::to_string).collect()
    }

    /// The metrics that a study tabulates.
    fn metrics(&self, py: Python<'_>) -> PyResult<Vec<Metric>> {
        let run = self.whole(py)?;
        let found = py.detach(|| metrics::of_run(&run));
        Ok(found
            .into_iter()
            .map(|m| (m.name.to_string(), m.value, m.unit, m.definition.to_owned()))
            .collect())
    }

    /// The contact episodes as (start, end): times of the first row in contact and of the first row
    /// after it, none if contact lasts to the end.
    fn episodes(&self, py: Python<'_>) -> PyResult<Vec<(f64, Option<f64>)>> {
        let run = self.whole(py)?;
        let history = &run.history;
        let times = run.times();
        let found = metrics::episodes(history, metrics::default_bridge(history));
        Ok(found.iter().map(|e| (times[e.start], e.end.map(|end| times[end]))).collect())
    }

    /// Times of the recorded fields.
    #[getter]
    fn field_times(&self) -> Vec<f64> {
        self.run.fields.iter().map(|entry| entry.time).collect()
    }

    /// Fields number `i`: points, blocks (body, VTK type, degree, connectivity) and arrays (name,
    /// unit, values).
    fn field<'py>(&self, py: Python<'py>, i: usize) -> PyResult<Bound<'py, PyDict>> {
        let entry = self.run.fields.get(i).ok_or_else(|| PyIndexError::new_err("no such fields"))?;
        let set = match &self.fields {
            Some(fields) => fields[i].clone(),
            None => py.detach(|| self.run.field(entry)).map_err(|error| of_record(&error))?,
        };
        let dict = PyDict::new(py);
        dict.set_item("time", entry.time)?;
        dict.set_item("points", tables::rows(py, set.points.as_flattened().to_vec(), 3)?)?;
        let blocks = PyList::empty(py);
        for block in set.blocks {
            let nodes = block.cell.nodes(block.degree);
            let cells = tables::integers(py, block.connectivity.iter().map(|n| *n as i64).collect())?;
            let cells = cells.reshape([block.connectivity.len() / nodes, nodes])?;
            blocks.append((block.body, block.cell.lagrange_type(), block.degree, cells))?;
        }
        dict.set_item("blocks", blocks)?;
        let arrays = PyList::empty(py);
        for found in set.arrays {
            arrays.append((found.name, found.unit, tables::rows(py, found.values, found.components)?))?;
        }
        dict.set_item("arrays", arrays)?;
        Ok(dict)
    }

    /// The history as text, `csv` or `json`.
    fn text(&self, py: Python<'_>, format: &str) -> PyResult<String> {
        let run = self.whole(py)?;
        Ok(if format == "json" { run.to_json() + "\n" } else { run.to_csv()? })
    }

    /// Writes figures and page of a run directory; returns the page.
    fn page(&self, py: Python<'_>) -> PyResult<PathBuf> {
        let made = py.detach(|| carom::report::report(&self.run.directory));
        made.map(|made| made.page).map_err(|error| PyOSError::new_err(error.to_string()))
    }
}

/// Reads a run directory.
#[pyfunction]
pub(crate) fn open(py: Python<'_>, path: PathBuf) -> PyResult<Record> {
    Record::of_directory(py, &path, false)
}

/// Continues a run that was stopped or killed.
#[pyfunction]
pub(crate) fn resume<'py>(
    py: Python<'py>,
    path: PathBuf,
    threads: Option<usize>,
    page: bool,
    given: &Bound<'py, PyDict>,
    report: Option<&Bound<'py, PyAny>>,
) -> PyResult<(Record, Option<PyErr>)> {
    let (functions, failure) = functions(given)?;
    let (done, interrupted) = watched(py, report, |show, stop| {
        let mut observe = |p: &Progress| show((p.step, p.steps, p.time));
        recording::resume_with(&path, functions, thread_count(threads), &mut observe, stop)
    })?;
    if let Some(error) = raised(&failure) {
        return Err(error);
    }
    done.map_err(|error| of_run(&error, None))?;
    Ok((Record::of_directory(py, &path, page)?, interrupted))
}
