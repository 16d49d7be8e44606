//! Velocities and accelerations of a state with closed pairs, under Coulomb's law:
//!
//! ```text
//! M x + Gᵀp + Hᵀq = f,   G x = c,   H x = b in stick,   q = −μp d in slip,   |q| ≤ −μp,   d·(H x − b) ≥ 0
//! ```
//!
//! d is the direction of H x − b, in the plane its sign. In space it follows from Newton's method
//! on its angle, with a row across d for each slip as in a step (`friction.rs`).
//!
//! For an impulse x is a change of velocity, and H x − b the slip rate after it. For accelerations
//! it is the rate of change of the slip rate, which decides for pairs that have none; others slip
//! in their direction, or in that of the step before. All rows are equalities, as without friction:
//! a closed gap stays closed, and one whose p is tensile remains closed: it slips with q = −μp d,
//! or sticks with any q. Such an impulse takes back a part of that of the step, as where the
//! midpoint rule has reversed the velocity, and friction is taken back with it: of a slip in the
//! same direction, or of a stick, whose slip rate the step has reversed, too. For accelerations
//! `persistency.rs` chooses pairs of which none pulls.

use std::collections::BTreeMap;
use std::ops::AddAssign;

use carom_algebra::Independent;
use carom_algebra::sums::max_abs;
use carom_contact::{
    Along, FrictionPair, FrictionState, Law, Row, Rows, StickSlip, Tangential, inner, length,
};

use crate::contact::constraints::Constraints;
use crate::contact::independent::{accept_stick, on_free_dofs, same_contact, slip_remainder};
use crate::contact::loose::{AT_REST, hold, may_be_held};
use crate::linear::system::System;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::state::State;

/// Most changes of stick and slip in one solve.
const CHANGES: usize = 200;
/// Rate or impulse, as a fraction of the largest one in a solve, that is round-off.
const ROUND_OFF: f64 = 1e-12;
/// Traction across a direction, relative to the largest one of a slip, that is round-off.
const TURN: f64 = 1e-13;

/// The closed pairs of a state whose gaps are constraints.
pub(crate) struct Closed {
    /// Contact and pair of each.
    pub places: Vec<(usize, usize)>,
    /// Rows of their gaps, a constraint each.
    pub normals: Constraints,
    /// H of each, a row per tangent, if it has friction.
    slips: Rows,
    /// The law of each that has friction.
    laws: Vec<Option<Law>>,
}

/// Right-hand sides of the problem; `slips` has an entry per pair, of no meaning without friction.
pub(crate) struct Right<'a> {
    pub forces: &'a [f64],
    pub gaps: &'a [f64],
    pub slips: &'a [Along],
}

/// Its solution.
#[derive(Default)]
pub(crate) struct Motion {
    pub x: Vec<f64>,
    /// p and q of each pair.
    pub normal: Vec<f64>,
    pub tangential: Vec<Along>,
    /// Traction across the direction of each slip, which is to vanish.
    turns: Vec<f64>,
}

/// Works of an impulse other than that of the contact.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Works {
    /// Work of friction.
    pub friction: f64,
    /// Work of moving supports and obstacles.
    pub external: f64,
}

impl AddAssign for Works {
    fn add_assign(&mut self, other: Self) {
        self.friction += other.friction;
        self.external += other.external;
    }
}

/// The state of a pair in a solve.
#[derive(Clone, Copy, PartialEq)]
struct Way {
    friction_state: FrictionState,
    /// Coefficient and traction of a slip, of which one is zero.
    slip: [f64; 2],
    /// Whether it may stick.
    is_free: bool,
    /// |H x − b|/|q| of a slip whose direction is an unknown.
    turns: Option<f64>,
}

impl Way {
    /// Turns the direction of a slip in space by what acts across it, and makes it an unknown of
    /// the next solve; returns whether that changes anything. `rate`: H x − b, `widest`: the
    /// largest traction.
    fn turn(&mut self, motion: &Motion, pair: usize, rate: Along, widest: f64) -> bool {
        let FrictionState::Slip(direction) = self.friction_state else { return false };
        let traction = inner(motion.tangential[pair], direction);
        if !self.is_free || traction <= 0.0 {
            return self.turns.take().is_some();
        }
        let turn = motion.turns[pair] / traction;
        let [along, other] = direction;
        self.friction_state = FrictionState::of([along - turn * other, other + turn * along], 0.0);
        let is_new = self.turns.is_none();
        self.turns = Some((inner(rate, direction) / traction).max(0.0));
        is_new || motion.turns[pair].abs() > TURN * widest
    }

    /// The components of the rows by which friction constrains a pair: along every tangent in
    /// stick, and across a slip whose direction is an unknown.
    fn prevented(&self, tangents: usize) -> impl Iterator<Item = Along> + use<> {
        match (self.friction_state, self.turns) {
            (FrictionState::Stick, _) => [[1.0, 0.0], [0.0, 1.0]].into_iter().take(tangents),
            (FrictionState::Slip([along, other]), turns) => {
                [[-other, along]; 2].into_iter().take(usize::from(turns.is_some()))
            }
        }
    }
}

impl Closed {
    /// These closed pairs, with the rows of their gaps.
    pub(crate) fn new(
        model: &Model,
        state: &State,
        places: Vec<(usize, usize)>,
        gaps: &[Rows],
    ) -> Result<Self, Rejected> {
        let rows = places.iter().map(|&(k, p)| ((k, p), gaps[k].row(p)));
        let normals = Constraints::plain(model.dimension, rows);
        let mut slips = Rows::new(model.dimension);
        let mut laws = Vec::new();
        let of_contacts = model.friction_laws(state.time, &state.pairs)?;
        for &(k, p) in &places {
            let contact = &model.contacts[k];
            let law = of_contacts[k].get(state.pairs[k][p].node).copied();
            laws.push(law.filter(|law| !law.is_none()));
            if contact.friction.is_none() {
                (1..model.dimension).for_each(|_| slips.push_open());
                continue;
            }
            let failed = |error| Rejected::Contact { contact: contact.name.clone(), error };
            let pair = &state.pairs[k][p];
            let first = slips.len();
            contact.kinematics.slip(pair, &state.y, &[], &mut slips).map_err(failed)?;
            if may_be_held(model, contact.node(pair)) {
                hold(model, gaps[k].row(p), &mut slips, first, &state.v, pair.tangential.traction);
            }
        }
        Ok(Self { places, normals, slips, laws })
    }

    /// Whether any has friction.
    pub(crate) fn rubs(&self) -> bool {
        self.laws.iter().any(Option::is_some)
    }

    /// H x of each pair; 0 without friction.
    pub(crate) fn slip_rates(&self, x: &[f64]) -> Vec<Along> {
        self.each_slip(|row, _| self.slips.row(row).along(x))
    }

    /// A value of each row H, by pairs; `of` is called with the row and its tangent.
    fn each_slip(&self, mut of: impl FnMut(usize, usize) -> f64) -> Vec<Along> {
        let tangents = self.slips.dimension() - 1;
        let pair = |i: usize| {
            let mut values = [0.0; 2];
            let rows = values.iter_mut().take(tangents).enumerate();
            rows.for_each(|(tangent, value)| *value = of(i * tangents + tangent, tangent));
            values
        };
        (0..self.places.len()).map(pair).collect()
    }

    /// v·∂H/∂y·v of each pair.
    pub(crate) fn slip_curvatures(&self, model: &Model, state: &State) -> Vec<Along> {
        let mut matrix = Vec::new();
        self.each_slip(|row, tangent| {
            let (k, p) = self.places[row / (model.dimension - 1)];
            let contact = &model.contacts[k];
            if contact.friction.is_none() {
                return 0.0;
            }
            let mut pair = state.pairs[k][p];
            pair.tangential.tangents = self.slips.tangents(row - tangent);
            let row = self.slips.row(row);
            let along: Vec<f64> = row.entries().map(|(dof, _)| state.v[dof]).collect();
            matrix.clear();
            matrix.resize(along.len().pow(2), 0.0);
            contact.kinematics.slip_derivative_into(&pair, &state.y, &[], tangent, &mut matrix);
            let rows = along.iter().zip(matrix.chunks_exact(along.len()));
            rows.map(|(v, row)| v * row.iter().zip(&along).map(|(c, w)| c * w).sum::<f64>()).sum()
        })
    }

    /// Impulse of a motion on the secondary side of each pair, with its contact.
    pub(crate) fn impulses<'a>(&'a self, motion: &'a Motion) -> impl Iterator<Item = (usize, [f64; 3])> + 'a {
        self.places.iter().enumerate().map(|(i, &(k, _))| {
            let mut impulse = self.normals.rows.row(i).normal().map(|n| -motion.normal[i] * n);
            for (row, q) in self.slip_rows(i).zip(motion.tangential[i]).filter(|(_, q)| *q != 0.0) {
                let along = row.normal();
                (0..3).for_each(|j| impulse[j] -= q * along[j]);
            }
            (k, impulse)
        })
    }

    /// Adds Gᵀp + Hᵀq of a motion.
    pub(crate) fn add_impulses(&self, motion: &Motion, sum: &mut [f64]) {
        for (i, (row, p)) in self.normals.rows.iter().zip(&motion.normal).enumerate() {
            row.add_to(*p, sum);
            self.slip_rows(i).zip(motion.tangential[i]).for_each(|(row, q)| row.add_to(q, sum));
        }
    }

    /// Adds an impulse to the velocities of a state, and to what its contacts record.
    pub(crate) fn strike(&self, model: &Model, state: &mut State, motion: &Motion) {
        for i in (0..model.dofs()).filter(|&i| !model.massless[i]) {
            state.v[i] += motion.x[i];
        }
        for (k, impulse) in self.impulses(motion) {
            (0..3).for_each(|i| state.impulses[k][i] += impulse[i]);
        }
    }

    /// Work of the reactions J = M Δv + Gᵀp + Hᵀq of moving supports, whose velocities stay.
    pub(crate) fn work_of_supports(&self, model: &Model, state: &State, motion: &Motion) -> f64 {
        if model.motions.is_empty() {
            return 0.0;
        }
        let mut reaction = vec![0.0; model.dofs()];
        model.mass.multiply_into(&motion.x, &mut reaction);
        self.add_impulses(motion, &mut reaction);
        model.motions.dofs().map(|dof| reaction[dof] * state.v[dof]).sum()
    }

    /// H of a pair, a row per tangent.
    fn slip_rows(&self, pair: usize) -> impl Iterator<Item = Row<'_>> {
        let tangents = self.slips.dimension() - 1;
        (pair * tangents..(pair + 1) * tangents).map(|row| self.slips.row(row))
    }

    /// The change of velocity for an impulse: stick and slip follow from the slip rates after it. A
    /// limited traction has no impulse.
    pub(crate) fn impulse(
        &self,
        model: &Model,
        state: &mut State,
        right: &Right,
        system: &mut System,
    ) -> Result<Motion, Rejected> {
        let ways = self.ways(state);
        let unlimited = |law: &Law| Law { limit: f64::INFINITY, ..*law };
        let coulomb = |law: &Law| if law.limit.is_finite() { Law::coulomb(0.0) } else { unlimited(law) };
        let laws: Vec<_> = self.laws.iter().map(|law| law.as_ref().map(coulomb)).collect();
        self.solve(model, state, right, system, (ways, &laws))
    }

    /// The change of velocity with which pairs that stick lose these slip rates, whatever impulse
    /// that takes, while gaps go on as before.
    pub(crate) fn stop(
        &self,
        model: &Model,
        state: &State,
        rates: &[Along],
        system: &mut System,
    ) -> Result<Motion, Rejected> {
        let slips: Vec<Along> = rates.iter().map(|rate| rate.map(|rate| -rate)).collect();
        let right =
            Right { forces: &vec![0.0; model.dofs()], gaps: &vec![0.0; self.places.len()], slips: &slips };
        self.solve_for(model, &right, system, &self.ways(state))
    }

    /// Which pairs stuck in the step, and in which direction those slipped that were closed
    /// `before`.
    pub(crate) fn slid(&self, state: &State, before: &State) -> BTreeMap<(usize, usize), FrictionState> {
        let of = |&(k, p): &(usize, usize)| {
            let pair = &state.pairs[k][p];
            let friction_state = pair.tangential.friction_state;
            let goes_on = friction_state == FrictionState::Stick || before.past(k, pair).is_some();
            goes_on.then_some(((k, p), friction_state))
        };
        self.places.iter().filter_map(of).collect()
    }

    /// The accelerations: pairs with a slip rate slip in the direction in which they `slid`, or in
    /// that of the rate; those that `slid` says stuck slip where their traction would leave the
    /// cone.
    pub(crate) fn accelerate(
        &self,
        model: &Model,
        state: &mut State,
        right: &Right,
        slid: &[Option<FrictionState>],
        system: &mut System,
    ) -> Result<Motion, Rejected> {
        let mut ways = self.ways(state);
        let rates = self.slip_rates(&state.v);
        let still = AT_REST * max_abs(&state.v);
        for (i, way) in ways.iter_mut().enumerate() {
            let friction_state = FrictionState::of(rates[i], still);
            let known = slid.get(i).copied().flatten();
            if friction_state != FrictionState::Stick && known != Some(FrictionState::Stick) {
                (way.friction_state, way.is_free) = (known.unwrap_or(friction_state), false);
            }
        }
        self.solve(model, state, right, system, (ways, &self.laws))
    }

    /// The ways of the pairs of a state.
    fn ways(&self, state: &State) -> Vec<Way> {
        let friction_state = |&(k, p): &(usize, usize)| state.pairs[k][p].tangential.friction_state;
        let way =
            |place| Way { friction_state: friction_state(place), slip: [0.0; 2], is_free: true, turns: None };
        self.places.iter().map(way).collect()
    }

    /// Solves, and sets stick and slip of the pairs.
    fn solve(
        &self,
        model: &Model,
        state: &mut State,
        right: &Right,
        system: &mut System,
        (mut ways, laws): (Vec<Way>, &[Option<Law>]),
    ) -> Result<Motion, Rejected> {
        let before = self.slip_rates(&state.v);
        let slip = |i: usize, law: &Law, pressure: f64| {
            let rate = length(before[i]);
            let radius = law.slip(pressure, rate);
            let is_limited = law.limit.is_finite() && radius.by_pressure == 0.0;
            if is_limited { [0.0, radius.value] } else { [law.coefficient(rate).value, 0.0] }
        };
        for (i, law) in laws.iter().enumerate() {
            let pressure = -state.pairs[self.places[i].0][self.places[i].1].lambda;
            ways[i].slip = law.as_ref().map_or([0.0; 2], |law| slip(i, law, pressure));
        }
        let mut set = StickSlip::new(0.0, true);
        for _ in 0..CHANGES {
            let motion = self.solve_for(model, right, system, &ways)?;
            let rates = self.slip_rates(&motion.x);
            let all = rates.iter().chain(right.slips).flatten().chain(right.gaps);
            // Rates are differences of motions: where all sides stick they are round-off of these.
            let none = ROUND_OFF * all.fold(max_abs(&motion.x), |most, rate| most.max(rate.abs()));
            let impulses = motion.tangential.iter().map(|q| length(*q));
            let no_impulse = ROUND_OFF * impulses.fold(max_abs(&motion.normal), f64::max);
            let mut changed = false;
            for (i, law) in laws.iter().enumerate() {
                let new = law.as_ref().map_or([0.0; 2], |law| slip(i, law, -motion.normal[i]));
                changed |= std::mem::replace(&mut ways[i].slip, new) != new;
            }
            let rub = |i: usize| {
                let way = ways[i];
                let law = laws[i]?;
                let traction = length(motion.tangential[i]);
                // A tensile impulse takes back what the step did in excess, and so does friction
                // of a pair that stuck in it. A limited traction has no impulse to take back.
                let sticks = way.friction_state == FrictionState::Stick;
                let takes_back = motion.normal[i] > no_impulse && sticks && !law.is_none();
                let cone = if takes_back { traction } else { law.grip(motion.normal[i].abs()) };
                // What is no slip to round-off has no direction.
                let rate = [0, 1].map(|a| rates[i][a] - right.slips[i][a]);
                let slip =
                    if way.is_free && length(rate) > none { rate } else { way.friction_state.direction() };
                Some(FrictionPair {
                    friction_state: way.friction_state,
                    traction: motion.tangential[i],
                    slip,
                    cone,
                })
            };
            let rubs: Vec<Option<FrictionPair>> = (0..ways.len()).map(rub).collect();
            let changes = set.changes(&rubs, true).map_err(|_| Rejected::NoFrictionBalance)?;
            let widest = motion.tangential.iter().map(|q| length(*q)).fold(0.0, f64::max);
            for (i, way) in ways.iter_mut().enumerate().filter(|_| model.dimension == 3) {
                let rate = [0, 1].map(|a| rates[i][a] - right.slips[i][a]);
                changed |= way.turn(&motion, i, rate, widest);
            }
            for change in &changes {
                ways[change.pair].friction_state = change.friction_state;
                ways[change.pair].turns = None;
            }
            if changes.is_empty() && !changed {
                for ((&(k, p), way), traction) in self.places.iter().zip(&ways).zip(&motion.tangential) {
                    let tangential = &mut state.pairs[k][p].tangential;
                    *tangential =
                        Tangential { friction_state: way.friction_state, traction: *traction, ..*tangential };
                }
                return Ok(motion);
            }
        }
        Err(Rejected::NoFrictionBalance)
    }

    /// One linear solve with given states.
    fn solve_for(
        &self,
        model: &Model,
        right: &Right,
        system: &mut System,
        ways: &[Way],
    ) -> Result<Motion, Rejected> {
        let mut rows = self.normals.clone();
        let mut targets = right.gaps.to_vec();
        let mut forces = right.forces.to_vec();
        let rubs: Vec<usize> = (0..ways.len()).filter(|&i| self.laws[i].is_some()).collect();
        rows.is_skew = !rubs.is_empty();
        let d = model.dimension;
        for &i in &rubs {
            let direction = ways[i].friction_state.direction();
            for (row, d) in self.slip_rows(i).zip(direction) {
                let [factor, traction] = ways[i].slip.map(|part| d * part);
                row.add_to(-traction, &mut forces);
                let along = rows.directions.gradient_mut(i).iter_mut().zip(row.gradient);
                along.for_each(|(along, h)| *along -= factor * h);
            }
        }
        let mut set = Independent::default();
        for row in self.normals.rows.iter() {
            set.accept(on_free_dofs(model, row), same_contact(model, row));
        }
        let mut slips = Rows::new(d);
        let mut holding = Vec::new();
        for &i in &rubs {
            let first = slips.len();
            let mut prevented: Vec<Along> = ways[i].prevented(d - 1).collect();
            for along in &prevented {
                slips.push_combined(&self.slips, i * (d - 1), &along[..d - 1]);
            }
            if prevented.is_empty() {
                continue;
            }
            let same = (first..slips.len()).map(|row| same_contact(model, slips.row(row)));
            let least = same.fold(slip_remainder(model), f64::max);
            let added = accept_stick(model, &mut set, &mut slips, first, least, &mut prevented);
            for (row, along) in (first..).zip(prevented).take(added) {
                rows.push_plain(self.places[i], slips.row(row), Some(along));
                targets.push(inner(along, right.slips[i]));
                holding.push((i, along));
                if let Some(compliance) = ways[i].turns {
                    rows.list.iter_mut().last().into_iter().for_each(|row| row.yields = compliance);
                }
            }
        }
        system.mass_with(model, &rows)?;
        let mut x = vec![0.0; model.dofs()];
        let mut multipliers = Vec::new();
        system.solve(model, [&forces, &targets], &mut x, &mut multipliers)?;
        let forces_held = multipliers.split_off(ways.len());
        let mut motion = Motion {
            x,
            normal: multipliers,
            tangential: vec![[0.0; 2]; ways.len()],
            turns: vec![0.0; ways.len()],
        };
        for &i in &rubs {
            let [coefficient, traction] = ways[i].slip;
            let size = traction - coefficient * motion.normal[i];
            motion.tangential[i] = ways[i].friction_state.direction().map(|d| d * size);
        }
        for ((i, along), q) in holding.into_iter().zip(forces_held) {
            if ways[i].turns.is_some() {
                motion.turns[i] = q;
            } else {
                (0..2).for_each(|a| motion.tangential[i][a] += q * along[a]);
            }
        }
        Ok(motion)
    }
}
