//! Errors of the library as exceptions of the package, with the text of the command.

use carom::case::{CaseError as Wrong, Document, Problems};
use carom::diagnostics;
use carom::record::RecordError as Damaged;
use carom::recording::RunError;
use carom::study::StudyError;
use pyo3::PyErr;
use pyo3::exceptions::{PyMemoryError, PyOSError};

pyo3::import_exception!(carom.errors, CaseError);
pyo3::import_exception!(carom.errors, RecordError);

/// A case that is wrong, or whose file cannot be read.
pub(crate) fn of_case(error: &Wrong) -> PyErr {
    let text = diagnostics::text(error, false);
    match error {
        Wrong::Wrong(found) if found.iter().any(|d| d.system) => PyMemoryError::new_err(text),
        Wrong::Wrong(_) => CaseError::new_err(text),
        Wrong::Refused { .. } => PyOSError::new_err(text),
    }
}

/// Problems that only the model of a case shows, with their places in its text.
pub(crate) fn of_problems(document: &Document, problems: &Problems) -> PyErr {
    of_case(&document.diagnose_all(problems))
}

/// A record that cannot be written or read.
pub(crate) fn of_record(error: &Damaged) -> PyErr {
    match error {
        Damaged::Io { .. } => PyOSError::new_err(error.to_string()),
        _ => cured(error, error.cure()),
    }
}

/// A message, and what to try.
fn cured(error: &dyn std::error::Error, cure: Option<String>) -> PyErr {
    RecordError::new_err(cure.map_or_else(|| error.to_string(), |cure| format!("{error}\ntry: {cure}")))
}

/// A run that cannot be computed; `document`: its case, if it is at hand.
pub(crate) fn of_run(error: &RunError, document: Option<&Document>) -> PyErr {
    match (error, document) {
        (RunError::Case(problems), Some(document)) => of_problems(document, problems),
        (RunError::Case(problems), None) => CaseError::new_err(problems.to_string()),
        (RunError::Record(error), _) => of_record(error),
        (error @ RunError::Incompatible { .. }, _) => cured(error, Some("run the case again".to_owned())),
    }
}

/// A study that cannot be computed.
pub(crate) fn of_study(error: &StudyError) -> PyErr {
    match error {
        StudyError::Record(error) => of_record(error),
        StudyError::Arm { arm, source } => {
            let source = of_run(source, None).to_string();
            RecordError::new_err(format!("arm \"{arm}\": {source}"))
        }
        error => cured(error, error.cure()),
    }
}
