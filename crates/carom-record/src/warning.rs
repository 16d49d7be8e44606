//! Doubts about a run that finishes all the same.

use serde::{Deserialize, Serialize};

/// A reason to distrust some of a run's numbers: what a reviewer would ask about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Warning {
    /// Its name in the table of warnings: `coarse-secondary`.
    pub id: String,
    /// Where: `contact "strike"`.
    pub place: String,
    /// What was found, with its numbers.
    pub what: String,
    /// Why it matters.
    pub why: String,
    /// What to try.
    pub advice: String,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { id, place, what, why, advice } = self;
        write!(f, "{place}: {what}; {why}; try {advice} ({id})")
    }
}
