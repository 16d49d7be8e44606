//! How the arms of a study are made comparable, and by which goal they are ranked.

use serde::{Deserialize, Serialize};

use super::ensemble::Member;

/// The quantity in which methods are matched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Every method has the same steps.
    MatchedStep,
    /// Every method has the step at which its cost equals that of `cost_of`.
    MatchedCost,
}

/// A design: methods, and the levels at which each of them is run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// Whether steps or costs are equal at a level.
    pub kind: Kind,
    /// The method whose cost the others are matched to, in a design of matched cost or where an arm
    /// requests it.
    pub cost_of: String,
    /// Steps of the levels, the coarsest first; with matched cost, those of `cost_of`.
    pub steps: Vec<f64>,
}

/// The goal by which a study ranks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Goal {
    /// Conservation of energy.
    Energy,
    /// Accuracy of the contact force.
    Force,
    /// Accuracy of the stresses.
    Stress,
    /// Accuracy of what friction takes and of how long nodes stick.
    Friction,
    /// Accuracy of the displacements.
    Trajectory,
    /// Least work for displacements of the required accuracy.
    Cost,
}

impl Goal {
    /// Names in study files, with the measure that each goal ranks by.
    const NAMES: [(&str, Goal, &str); 6] = [
        ("energy", Goal::Energy, "largest energy that time integrator and contact dissipated or created"),
        ("force", Goal::Force, "deviation of the contact force, averaged over a short time"),
        ("stress", Goal::Stress, "deviation of the stresses of the probes, averaged over a short time"),
        (
            "friction",
            Goal::Friction,
            "root mean square of the errors of friction's work and of the share of the time in contact that nodes stick",
        ),
        ("trajectory", Goal::Trajectory, "deviation of displacements and centres"),
        ("cost", Goal::Cost, "counted cost of arms whose displacements are within `accuracy`"),
    ];

    /// All goals.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::NAMES.iter().map(|(_, goal, _)| *goal)
    }

    /// Name in study files.
    pub fn word(self) -> &'static str {
        Self::NAMES.iter().find(|(_, goal, _)| *goal == self).map_or("", |(name, ..)| name)
    }

    /// Description of the measure that the goal ranks by.
    pub fn meaning(self) -> &'static str {
        Self::NAMES.iter().find(|(_, goal, _)| *goal == self).map_or("", |(.., meaning)| meaning)
    }
}

/// The role of an arm in its study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Role {
    /// Method of the arm, in a design.
    pub method: Option<String>,
    /// Number of the arm's level.
    pub level: usize,
    /// Whether the cost of the arm is matched to that of `cost_of`, while the other arms have the
    /// step of the level.
    pub by_cost: bool,
    /// Counted cost of the arm divided by the budget of its level, if its cost is matched.
    pub cost: Option<f64>,
    /// Whether the arm is one of the runs of the computed reference.
    pub fine: bool,
    /// Whether the arm is a run of the reference with another scheme, or with twice its step.
    pub check: bool,
    /// Place of the run in an ensemble, if it is a member of one.
    pub member: Option<MemberOf>,
}

/// A member of an ensemble.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MemberOf {
    /// Number of the arm that is repeated.
    pub arm: usize,
    /// How the member differs from the arm.
    #[serde(flatten)]
    pub member: Member,
}
