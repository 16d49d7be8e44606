//! An arm of a study: one variant that is simulated, as stored in the manifest.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::design::Role;
use crate::Facts;

/// Arm of a study: one simulation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Arm {
    /// Name in tables and figures.
    pub name: String,
    /// Run directory of the arm, relative to the directory of the study.
    pub directory: String,
    /// Changes of the case in this arm, each as `key=value`.
    pub sets: Vec<String>,
    /// Number of time steps.
    pub steps: u64,
    /// Role of the arm in the study.
    pub role: Role,
    /// Path of the arm's case file, if it is not that of the study.
    pub case_path: Option<String>,
    /// Properties of the arm's case that metrics and rankings depend on.
    pub facts: Facts,
    /// The case as resolved.
    pub case: serde_json::Value,
}

impl Arm {
    /// Method of the arm, or the name of the arm in a study without methods.
    pub fn method(&self) -> &str {
        self.role.method.as_ref().unwrap_or(&self.name)
    }

    /// Changes of the case in this arm, except for the time step.
    pub fn sets_without_step(&self) -> impl Iterator<Item = &String> {
        self.sets.iter().filter(|set| !sets_step(set))
    }
}

/// Number of steps of an arm from one row of its history to the next.
pub(super) fn history_every(arm: &Arm) -> f64 {
    let given = arm.case.get("output").and_then(|output| output.get("history_every"));
    given.and_then(serde_json::Value::as_f64).unwrap_or(1.0)
}

/// Whether a change `key=value` sets the time step.
pub fn sets_step(set: &str) -> bool {
    set.split('=').next().is_some_and(|key| key.trim() == "time.step")
}

/// The step of an arm: the value it sets for the key, or that of its case; 1/n for a count
/// ([`count`]).
pub fn step(arm: &Arm, key: &str) -> Option<f64> {
    let value = match set(arm, key) {
        Some(text) => number(text.trim_start_matches('[').split([',', ']']).next()?)?,
        None => of_case(arm, key)?,
    };
    let is_count = count(key).is_some();
    (value > 0.0 && f64::is_finite(value)).then(|| if is_count { 1.0 / value } else { value })
}

/// The number of an arm for a key, of any sign: the value it sets, or that of its case. Of arrays
/// only numbers of cells are numbers, 1/n of the first direction.
pub fn scalar(arm: &Arm, key: &str) -> Option<f64> {
    if count(key).is_some() {
        return step(arm, key);
    }
    let value = set(arm, key).map_or_else(|| of_case(arm, key), number)?;
    value.is_finite().then_some(value)
}

/// The last part of a key that counts cells, layers of cells or refinements: the mesh becomes finer
/// as its value grows. None of other keys.
pub fn count(key: &str) -> Option<&str> {
    let last = key.rsplit_once('.').map_or(key, |(_, last)| last);
    ["cells", "layers", "refine"].contains(&last).then_some(last)
}

/// Value that an arm sets for a key; the last one counts.
fn set<'a>(arm: &'a Arm, key: &str) -> Option<&'a str> {
    let sets = |set: &'a String| set.strip_prefix(key)?.trim_start().strip_prefix('=').map(str::trim);
    arm.sets.iter().rev().find_map(sets)
}

/// The number of a key in the resolved case; of numbers of cells that of the first direction
/// counts.
fn of_case(arm: &Arm, key: &str) -> Option<f64> {
    let found = arm.case.pointer(&pointer(&arm.case, key)?)?;
    let first = found.as_array().filter(|_| count(key).is_some()).and_then(|list| list.first());
    first.unwrap_or(found).as_f64()
}

/// The resolved case of an arm without a key, output, expectations and title.
pub(super) fn case_without(arm: &Arm, key: &str) -> Value {
    let mut case = arm.case.clone();
    let path = pointer(&case, key);
    if let Some(value) = path.and_then(|path| case.pointer_mut(&path)) {
        *value = Value::Null;
    }
    if let Some(table) = case.as_object_mut() {
        ["output", "expects", "title"].iter().for_each(|name| _ = table.remove(*name));
    }
    case
}

/// The JSON pointer of a key in a resolved case, where tables in lists have names.
fn pointer(case: &Value, key: &str) -> Option<String> {
    let mut path = String::new();
    for part in key.split('.') {
        let place = match case.pointer(&path)? {
            Value::Array(list) => {
                let is_named = |table: &Value| table.get("name").is_some_and(|name| name == part);
                list.iter().position(is_named)?.to_string()
            }
            table => {
                let lists = [part.to_owned(), format!("{part}s"), part.replace("body", "bodies")];
                lists.into_iter().find(|name| table.get(name).is_some())?
            }
        };
        path.push('/');
        path.push_str(&place);
    }
    Some(path)
}

fn number(text: &str) -> Option<f64> {
    text.trim().replace('_', "").parse().ok()
}
