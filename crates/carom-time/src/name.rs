//! The name of a scheme with its parameters, as in a case file.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::scheme::ForceRule;

/// The name of a scheme with its parameters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Name {
    /// Kind as in [`crate::KINDS`].
    pub kind: &'static str,
    /// Parameters by key.
    pub parameters: BTreeMap<&'static str, f64>,
    /// What α_f averages; of the α family only.
    pub forces: ForceRule,
}

impl std::fmt::Display for Name {
    /// As in a case file.
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{{ kind = \"{}\"", self.kind)?;
        for (key, value) in &self.parameters {
            write!(f, ", {key} = {}", short(*value))?;
        }
        if self.forces == ForceRule::AverageState {
            write!(f, ", forces = \"average-state\"")?;
        }
        write!(f, " }}")
    }
}

/// A number for display: twelve significant digits, no trailing noise.
pub(crate) fn short(x: f64) -> String {
    format!("{x:.11e}").parse::<f64>().unwrap_or(x).to_string()
}
