//! Doubts about a run that finishes all the same.

use serde::{Deserialize, Serialize};

/// A reason to distrust some of a run's numbers: what a reviewer would ask about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Warning {
    /// Name of the warning in the table of warnings: `coarse-secondary`.
    pub id: String,
    /// Place in the case: `contact "strike"`.
    pub place: String,
    /// Description of what was found, with numbers.
    pub what: String,
    /// Why the finding matters.
    pub why: String,
    /// Suggested remedy.
    pub advice: String,
}

impl Warning {
    /// The warnings of several runs, each once, in order of their first occurrence, with the
    /// numbers of the runs that gave it.
    pub fn shared<'a>(given: impl Iterator<Item = &'a [Self]>) -> Vec<(&'a Self, Vec<usize>)> {
        let mut shared: Vec<(&Self, Vec<usize>)> = Vec::new();
        for (run, warning) in given.enumerate().flat_map(|(run, all)| all.iter().map(move |w| (run, w))) {
            match shared.iter_mut().find(|(known, _)| *known == warning) {
                Some((_, runs)) => runs.push(run),
                None => shared.push((warning, vec![run])),
            }
        }
        shared
    }
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { id, place, what, why, advice } = self;
        write!(f, "{place}: {what}; {why}; try {advice} ({id})")
    }
}
