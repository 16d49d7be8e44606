//! The rows that active contacts add to the linear system, and their data.
//!
//! Not every active pair is a row: a redundant one would make the system singular, which its
//! residual would not reveal. A row is kept if its gradient on free dofs is linearly independent of
//! those of the rows before. A node on a symmetry axis keeps its support and its contact; a corner
//! node in two contacts with one facet keeps one of them, for any contacts and nodes (Gaussian
//! elimination of the sparse rows). The row of a single node beside a field of pressure is also
//! left out where it nearly depends on others.

use carom_contact::{
    Along, Answer, Direction, DiscreteGradient, FrictionState, Pair, Pairing, Row, Rows, inner, length,
};

use crate::contact::independent::{DEPENDENT, SAME};
use crate::contact::prevented_slips::PreventedSlips;
use crate::contact::slip_derivatives::SlipDerivatives;
use crate::model::{Contact, Model};
use crate::stage::balance::contact_weights;
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;

/// Largest gap per unit of a multiplier: of a slip whose traction is round-off.
const LOOSE: f64 = 1e100;

/// A row of a linear system, apart from its gradient and the direction of its force.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// Contact and pair.
    pub place: (usize, usize),
    /// The components of a slip that is prevented; others are gaps.
    pub slip: Option<Along>,
    /// Weight of the contact force in the balance.
    pub weight: f64,
    /// Gap per unit of multiplier.
    pub compliance: f64,
    /// Gap per unit of a multiplier that is an unknown: of the direction of a slip, and of an
    /// augmented Lagrangian.
    pub yields: f64,
    /// Gap still to be closed.
    pub open: f64,
    /// λ times the derivative of the direction over the nodes of the row, row-major: λ∇²g, or not
    /// symmetric for a discrete gradient. Empty if not requested.
    pub curvature: Vec<f64>,
}

impl Constraint {
    /// One of weight 1, without second derivatives.
    fn plain(place: (usize, usize), slip: Option<Along>) -> Self {
        Self { place, slip, weight: 1.0, compliance: 0.0, yields: 0.0, open: 0.0, curvature: Vec::new() }
    }

    /// Entry (i, j) of what a row with this gradient adds to the tangent of positions: w/C ∇g ∇gᵀ
    /// of a spring, and, if `curved`, w·λ∇²g, symmetrised.
    pub(crate) fn stiffness(&self, gradient: &[f64], [i, j]: [usize; 2], spring: f64, curved: bool) -> f64 {
        let n = gradient.len();
        let spring = if spring == 0.0 { 0.0 } else { gradient[i] * gradient[j] / spring };
        let bent = if curved && !self.curvature.is_empty() {
            0.5 * (self.curvature[i * n + j] + self.curvature[j * n + i])
        } else {
            0.0
        };
        self.weight * (spring + bent)
    }
}

/// Rows of a linear system.
#[derive(Clone, Debug)]
pub struct Constraints {
    /// What the rows are, in their order.
    pub list: Vec<Constraint>,
    /// Gradients of the gaps.
    pub rows: Rows,
    /// Directions of the forces.
    pub directions: Rows,
    /// Whether friction turns some of these, which the factor then takes into account.
    pub is_skew: bool,
    /// Contact, pair and components of slips of sticks that depend on these rows, and have no
    /// traction.
    pub dropped: Vec<((usize, usize), Along)>,
    /// Contact and pair of closed gaps that depend on these rows, and have no multiplier.
    pub dependent: Vec<(usize, usize)>,
    /// Contact and pair of closed gaps of single nodes beside a field of pressure, which presses in
    /// their place: they depend on these rows but for a hundredth, and have no multiplier.
    pub covered: Vec<(usize, usize)>,
}

impl Constraints {
    /// No rows.
    pub fn none(dimension: usize) -> Self {
        let [rows, directions] = [Rows::new(dimension), Rows::new(dimension)];
        Self {
            list: Vec::new(),
            rows,
            directions,
            is_skew: false,
            dropped: Vec::new(),
            dependent: Vec::new(),
            covered: Vec::new(),
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
        self.list.push(Constraint::plain(place, slip));
        self.rows.push_row(row);
        self.directions.push_row(row);
    }

    /// Adds a row without the nodes on which it does not act and its force does not depend: those
    /// of mortar contact extend over all nodes that they may reach in a step.
    fn push(&mut self, mut constraint: Constraint, row: Row, direction: Row) {
        let d = row.dimension();
        let rests = |place: &usize| row.is_zero_at(*place) && direction.is_zero_at(*place);
        let resting: Vec<usize> = (0..row.nodes.len()).filter(rests).collect();
        if resting.is_empty() || row.nodes != direction.nodes {
            self.rows.push_row(row);
            self.directions.push_row(direction);
        } else {
            let places = needed(&resting, row.nodes.len(), &constraint.curvature);
            self.rows.push_part(row, &places);
            self.directions.push_part(direction, &places);
            constraint.curvature = part_of(&constraint.curvature, row.gradient.len(), d, &places);
        }
        self.list.push(constraint);
    }

    /// The rows of an evaluation, with second derivatives.
    pub fn of(equations: &Equations, evaluation: &Evaluation) -> Self {
        let model = equations.model;
        let mut constraints = Self::none(model.dimension);
        let mut rows = Rows::new(model.dimension);
        let mut gradient = DiscreteGradient::default();
        let mut derivatives = SlipDerivatives::new(model.dimension);
        let slips = PreventedSlips::of(equations, evaluation);
        let places = slips.independent();
        constraints.dropped = slips.dropped(evaluation);
        let depends = |&(k, p): &(usize, usize)| {
            let contact = &model.contacts[k];
            let is_row = contact.interface.is_constraint() && contact.augmentation.is_none();
            is_row && places.binary_search(&(k, p, 0)).is_err()
        };
        let covered = |place: &(usize, usize)| is_covered(equations, evaluation, *place);
        (constraints.covered, constraints.dependent) =
            evaluation.pressing().filter(depends).partition(covered);
        for &(k, p, number) in places {
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
            let weight = contact_weights(&equations.stage, contact.at_the_end).0;
            let Answer { compliance, yields, open, .. } = *answer;
            let constraint = Constraint { place, slip: None, weight, compliance, yields, open, curvature };
            let direction = evaluation.directions(k).row(p);
            constraints.push(constraint, evaluation.rows[k].row(p), direction);
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
        let mut curvature = vec![0.0; slip.gradient.len().pow(2)];
        let mut turned_row = Rows::new(slip.dimension());
        turned_row.push_row(slip);
        let gradient = turned_row.gradient_mut(0);
        gradient.fill(0.0);
        let held = inner(along, traction);
        for tangent in (0..2).filter(|&tangent| along[tangent] != 0.0) {
            let turned = &derivatives.turned[tangent];
            let slope = &derivatives.slopes[tangent];
            gradient.iter_mut().zip(slope).for_each(|(sum, slope)| *sum += along[tangent] * slope);
            // The force of a slip is that of its gap.
            if pair.tangential.friction_state == FrictionState::Stick {
                let force = along[tangent] * held;
                curvature.iter_mut().zip(turned).for_each(|(sum, h)| *sum += force * h);
            }
        }
        self.is_skew = true;
        let moved = evaluation.slip_of((k, p));
        let forward = inner(pair.tangential.friction_state.direction(), moved);
        let turns = if forward > 0.0 { (forward / length(traction)).min(LOOSE) } else { 0.0 };
        let stiffer = evaluation.at.stiffer;
        let [yields, open] = if equations.stick_spring(k, pair).is_some() {
            [0.0; 2]
        } else {
            let yields = equations.stick_yields(k, pair, stiffer).unwrap_or(turns);
            [yields, slip.gap - equations.stretch(k, pair, along, stiffer)]
        };
        let constraint = Constraint {
            place: (k, p),
            slip: Some(along),
            weight: contact_weights(&equations.stage, contact.at_the_end).0,
            compliance: equations.spring_yields(k, pair, moved).unwrap_or(0.0),
            yields,
            open,
            curvature,
        };
        self.push(constraint, turned_row.row(0), slip);
    }

    /// Largest gap that a constraint has to close. The slip of a stick that depends on other rows,
    /// as of a node on a symmetry axis, is theirs.
    pub(crate) fn gap(equations: &Equations, evaluation: &Evaluation) -> f64 {
        let slips = PreventedSlips::of(equations, evaluation);
        let places = slips.independent();
        let counts = |&(k, p): &(usize, usize)| {
            places.binary_search(&(k, p, 0)).is_ok() || !follows(equations, evaluation, (k, p))
        };
        let of_pair = |(k, p): (usize, usize)| evaluation.answers[k][p].open.abs();
        let gaps = evaluation.pressing().filter(counts).map(of_pair).fold(0.0, f64::max);
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
        places.iter().copied().map(open).fold(gaps, f64::max)
    }

    /// Adds a share of a correction to the multipliers of the pairs.
    pub(crate) fn add_to(&self, pairings: &mut [Pairing], share: f64, multipliers: &[f64]) {
        for (row, change) in self.list.iter().zip(multipliers) {
            let pair = &mut pairings[row.place.0].pairs[row.place.1];
            match row.slip {
                None => pair.lambda += share * change,
                Some(along) => pair.tangential.pull(along, share * change),
            }
        }
        for &(k, p) in &self.covered {
            pairings[k].pairs[p].lambda = 0.0;
        }
        for &((k, p), along) in &self.dropped {
            // Other rows constrain it.
            let tangential = &mut pairings[k].pairs[p].tangential;
            tangential.pull(along, -inner(along, tangential.traction));
        }
    }

    /// Subtracts the forces that a correction of positions and multipliers causes.
    pub(crate) fn subtract_forces(&self, [increment, multipliers]: [&[f64]; 2], forces: &mut [f64]) {
        let mut moved = Vec::new();
        for (r, (constraint, row)) in self.list.iter().zip(self.rows.iter()).enumerate() {
            let multiplier = match constraint.compliance {
                0.0 => multipliers[r],
                compliance => row.along(increment) / compliance,
            };
            self.directions.row(r).add_to(-constraint.weight * multiplier, forces);
            if constraint.curvature.is_empty() {
                continue;
            }
            moved.clear();
            moved.extend(row.entries().map(|(dof, _)| increment[dof]));
            let curvature = constraint.curvature.chunks_exact(row.gradient.len());
            for ((dof, _), curved) in row.entries().zip(curvature) {
                let bent: f64 = curved.iter().zip(&moved).map(|(c, moved)| c * moved).sum();
                forces[dof] -= constraint.weight * bent;
            }
        }
    }

    /// Subtracts what such a correction closes of the gaps of constraints.
    pub(crate) fn subtract_gaps(&self, [increment, multipliers]: [&[f64]; 2], gaps: &mut [f64]) {
        let rows = self.list.iter().zip(self.rows.iter()).enumerate();
        for (r, (constraint, row)) in rows.filter(|(_, (constraint, _))| constraint.compliance == 0.0) {
            gaps[r] -= constraint.weight * row.along(increment);
            if constraint.yields != 0.0 {
                gaps[r] += constraint.weight * constraint.yields * multipliers[r];
            }
        }
    }

    /// The nodes on which each row acts, or on which its force depends.
    pub(crate) fn acting(&self) -> impl Iterator<Item = usize> {
        let rows = self.list.iter().zip(self.rows.iter().zip(self.directions.iter()));
        rows.flat_map(|(constraint, (row, direction))| {
            // `push` has left out the other nodes of rows with second derivatives.
            let all = !constraint.curvature.is_empty() || row.nodes != direction.nodes;
            let acts = move |place: &usize| all || !row.is_zero_at(*place) || !direction.is_zero_at(*place);
            (0..row.nodes.len()).filter(acts).map(move |place| row.nodes[place])
        })
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The nodes on which the rows act, ascending.
    pub(crate) fn nodes(&self) -> Vec<usize> {
        let mut nodes: Vec<usize> = self.acting().collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

/// The places of all nodes of a row but those among `resting`, on which it does not act, on which
/// its force does not depend either.
fn needed(resting: &[usize], nodes: usize, curvature: &[f64]) -> Vec<usize> {
    let size = curvature.len().isqrt();
    let d = size / nodes;
    let bends = |place: usize| {
        let components = place * d..(place + 1) * d;
        let of_rows = components.start * size..components.end * size;
        let of_columns = || curvature.chunks_exact(size).flat_map(|row| &row[components.clone()]);
        curvature[of_rows].iter().any(|c| *c != 0.0) || of_columns().any(|c| *c != 0.0)
    };
    let rests = |place: &usize| resting.binary_search(place).is_ok() && (size == 0 || !bends(*place));
    (0..nodes).filter(|place| !rests(place)).collect()
}

/// The entries of a matrix over the `size` components of a row, or of none, that belong to the
/// nodes at some places.
fn part_of(matrix: &[f64], size: usize, d: usize, places: &[usize]) -> Vec<f64> {
    if matrix.is_empty() {
        return Vec::new();
    }
    let components: Vec<usize> = places.iter().flat_map(|place| place * d..(place + 1) * d).collect();
    let mut part = Vec::with_capacity(components.len().pow(2));
    for row in &components {
        let entries = &matrix[row * size..(row + 1) * size];
        part.extend(components.iter().map(|&column| entries[column]));
    }
    part
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
    let row = evaluation.rows[k].row(p);
    let pair = &evaluation.at.pairings[k].pairs[p];
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
                let measured = rows.row(0);
                if measured.nodes.is_empty() {
                    contact.kinematics.curvature_into(pair, y, &mut matrix);
                    return matrix;
                }
                let change = if start.is_finite() { row.gap - start } else { measured.along(&at.increment) };
                gradient.evaluate(measured, change, place, &at.increment);
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

/// Whether the field of pressure beside a single node presses for it, whose row depends on others.
fn is_covered(equations: &Equations, evaluation: &Evaluation, (k, p): (usize, usize)) -> bool {
    let model = equations.model;
    let bounds = model.contacts[k].bounds(&evaluation.at.pairings[k].pairs[p]);
    bounds && acts(model, evaluation.rows[k].row(p)) && follows(equations, evaluation, (k, p))
}

/// Whether supports leave a row something to move.
fn acts(model: &Model, row: Row) -> bool {
    row.entries().any(|(dof, slope)| slope != 0.0 && !model.fixed[dof])
}

/// Whether a gap whose row depends on others is closed by theirs, but for the share that the row
/// may differ from them.
pub(crate) fn follows(equations: &Equations, evaluation: &Evaluation, (k, p): (usize, usize)) -> bool {
    let model = equations.model;
    let contact = &model.contacts[k];
    let row = evaluation.rows[k].row(p);
    let size = size_at(contact, row.nodes, &evaluation.y, model.dimension);
    let bounds = contact.bounds(&evaluation.at.pairings[k].pairs[p]);
    let share = if bounds && acts(model, row) { SAME } else { DEPENDENT };
    evaluation.answers[k][p].open.abs() <= model.gap_tolerance + share * size
}

/// Size of the facet of a row; of a node alone, beside a rigid obstacle, that of the facets of its
/// own side.
fn size_at(contact: &Contact, nodes: &[usize], y: &[f64], d: usize) -> f64 {
    let [node] = nodes else { return extent(nodes, y, d) };
    let facets = contact.facets.iter().flat_map(|(_, facets)| facets);
    let beside = facets.filter(|facet| facet.contains(node));
    beside.map(|facet| extent(facet, y, d)).fold(0.0, f64::max)
}

/// Largest distance between nodes.
fn extent(nodes: &[usize], y: &[f64], d: usize) -> f64 {
    let square = |a: usize, b: usize| (0..d).map(|i| (y[a * d + i] - y[b * d + i]).powi(2)).sum::<f64>();
    let from =
        |(place, &a): (usize, &usize)| nodes[..place].iter().map(|&b| square(a, b)).fold(0.0, f64::max);
    nodes.iter().enumerate().map(from).fold(0.0, f64::max).sqrt()
}
