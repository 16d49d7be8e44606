//! An arm of a study: one variant that is simulated, as stored in the manifest.

use serde::{Deserialize, Serialize};

use super::design::Role;
use crate::Facts;

/// One simulation of a study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
    pub role: Role,
    /// Its case file, if it is not that of the study.
    pub case_path: Option<String>,
    /// What metrics and rankings need to know of its case.
    pub facts: Facts,
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
}

/// Whether a change is that of the step.
pub fn sets_step(set: &str) -> bool {
    set.split('=').next().is_some_and(|key| key.trim() == "time.step")
}

/// The step of an arm: the value it sets for the key, or that of its case; 1/n for a number of
/// cells and for the factor of refinement.
pub fn step(arm: &Arm, key: &str) -> Option<f64> {
    let value = match set(arm, key) {
        Some(text) => number(text.trim_start_matches('[').split([',', ']']).next()?)?,
        None => of_case(arm, key)?,
    };
    let counts = counts_cells(key);
    (value > 0.0 && f64::is_finite(value)).then(|| if counts { 1.0 / value } else { value })
}

/// The number of an arm for a key, of any sign: the value it sets, or that of its case. Of arrays
/// only numbers of cells are numbers, 1/n of the first direction.
pub(super) fn scalar(arm: &Arm, key: &str) -> Option<f64> {
    if counts_cells(key) {
        return step(arm, key);
    }
    let value = set(arm, key).map_or_else(|| of_case(arm, key), number)?;
    value.is_finite().then_some(value)
}

fn counts_cells(key: &str) -> bool {
    key.ends_with("cells") || key == "refine"
}

/// What an arm sets for a key.
fn set<'a>(arm: &'a Arm, key: &str) -> Option<&'a str> {
    let sets = |set: &'a String| set.strip_prefix(key)?.trim_start().strip_prefix('=').map(str::trim);
    arm.sets.iter().rev().find_map(sets)
}

fn of_case(arm: &Arm, key: &str) -> Option<f64> {
    key.split('.').try_fold(&arm.case, |node, part| node.get(part))?.as_f64()
}

fn number(text: &str) -> Option<f64> {
    text.trim().replace('_', "").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_step_is_the_step() {
        assert!(sets_step("time.step=1") && sets_step(" time.step = 1e-3"));
        assert!(!sets_step("time.stepper=1") && !sets_step("title=time.step"));
    }

    #[test]
    fn numbers_have_any_sign_and_are_no_arrays() {
        let arm = |set: &str| Arm {
            sets: vec![set.to_owned()],
            case: serde_json::json!({ "friction": -0.5 }),
            ..Arm::default()
        };
        assert_eq!(scalar(&arm("a.v=-2"), "a.v"), Some(-2.0));
        assert_eq!(scalar(&arm("a.v = 0"), "a.v"), Some(0.0));
        assert_eq!(scalar(&arm("a.v=1_000"), "friction"), Some(-0.5));
        assert_eq!(scalar(&arm("a.v=[0, -2]"), "a.v"), None);
        assert_eq!(scalar(&arm("a.v=inf"), "a.v"), None);
        assert_eq!(scalar(&arm("a.mesh.cells=[8, 4]"), "a.mesh.cells"), Some(0.125));
        assert_eq!(scalar(&arm("refine=4"), "refine"), Some(0.25));
    }
}
