//! An arm of a study: one variant that is simulated, as stored in the manifest.

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
    /// Its changes to the case, `key=value`.
    pub sets: Vec<String>,
    /// Number of time steps.
    pub steps: u64,
    /// Its role in the study.
    #[serde(default)]
    pub role: Role,
    /// Its case file, if it is not that of the study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub case_path: Option<String>,
    /// The case as resolved.
    pub case: serde_json::Value,
}

impl Arm {
    /// Its method, or its name where there are no methods.
    pub fn method(&self) -> &str {
        self.role.method.as_ref().unwrap_or(&self.name)
    }

    /// Its changes to the case, except for the step.
    pub fn sets_without_step(&self) -> impl Iterator<Item = &String> {
        self.sets.iter().filter(|set| !sets_step(set))
    }

    /// Its expectations.
    pub fn expects(&self) -> Vec<Expect> {
        self.case.get("expects").and_then(|e| serde_json::from_value(e.clone()).ok()).unwrap_or_default()
    }
}

/// Whether a change is that of the step.
pub fn sets_step(set: &str) -> bool {
    set.split('=').next().is_some_and(|key| key.trim() == "time.step")
}

/// The step of an arm: the value it sets for the key, or that of its case; 1/n for a number of
/// cells.
pub fn step(arm: &Arm, key: &str) -> Option<f64> {
    let set = arm.sets.iter().rev().find_map(|set| set.strip_prefix(key)?.trim_start().strip_prefix('='));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_step_is_the_step() {
        assert!(sets_step("time.step=1") && sets_step(" time.step = 1e-3"));
        assert!(!sets_step("time.stepper=1") && !sets_step("title=time.step"));
    }
}
