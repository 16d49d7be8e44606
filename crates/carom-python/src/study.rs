//! Studies: in this process, or planned for many.

use std::path::{Path, PathBuf};

use carom::case::Document;
use carom::record::study::{Study, StudyManifest};
use carom::record::{RecordError, Status};
use carom::study::{Event, Plan, StudyError};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;

use crate::case::Case;
use crate::error::{of_case, of_record, of_study};
use crate::watched::watched;

/// A row of the table: arm, status, reason, directory, metrics with values and units.
type Row = (String, Option<String>, Option<String>, String, Vec<(String, Option<f64>, String)>);

/// The plan of a study of a case that has been read, which the study names by `name`.
fn planned(text: &str, name: &str, case: &Case) -> PyResult<Plan> {
    let parsed = |name: &str, text: &str| Document::parse(name, text, &[]).map_err(|error| of_case(&error));
    let study = parsed("study", text)?;
    let case = parsed(name, case.document.text())?;
    Plan::with_case(&study, Path::new(""), Some(&case)).map_err(|error| of_case(&error))
}

/// Computes a study; returns the exception of a signal handler, if there was one.
#[pyfunction]
pub(crate) fn study<'py>(
    py: Python<'py>,
    text: &str,
    name: &str,
    case: &Case,
    out: PathBuf,
    jobs: usize,
    report: Option<&Bound<'py, PyAny>>,
) -> PyResult<Option<PyErr>> {
    let plan = py.detach(|| planned(text, name, case))?;
    let steps: Vec<u64> = plan.manifest.runs().map(|run| run.steps).collect();
    let (done, interrupted) = watched(py, report, |show, stop| {
        let all = steps.iter().sum::<u64>();
        let mut done = vec![0; steps.len()];
        let mut observe = |event: &Event| {
            match event {
                Event::AlreadyDone(i) | Event::Ended(i, _) => done[*i] = steps[*i],
                Event::Progress(i, progress) => done[*i] = progress.step,
                Event::Began(_) => {}
            }
            show((done.iter().sum(), all, 0.0));
        };
        carom::study::start(&plan, &out, jobs, &mut observe, stop)
    })?;
    done.map_err(|error| of_study(&error))?;
    Ok(interrupted)
}

/// Writes the directory of a study; returns the number of its runs.
#[pyfunction]
pub(crate) fn study_plan(
    py: Python<'_>,
    text: &str,
    name: &str,
    case: &Case,
    out: PathBuf,
) -> PyResult<usize> {
    let plan = py.detach(|| planned(text, name, case))?;
    py.detach(|| carom::study::plan(&plan, &out)).map_err(|error| of_study(&error))?;
    Ok(plan.manifest.runs().count())
}

/// Computes run `number`, from 1; its status, or none if another process is computing it.
#[pyfunction]
pub(crate) fn study_arm(py: Python<'_>, directory: PathBuf, number: usize) -> PyResult<Option<String>> {
    let (done, interrupted) = watched(py, None, |show, stop| {
        carom::study::arm(&directory, number, &mut |p| show((p.step, p.steps, p.time)), stop)
    })?;
    if let Some(error) = interrupted {
        return Err(error);
    }
    match done {
        Ok(ended) => Ok(Some(word(ended.status))),
        Err(error) if busy(&error) => Ok(None),
        Err(error) => Err(of_study(&error)),
    }
}

fn busy(error: &StudyError) -> bool {
    use carom::recording::RunError;
    matches!(error, StudyError::Arm { source: RunError::Record(RecordError::Busy { .. }), .. })
}

/// Writes the tables of a study from what has been computed; `page`: also figures and page.
#[pyfunction]
pub(crate) fn study_collect(py: Python<'_>, directory: PathBuf, page: bool) -> PyResult<()> {
    let (done, interrupted) = watched(py, None, |_, stop| carom::study::collect(&directory, stop))?;
    done.map_err(|error| of_study(&error))?;
    if let Some(error) = interrupted {
        return Err(error);
    }
    if page {
        let made = py.detach(|| carom::report::study(&directory));
        made.map_err(|error| PyOSError::new_err(error.to_string()))?;
    }
    Ok(())
}

/// The table of a study, arms only.
#[pyfunction]
pub(crate) fn study_table(py: Python<'_>, directory: PathBuf) -> PyResult<Vec<Row>> {
    let read = py.detach(|| {
        let manifest = StudyManifest::read(&directory)?;
        Ok((manifest, Study::open(&directory, &mut |_, _| ())?))
    });
    let (manifest, study) = read.map_err(|error: RecordError| of_record(&error))?;
    let rows = manifest.arms.into_iter().zip(study.rows);
    Ok(rows
        .map(|(arm, row)| {
            let metrics = row.metrics.into_iter().map(|m| (m.name.to_string(), m.value, m.unit)).collect();
            (row.name, row.status.map(word), row.reason, arm.directory, metrics)
        })
        .collect())
}

/// The word of a status, as in `study.csv`.
fn word(status: Status) -> String {
    serde_json::to_value(status).ok().and_then(|s| s.as_str().map(str::to_owned)).unwrap_or_default()
}
