//! Ensembles: every arm of a study is run several times with changes that should not matter, so
//! that a number of a single run is not taken for a property of the method. Contact chatters: a
//! small shift of the instant at which a body arrives within a step, the phase of the mesh, or
//! which side is called secondary can change peaks, roughness and losses more than the method does.
//!
//! ```text
//! phases    the grid of times shifted by 0, 1/n, … of a step
//! roles     secondary and primary sides as given, and swapped
//! mesh      all meshes refined by these factors
//! sets      the case as given, and with each of these changes: the impact law, other nodes
//! ```
//!
//! The members of an arm are all combinations; the first one is the arm itself. Of n members the
//! median and the range are given. The range is an interval for the median of all possible members
//! with the confidence 1 − 2^(1−n), because the probability that n independent members lie on one
//! side of it is 2·2^(−n).

use serde::{Deserialize, Serialize};

/// Changes with which every arm of a study is repeated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ensemble {
    /// Number of phases of the grid of times.
    pub phases: u32,
    /// Whether secondary and primary sides are swapped too.
    pub swapped: bool,
    /// Factors of mesh refinement; the first one is 1.
    pub mesh: Vec<f64>,
    /// Sets of changes of the case, each `key=value`, besides the case as given.
    pub sets: Vec<Vec<String>>,
}

/// Difference of one member of an ensemble from its arm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Member {
    /// Shift of the grid of times as a fraction of a step.
    pub phase: f64,
    /// Whether secondary and primary sides are swapped.
    pub swapped: bool,
    /// Factor of mesh refinement.
    pub mesh: f64,
    /// Number of the set of changes of the case, from 1; 0 for none.
    pub set: usize,
}

impl Ensemble {
    /// All members; the first one changes nothing.
    pub fn members(&self) -> Vec<Member> {
        let roles: &[bool] = if self.swapped { &[false, true] } else { &[false] };
        let phases = self.phases.max(1);
        let mut members = Vec::new();
        for set in 0..=self.sets.len() {
            for &mesh in &self.mesh {
                for &swapped in roles {
                    let phase = |k: u32| f64::from(k) / f64::from(phases);
                    members.extend((0..phases).map(|k| Member { phase: phase(k), swapped, mesh, set }));
                }
            }
        }
        members
    }

    /// The changes of the case that a member makes.
    pub fn changes(&self, member: &Member) -> &[String] {
        member.set.checked_sub(1).and_then(|i| self.sets.get(i)).map_or(&[], Vec::as_slice)
    }

    /// `contact.strike.persistency="none", swapped, phase 0.2`; empty for the arm itself.
    pub fn name(&self, member: &Member) -> String {
        let parts = [
            (member.set != 0).then(|| self.changes(member).join(", ")),
            (member.mesh != 1.0).then(|| format!("mesh {}", member.mesh)),
            member.swapped.then(|| "swapped".to_owned()),
            (member.phase != 0.0).then(|| format!("phase {}", member.phase)),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }

    /// Description of the ensemble in words.
    pub fn words(&self) -> String {
        let mut parts = Vec::new();
        if self.mesh.len() > 1 {
            let factors: Vec<String> = self.mesh.iter().map(ToString::to_string).collect();
            parts.push(format!("{} meshes (refined by {})", self.mesh.len(), factors.join(", ")));
        }
        if self.phases > 1 {
            parts.push(format!("{} phases of the steps", self.phases));
        }
        if self.swapped {
            parts.push("both choices of the secondary side".to_owned());
        }
        if !self.sets.is_empty() {
            let sets: Vec<String> = self.sets.iter().map(|set| set.join(" and ")).collect();
            parts.push(format!("{} settings (as given; {})", sets.len() + 1, sets.join("; ")));
        }
        parts.join(" × ")
    }
}

/// Values of the members: their median and range.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    /// The values in ascending order.
    values: Vec<f64>,
}

impl Spread {
    /// Collects the finite values; none if there are none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        (!values.is_empty()).then_some(Self { values })
    }

    /// Number of values.
    pub fn count(&self) -> usize {
        self.values.len()
    }

    /// The median.
    pub fn median(&self) -> f64 {
        let n = self.values.len();
        f64::midpoint(self.values[(n - 1) / 2], self.values[n / 2])
    }

    /// Least and largest value.
    pub fn range(&self) -> (f64, f64) {
        (self.values[0], self.values[self.values.len() - 1])
    }

    /// Largest distance of a value from the median.
    pub fn half_width(&self) -> f64 {
        let median = self.median();
        let (low, high) = self.range();
        (high - median).max(median - low)
    }
}
