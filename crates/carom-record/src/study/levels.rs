//! The runs of a reference: levels of refinement with their members, and checks.

use super::exact::Exact;
use super::trajectory::Trajectory;

/// The runs of one level of refinement.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Time step; cells shrink with it where the mesh is refined too.
    pub step: f64,
    /// Factor of mesh refinement.
    pub mesh: f64,
    /// Number of different phases of the members.
    pub phases: usize,
    /// Members of the level's ensemble, the run as given first.
    pub members: Vec<Trajectory>,
}

impl Level {
    /// A single run whose mesh is refined with its step.
    pub fn single(step: f64, run: Trajectory) -> Self {
        Self { step, mesh: 1.0 / step, phases: 1, members: vec![run] }
    }

    /// Number of steps from one row of its record to the next.
    pub(super) fn steps_of_a_row(&self) -> f64 {
        let times = self.members.first().map_or(&[][..], |run| &run.times);
        let row = times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        if self.step > 0.0 { (row / self.step).round().max(1.0) } else { 1.0 }
    }

    /// Range of all phases relative to that of the members: n phases, 1/n of a step apart, cover
    /// (n − 1)/n of the range of a quantity that changes evenly with the phase.
    pub(super) fn between_phases(&self) -> f64 {
        if self.phases > 1 { self.phases as f64 / (self.phases - 1) as f64 } else { 1.0 }
    }
}

/// The runs of a reference.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Levels {
    /// Levels of refinement, the finest last; of exact formulas, two samplings.
    pub(super) all: Vec<Level>,
    /// Runs of another scheme and of twice the step on the finest mesh.
    pub(super) checks: Vec<Trajectory>,
    /// The formulas, of an exact reference.
    pub(super) exact: Option<Exact>,
    /// Whether arms have rows between those of the reference.
    pub(super) is_interpolated: bool,
}

impl Levels {
    /// Sizes of the levels: their steps; where the mesh is refined too, in the smaller ratio of
    /// step and mesh from one level to the next, which leaves the larger error.
    pub(super) fn sizes(&self) -> Vec<f64> {
        let Some(finest) = self.all.last() else { return Vec::new() };
        let mut sizes = vec![finest.step];
        for pair in self.all.windows(2).rev() {
            let of_step = pair[0].step / pair[1].step;
            let of_mesh = if self.refines_mesh() { pair[1].mesh / pair[0].mesh } else { of_step };
            sizes.push(sizes[sizes.len() - 1] * of_step.min(of_mesh));
        }
        sizes.reverse();
        sizes
    }

    /// The first member of the finest level.
    pub(super) fn finest(&self) -> Option<&Trajectory> {
        self.all.last()?.members.first()
    }

    /// Whether the error of the mesh is known: there is none, or the mesh was refined.
    pub(super) fn refines_mesh(&self) -> bool {
        self.exact.is_some() || self.all.windows(2).any(|pair| pair[1].mesh > pair[0].mesh)
    }
}
