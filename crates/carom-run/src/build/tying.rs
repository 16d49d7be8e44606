//! Whether supports, the start and the masses of a case suit its ties.

use carom_case::{BodySpec, Case, Problem};
use carom_mechanics::model::{BodyInstance, Point};

use super::motions::Moves;
use super::side::coordinates;
use super::ties::{Ties, tie_of};

/// Difference across a tie, relative to the largest value, that is round-off.
const NEAR: f64 = 1e-9;

/// The ties of a model of these bodies.
pub(super) struct Tying<'a> {
    pub(super) case: &'a Case,
    pub(super) parts: &'a [BodyInstance],
    pub(super) reference: &'a [f64],
    pub(super) ties: &'a Ties,
}

impl Tying<'_> {
    /// Releases points from supports that also hold all that carries them; any other support of a
    /// point is a problem. Returns the released dofs, ascending.
    pub(super) fn release(
        &self,
        fixed: &mut [bool],
        moves: &mut Moves,
        problems: &mut Vec<Problem>,
    ) -> Vec<usize> {
        let d = self.case.dimension;
        let mut released = Vec::new();
        for point in self.ties.points.iter() {
            for axis in 0..d {
                let support = |node: usize| (fixed[node * d + axis], moves.text(node * d + axis));
                let own = support(point.node);
                if own == (false, None) {
                    continue;
                }
                if point.weights.iter().any(|(carrier, _)| support(*carrier) != own) {
                    problems.push(self.overconstrained(point, axis));
                    return released;
                }
                fixed[point.node * d + axis] = false;
                moves.by_dof.remove(&(point.node * d + axis));
                released.push(point.node * d + axis);
            }
        }
        released
    }

    /// Marks the dofs of points as constrained that nothing unconstrained carries.
    pub(super) fn constrain(&self, fixed: &mut [bool]) {
        let d = self.case.dimension;
        for point in self.ties.points.iter() {
            for axis in 0..d {
                let is_fixed = point.weights.iter().all(|(carrier, _)| fixed[carrier * d + axis]);
                fixed[point.node * d + axis] = is_fixed;
            }
        }
    }

    fn overconstrained(&self, point: &Point, axis: usize) -> Problem {
        let at = coordinates(self.place(point.node));
        let (_, body) = self.body_of(point.node);
        let tie = tie_of(&self.ties.list, point.node);
        let name = &self.ties.list[tie].name;
        let axis = ["x", "y", "z"][axis];
        let what = format!(
            "tie `{name}` and a support both hold the node of body \"{}\" at {at} along {axis}",
            body.map_or("", |body| body.name.as_str())
        );
        let why = "a tied node moves with the primary side, which no support moves or holds like this there";
        let help = "give the side of the other body the same support, leave this node's side out of it, or \
            exchange `secondary` and `primary` of the tie";
        Problem::new(format!("tie[{tie}].secondary"), what, why, help)
    }

    fn place(&self, node: usize) -> &[f64] {
        let d = self.case.dimension;
        &self.reference[node * d..(node + 1) * d]
    }

    /// The number and the table of a node's body; none of an obstacle.
    fn body_of(&self, node: usize) -> (usize, Option<&BodySpec>) {
        let body = self.parts.iter().position(|part| part.nodes().contains(&node)).unwrap_or(0);
        (body, self.case.bodies.get(body))
    }

    /// Gives the points the initial positions and velocities of what carries them. Values that
    /// differ are a problem, unless both bodies have the same formulas.
    pub(super) fn start(&self, position: &mut [f64], velocity: &mut [f64], problems: &mut Vec<Problem>) {
        let of_position = |body: &BodySpec| body.position.clone();
        let of_velocity = |body: &BodySpec| Some(body.velocity.clone());
        let before = problems.len();
        self.carry("position", position, problems, |a, b| of_position(a) == of_position(b));
        // Rigid-body velocities follow from positions, and would differ with them.
        if problems.len() == before {
            self.carry("velocity", velocity, problems, |a, b| of_velocity(a) == of_velocity(b));
        }
    }

    fn carry(
        &self,
        key: &str,
        values: &mut [f64],
        problems: &mut Vec<Problem>,
        same: impl Fn(&BodySpec, &BodySpec) -> bool,
    ) {
        let d = self.case.dimension;
        let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let given = values.to_vec();
        self.ties.points.carry(values);
        let differs = |dof: &usize| (values[*dof] - given[*dof]).abs() > NEAR * largest;
        let has_own = |point: &&Point| {
            let (_, own) = self.body_of(point.node);
            let others = point.weights.iter().map(|(carrier, _)| self.body_of(*carrier).1);
            others.into_iter().any(|other| own.zip(other).is_some_and(|(own, other)| !same(own, other)))
        };
        let dofs = self.ties.points.iter().filter(has_own).flat_map(|p| p.node * d..(p.node + 1) * d);
        let Some(dof) = dofs.into_iter().find(differs) else { return };
        let (body, _) = self.body_of(dof / d);
        let at = coordinates(self.place(dof / d));
        let tie = &self.ties.list[tie_of(&self.ties.list, dof / d)];
        let axis = ["x", "y", "z"][dof % d];
        let what = format!("the initial {key} differs across tie `{}` at {at}", tie.name);
        let why = format!(
            "along {axis} it is {} on the secondary side, and {} on the primary side",
            given[dof], values[dof]
        );
        let help = format!("give both bodies the same `{key}`, or formulas that agree along the tie");
        problems.push(Problem::new(format!("body[{body}].{key}"), what, why, help));
    }

    /// Reports points of which only one side has mass.
    pub(super) fn check_masses(&self, massless: &[bool], problems: &mut Vec<Problem>) {
        if self.case.time.scheme.is_static() {
            return;
        }
        let d = self.case.dimension;
        let differs = |point: &&Point| {
            let own = massless[point.node * d];
            point.weights.iter().any(|(carrier, _)| massless[carrier * d] != own)
        };
        if let Some(point) = self.ties.points.iter().find(differs) {
            let at = coordinates(self.place(point.node));
            let tie = tie_of(&self.ties.list, point.node);
            let what = format!("only one side of tie `{}` has mass at {at}", self.ties.list[tie].name);
            let why = "the balance of nodes without mass holds at the end of a step, that of others as a mean over it";
            let help =
                "use mass = \"consistent\" for bodies whose contact sides are tied, or density > 0 for both";
            problems.push(Problem::new(format!("tie[{tie}].secondary"), what, why, help));
        }
    }
}
