//! A study directory, and its tables as functions of the records in it alone.
//!
//! ```text
//! runs/paper/study.json              what was compared: arms with their cases, claims, the files as given
//!            arms/01-hu/ …           one run directory per arm
//!            study.csv               one row per arm, one column per metric
//!            study_tidy.csv          arm,metric,value,unit
//!            claims.csv              what was claimed, both numbers, the verdict
//!            study.html figures/     the page
//! ```

mod arms;
mod claim;
mod orders;
mod tables;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::metrics::{self, Metric};
use crate::question::{Question, Series};
use crate::{Expect, Expectation, Machine, Manifest, RecordError, Run, Source, Status, files, judge};
pub use arms::ArmRecords;
pub use claim::{Comparison, Verdict};
pub use orders::{Refinement, numeric_keys, refinements, step};

/// The files a study was made from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StudySource {
    /// Text of the study file.
    pub study: String,
    /// The case file as the study names it.
    pub case_path: String,
    /// Text of the case file.
    pub case: String,
    /// Texts of the case files that arms name, by the name they use.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub others: BTreeMap<String, String>,
}

/// One simulation of a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Arm {
    /// Name in tables and figures.
    pub name: String,
    /// Its run directory, relative to the study's.
    pub directory: String,
    /// What it changes in the case, `key=value`.
    pub sets: Vec<String>,
    /// Time steps.
    pub steps: u64,
    /// The case file it names instead of the study's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub case_path: Option<String>,
    /// The case as resolved.
    pub case: serde_json::Value,
}

impl Arm {
    /// What is expected of its record.
    pub fn expects(&self) -> Vec<Expect> {
        self.case.get("expects").and_then(|e| serde_json::from_value(e.clone()).ok()).unwrap_or_default()
    }
}

/// A statement and the comparison that decides it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Claim {
    /// In words.
    pub text: String,
    /// `METRIC of "ARM" > METRIC of "ARM"`: see [`Comparison`].
    pub compare: String,
}

/// `study.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudyManifest {
    /// Running, finished or stopped; failed arms do not fail a study.
    pub status: Status,
    /// Title.
    pub title: String,
    /// Version of Carom that wrote it.
    pub version: String,
    /// blake3 of the study file and the case file.
    pub input_hash: String,
    /// When the directory was made, UTC.
    pub created: String,
    /// Where it ran.
    pub machine: Machine,
    /// Arm the others are held against, if one was named.
    pub reference: Option<String>,
    /// The simulations.
    pub arms: Vec<Arm>,
    /// Statements to decide.
    pub claims: Vec<Claim>,
    /// Expected values.
    #[serde(default)]
    pub expects: Vec<Expect>,
    /// The files as given.
    pub source: StudySource,
}

impl StudyManifest {
    /// Whether a directory is a study's.
    pub fn is_in(directory: &Path) -> bool {
        directory.join("study.json").is_file()
    }

    /// Reads `study.json`.
    ///
    /// # Errors
    /// What the machine refused, or where the file is damaged.
    pub fn read(directory: &Path) -> Result<Self, RecordError> {
        let path = directory.join("study.json");
        let text = std::fs::read(&path).map_err(RecordError::io("read", &path))?;
        serde_json::from_slice(&text).map_err(|error| {
            let line = Some(error.line() as u64);
            RecordError::corrupt(&path, line, error.to_string(), "run the study again")
        })
    }

    /// Writes or replaces `study.json`.
    ///
    /// # Errors
    /// What the machine refused.
    pub fn write(&self, directory: &Path) -> Result<(), RecordError> {
        let path = directory.join("study.json");
        let mut text = serde_json::to_vec_pretty(self).map_err(|e| RecordError::io("write", &path)(e.into()))?;
        text.push(b'\n');
        files::write_atomically(&path, &[&text])
    }

    /// The case file and the changes an arm is made of.
    pub fn source_of(&self, arm: &Arm) -> Source {
        let other = arm.case_path.as_ref().and_then(|path| self.source.others.get(path));
        Source { text: other.unwrap_or(&self.source.case).clone(), sets: arm.sets.clone() }
    }

    /// How far an arm is: none when it has not begun; the reason if it did not finish.
    ///
    /// # Errors
    /// What the machine refused, or where its manifest is damaged.
    pub fn state(&self, directory: &Path, arm: &Arm) -> Result<(Option<Status>, Option<String>), RecordError> {
        let path = directory.join(&arm.directory);
        if !path.join("manifest.json").is_file() {
            return Ok((None, None));
        }
        Manifest::read(&path).map(|m| (Some(m.status), m.reason))
    }
}

/// An arm with its metrics.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The arm.
    pub name: String,
    /// How far it is; none when it has not begun.
    pub status: Option<Status>,
    /// Why it did not finish.
    pub reason: Option<String>,
    /// Metrics of a finished run; empty otherwise, since numbers of half a run mislead.
    pub metrics: Vec<Metric>,
    /// What was expected of its record.
    pub expectations: Vec<Expectation>,
    /// Whether a contact was ever active in it.
    pub contact: bool,
}

impl Row {
    /// Value of a metric.
    pub fn value(&self, metric: &str) -> Option<f64> {
        self.metrics.iter().find(|m| m.name == metric)?.value
    }
}

/// A study, read.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// Where it is.
    pub directory: PathBuf,
    /// What was compared.
    pub manifest: StudyManifest,
    /// One per arm.
    pub rows: Vec<Row>,
    /// One per claim.
    pub verdicts: Vec<Verdict>,
    /// What was expected of the study as a whole; an order may have one per group of arms.
    pub expectations: Vec<Expectation>,
}

impl Study {
    /// Reads a study arm by arm; only one arm's record is in memory at a time. `visit` sees every arm that has one.
    ///
    /// # Errors
    /// What the machine refused, or where a record is damaged.
    pub fn open(directory: &Path, visit: &mut dyn FnMut(usize, &Run)) -> Result<Self, RecordError> {
        let manifest = StudyManifest::read(directory)?;
        let comparisons: Vec<_> = manifest.claims.iter().map(|c| Comparison::parse(&c.compare).ok()).collect();
        let (asked, series): (Vec<_>, Vec<_>) = manifest.expects.iter().map(|e| orders::needs(e, &manifest)).unzip();
        let claimed = comparisons.iter().flatten().flat_map(Comparison::questions);
        let questions: Vec<&Question> = claimed.chain(asked.iter().flatten()).collect();
        let series: Vec<&Series> = series.iter().flatten().collect();
        let mut records = ArmRecords::default();
        let mut rows = Vec::new();
        for (i, arm) in manifest.arms.iter().enumerate() {
            let (status, reason) = manifest.state(directory, arm)?;
            let (mut metrics, mut expectations, mut contact) = (Vec::new(), Vec::new(), false);
            if status.is_some() {
                let run = Run::open(&directory.join(&arm.directory))?;
                visit(i, &run);
                if status == Some(Status::Finished) {
                    metrics = metrics::of_run(&run);
                }
                records.gather(&arm.name, &run, &metrics, &questions, &series);
                expectations = judge(&run, &arm.expects());
                contact = run.had_dynamic_contact();
            }
            rows.push(Row { name: arm.name.clone(), status, reason, metrics, expectations, contact });
        }
        let verdicts =
            manifest.claims.iter().zip(&comparisons).map(|(claim, c)| Verdict::of(claim, c.as_ref(), &records));
        let judged = manifest.expects.iter().flat_map(|expect| match &expect.order {
            Some(order) => orders::judge(expect, order, &manifest, &records),
            None => vec![expect.verdict(expect.got(&records))],
        });
        let expectations = judged.collect();
        Ok(Self { expectations, directory: directory.to_path_buf(), verdicts: verdicts.collect(), rows, manifest })
    }

    /// Every metric any arm has, in order: name, unit, definition.
    pub fn metrics(&self) -> Vec<&Metric> {
        let mut found: Vec<&Metric> = Vec::new();
        for metric in self.rows.iter().flat_map(|row| &row.metrics) {
            if !found.iter().any(|m| m.name == metric.name) {
                found.push(metric);
            }
        }
        found
    }
}
