//! A study directory, and its tables as functions of the records in it alone.
//!
//! ```text
//! runs/paper/study.json              what was compared: arms with their cases, claims, the files as given
//!            arms/01-hu/ …           one run directory per arm
//!            study.csv               one row per arm, one column per metric
//!            study_tidy.csv          arm,metric,value,unit
//!            checks.json             an arm computed again with more threads, and resumed (of a study with a goal)
//!            claims.csv              what was claimed, both numbers, the verdict
//!            study.html figures/     the page
//! ```

mod arms;
pub mod checks;
mod claim;
pub mod compared;
pub mod design;
mod orders;
pub mod ranking;
pub mod reference;
mod tables;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::metrics::{self, Metric};
use crate::question::{Question, Series};
use crate::{Expect, Expectation, Machine, Manifest, RecordError, Run, Source, Status, files, judge};
pub use arms::ArmRecords;
use checks::Checks;
pub use claim::{Comparison, Verdict};
use compared::{Compared, PhaseOrders};
use design::{Design, Goal, Kind, Part};
pub use orders::{Refinement, numeric_keys, refinements, step};
use ranking::Ranking;
use reference::{Kept, Reference};

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
    /// What it is to the study.
    #[serde(default)]
    pub part: Part,
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
    /// How the arms were made comparable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub design: Option<Design>,
    /// What is ranked by.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub goal: Option<Goal>,
    /// The error that is good enough, if it was said: see [`Self::accuracy`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<f64>,
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

    /// The methods of a design, in order.
    pub fn methods(&self) -> Vec<&str> {
        let mut methods: Vec<&str> = Vec::new();
        for method in self.arms.iter().filter_map(|a| a.part.method.as_deref()) {
            if !methods.contains(&method) {
                methods.push(method);
            }
        }
        methods
    }

    /// Whether an arm gets the step at which it costs what `cost_of` does.
    pub fn by_cost(&self, arm: &Arm) -> bool {
        let Some(design) = &self.design else { return false };
        let other = arm.part.method.as_ref().is_some_and(|m| *m != design.cost_of);
        !arm.part.fine && other && (design.kind == Kind::MatchedCost || arm.part.by_cost)
    }

    /// The error that is good enough: 0.05 if nothing was said.
    pub fn accuracy(&self) -> f64 {
        self.accuracy.unwrap_or(0.05)
    }

    /// Numbers of the arms the reference is made of, the finest last: the three of a computed one; else the arm of that name, behind arms that differ
    /// from it in a longer step alone.
    fn reference_arms(&self) -> Vec<usize> {
        let Some(named) = self.arms.iter().position(|a| self.reference.as_ref() == Some(&a.name)) else {
            return Vec::new();
        };
        let others = |a: &Arm| {
            let sets = a.sets.iter().filter(|s| !s.trim_start().starts_with("time.step")).cloned().collect::<Vec<_>>();
            (sets, a.case_path.clone(), a.part.fine)
        };
        let size = |i: &usize| step(&self.arms[*i], "time.step").unwrap_or_default();
        let alike = |i: &usize| others(&self.arms[*i]) == others(&self.arms[named]) && size(i) >= size(&named);
        let mut found: Vec<usize> = (0..self.arms.len()).filter(alike).collect();
        found.sort_by(|a, b| size(b).total_cmp(&size(a)));
        found.split_off(found.len().saturating_sub(3))
    }

    /// What arms are compared with.
    ///
    /// # Errors
    /// What the machine refused, or where a record is damaged.
    fn reference(&self, directory: &Path) -> Result<Option<Reference>, RecordError> {
        if self.reference.as_deref() == Some("exact") {
            let Some(case) = self.arms.first().map(|a| &a.case) else { return Ok(None) };
            let formulas = case.get("exact").and_then(|e| serde_json::from_value(e.clone()).ok()).unwrap_or_default();
            let end = case.pointer("/time/end").and_then(serde_json::Value::as_f64).unwrap_or_default();
            return Ok(Reference::of_formulas(&formulas, end, 8000));
        }
        let mut runs = Vec::new();
        let arms = self.reference_arms();
        for i in &arms {
            if self.state(directory, &self.arms[*i])?.0 == Some(Status::Finished) {
                let run = Run::open(&directory.join(&self.arms[*i].directory))?;
                runs.push(Kept::of(&run, &metrics::of_run(&run)));
            }
        }
        let Some(last) = arms.last().filter(|_| runs.len() == arms.len()) else { return Ok(None) };
        let count = match runs.len() {
            1 => "one run: its error is not known".to_owned(),
            n => format!("the finest of {n} runs whose steps double"),
        };
        Ok(Some(Reference::of_runs(format!("\"{}\", {count}", self.arms[*last].name), runs)))
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
    /// What arms were compared with, if it is finished.
    pub reference: Option<Reference>,
    /// Arms held against it.
    pub compared: Vec<Option<Compared>>,
    /// Orders of the methods of a design, in smooth phases and across the impact.
    pub phase_orders: Vec<PhaseOrders>,
    /// The ranking, where the study has a goal.
    pub ranking: Option<Ranking>,
    /// What it would be by the other goals.
    pub other_rankings: Vec<Ranking>,
    /// What was tried on one of its arms.
    pub checks: Option<Checks>,
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
        let reference = manifest.reference(directory)?;
        let contact = reference.as_ref().and_then(|r| {
            let time = |name: &str| r.metric(name).established().map(|x| x.0);
            time("contact_start").zip(time("contact_end"))
        });
        let (mut rows, mut compared) = (Vec::new(), Vec::new());
        for (i, arm) in manifest.arms.iter().enumerate() {
            let (status, reason) = manifest.state(directory, arm)?;
            let (mut metrics, mut expectations, mut touched) = (Vec::new(), Vec::new(), false);
            let mut held = None;
            if status.is_some() {
                let run = Run::open(&directory.join(&arm.directory))?;
                visit(i, &run);
                if status == Some(Status::Finished) {
                    metrics = metrics::of_run(&run);
                    held = reference.as_ref().map(|r| Compared::of(&Kept::of(&run, &[]), r, contact));
                }
                records.gather(&arm.name, &run, &metrics, &questions, &series);
                expectations = judge(&run, &arm.expects());
                touched = run.had_dynamic_contact();
            }
            compared.push(held);
            rows.push(Row { name: arm.name.clone(), status, reason, metrics, expectations, contact: touched });
        }
        let verdicts =
            manifest.claims.iter().zip(&comparisons).map(|(claim, c)| Verdict::of(claim, c.as_ref(), &records));
        let judged = manifest.expects.iter().flat_map(|expect| match &expect.order {
            Some(order) => orders::judge(expect, order, &manifest, &records),
            None => vec![expect.verdict(expect.got(&records))],
        });
        let (expectations, verdicts) = (judged.collect(), verdicts.collect());
        let ranking = manifest.goal.map(|goal| Ranking::of(goal, &manifest, &rows, &compared, reference.as_ref()));
        let others = Goal::all().filter(|goal| manifest.goal.is_some_and(|own| own != *goal));
        let other_rankings: Vec<Ranking> =
            others.map(|goal| Ranking::of(goal, &manifest, &rows, &compared, reference.as_ref())).collect();
        let phase_orders = reference.as_ref().map(|r| phase_orders(&manifest, &compared, r)).unwrap_or_default();
        let checks = Checks::read(directory)?;
        let directory = directory.to_path_buf();
        Ok(Self {
            directory,
            manifest,
            rows,
            verdicts,
            expectations,
            reference,
            compared,
            phase_orders,
            ranking,
            other_rankings,
            checks,
        })
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

/// Orders of every method of a design in the columns that tell where things are.
fn phase_orders(manifest: &StudyManifest, compared: &[Option<Compared>], reference: &Reference) -> Vec<PhaseOrders> {
    let mut found = Vec::new();
    for method in manifest.methods() {
        let arms = manifest.arms.iter().zip(compared).filter(|(a, _)| a.part.method.as_deref() == Some(method));
        let mut known: Vec<(f64, &Compared)> =
            arms.filter_map(|(a, c)| Some((step(a, "time.step")?, c.as_ref()?))).collect();
        known.sort_by(|a, b| b.0.total_cmp(&a.0));
        for column in reference.columns().into_iter().filter(|c| compared::is_trajectory(c)) {
            found.extend(compared::phase_orders(method, column, &known, reference));
        }
    }
    found
}
