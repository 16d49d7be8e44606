//! `study.json`: what is compared, the files it was made from, and the status.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::arm::Arm;
use super::claim::Claim;
use super::design::{Design, Goal, Kind};
use super::ensemble::Ensemble;
use super::roles::as_in_arm;
use crate::metrics::Overlay;
use crate::{Expect, Machine, Manifest, RecordError, Run, Source, Status, json};

/// A cost is matched when it is within this fraction of the budget.
const OFF_BUDGET: f64 = 0.1;

/// The files a study was made from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StudySource {
    /// Text of the study file.
    pub study: String,
    /// Path of the case file, as given in the study file.
    pub case_path: String,
    /// Text of the case file.
    pub case: String,
    /// Texts of the case files of arms, by their path as given.
    pub others: BTreeMap<String, String>,
}

/// `study.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudyManifest {
    /// Running, finished or stopped; a study with failed arms still finishes.
    pub status: Status,
    /// Title of the study.
    pub title: String,
    /// Version of Carom that wrote the study.
    pub version: String,
    /// BLAKE3 hash of the study file and the case file.
    pub input_hash: String,
    /// When the directory was created, UTC.
    pub created: String,
    /// The machine that the study was computed on.
    pub machine: Machine,
    /// Arm that the others are compared with, if any.
    pub reference: Option<String>,
    /// How the arms are made comparable.
    pub design: Option<Design>,
    /// The goal of the ranking.
    pub goal: Option<Goal>,
    /// The required accuracy, if given.
    pub accuracy: Option<f64>,
    /// Time over which forces and stresses are averaged, if given.
    pub window: Option<f64>,
    /// The simulations.
    pub arms: Vec<Arm>,
    /// Changes with which the arms are repeated, if they are run several times.
    pub ensemble: Option<Ensemble>,
    /// Repetitions of the arms in an ensemble, without the arms themselves.
    pub members: Vec<Arm>,
    /// Measured data with which all arms are compared.
    pub overlays: Vec<Overlay>,
    /// Claims to be decided.
    pub claims: Vec<Claim>,
    /// Expected values.
    pub expects: Vec<Expect>,
    /// The files as given.
    pub source: StudySource,
}

impl StudyManifest {
    /// Whether a directory is a study directory.
    pub fn is_in(directory: &Path) -> bool {
        directory.join("study.json").is_file()
    }

    /// Reads `study.json`.
    ///
    /// # Errors
    /// Input/output or system error, no study, or a damaged file.
    pub fn read(directory: &Path) -> Result<Self, RecordError> {
        let found = json::read(&directory.join("study.json"), "run the study again")?;
        found.ok_or_else(|| RecordError::NotAStudy { path: directory.to_path_buf() })
    }

    /// Writes or replaces `study.json`.
    ///
    /// # Errors
    /// Input/output or system error.
    pub fn write(&self, directory: &Path) -> Result<(), RecordError> {
        json::write(&directory.join("study.json"), self)
    }

    /// The arms, and after them the members of their ensembles.
    pub fn runs(&self) -> impl Iterator<Item = &Arm> {
        self.arms.iter().chain(&self.members)
    }

    /// The run of this number.
    pub fn run(&self, i: usize) -> &Arm {
        self.arms.get(i).unwrap_or_else(|| &self.members[i - self.arms.len()])
    }

    /// Numbers of the runs of an arm: its own, then those of its members.
    pub fn runs_of(&self, arm: usize) -> Vec<usize> {
        let of = |(_, run): &(usize, &Arm)| run.role.member.is_some_and(|m| m.arm == arm);
        let members = self.members.iter().enumerate().filter(of);
        std::iter::once(arm).chain(members.map(|(i, _)| self.arms.len() + i)).collect()
    }

    /// The methods of a design, in order.
    pub fn methods(&self) -> Vec<&str> {
        let mut methods: Vec<&str> = Vec::new();
        for method in self.arms.iter().filter_map(|a| a.role.method.as_deref()) {
            if !methods.contains(&method) {
                methods.push(method);
            }
        }
        methods
    }

    /// Whether the step of an arm is chosen such that its cost equals that of `cost_of`.
    pub fn by_cost(&self, arm: &Arm) -> bool {
        let Some(design) = &self.design else { return false };
        let other = arm.role.method.as_ref().is_some_and(|m| *m != design.cost_of);
        !arm.role.fine && other && (design.kind == Kind::MatchedCost || arm.role.by_cost)
    }

    /// Whether the cost of an arm is matched, but more than 10 % off its budget.
    pub fn is_off_budget(&self, arm: &Arm) -> bool {
        self.by_cost(arm) && arm.role.cost.is_none_or(|share| (share - 1.0).abs() > OFF_BUDGET)
    }

    /// The arms that are off their budget.
    pub fn off_budget(&self) -> impl Iterator<Item = &Arm> {
        self.arms.iter().filter(|arm| self.is_off_budget(arm))
    }

    /// The case file of an arm and its changes.
    pub fn source_of(&self, arm: &Arm) -> Source {
        let other = arm.case_path.as_ref().and_then(|path| self.source.others.get(path));
        Source {
            text: other.unwrap_or(&self.source.case).clone(),
            sets: arm.sets.clone(),
            ..Source::default()
        }
    }

    /// Status of an arm; none if it has not started.
    ///
    /// # Errors
    /// Input/output or system error, or a damaged manifest.
    pub fn status_of(&self, directory: &Path, arm: &Arm) -> Result<Option<Status>, RecordError> {
        let path = directory.join(&arm.directory);
        if !path.join("manifest.json").is_file() {
            return Ok(None);
        }
        Manifest::read(&path).map(|run| Some(run.status))
    }

    /// Whether an arm has finished or failed.
    pub fn has_ended(&self, directory: &Path, arm: &Arm) -> bool {
        matches!(self.status_of(directory, arm), Ok(Some(Status::Finished | Status::Failed)))
    }

    /// The record of an arm, none if it has not started; forces and impulses of contact have the
    /// same sign in all members of an arm.
    ///
    /// # Errors
    /// Input/output or system error, or a damaged record.
    pub fn record(&self, directory: &Path, arm: &Arm) -> Result<Option<Run>, RecordError> {
        let path = directory.join(&arm.directory);
        let mut run = path.join("manifest.json").is_file().then(|| Run::open(&path)).transpose()?;
        let swapped = arm.role.member.filter(|of| of.member.swapped);
        if let (Some(run), Some(base)) = (&mut run, swapped.and_then(|of| self.arms.get(of.arm))) {
            as_in_arm(&mut run.history, [&base.facts, &arm.facts]);
        }
        Ok(run)
    }

    /// The record of an arm that has finished, as [`Self::record`] reads it; none if it is damaged.
    pub(super) fn finished(&self, directory: &Path, arm: &Arm) -> Result<Option<Run>, RecordError> {
        match self.record(directory, arm) {
            Err(error) if !error.is_system() => Ok(None),
            record => Ok(record?.filter(|run| run.manifest.status == Status::Finished)),
        }
    }
}
