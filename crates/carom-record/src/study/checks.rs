//! What a study tried on one of its own arms, `checks.json`, and the fingerprint of a record by
//! which two are told to have the same bits.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{RecordError, files};

/// Tables whose every byte is a result; the others hold times of the clock.
const TABLES: [&str; 2] = ["history.csv", "contact.csv"];

/// blake3 of `history.csv` and `contact.csv` of a run directory, each with its length, in
/// hexadecimal.
///
/// # Errors
/// What the machine refused.
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

/// `checks.json`: an arm computed twice more.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Checks {
    /// Its name.
    pub arm: String,
    /// Its fingerprint.
    pub fingerprint: String,
    /// Threads of the first repetition, and its fingerprint.
    pub threads: (usize, String),
    /// The step after which the second repetition was stopped, to be resumed from its files, and
    /// its fingerprint.
    pub resumed: (u64, String),
    /// Pairs that touched at that step.
    pub active_pairs: usize,
}

impl Checks {
    /// Of a study directory; none where nothing was tried.
    ///
    /// # Errors
    /// What the machine refused, or where the file is damaged.
    pub fn read(study: &Path) -> Result<Option<Self>, RecordError> {
        let path = study.join("checks.json");
        match fs::read(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(RecordError::io("read", &path)(error)),
            Ok(text) => serde_json::from_slice(&text).map(Some).map_err(|error| {
                let line = Some(error.line() as u64);
                RecordError::corrupt(
                    &path,
                    line,
                    error.to_string(),
                    "delete it: it will say nothing of restarts then",
                )
            }),
        }
    }

    /// Writes it into a study directory.
    ///
    /// # Errors
    /// What the machine refused.
    pub fn write(&self, study: &Path) -> Result<(), RecordError> {
        let path = study.join("checks.json");
        let text = serde_json::to_vec_pretty(self).map_err(|e| RecordError::io("write", &path)(e.into()))?;
        files::write_atomically(&path, &[&text])
    }
}
