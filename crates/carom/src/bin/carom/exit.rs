//! Exit codes, and the failures they stand for.

use std::path::PathBuf;

use carom::case::CaseError;

/// Exit codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    /// Success.
    Done = 0,
    /// An expectation was missed (`verify`, `--strict`).
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
    Stopped { reason: String, help: String, directory: PathBuf },
    /// Input/output or system error.
    #[error("{what}")]
    System { what: String },
}

impl Failure {
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
}
