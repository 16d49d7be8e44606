//! Velocities and accelerations of a state with closed pairs, under Coulomb's law:
//!
//! ```text
//! M x + Gᵀp + Hᵀq = f,   G x = c,   H x = b in stick,   q = −sμp in slip,   |q| ≤ −μp,   s (H x − b) ≥ 0
//! ```
//!
//! For an impulse x is a change of velocity, and H x − b the slip rate after it. For accelerations
//! it is the rate of change of the slip rate, which decides for pairs that have none; others slip
//! in their direction. All rows are equalities, as without friction: a closed gap stays closed
//! (`persistency.rs`), and one whose p pulls goes on to stick, or to slip with q = −sμp. So the
//! solution depends continuously on μ, and tangential impulses that slip are μ times the normal
//! ones.

use carom_contact::{Hold, Law, Rows, Rub, StickSlip, Tangential};

use crate::constraints::{Constraints, independent};
use crate::model::Model;
use crate::rejected::Rejected;
use crate::state::State;
use crate::sums::max_abs;
use crate::system::System;

/// Most changes of stick and slip in one solve.
const CHANGES: usize = 200;
/// Slip rate, as a fraction of the largest velocity, that is none.
pub(crate) const AT_REST: f64 = 1e-10;
/// Rate, as a fraction of the largest one in a solve, that is round-off.
const ROUND_OFF: f64 = 1e-12;

/// The closed pairs of a state whose gaps are constraints.
pub(crate) struct Closed {
    /// Contact and pair of each.
    pub places: Vec<(usize, usize)>,
    /// Rows of their gaps, a constraint each.
    pub normals: Constraints,
    /// H of each that has friction.
    slips: Rows,
    /// The law of each that has friction.
    laws: Vec<Option<Law>>,
}

/// Right-hand sides of the problem; `slips` has an entry per pair, of no meaning without friction.
pub(crate) struct Right<'a> {
    pub forces: &'a [f64],
    pub gaps: &'a [f64],
    pub slips: &'a [f64],
}

/// Its solution.
#[derive(Default)]
pub(crate) struct Motion {
    pub x: Vec<f64>,
    /// p and q of each pair.
    pub normal: Vec<f64>,
    pub tangential: Vec<f64>,
}

/// The state of a pair in a solve.
#[derive(Clone, Copy, PartialEq)]
struct Way {
    hold: Hold,
    /// Coefficient and traction of a slip, of which one is zero.
    slip: [f64; 2],
    /// Whether it may stick.
    is_free: bool,
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
        let (mut slips, mut laws) = (Rows::new(model.dimension), Vec::new());
        let of_contacts = model.friction_laws(state.time)?;
        for &(k, p) in &places {
            let contact = &model.contacts[k];
            laws.push(of_contacts[k].get(state.pairs[k][p].node).copied());
            if contact.friction.is_none() {
                slips.push_open();
                continue;
            }
            let failed = |error| Rejected::Contact { contact: contact.name.clone(), error };
            contact.kinematics.slip(&state.pairs[k][p], &state.y, &mut slips).map_err(failed)?;
        }
        Ok(Self { places, normals, slips, laws })
    }

    /// Whether any has friction.
    pub(crate) fn rubs(&self) -> bool {
        self.laws.iter().any(Option::is_some)
    }

    /// H x of each pair; 0 without friction.
    pub(crate) fn slip_rates(&self, x: &[f64]) -> Vec<f64> {
        self.slips.iter().map(|row| row.along(x)).collect()
    }

    /// v·∂H/∂y·v of each pair.
    pub(crate) fn slip_curvatures(&self, model: &Model, state: &State) -> Vec<f64> {
        let mut matrix = Vec::new();
        let curvature = |(i, &(k, p)): (usize, &(usize, usize))| {
            let contact = &model.contacts[k];
            if contact.friction.is_none() {
                return 0.0;
            }
            let along: Vec<f64> = self.slips.row(i).entries().map(|(dof, _)| state.v[dof]).collect();
            matrix.clear();
            matrix.resize(along.len().pow(2), 0.0);
            contact.kinematics.slip_derivative_into(&state.pairs[k][p], &state.y, &mut matrix);
            let rows = along.iter().zip(matrix.chunks_exact(along.len()));
            rows.map(|(v, row)| v * row.iter().zip(&along).map(|(c, w)| c * w).sum::<f64>()).sum()
        };
        self.places.iter().enumerate().map(curvature).collect()
    }

    /// Impulse of a motion on the secondary side of each pair, with its contact.
    pub(crate) fn impulses<'a>(&'a self, motion: &'a Motion) -> impl Iterator<Item = (usize, [f64; 3])> + 'a {
        self.places.iter().enumerate().map(|(i, &(k, _))| {
            let mut impulse = self.normals.rows.row(i).normal().map(|n| -motion.normal[i] * n);
            if motion.tangential[i] != 0.0 {
                let along = self.slips.row(i).normal();
                (0..3).for_each(|j| impulse[j] -= motion.tangential[i] * along[j]);
            }
            (k, impulse)
        })
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

    /// The accelerations: pairs with a slip rate slip in its direction.
    pub(crate) fn accelerate(
        &self,
        model: &Model,
        state: &mut State,
        right: &Right,
        system: &mut System,
    ) -> Result<Motion, Rejected> {
        let mut ways = self.ways(state);
        let (rates, still) = (self.slip_rates(&state.v), AT_REST * max_abs(&state.v));
        for (i, way) in ways.iter_mut().enumerate() {
            if Hold::of(rates[i], still) != Hold::Stick {
                (way.hold, way.is_free) = (Hold::of(rates[i], still), false);
            }
        }
        self.solve(model, state, right, system, (ways, &self.laws))
    }

    /// The ways of the pairs of a state.
    fn ways(&self, state: &State) -> Vec<Way> {
        let hold = |&(k, p): &(usize, usize)| state.pairs[k][p].tangential.hold;
        let way = |place| Way { hold: hold(place), slip: [0.0; 2], is_free: true };
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
            let rate = before[i].abs();
            let radius = law.slip(pressure, rate);
            let is_limited = law.limit.is_finite() && radius.by_pressure == 0.0;
            if is_limited { [0.0, radius.value] } else { [law.coefficient(rate).0, 0.0] }
        };
        for (i, law) in laws.iter().enumerate() {
            let pressure = -state.pairs[self.places[i].0][self.places[i].1].lambda;
            ways[i].slip = law.as_ref().map_or([0.0; 2], |law| slip(i, law, pressure));
        }
        let mut set = StickSlip::new(0.0, true);
        for _ in 0..CHANGES {
            let motion = self.solve_for(model, right, system, &ways)?;
            let rates = self.slip_rates(&motion.x);
            let all = rates.iter().chain(right.slips).chain(right.gaps);
            let none = ROUND_OFF * all.fold(0.0_f64, |most, rate| most.max(rate.abs()));
            let mut changed = false;
            for (i, law) in laws.iter().enumerate() {
                let new = law.as_ref().map_or([0.0; 2], |law| slip(i, law, -motion.normal[i]));
                changed |= std::mem::replace(&mut ways[i].slip, new) != new;
            }
            let rub = |i: usize| {
                let (way, law, p) = (ways[i], laws[i]?, motion.normal[i]);
                if p >= 0.0 && way.hold == Hold::Stick {
                    return None;
                }
                let cone = law.grip(-p);
                // What is no slip to round-off has no direction.
                let rate = rates[i] - right.slips[i];
                let slip = if way.is_free && rate.abs() > none { rate } else { way.hold.sign() };
                Some(Rub { hold: way.hold, traction: motion.tangential[i], slip, cone })
            };
            let rubs: Vec<Option<Rub>> = (0..ways.len()).map(rub).collect();
            let changes = set.changes(&rubs, true).map_err(|_| Rejected::NoFrictionBalance)?;
            for &(i, hold) in &changes {
                ways[i].hold = hold;
            }
            if changes.is_empty() && !changed {
                for ((&(k, p), way), traction) in self.places.iter().zip(&ways).zip(&motion.tangential) {
                    let tangential = &mut state.pairs[k][p].tangential;
                    *tangential = Tangential { hold: way.hold, traction: *traction, ..*tangential };
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
        for &i in &rubs {
            let [factor, traction] = ways[i].slip.map(|part| ways[i].hold.sign() * part);
            self.slips.row(i).add_to(-traction, &mut forces);
            let direction = rows.directions.gradient_mut(i).iter_mut().zip(self.slips.row(i).gradient);
            direction.for_each(|(along, h)| *along -= factor * h);
        }
        let normals = self.normals.rows.iter().map(|row| (None, row));
        let sticks = rubs.iter().filter(|i| ways[**i].hold == Hold::Stick);
        let tangents = sticks.map(|&i| (Some(i), self.slips.row(i)));
        let sticking: Vec<usize> =
            independent(model, normals.chain(tangents)).into_iter().flatten().collect();
        for &i in &sticking {
            rows.push_plain(self.places[i], self.slips.row(i), true);
            targets.push(right.slips[i]);
        }
        system.mass_with(model, &rows)?;
        let (mut x, mut multipliers) = (vec![0.0; model.dofs()], Vec::new());
        system.solve(model, [&forces, &targets], &mut x, &mut multipliers)?;
        let stick_multipliers = multipliers.split_off(ways.len());
        let mut motion = Motion { x, normal: multipliers, tangential: vec![0.0; ways.len()] };
        for &i in &rubs {
            let [coefficient, traction] = ways[i].slip;
            motion.tangential[i] = ways[i].hold.sign() * (traction - coefficient * motion.normal[i]);
        }
        sticking.iter().zip(stick_multipliers).for_each(|(&i, q)| motion.tangential[i] = q);
        Ok(motion)
    }
}
