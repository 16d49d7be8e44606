//! Exit codes, and the failures they stand for.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use carom::case::{CaseError, Problem};
use carom::recording::RunError;
use carom_record::RecordError;
use carom_record::study::StudyManifest;
use carom_report::ReportError;
use carom_study::StudyError;

/// Exit codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    /// Success.
    Done = 0,
    /// An expectation was missed (`verify`, `--strict`), or runs of a study are missing or damaged.
    Missed = 1,
    /// The case or an argument is wrong.
    Wrong = 2,
    /// The simulation stopped; its last valid state is saved.
    Stopped = 3,
    /// Input/output or system error: disk, permission, memory.
    System = 4,
    /// Stopped by Ctrl-C; `carom resume` continues it.
    Interrupted = 130,
}

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// The case is wrong, or the system has too little memory for it or cannot read its file.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// An argument is wrong.
    #[error("{what}")]
    Argument { what: String, help: String },
    /// The simulation stopped.
    #[error("{reason}")]
    Stopped { reason: String, help: String, directory: PathBuf, page: bool },
    /// Input/output or system error.
    #[error("{what}")]
    System { what: String },
}

impl Failure {
    /// A wrong argument, and what to do.
    pub(crate) fn argument(what: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Argument { what: what.into(), help: help.into() }
    }

    /// An action that the system refused: `cannot write FILE: …`.
    pub(crate) fn cannot(verb: &str, path: &Path, error: &dyn Display) -> Self {
        Self::System { what: format!("cannot {verb} {}: {error}", path.display()) }
    }

    pub(crate) fn exit(&self) -> Exit {
        match self {
            Self::Case(CaseError::Wrong(found)) if found.iter().any(|d| d.system) => Exit::System,
            Self::Case(CaseError::Wrong(_)) | Self::Argument { .. } => Exit::Wrong,
            Self::Stopped { .. } => Exit::Stopped,
            Self::Case(CaseError::Refused { .. }) | Self::System { .. } => Exit::System,
        }
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        Self::System { what: error.to_string() }
    }
}

impl From<RecordError> for Failure {
    fn from(error: RecordError) -> Self {
        let what = match &error {
            RecordError::Io { .. } => return Self::System { what: error.to_string() },
            RecordError::NotARun { path } if StudyManifest::is_in(path) => {
                format!("{} is the directory of a study, not of a run", path.display())
            }
            _ => error.to_string(),
        };
        let help = error.cure().unwrap_or_default();
        Self::Argument { what, help }
    }
}

impl From<ReportError> for Failure {
    fn from(error: ReportError) -> Self {
        match error {
            ReportError::Record(error) => error.into(),
            error @ ReportError::Write { .. } => Self::System { what: error.to_string() },
            error @ ReportError::Case { .. } => {
                let help = "run the case again with this version".to_owned();
                Self::Argument { what: error.to_string(), help }
            }
        }
    }
}

/// Problems of a run whose case file is not at hand are reported without their lines.
impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Record(error) => error.into(),
            RunError::Case(problems) => {
                let sentence = |p: &Problem| format!("{}: {}", p.what, p.why);
                let what = problems.iter().map(sentence).collect::<Vec<_>>().join("; ");
                if problems.iter().any(|p| p.system) {
                    return Self::System { what };
                }
                let help = problems.first().map_or_else(String::new, |p| p.help.clone());
                Self::Argument { what, help }
            }
            RunError::Incompatible { what } => Self::argument(what, "run the case again"),
        }
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Record(error) => error.into(),
            StudyError::Arm { arm, source } => match source.into() {
                Self::System { what } => Self::System { what: format!("arm \"{arm}\": {what}") },
                Self::Argument { what, help } => Self::argument(format!("arm \"{arm}\": {what}"), help),
                other => other,
            },
            error => {
                let help = error.cure().unwrap_or_default();
                if matches!(error, StudyError::Memory { .. }) {
                    return Self::System { what: format!("{error}: {help}") };
                }
                Self::argument(error.to_string(), help)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use carom::case::{Document, Problem};

    use super::*;

    /// A lack of memory is not a mistake of the case, though it is reported at its place.
    #[test]
    fn problems_of_the_system_exit_4() {
        let document = Document::parse("a.toml", "dimension = 2", &[]).unwrap();
        let problem = Problem::new("dimension", "too little memory", "", "use a coarser mesh");
        let exit = |problem| Failure::Case(document.diagnose_all(&[problem])).exit();
        assert_eq!(exit(problem.clone()), Exit::Wrong);
        assert_eq!(exit(problem.of_system()), Exit::System);
    }

    /// A lack of memory and a full disk are of the system, and a damaged record is not, whichever
    /// command finds them.
    #[test]
    fn the_same_error_has_the_same_code_in_every_command() {
        let arm = |source: RunError| Failure::from(StudyError::Arm { arm: "a".to_owned(), source });
        let memory =
            || RunError::Case(vec![Problem::new("", "too little memory", "", "").of_system()].into());
        let full = || RecordError::Io {
            action: "write",
            path: "x".into(),
            source: std::io::ErrorKind::StorageFull.into(),
        };
        let damaged = || RecordError::NotARun { path: "x".into() };
        for failure in [memory().into(), arm(memory()), full().into(), arm(full().into())] {
            assert_eq!(Failure::exit(&failure), Exit::System, "{failure}");
        }
        let reported = Failure::from(ReportError::Record(damaged()));
        for failure in [damaged().into(), arm(damaged().into()), reported] {
            assert_eq!(Failure::exit(&failure), Exit::Wrong, "{failure}");
        }
        assert!(arm(memory()).to_string().starts_with("arm \"a\": too little memory"));
    }
}
