//! An arm of a study: one simulation, as the manifest has it.

use serde::{Deserialize, Serialize};

use super::design::Role;
use crate::Expect;

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
    pub role: Role,
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

/// The step of an arm: what it sets the key to, or what its case has; 1/n for a number of cells.
pub fn step(arm: &Arm, key: &str) -> Option<f64> {
    let set = arm.sets.iter().find_map(|set| set.strip_prefix(key)?.trim_start().strip_prefix('='));
    let value = match set {
        Some(text) => {
            let first = text.trim().trim_start_matches('[').split([',', ']']).next()?;
            first.trim().replace('_', "").parse().ok()?
        }
        None => key.split('.').try_fold(&arm.case, |node, part| node.get(part))?.as_f64()?,
    };
    let counts = key.ends_with("cells");
    (value > 0.0 && f64::is_finite(value)).then(|| if counts { 1.0 / value } else { value })
}
