//! Repetitions of one arm of a study, `checks.json`, and the fingerprint of a record, by which two
//! records are compared bit for bit.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{RecordError, json};

/// Files that contain results only; the others contain wall times.
const TABLES: [&str; 2] = ["history.csv", "contact.csv"];

/// BLAKE3 hash of `history.csv` and `contact.csv` of a run directory, each with its length, in
/// hexadecimal.
///
/// # Errors
/// Input/output or system error.
pub fn fingerprint(run: &Path) -> Result<String, RecordError> {
    let mut hasher = blake3::Hasher::new();
    for name in TABLES {
        let path = run.join(name);
        let bytes = match fs::read(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => continue,
            read => read.map_err(RecordError::io("read", &path))?,
        };
        hasher.update(&(bytes.len() as u64).to_le_bytes()).update(&bytes);
    }
    Ok(hasher.finalize().to_hex().to_string())
}

/// `checks.json`: an arm that was computed two more times.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Checks {
    /// Name of the arm.
    pub arm: String,
    /// Fingerprint of the arm's record.
    pub fingerprint: String,
    /// Threads of the first repetition, and its fingerprint.
    pub threads: (usize, String),
    /// The step after which the second repetition was stopped and then resumed from its files, and
    /// its fingerprint.
    pub resumed: (u64, String),
    /// Number of active pairs at that step.
    pub active_pairs: usize,
}

impl Checks {
    /// Reads the checks of a study directory, if there are any.
    ///
    /// # Errors
    /// Input/output or system error, or a damaged file.
    pub fn read(study: &Path) -> Result<Option<Self>, RecordError> {
        json::read(&study.join("checks.json"), "delete it; the page then shows no check of restarts")
    }

    /// Writes the checks into a study directory.
    ///
    /// # Errors
    /// Input/output or system error.
    pub fn write(&self, study: &Path) -> Result<(), RecordError> {
        json::write(&study.join("checks.json"), self)
    }
}
