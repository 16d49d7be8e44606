//! The rows that active contacts add to the linear system, and their data.
//!
//! Not every active pair is a row: a redundant one would make the system singular, which its
//! residual would not reveal. A row is kept if its gradient on free dofs is linearly independent of
//! those of the rows before. A node on a symmetry axis keeps its support and its contact; a corner
//! node in two contacts with one facet keeps one of them, for any contacts and nodes (Gaussian
//! elimination of the sparse rows).

use carom_contact::{Along, Direction, DiscreteGradient, FrictionState, Pair, Row, Rows, inner, length};

use crate::balance::contact_weights;
use crate::equations::Equations;
use crate::evaluation::Evaluation;
use crate::model::Model;
use crate::prevented_slips::PreventedSlips;
use crate::slip_derivatives::SlipDerivatives;

/// Largest gap per unit of a multiplier: of a slip whose traction is round-off.
const LOOSE: f64 = 1e100;

/// Rows of a linear system.
#[derive(Clone, Debug)]
pub(crate) struct Constraints {
    /// Contact and pair of each row.
    pub places: Vec<(usize, usize)>,
    /// The components of each row that is a slip which is prevented; others are gaps.
    pub slips: Vec<Option<Along>>,
    /// Gradients of the gaps.
    pub rows: Rows,
    /// Directions of the forces.
    pub directions: Rows,
    /// Whether friction turns some of these, which the factor then takes into account.
    pub is_skew: bool,
    /// Weight of the contact force in the balance.
    pub weights: Vec<f64>,
    /// Gap per unit of multiplier.
    pub compliances: Vec<f64>,
    /// Gap per unit of a multiplier that is an unknown: of the direction of a slip, and of an
    /// augmented Lagrangian.
    pub yields: Vec<f64>,
    /// Gap still to be closed.
    pub open: Vec<f64>,
    /// Contact, pair and components of slips of sticks that depend on these rows, and have no
    /// traction.
    pub dropped: Vec<((usize, usize), Along)>,
    /// λ times the derivative of the direction over the nodes of each row, row-major: λ∇²g, or not
    /// symmetric for a discrete gradient. Empty if not requested.
    pub curvatures: Vec<Vec<f64>>,
}

impl Constraints {
    /// No rows.
    pub(crate) fn none(dimension: usize) -> Self {
        Self {
            places: Vec::new(),
            slips: Vec::new(),
            rows: Rows::new(dimension),
            directions: Rows::new(dimension),
            is_skew: false,
            weights: Vec::new(),
            compliances: Vec::new(),
            yields: Vec::new(),
            open: Vec::new(),
            dropped: Vec::new(),
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
        rows.into_iter().for_each(|(place, row)| plain.push_plain(place, row, None));
        plain
    }

    /// Adds such a row; `slip`: the components of a slip that is prevented.
    pub(crate) fn push_plain(&mut self, place: (usize, usize), row: Row, slip: Option<Along>) {
        self.places.push(place);
        self.slips.push(slip);
        self.rows.push_row(row);
        self.directions.push_row(row);
        self.weights.push(1.0);
        self.compliances.push(0.0);
        self.yields.push(0.0);
        self.open.push(0.0);
    }

    /// The rows of an evaluation, with second derivatives.
    pub(crate) fn of(equations: &Equations, evaluation: &Evaluation) -> Self {
        let model = equations.model;
        let mut constraints = Self::none(model.dimension);
        let (mut rows, mut gradient) = (Rows::new(model.dimension), DiscreteGradient::default());
        let mut derivatives = SlipDerivatives::new(model.dimension);
        let slips = PreventedSlips::of(equations, evaluation);
        let places = slips.independent(equations, evaluation);
        constraints.dropped = slips.dropped(evaluation, &places);
        for (k, p, number) in places {
            let place = (k, p);
            if number > 0 {
                let slip = slips.find((k, p, number));
                constraints.push_slip(equations, evaluation, slip, place, &mut derivatives);
                continue;
            }
            let contact = &model.contacts[k];
            let answer = &evaluation.answers[k][p];
            let mut curvature =
                derivative_of_direction(equations, evaluation, place, &mut rows, &mut gradient);
            let pair = &evaluation.at.pairings[k].pairs[p];
            curvature.iter_mut().for_each(|c| *c *= answer.lambda);
            let rubs = equations.laws[k].get(pair.node).is_some_and(|law| !law.is_none());
            if rubs && pair.tangential.friction_state != FrictionState::Stick {
                equations.slip_curvature_into(evaluation, place, &mut derivatives, &mut curvature);
                constraints.is_skew = true;
            }
            constraints.places.push(place);
            constraints.slips.push(None);
            constraints.rows.push_row(evaluation.rows[k].row(p));
            constraints.directions.push_row(evaluation.directions(k).row(p));
            constraints.weights.push(contact_weights(&equations.stage, contact.at_the_end).0);
            constraints.compliances.push(answer.compliance);
            constraints.yields.push(answer.yields);
            constraints.open.push(answer.open);
            constraints.curvatures.push(curvature);
        }
        constraints
    }

    /// Adds the row of a slip that is prevented: of a pair that sticks, or across the direction of
    /// a slip.
    fn push_slip(
        &mut self,
        equations: &Equations,
        evaluation: &Evaluation,
        (along, slip): (Along, Row),
        (k, p): (usize, usize),
        derivatives: &mut SlipDerivatives,
    ) {
        let contact = &equations.model.contacts[k];
        let pair = &evaluation.at.pairings[k].pairs[p];
        equations.slip_derivatives_into(evaluation, (k, p), derivatives);
        let traction = pair.tangential.traction;
        let spring = equations.spring_yields(k, pair, evaluation.slip_of((k, p)));
        let mut curvature = vec![0.0; slip.gradient.len().pow(2)];
        self.rows.push_row(slip);
        self.directions.push_row(slip);
        let gradient = self.rows.gradient_mut(self.rows.len() - 1);
        gradient.fill(0.0);
        for tangent in (0..2).filter(|&tangent| along[tangent] != 0.0) {
            let (turned, slope) = (&derivatives.turned[tangent], &derivatives.slopes[tangent]);
            gradient.iter_mut().zip(slope).for_each(|(sum, slope)| *sum += along[tangent] * slope);
            // The force of a slip is that of its gap.
            if pair.tangential.friction_state == FrictionState::Stick {
                let force = along[tangent] * traction[tangent];
                curvature.iter_mut().zip(turned).for_each(|(sum, h)| *sum += force * h);
            }
        }
        self.is_skew = true;
        self.places.push((k, p));
        self.slips.push(Some(along));
        self.weights.push(contact_weights(&equations.stage, contact.at_the_end).0);
        self.compliances.push(spring.unwrap_or(0.0));
        let forward = inner(pair.tangential.friction_state.direction(), evaluation.slip_of((k, p)));
        let stiffer = evaluation.at.stiffer;
        let turns = if forward > 0.0 { (forward / length(traction)).min(LOOSE) } else { 0.0 };
        let yields = equations.stick_yields(k, pair, stiffer).unwrap_or(turns);
        self.yields.push(if spring.is_some() { 0.0 } else { yields });
        let open = slip.gap - equations.stretch(k, pair, along, stiffer);
        self.open.push(if spring.is_some() { 0.0 } else { open });
        self.curvatures.push(curvature);
    }

    /// Largest gap that a constraint has to close. The slip of a stick that depends on other rows,
    /// as of a node on a symmetry axis, is theirs.
    pub(crate) fn gap(equations: &Equations, evaluation: &Evaluation) -> f64 {
        let of_pair = |(k, p): (usize, usize)| evaluation.answers[k][p].open.abs();
        let gaps = evaluation.pressing().map(of_pair).fold(0.0, f64::max);
        let slips = PreventedSlips::of(equations, evaluation);
        let open = |(k, p, number): (usize, usize, usize)| {
            let pair = &evaluation.at.pairings[k].pairs[p];
            let is_spring = number == 0 || equations.stick_spring(k, pair).is_some();
            if is_spring {
                return 0.0;
            }
            let weight = equations.weight_of_slip(pair, evaluation.slip_of((k, p)));
            let (along, slip) = slips.find((k, p, number));
            weight * (slip.gap - equations.stretch(k, pair, along, evaluation.at.stiffer)).abs()
        };
        slips.independent(equations, evaluation).into_iter().map(open).fold(gaps, f64::max)
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
    pub(crate) fn each_entry(&self, model: &Model, visit: impl FnMut(usize, usize, f64)) {
        self.each_of(&self.rows, model, visit);
    }

    /// Calls `visit(row, dof, slope)` for the entries of the directions, with their weights.
    pub(crate) fn each_direction(&self, model: &Model, visit: impl FnMut(usize, usize, f64)) {
        self.each_of(&self.directions, model, visit);
    }

    fn each_of(&self, rows: &Rows, model: &Model, mut visit: impl FnMut(usize, usize, f64)) {
        for (r, row) in rows.iter().enumerate() {
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

    /// The rows H of those that slip.
    pub(crate) fn slipping(&self) -> impl Iterator<Item = Row<'_>> {
        let slips = |pair: &Pair| pair.tangential.friction_state != FrictionState::Stick;
        let places = self.pressing().filter(move |&(k, p)| slips(&self.at.pairings[k].pairs[p]));
        places.filter(|&(k, _)| !self.slips[k].is_empty()).flat_map(|place| self.slip_rows(place))
    }
}
