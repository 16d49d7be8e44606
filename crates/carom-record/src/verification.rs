//! Results of `carom verify`, from which its page and tables are made.
//!
//! ```text
//! verify/verify.json             what was run, and every row
//!        verify.csv              one row per expectation
//!        verify.html             the page
//!        FAMILY/NAME/ …          run or study directory of a set-up
//! ```

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{Expectation, Machine, RecordError, json, table};

/// Columns of `verify.csv`.
const COLUMNS: [&str; 11] = [
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

/// A verification.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verification {
    /// Version of Carom.
    pub version: String,
    /// When the verification started, UTC.
    pub started: String,
    /// The machine that the verification ran on.
    pub machine: Machine,
    /// Number of concurrent runs.
    pub jobs: usize,
    /// Wall time of the verification in seconds.
    pub wall: f64,
    /// Whether slow expectations were skipped.
    pub fast: bool,
    /// The set-ups, family by family.
    pub set_ups: Vec<SetUp>,
}

/// A case, or a study with all its arms.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SetUp {
    /// Name of the folder of the set-up's file.
    pub family: String,
    /// Name of the set-up's file without the ending.
    pub name: String,
    /// Title of the case or study.
    pub title: String,
    /// The file.
    pub file: String,
    /// BLAKE3 hash of the set-up's input.
    pub input_hash: String,
    /// Directory of the set-up's records, relative to that of the verification.
    pub directory: String,
    /// Number of simulations.
    pub runs: usize,
    /// Simulations that stopped unexpectedly, and why.
    pub stopped: Vec<String>,
    /// Whether a contact was active in one of the dynamic runs.
    pub contact: bool,
    /// Sum of the wall times of the simulations, in seconds.
    pub wall: f64,
    /// Outcomes of the expectations.
    pub rows: Vec<Row>,
}

/// Outcome of one expectation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The arm, if it is an expectation of an arm.
    pub arm: Option<String>,
    /// Directory of the record, relative to that of the verification.
    pub directory: String,
    /// Outcome of the expectation.
    #[serde(flatten)]
    pub verdict: Expectation,
}

impl SetUp {
    /// Whether an expectation was missed or a simulation stopped unexpectedly.
    pub fn is_bad(&self) -> bool {
        !self.stopped.is_empty() || self.rows.iter().any(|row| !row.verdict.pass)
    }
}

impl Row {
    /// The quantity in words, with its arm.
    pub fn quantity(&self) -> String {
        match &self.arm {
            Some(arm) => format!("{} of \"{arm}\"", self.verdict.what),
            None => self.verdict.what.clone(),
        }
    }

    /// got − expected; for an upper or lower bound, the excess over it (0 if it is satisfied).
    pub fn error(&self) -> Option<f64> {
        let got = self.verdict.got?;
        let value = self.verdict.value?;
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

    /// Number of missed expectations.
    pub fn missed(&self) -> usize {
        self.rows().filter(|(_, row)| !row.verdict.pass).count()
    }

    /// Number of set-ups with dynamic contact.
    pub fn with_contact(&self) -> usize {
        self.set_ups.iter().filter(|s| s.contact).count()
    }

    /// Number of simulations that stopped unexpectedly.
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
    /// Input/output or system error, or a damaged file.
    pub fn read(directory: &Path) -> Result<Self, RecordError> {
        let path = directory.join("verify.json");
        let text = std::fs::read(&path).map_err(RecordError::io("read", &path))?;
        json::value(&path, &text, "run carom verify again")
    }

    /// Writes `verify.json` and `verify.csv`.
    ///
    /// # Errors
    /// Input/output or system error.
    pub fn write(&self, directory: &Path) -> Result<(), RecordError> {
        json::write(&directory.join("verify.json"), self)?;
        let row = |(set_up, row): (&SetUp, &Row)| {
            let verdict = &row.verdict;
            (
                (set_up.family.clone(), set_up.name.clone(), row.arm.clone()),
                (verdict.what.clone(), verdict.expected.clone()),
                (verdict.got, row.error(), verdict.tolerance),
                verdict.source.clone(),
                if verdict.pass { "pass" } else { "MISSED" },
                row.directory.clone(),
            )
        };
        table::write(&directory.join("verify.csv"), &COLUMNS, self.rows().map(row))
    }
}
