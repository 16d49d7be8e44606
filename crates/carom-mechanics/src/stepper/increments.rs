//! Contact forces of an explicit step, by forward increments: P_n such that y_n + Δt v_{n+½} is
//! admissible (`explicit.rs`). With linearised gaps they solve a complementarity problem with
//! G M⁻¹Gᵀ, with friction one of both forces; the linearisation is repeated.

use carom_algebra::{Cone, Couplings, Kind, LinearError};
use carom_contact::{Law, Pair, Pairing, Rows, Tangential, inner};

use super::StepReport;
use super::forward::Forward;
use super::rubbing::{combined, friction_state, kind};
use super::scratch::Scratch;
use super::tied_mass::TiedMass;
use super::watch::{active, carry_into, measure_into, moves, overconstrained};
use crate::contact::depths::{begin, beginning, ease, gap_at};
use crate::contact::independent::{HELD, dependent_on_others, is_dependent, share_nodes};
use crate::contact::loose::loose;
use crate::contact::update::search;
use crate::model::Model;
use crate::rejected::Rejected;
use crate::state::State;

/// Linearisations of the gaps in a step before it is rejected; two to five are typical.
const ROUNDS: u32 = 60;
/// Dofs of a task of a thread.
const BLOCK: usize = 1 << 14;

/// A step from y_n and v_{n−½}.
pub(super) struct Increments<'a> {
    pub model: &'a Model,
    /// With y_n and the acceleration without contact.
    pub state: &'a State,
    /// v_{n−½}.
    pub before: &'a [f64],
    pub dt: f64,
    /// 1/m per dof; zero if constrained.
    pub inverse_mass: &'a [f64],
}

/// The gaps at the end of a step, as the law takes them.
struct Gaps {
    /// The largest that must not be.
    worst: f64,
    /// Whether a force was handed to another facet, and acts along another row.
    moved_on: bool,
    /// Whether a pair is behind its facet at y_n.
    is_behind: bool,
}

/// A row with one of its nodes.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Meeting {
    node: usize,
    row: usize,
}

/// Whether rows depend on each other. Their gradients are those at y_n in every round, so that it
/// is found once for the same contacts, nodes and facets.
#[derive(Default)]
struct Dependence {
    examined: Vec<(usize, usize, usize)>,
    is_dependent: bool,
}

impl Increments<'_> {
    /// Leaves in `scratch` the pairs with the forces that make y_n + Δt v_{n+½} admissible, whose
    /// rows have the gradients at y_n, and that velocity in `velocity`. Returns whether a pair is
    /// behind its facet at y_n.
    pub(super) fn solve(
        &self,
        velocity: &mut Vec<f64>,
        scratch: &mut Scratch,
        report: &mut StepReport,
    ) -> Result<bool, Rejected> {
        let model = self.model;
        let tolerance = self.model.gap_tolerance;
        let laws = model.friction_laws(self.state.time, &self.state.pairs)?;
        scratch.places.clear();
        scratch.acting.clear();
        scratch.along.clear();
        scratch.kinds.clear();
        carry_into(model, self.state, Pairing::near, &mut scratch.pairings);
        ease(model, &self.state.y, &mut scratch.pairings);
        self.move_freely(velocity, scratch);
        let mut row = Rows::new(model.dimension);
        let mut is_behind = false;
        let mut dependence = Dependence::default();
        for round in 0..=ROUNDS {
            let gaps = self.gaps(velocity, scratch, &mut row, report)?;
            is_behind |= gaps.is_behind;
            if gaps.worst <= tolerance && !gaps.moved_on {
                break;
            }
            if round == ROUNDS {
                return Err(Rejected::Unsettled { rounds: ROUNDS, gap: gaps.worst });
            }
            report.newton += 1;
            self.choose_rows(&laws, scratch)?;
            self.find_impulses(&mut dependence, scratch)?;
            self.apply(velocity, scratch);
        }
        if dependence.is_dependent && model.has_friction() {
            let Scratch { places, acting, pairings, .. } = &*scratch;
            let gaps = places.iter().copied().zip(acting.iter());
            let node = |(k, p): (usize, usize)| (k, model.contacts[k].node(&pairings[k].pairs[p]));
            report.dependent.extend(dependent_on_others(model, gaps).into_iter().map(node));
        }
        self.note_slips(velocity, scratch);
        for (contact, pairing) in model.contacts.iter().zip(&mut scratch.pairings) {
            for pair in &mut pairing.pairs {
                (pair.active, pair.start) = (pair.lambda < 0.0, None);
                if pair.active {
                    // The recorded contact point is that of the force: at y_n.
                    gap_at(contact, pair, &self.state.y, &mut row);
                } else {
                    pair.tangential = Tangential::default();
                }
            }
        }
        Ok(is_behind)
    }

    /// The velocity without contact, and the positions to which it leads.
    fn move_freely(&self, velocity: &mut Vec<f64>, scratch: &mut Scratch) {
        let size = self.before.len();
        let Scratch { free, at, moved, touched, .. } = scratch;
        touched.clear();
        at.resize(size, 0.0);
        for vector in [&mut *velocity, free, &mut moved.to] {
            vector.resize(size, 0.0);
        }
        let State { y, a, .. } = self.state;
        let blocks = velocity.chunks_mut(BLOCK).zip(free.chunks_mut(BLOCK)).zip(moved.to.chunks_mut(BLOCK));
        self.model.threads.for_each(blocks, |block, ((velocity, free), to)| {
            let first = block * BLOCK;
            for k in 0..free.len() {
                let i = first + k;
                free[k] = self.before[i] + self.dt * a[i];
                velocity[k] = free[k];
                to[k] = y[i] + self.dt * free[k];
            }
        });
    }

    /// Searches pairs for the motion with this velocity and measures their gaps; a violated pair
    /// joins the working set and stays.
    fn gaps(
        &self,
        velocity: &[f64],
        scratch: &mut Scratch,
        row: &mut Rows,
        report: &mut StepReport,
    ) -> Result<Gaps, Rejected> {
        let model = self.model;
        let state = self.state;
        let tolerance = self.model.gap_tolerance;
        let Scratch { moved, pairings, rows, loaded, .. } = scratch;
        let motion = Forward { state, before: self.before, velocity, dt: self.dt };
        loaded.clear();
        loaded.extend(forces(pairings));
        search(model, &state.y, &moved.to, pairings, &mut report.events);
        begin(model, beginning(state, &state.y), pairings);
        // Gaps of new pairs are measured below with all others.
        let moved_on = !forces(pairings).eq(loaded.iter().copied());
        measure_into(model, &state.y, pairings, rows)?;
        let mut gaps = Gaps { worst: 0.0, moved_on, is_behind: false };
        for (k, contact) in model.contacts.iter().enumerate() {
            let pairs = &mut pairings[k].pairs;
            if pairs.is_empty() {
                continue;
            }
            // Gaps at the positions of the law replace those at y_n.
            gaps.is_behind |= motion.gaps_of_law(contact, pairs, &mut rows[k], tolerance, moved, row);
            for (p, pair) in pairs.iter_mut().enumerate() {
                let gap = rows[k].row(p).gap;
                let wrong = if pair.lambda < 0.0 { gap.abs() } else { -gap };
                if -gap > tolerance && !moves(model, rows[k].row(p)) {
                    return Err(overconstrained(contact, pair, gap));
                }
                gaps.worst = gaps.worst.max(wrong);
                pair.active |= wrong > tolerance;
            }
        }
        Ok(gaps)
    }

    /// The rows that impulses act along, those of the gaps and then of slips, with their last
    /// impulses.
    fn choose_rows(&self, laws: &[Vec<Law>], scratch: &mut Scratch) -> Result<(), Rejected> {
        let model = self.model;
        let state = self.state;
        let Scratch { free, pairings, rows, impulses, places, acting, slips, along, kinds, .. } = scratch;
        places.clear();
        places.extend(active(pairings).filter(|&(k, p)| moves(model, rows[k].row(p))));
        acting.clear();
        places.iter().for_each(|&(k, p)| acting.push_row(rows[k].row(p)));
        kinds.clear();
        kinds.resize(places.len(), Kind::Normal);
        impulses.clear();
        impulses.extend(places.iter().map(|&(k, p)| -pairings[k].pairs[p].lambda));
        along.clear();
        for (i, &(k, p)) in places.iter().enumerate().filter(|_| model.has_friction()) {
            let pair = &mut pairings[k].pairs[p];
            let Some(law) = model.law_of((k, pair), laws, state.time)? else { continue };
            slips.clear();
            slip_into(model, state, (k, pair), slips)?;
            let kind = kind(&law, i, state, (k, pair), slips, self.before);
            for part in loose(model, rows[k].row(p), slips, free, HELD) {
                acting.push_combined(slips, 0, &part[..slips.len()]);
                along.push(part);
                kinds.push(kind);
                impulses.push(-inner(part, pair.tangential.traction));
            }
        }
        Ok(())
    }

    /// Solves the small problem of these rows.
    fn find_impulses(&self, dependence: &mut Dependence, scratch: &mut Scratch) -> Result<(), Rejected> {
        let model = self.model;
        let dt = self.dt;
        let Scratch { free, at, pairings, rows, impulses, places, acting, kinds, ties, .. } = scratch;
        let Scratch { matrix, right, .. } = scratch;
        self.matrix(acting, at, ties, matrix)?;
        right.clear();
        right.resize(kinds.len(), 0.0);
        for (i, &(k, p)) in places.iter().enumerate() {
            let leaves = pairings[k].pairs[p].start.is_some();
            let restitution = if leaves { 0.0 } else { model.contacts[k].restitution };
            right[i] = (1.0 + restitution) * rows[k].row(p).gap / (dt * dt) - matrix.along(i, impulses);
        }
        for i in places.len()..kinds.len() {
            right[i] = acting.row(i).along(free) / dt;
        }
        let named = |&(k, p): &(usize, usize)| {
            let pair = &pairings[k].pairs[p];
            (k, pair.node, pair.facet)
        };
        let Dependence { examined, is_dependent: dependent } = dependence;
        if !places.iter().map(named).eq(examined.iter().copied()) {
            examined.clear();
            examined.extend(places.iter().map(named));
            let may_depend = model.dimension == 3 || share_nodes(model, pairings, places);
            *dependent = is_dependent(model, acting.iter().take(places.len()))
                || model.has_friction() && may_depend && is_dependent(model, acting.iter());
        }
        Ok(Cone { matrix, right, kinds, is_dependent: *dependent }.solve(impulses)?)
    }

    /// Gives the impulses to their pairs, and to the velocity.
    fn apply(&self, velocity: &mut [f64], scratch: &mut Scratch) {
        let Scratch { free, at, pairings, impulses, places, acting, along, kinds, ties, .. } = scratch;
        let Scratch { moved, touched, .. } = scratch;
        for pair in pairings.iter_mut().flat_map(|pairing| &mut pairing.pairs) {
            (pair.lambda, pair.tangential.traction) = (0.0, [0.0; 2]);
        }
        for (row, force) in acting.iter().zip(impulses.iter()) {
            row.add_to(*force, at);
        }
        for (&(k, p), force) in places.iter().zip(impulses.iter()) {
            pairings[k].pairs[p].lambda = -force;
        }
        for (of, force) in combined(kinds, along, &impulses[places.len()..]) {
            let (k, p) = places[of];
            let traction = &mut pairings[k].pairs[p].tangential.traction;
            (0..2).for_each(|a| traction[a] -= force[a]);
        }
        if let Some(ties) = ties {
            at.iter_mut().zip(self.inverse_mass).for_each(|(force, inverse)| *force *= inverse);
            ties.correct(self.model, self.inverse_mass, at);
            for i in 0..free.len() {
                velocity[i] = free[i] + self.dt * at[i];
                moved.to[i] = self.state.y[i] + self.dt * velocity[i];
            }
            at.fill(0.0);
            return;
        }
        // The dofs of the last impulses too, which may not act any more.
        let last = touched.len();
        for row in acting.iter() {
            touched.extend(row.entries().map(|(dof, _)| dof));
        }
        for &i in &*touched {
            velocity[i] = free[i] + self.dt * self.inverse_mass[i] * at[i];
            moved.to[i] = self.state.y[i] + self.dt * velocity[i];
        }
        touched.iter().for_each(|&i| at[i] = 0.0);
        touched.drain(..last);
    }

    /// Adds the slips over the step, and whether pairs stick, to those with a force. The last
    /// search may have added and removed pairs, but none with a force.
    fn note_slips(&self, velocity: &[f64], scratch: &mut Scratch) {
        let Scratch { pairings, impulses, places, acting, along, kinds, .. } = scratch;
        let pressing: Vec<_> = pressing(pairings).collect();
        let mut pressing = pressing.into_iter();
        let now = |force: &f64| if *force > 0.0 { pressing.next() } else { None };
        let now: Vec<_> = impulses[..places.len()].iter().map(now).collect();
        let slipped: Vec<f64> =
            acting.iter().skip(places.len()).map(|row| self.dt * row.along(velocity)).collect();
        for ((of, slip), kind) in combined(kinds, along, &slipped).zip(&kinds[places.len()..]) {
            let Some((k, p)) = now[of] else { continue };
            let tangential = &mut pairings[k].pairs[p].tangential;
            tangential.friction_state = friction_state(*kind, impulses[of], tangential.traction.map(|q| -q));
            (0..2).for_each(|a| tangential.slip[a] += slip[a]);
        }
    }

    /// G M⁻¹Gᵀ over these rows into `matrix`. `column` is zero before and after.
    ///
    /// # Errors
    /// If there is not enough memory for it: with ties it is dense.
    fn matrix(
        &self,
        rows: &Rows,
        column: &mut [f64],
        ties: &mut Option<TiedMass>,
        matrix: &mut Couplings,
    ) -> Result<(), LinearError> {
        let mut meeting: Vec<Meeting> = Vec::new();
        if ties.is_none() {
            let nodes = rows.iter().enumerate();
            meeting
                .extend(nodes.flat_map(|(row, of)| of.nodes.iter().map(move |&node| Meeting { node, row })));
            meeting.sort_unstable();
        }
        matrix.reset(rows.len(), |i, columns| {
            if ties.is_some() {
                columns.extend(0..rows.len());
                return;
            }
            for &node in rows.row(i).nodes {
                let begin = meeting.partition_point(|other| other.node < node);
                let same = meeting[begin..].iter().take_while(|other| other.node == node);
                columns.extend(same.map(|other| other.row));
            }
            columns.sort_unstable();
            columns.dedup();
        })?;
        let mut coupled = Vec::new();
        for (j, row) in rows.iter().enumerate() {
            for (dof, slope) in row.entries() {
                column[dof] = self.inverse_mass[dof] * slope;
            }
            if let Some(ties) = ties {
                ties.correct(self.model, self.inverse_mass, column);
            }
            coupled.clear();
            coupled.extend_from_slice(matrix.columns(j));
            for &i in &coupled {
                matrix.set(i, j, rows.row(i).along(column));
            }
            if ties.is_some() {
                column.fill(0.0);
            }
            row.entries().for_each(|(dof, _)| column[dof] = 0.0);
        }
        Ok(())
    }
}

/// Adds H at y_n of a pair, which keeps the tangents there.
fn slip_into(
    model: &Model,
    state: &State,
    (k, pair): (usize, &mut Pair),
    rows: &mut Rows,
) -> Result<(), Rejected> {
    let contact = &model.contacts[k];
    let mut at = *pair;
    let failed = |error| Rejected::Contact { contact: contact.name.clone(), error };
    contact.kinematics.measure(&mut at, &state.y, rows).map_err(failed)?;
    rows.pop();
    let first = rows.len();
    contact.kinematics.slip(&at, &state.y, &[], rows).map_err(failed)?;
    pair.tangential.tangents = rows.tangents(first);
    Ok(())
}

/// Contact and index of the pairs with a force.
fn pressing(pairings: &[Pairing]) -> impl Iterator<Item = (usize, usize)> {
    pairings.iter().enumerate().flat_map(|(k, pairing)| {
        let loaded = pairing.pairs.iter().enumerate().filter(|(_, pair)| pair.lambda < 0.0);
        loaded.map(move |(p, _)| (k, p))
    })
}

/// Contact, node and facet of the pairs with a force.
fn forces(pairings: &[Pairing]) -> impl Iterator<Item = (usize, usize, usize)> {
    pressing(pairings).map(|(k, p)| (k, pairings[k].pairs[p].node, pairings[k].pairs[p].facet))
}
