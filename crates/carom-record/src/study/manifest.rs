//! `study.json`: what is compared, with which files it was made and how far it is.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::arm::Arm;
use super::claim::Claim;
use super::design::{Design, Goal, Kind};
use crate::{Expect, Machine, Manifest, RecordError, Source, Status, files};

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
        let mut text =
            serde_json::to_vec_pretty(self).map_err(|e| RecordError::io("write", &path)(e.into()))?;
        text.push(b'\n');
        files::write_atomically(&path, &[&text])
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

    /// Whether an arm gets the step at which it costs what `cost_of` does.
    pub fn by_cost(&self, arm: &Arm) -> bool {
        let Some(design) = &self.design else { return false };
        let other = arm.role.method.as_ref().is_some_and(|m| *m != design.cost_of);
        !arm.role.fine && other && (design.kind == Kind::MatchedCost || arm.role.by_cost)
    }

    /// The error that is good enough: 0.05 if nothing was said.
    pub fn accuracy(&self) -> f64 {
        self.accuracy.unwrap_or(0.05)
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
    pub fn state(
        &self,
        directory: &Path,
        arm: &Arm,
    ) -> Result<(Option<Status>, Option<String>), RecordError> {
        let path = directory.join(&arm.directory);
        if !path.join("manifest.json").is_file() {
            return Ok((None, None));
        }
        Manifest::read(&path).map(|m| (Some(m.status), m.reason))
    }
}
