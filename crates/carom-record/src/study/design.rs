//! How the arms of a study were made comparable, and what its user is after.

use serde::{Deserialize, Serialize};

/// What makes methods comparable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Every method at the same steps.
    MatchedStep,
    /// Every method at the step at which it costs what one of them costs.
    MatchedCost,
}

/// A design: methods, and the levels at which each of them runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// What is equal at a level.
    pub kind: Kind,
    /// The method whose cost the others are given, with matched cost or by their own wish.
    pub cost_of: String,
    /// Steps of the levels, the coarsest first; with matched cost those of `cost_of`.
    pub steps: Vec<f64>,
}

/// What a study ranks by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Goal {
    /// Energy kept.
    Energy,
    /// Contact force as the reference has it.
    Force,
    /// Stresses as the reference has them.
    Stress,
    /// Displacements as the reference has them.
    Trajectory,
    /// Least work for displacements within the accuracy.
    Cost,
}

impl Goal {
    /// Names, as a study file writes them, with what each ranks by.
    pub const NAMES: [(&str, Goal, &str); 5] = [
        ("energy", Goal::Energy, "largest change of energy at any time"),
        (
            "force",
            Goal::Force,
            "total variation of the contact force; power above 16 cycles per contact, mean peak and impulse stand in for it",
        ),
        (
            "stress",
            Goal::Stress,
            "total variation of the probes' stresses; their mean peaks and deviations stand in for it",
        ),
        ("trajectory", Goal::Trajectory, "deviation of displacements and centres"),
        ("cost", Goal::Cost, "processor time of what keeps displacements within `accuracy`"),
    ];

    /// All goals.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::NAMES.iter().map(|(_, goal, _)| *goal)
    }

    /// As a study file writes it.
    pub fn word(self) -> &'static str {
        Self::NAMES.iter().find(|(_, goal, _)| *goal == self).map_or("", |(name, ..)| name)
    }

    /// What it ranks by, in words.
    pub fn meaning(self) -> &'static str {
        Self::NAMES.iter().find(|(_, goal, _)| *goal == self).map_or("", |(.., meaning)| meaning)
    }
}

/// What an arm is to its study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Role {
    /// The method it is, in a design.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub method: Option<String>,
    /// Number of its level.
    #[serde(default)]
    pub level: usize,
    /// Whether it is given the cost of `cost_of` where the others have the level's step.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub by_cost: bool,
    /// Its counted cost over the budget of its level, where its cost is matched.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cost: Option<f64>,
    /// Whether it is one of the three runs of the computed reference.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub fine: bool,
}
