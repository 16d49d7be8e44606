//! Velocities and accelerations of a state with closed pairs, under Coulomb's law:
//!
//! ```text
//! M x + Gᵀp + Hᵀq = f,   G x − c ≥ 0 ⊥ p ≤ 0,   H x = b in stick,   q = −sμp in slip,   |q| ≤ −μp,   s (H x − b) ≥ 0
//! ```
//!
//! For an impulse x is a change of velocity, G x − c and H x − b the rates of gap and slip after it. For
//! accelerations they are the rates of change of these rates, which decide for pairs that have none;
//! others separate, or slip in their direction. Without friction all p count, and this is one linear
//! solve.

use carom_contact::{Hold, Rows, Rub, StickSlip, Tangential};

use crate::constraints::{Constraints, independent};
use crate::model::Model;
use crate::rejected::Rejected;
use crate::state::State;
use crate::sums::max_abs;
use crate::system::System;

/// Most changes of stick and slip in one solve.
const CHANGES: usize = 200;
/// Rate of a gap or slip, as a fraction of the largest velocity, that is none.
const AT_REST: f64 = 1e-10;
/// Rate, as a fraction of the largest one in a solve, that is round-off.
const ROUND_OFF: f64 = 1e-12;

/// The closed pairs of a state whose gaps are constraints.
pub(crate) struct Closed {
    /// Contact and pair of each.
    pub places: Vec<(usize, usize)>,
    /// Rows of their gaps, a constraint each.
    pub normals: Constraints,
    /// H of each; empty without friction.
    slips: Rows,
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

/// Where a pair is in the law.
#[derive(Clone, Copy, PartialEq)]
struct Law {
    hold: Hold,
    /// Whether it may stick.
    is_free: bool,
    /// Whether its gap opens; and does so whatever the solution is.
    opens: bool,
    separates: bool,
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
        for &(k, p) in places.iter().filter(|_| model.has_friction()) {
            let contact = &model.contacts[k];
            if contact.friction.is_none() {
                slips.push_open();
                continue;
            }
            let failed = |error| Rejected::Contact { contact: contact.name.clone(), error };
            contact.kinematics.slip(&state.pairs[k][p], &state.y, &mut slips).map_err(failed)?;
        }
        Ok(Self { places, normals, slips })
    }

    /// H x of each pair; 0 without friction.
    pub(crate) fn slip_rates(&self, x: &[f64]) -> Vec<f64> {
        if self.slips.is_empty() {
            return vec![0.0; self.places.len()];
        }
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

    /// The change of velocity for an impulse: stick and slip follow from the slip rates after it.
    pub(crate) fn impulse(
        &self,
        model: &Model,
        state: &mut State,
        right: &Right,
        system: &mut System,
    ) -> Result<Motion, Rejected> {
        let laws = self.laws(state);
        self.solve(model, state, right, system, laws)
    }

    /// The accelerations: pairs with a slip rate slip in its direction.
    pub(crate) fn accelerate(
        &self,
        model: &Model,
        state: &mut State,
        right: &Right,
        system: &mut System,
    ) -> Result<Motion, Rejected> {
        let mut laws = self.laws(state);
        let (rates, still) = (self.slip_rates(&state.v), AT_REST * max_abs(&state.v));
        for (i, law) in laws.iter_mut().enumerate() {
            if Hold::of(rates[i], still) != Hold::Stick {
                (law.hold, law.is_free) = (Hold::of(rates[i], still), false);
            }
            law.separates = self.normals.rows.row(i).along(&state.v) > still;
            law.opens = law.separates;
        }
        self.solve(model, state, right, system, laws)
    }

    /// The laws of the pairs of a state.
    fn laws(&self, state: &State) -> Vec<Law> {
        let hold = |&(k, p): &(usize, usize)| state.pairs[k][p].tangential.hold;
        let law = |place| Law { hold: hold(place), is_free: true, opens: false, separates: false };
        self.places.iter().map(law).collect()
    }

    /// Solves, and sets stick and slip of the pairs.
    fn solve(
        &self,
        model: &Model,
        state: &mut State,
        right: &Right,
        system: &mut System,
        mut laws: Vec<Law>,
    ) -> Result<Motion, Rejected> {
        if self.slips.is_empty() {
            system.factor_mass(model, &self.normals)?;
            let mut motion = Motion { x: vec![0.0; model.dofs()], ..Motion::default() };
            system.factor.solve(model, right.forces, right.gaps, &mut motion.x, &mut motion.normal)?;
            motion.tangential = vec![0.0; self.places.len()];
            return Ok(motion);
        }
        let mut set = StickSlip::new(0.0, true);
        for _ in 0..CHANGES {
            let motion = self.solve_for(model, right, system, &laws)?;
            let rates = self.slip_rates(&motion.x);
            let all = rates.iter().chain(right.slips).chain(right.gaps);
            let none = ROUND_OFF * all.fold(0.0_f64, |most, rate| most.max(rate.abs()));
            let mut changed = false;
            for (i, law) in laws.iter_mut().enumerate().filter(|(_, law)| !law.separates) {
                let opens = match law.opens {
                    true => self.normals.rows.row(i).along(&motion.x) - right.gaps[i] >= -none,
                    false => motion.normal[i] > 0.0,
                };
                changed |= std::mem::replace(&mut law.opens, opens) != opens;
            }
            let rub = |i: usize| {
                let (law, cone) = (laws[i], self.coefficient(model, i)? * (-motion.normal[i]).max(0.0));
                // What is no slip to round-off has no direction.
                let rate = rates[i] - right.slips[i];
                let slip = if law.is_free && rate.abs() > none { rate } else { law.hold.sign() };
                (!law.opens).then_some(Rub { hold: law.hold, traction: motion.tangential[i], slip, cone })
            };
            let rubs: Vec<Option<Rub>> = (0..laws.len()).map(rub).collect();
            let changes = set.changes(&rubs, true).map_err(|_| Rejected::NoFrictionBalance)?;
            for &(i, hold) in &changes {
                laws[i].hold = hold;
            }
            if changes.is_empty() && !changed {
                for ((&(k, p), law), traction) in self.places.iter().zip(&laws).zip(&motion.tangential) {
                    let tangential = &mut state.pairs[k][p].tangential;
                    *tangential = Tangential { hold: law.hold, traction: *traction, ..*tangential };
                }
                return Ok(motion);
            }
        }
        Err(Rejected::NoFrictionBalance)
    }

    fn coefficient(&self, model: &Model, i: usize) -> Option<f64> {
        model.contacts[self.places[i].0].friction
    }

    /// One linear solve with given states.
    fn solve_for(
        &self,
        model: &Model,
        right: &Right,
        system: &mut System,
        laws: &[Law],
    ) -> Result<Motion, Rejected> {
        let closed: Vec<usize> = (0..laws.len()).filter(|&i| !laws[i].opens).collect();
        let normal = |&i: &usize| (self.places[i], self.normals.rows.row(i));
        let mut rows = Constraints::plain(model.dimension, closed.iter().map(normal));
        rows.is_skew = true;
        let mut targets: Vec<f64> = closed.iter().map(|&i| right.gaps[i]).collect();
        let coefficient = |i: usize| self.coefficient(model, i).unwrap_or(0.0);
        for (r, &i) in closed.iter().enumerate() {
            let factor = laws[i].hold.sign() * coefficient(i);
            let direction = rows.directions.gradient_mut(r).iter_mut().zip(self.slips.row(i).gradient);
            direction.for_each(|(along, h)| *along -= factor * h);
        }
        let sticks = |i: &&usize| self.coefficient(model, **i).is_some() && laws[**i].hold == Hold::Stick;
        let normals = closed.iter().map(|&i| (None, self.normals.rows.row(i)));
        let tangents = closed.iter().filter(sticks).map(|&i| (Some(i), self.slips.row(i)));
        let sticking: Vec<usize> =
            independent(model, normals.chain(tangents)).into_iter().flatten().collect();
        for &i in &sticking {
            rows.push_plain(self.places[i], self.slips.row(i), true);
            targets.push(right.slips[i]);
        }
        system.factor_mass(model, &rows)?;
        let (mut x, mut multipliers) = (vec![0.0; model.dofs()], Vec::new());
        system.factor.solve(model, right.forces, &targets, &mut x, &mut multipliers)?;
        let mut motion = Motion { x, normal: vec![0.0; laws.len()], tangential: vec![0.0; laws.len()] };
        for (&i, p) in closed.iter().zip(&multipliers) {
            motion.normal[i] = *p;
            motion.tangential[i] = -laws[i].hold.sign() * coefficient(i) * p;
        }
        for (&i, q) in sticking.iter().zip(&multipliers[closed.len()..]) {
            motion.tangential[i] = *q;
        }
        Ok(motion)
    }
}
