//! Gravity as nodal forces M g with the mass matrix of the case: lumped or not, a free body falls
//! without deforming. Components that are constant have a potential; those that vary in time are
//! loads.

use carom_case::keys::IN_TIME;
use carom_case::{Case, FormulaSpec, Problem};
use carom_formula::Formula;
use carom_mechanics::model::{BodyInstance, Load, Loads, Mass, Weight};

use super::obstacles::Moving;

/// The bodies and free obstacles that gravity acts on, with their masses.
pub(super) struct Weights<'a> {
    pub(super) case: &'a Case,
    pub(super) parts: &'a [BodyInstance],
    pub(super) obstacles: &'a [Moving<'a>],
    pub(super) mass: &'a Mass,
}

/// Gravity of a part, and its key in the case.
struct Gravity<'a> {
    part: &'a BodyInstance,
    components: &'a [FormulaSpec],
    path: String,
}

impl Weights<'_> {
    fn each(&self) -> impl Iterator<Item = Gravity<'_>> {
        let bodies = self.parts.iter().zip(&self.case.bodies).enumerate();
        let of_bodies = bodies.map(|(k, (part, body))| Gravity {
            part,
            components: &body.gravity,
            path: format!("body[{k}].gravity"),
        });
        of_bodies.chain(self.obstacles.iter().map(|obstacle| Gravity {
            part: &self.parts[obstacle.part],
            components: obstacle.gravity(),
            path: self.case.contacts[obstacle.contact].path("primary.gravity"),
        }))
    }

    /// Nodal forces of constant gravity.
    pub(super) fn constant(&self) -> Vec<f64> {
        let mut acceleration = vec![0.0; self.mass.nodes() * self.case.dimension];
        for Gravity { part, components, .. } in self.each() {
            for node in part.of_mut(&mut acceleration).chunks_exact_mut(self.case.dimension) {
                node.iter_mut().zip(components).for_each(|(g, of)| *g = of.constant().unwrap_or(0.0));
            }
        }
        self.force(&acceleration)
    }

    /// Adds gravity that varies in time to the loads. Returns what is no formula.
    pub(super) fn add_varying(&self, loads: &mut Loads) -> Vec<Problem> {
        let d = self.case.dimension;
        let mut problems = Vec::new();
        for Gravity { part, components, path } in self.each() {
            if components.iter().all(|of| of.constant().is_some()) {
                continue;
            }
            let varying = |of: &FormulaSpec| match of.constant() {
                Some(_) => Ok(Formula::constant(0.0)),
                None => of.formula(IN_TIME),
            };
            let mut along_x = vec![0.0; self.mass.nodes() * d];
            part.of_mut(&mut along_x).iter_mut().step_by(d).for_each(|a| *a = 1.0);
            let masses = part.of(&self.force(&along_x)).iter().copied().step_by(d).collect();
            match components.iter().map(varying).collect() {
                Ok(value) => loads.add_weight(Load {
                    on: Weight { first_node: part.first_node, masses },
                    value,
                    label: format!("the gravity of \"{}\"", part.name),
                    amplitude: None,
                }),
                Err(error) => problems.push(Problem::new(path, error.to_string(), "", "")),
            }
        }
        problems
    }

    fn force(&self, acceleration: &[f64]) -> Vec<f64> {
        let mut force = vec![0.0; acceleration.len()];
        self.mass.multiply_into(acceleration, &mut force);
        force
    }
}
