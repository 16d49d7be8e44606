//! The rows that active contacts add to the linear system, and their data.
//!
//! Not every active pair is a row: a redundant one would make the system singular, which its
//! residual would not reveal. A row is kept if its gradient on free dofs is linearly independent of
//! those of the rows before. A node on a symmetry axis keeps its support and its contact; a corner
//! node in two contacts with one facet keeps one of them, for any contacts and nodes (Gaussian
//! elimination of the sparse rows).

use std::collections::BTreeMap;

use carom_contact::{Direction, DiscreteGradient, Row, Rows};

use crate::balance::contact_weights;
use crate::equations::{Equations, Evaluation};
use crate::model::Model;

/// Remainder after elimination (gradients are of order one) below which a row depends on the
/// others.
pub(crate) const DEPENDENT: f64 = 1e-8;

/// Rows of a linear system.
#[derive(Clone, Debug)]
pub(crate) struct Constraints {
    /// Contact and pair of each row.
    pub places: Vec<(usize, usize)>,
    /// Gradients of the gaps.
    pub rows: Rows,
    /// Directions of the forces.
    pub directions: Rows,
    /// Weight of the contact force in the balance.
    pub weights: Vec<f64>,
    /// Gap per unit of multiplier.
    pub compliances: Vec<f64>,
    /// Gap still to be closed.
    pub open: Vec<f64>,
    /// λ times the derivative of the direction over the nodes of each row, row-major: λ∇²g, or not
    /// symmetric for a discrete gradient. Empty if not requested.
    pub curvatures: Vec<Vec<f64>>,
}

impl Constraints {
    /// No rows.
    pub(crate) fn none(dimension: usize) -> Self {
        Self {
            places: Vec::new(),
            rows: Rows::new(dimension),
            directions: Rows::new(dimension),
            weights: Vec::new(),
            compliances: Vec::new(),
            open: Vec::new(),
            curvatures: Vec::new(),
        }
    }

    /// Rows as constraints of weight 1, without second derivatives, to solve for velocities or
    /// accelerations.
    pub(crate) fn plain<'a>(
        dimension: usize,
        rows: impl IntoIterator<Item = ((usize, usize), Row<'a>)>,
    ) -> Self {
        let mut plain = Self::none(dimension);
        for (place, row) in rows {
            plain.places.push(place);
            plain.rows.push_row(row);
            plain.directions.push_row(row);
            plain.weights.push(1.0);
            plain.compliances.push(0.0);
            plain.open.push(0.0);
        }
        plain
    }

    /// The rows of an evaluation, with second derivatives.
    pub(crate) fn of(equations: &Equations, evaluation: &Evaluation) -> Self {
        let model = equations.model;
        let mut constraints = Self::none(model.dimension);
        let (mut rows, mut gradient) = (Rows::new(model.dimension), DiscreteGradient::default());
        // Springs may depend on each other: each adds its stiffness.
        let is_spring = |&(k, _): &(usize, usize)| !model.contacts[k].interface.is_constraint();
        let held = evaluation.pressing().filter(|place| !is_spring(place));
        let mut places = independent_rows(model, held, &evaluation.rows);
        places.extend(evaluation.pressing().filter(is_spring));
        places.sort_unstable();
        for place in places {
            let (k, p) = place;
            let contact = &model.contacts[k];
            let answer = &evaluation.answers[k][p];
            let mut curvature =
                derivative_of_direction(equations, evaluation, place, &mut rows, &mut gradient);
            curvature.iter_mut().for_each(|c| *c *= answer.lambda);
            constraints.places.push(place);
            constraints.rows.push_row(evaluation.rows[k].row(p));
            constraints.directions.push_row(evaluation.directions(k).row(p));
            constraints.weights.push(contact_weights(&equations.stage, contact.at_the_end).0);
            constraints.compliances.push(answer.compliance);
            constraints.open.push(answer.open);
            constraints.curvatures.push(curvature);
        }
        constraints
    }

    /// Number of rows.
    pub(crate) fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there are no rows.
    pub(crate) fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// The nodes of all rows, ascending.
    pub(crate) fn nodes(&self) -> Vec<usize> {
        let mut nodes: Vec<usize> = self.rows.iter().flat_map(|row| row.nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Calls `visit(row, dof, slope)` for the entries w·∇g of all rows at unknowns.
    pub(crate) fn each_entry(&self, model: &Model, mut visit: impl FnMut(usize, usize, f64)) {
        for (r, row) in self.rows.iter().enumerate() {
            for (dof, slope) in row.entries() {
                if let Some(unknown) = model.unknown(dof) {
                    visit(r, unknown, self.weights[r] * slope);
                }
            }
        }
    }

    /// Calls `visit(a, b, value)` for the entries w/C·∇g ∇gᵀ of the springs at unknowns a ≥ b.
    pub(crate) fn each_spring(&self, model: &Model, mut visit: impl FnMut(usize, usize, f64)) {
        for (r, row) in self.rows.iter().enumerate().filter(|(r, _)| self.compliances[*r] != 0.0) {
            let stiffness = self.weights[r] / self.compliances[r];
            let slopes = || row.entries().filter_map(|(dof, slope)| Some((model.unknown(dof)?, slope)));
            for (a, slope) in slopes() {
                slopes()
                    .filter(|(b, _)| a >= *b)
                    .for_each(|(b, other)| visit(a, b, stiffness * slope * other));
            }
        }
    }

    /// Calls `visit(a, b, value)` for the entries w·λ∇²g of all rows at unknowns a ≥ b,
    /// symmetrised.
    pub(crate) fn each_curvature(&self, model: &Model, mut visit: impl FnMut(usize, usize, f64)) {
        for (r, (row, curvature)) in self.rows.iter().zip(&self.curvatures).enumerate() {
            let count = row.gradient.len();
            for (i, (dof, _)) in row.entries().enumerate() {
                let Some(a) = model.unknown(dof) else { continue };
                for (j, (other, _)) in row.entries().enumerate() {
                    if let Some(b) = model.unknown(other)
                        && a >= b
                    {
                        let mean = 0.5 * (curvature[i * count + j] + curvature[j * count + i]);
                        visit(a, b, self.weights[r] * mean);
                    }
                }
            }
        }
    }
}

/// Derivative of the direction of a pair's force to the positions at the end of the step, over the
/// nodes of its row, row-major; `rows` and `gradient` are buffers.
fn derivative_of_direction(
    equations: &Equations,
    evaluation: &Evaluation,
    (k, p): (usize, usize),
    rows: &mut Rows,
    gradient: &mut DiscreteGradient,
) -> Vec<f64> {
    let contact = &equations.model.contacts[k];
    let (row, pair) = (evaluation.rows[k].row(p), &evaluation.at.pairings[k].pairs[p]);
    let Evaluation { y, place, at, .. } = evaluation;
    let mut matrix = vec![0.0; row.gradient.len().pow(2)];
    match contact.interface.direction() {
        Direction::End => contact.kinematics.curvature_into(pair, y, &mut matrix),
        Direction::Midpoint => {
            contact.kinematics.curvature_into(pair, place, &mut matrix);
            matrix.iter_mut().for_each(|entry| *entry *= 0.5);
        }
        Direction::DiscreteGradient => {
            // Both were measured in the evaluation.
            rows.clear();
            let mut middle = *pair;
            if let Ok(start) = equations.gap_at_start(k, pair, rows)
                && contact.kinematics.measure(&mut middle, place, rows).is_ok()
            {
                gradient.evaluate(rows.row(0), row.gap - start, place, &at.increment);
                contact.kinematics.curvature_into(&middle, place, &mut matrix);
                gradient.derivative_into(row, &mut matrix);
            }
        }
    }
    matrix
}

impl Evaluation {
    /// Contact and pair of all active ones.
    pub(crate) fn pressing(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let pairs = self.at.pairings.iter().enumerate();
        pairs.flat_map(|(k, pairing)| {
            let active = pairing.pairs.iter().enumerate().filter(|(_, pair)| pair.active);
            active.map(move |(p, _)| (k, p))
        })
    }
}

/// The places whose rows are linearly independent on the free dofs.
pub(crate) fn independent_rows(
    model: &Model,
    places: impl Iterator<Item = (usize, usize)>,
    rows: &[Rows],
) -> Vec<(usize, usize)> {
    let mut accepted: Vec<Vec<(usize, f64)>> = Vec::new();
    // The accepted row whose pivot is this dof.
    let mut pivots: BTreeMap<usize, usize> = BTreeMap::new();
    let independent = |&(k, p): &(usize, usize)| {
        let mut row: Vec<(usize, f64)> =
            rows[k].row(p).entries().filter(|(dof, _)| !model.fixed[*dof]).collect();
        let mut from = 0;
        // An accepted row contains pivots of later ones only: in ascending order each occurs once.
        while let Some((r, factor)) = row
            .iter()
            .filter_map(|(dof, value)| Some((*pivots.get(dof)?, *value)))
            .filter(|(r, value)| *r >= from && *value != 0.0)
            .min_by_key(|(r, _)| *r)
        {
            for &(dof, value) in &accepted[r] {
                match row.iter_mut().find(|(d, _)| *d == dof) {
                    Some((_, x)) => *x -= factor * value,
                    None => row.push((dof, -factor * value)),
                }
            }
            from = r + 1;
        }
        let largest = row
            .iter()
            .fold((0, 0.0_f64), |most, &(dof, x)| if x.abs() > most.1.abs() { (dof, x) } else { most });
        if largest.1.abs() <= DEPENDENT {
            return false;
        }
        row.iter_mut().for_each(|(_, x)| *x /= largest.1);
        pivots.insert(largest.0, accepted.len());
        accepted.push(row);
        true
    };
    places.filter(independent).collect()
}
