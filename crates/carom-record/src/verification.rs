//! What `carom verify` found, as its page and tables are made from.
//!
//! ```text
//! verify/verify.json             what was run, and every row
//!        verify.csv              one row per expectation
//!        verify.html             the page
//!        FAMILY/NAME/ …          the run, or study, directory of a set-up
//! ```

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{Expectation, Machine, RecordError, files};

/// Everything that was verified.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verification {
    /// Version of Carom.
    pub version: String,
    /// When it began, UTC.
    pub started: String,
    /// Where it ran.
    pub machine: Machine,
    /// Runs at the same time.
    pub jobs: usize,
    /// Wall seconds.
    pub wall: f64,
    /// Whether slow expectations were left out.
    pub fast: bool,
    /// What was run, family by family.
    pub set_ups: Vec<SetUp>,
}

/// A case, or a study with all its arms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SetUp {
    /// Folder it belongs to.
    pub family: String,
    /// Name of its file without the ending.
    pub name: String,
    /// Its title.
    pub title: String,
    /// The file.
    pub file: String,
    /// blake3 of what was run.
    pub input_hash: String,
    /// Directory of its records, relative to the verification's.
    pub directory: String,
    /// Simulations.
    pub runs: usize,
    /// Simulations that could not go on although nothing expected it, and why.
    pub stopped: Vec<String>,
    /// Whether a contact was active in one of its motions.
    pub contact: bool,
    /// Wall seconds of its simulations, one after the other.
    pub wall: f64,
    /// What was expected of it.
    pub rows: Vec<Row>,
}

/// One expectation, judged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The arm, where it is one's.
    pub arm: Option<String>,
    /// Directory of the record it was judged on, relative to the verification's.
    pub directory: String,
    /// The verdict.
    #[serde(flatten)]
    pub verdict: Expectation,
}

impl SetUp {
    /// Whether an expectation was missed, or a simulation could not go on.
    pub fn is_bad(&self) -> bool {
        !self.stopped.is_empty() || self.rows.iter().any(|row| !row.verdict.pass)
    }
}

impl Row {
    /// What is asked, and of which arm.
    pub fn quantity(&self) -> String {
        match &self.arm {
            Some(arm) => format!("{} of \"{arm}\"", self.verdict.what),
            None => self.verdict.what.clone(),
        }
    }

    /// got − expected; beyond a bound by how much (0 within).
    pub fn error(&self) -> Option<f64> {
        let (got, value) = (self.verdict.got?, self.verdict.value?);
        match self.verdict.tolerance {
            None if self.verdict.pass => Some(0.0),
            _ => Some(got - value),
        }
    }
}

impl Verification {
    /// All rows, with their set-ups.
    pub fn rows(&self) -> impl Iterator<Item = (&SetUp, &Row)> {
        self.set_ups.iter().flat_map(|set_up| set_up.rows.iter().map(move |row| (set_up, row)))
    }

    /// Rows that were missed.
    pub fn missed(&self) -> usize {
        self.rows().filter(|(_, row)| !row.verdict.pass).count()
    }

    /// Set-ups with a contact that was active in a motion.
    pub fn with_contact(&self) -> usize {
        self.set_ups.iter().filter(|s| s.contact).count()
    }

    /// Simulations that stopped unexpectedly.
    pub fn stopped(&self) -> usize {
        self.set_ups.iter().map(|s| s.stopped.len()).sum()
    }

    /// Families, in order.
    pub fn families(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.set_ups.iter().map(|s| s.family.as_str()).collect();
        names.dedup();
        names
    }

    /// Reads `verify.json`.
    ///
    /// # Errors
    /// What the machine refused, or where the file is damaged.
    pub fn read(directory: &Path) -> Result<Self, RecordError> {
        let path = directory.join("verify.json");
        let text = std::fs::read(&path).map_err(RecordError::io("read", &path))?;
        serde_json::from_slice(&text).map_err(|error| {
            RecordError::corrupt(
                &path,
                Some(error.line() as u64),
                error.to_string(),
                "run carom verify again",
            )
        })
    }

    /// Writes `verify.json` and `verify.csv`.
    ///
    /// # Errors
    /// What the machine refused.
    pub fn write(&self, directory: &Path) -> Result<(), RecordError> {
        let path = directory.join("verify.json");
        let text = serde_json::to_vec_pretty(self).map_err(|e| RecordError::io("write", &path)(e.into()))?;
        files::write_atomically(&path, &[&text, b"\n"])?;
        let path = directory.join("verify.csv");
        files::write_atomically(&path, &[&self.csv().map_err(RecordError::io("write", &path))?])
    }

    /// The table, as CSV; numbers read back to the same bits.
    ///
    /// # Errors
    /// None that memory does not have.
    pub fn csv(&self) -> std::io::Result<Vec<u8>> {
        let number = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:?}"));
        let mut writer = csv::Writer::from_writer(Vec::new());
        let header = [
            "family",
            "case",
            "arm",
            "quantity",
            "expected",
            "got",
            "error",
            "tolerance",
            "source",
            "pass",
            "directory",
        ];
        writer.write_record(header)?;
        for (set_up, row) in self.rows() {
            let verdict = &row.verdict;
            let pass = if verdict.pass { "pass" } else { "MISSED" };
            writer.write_record([
                set_up.family.as_str(),
                &set_up.name,
                row.arm.as_deref().unwrap_or_default(),
                &verdict.what,
                &verdict.expected,
                &number(verdict.got),
                &number(row.error()),
                &number(verdict.tolerance),
                verdict.source.as_deref().unwrap_or_default(),
                pass,
                &row.directory,
            ])?;
        }
        writer.into_inner().map_err(csv::IntoInnerError::into_error)
    }
}
