//! Friction in a stage and in a state. With y_½ = (y_s + y)/2, the rows H of
//! [`Kinematics::slip`](carom_contact::Kinematics::slip), one per tangent, and the states of
//! `carom_contact::StickSlip`
//!
//! ```text
//! S = H(y_½)·(Δy − Δy_free),   force  λ∇g + Σ q_α H_α(y_½),   ∂S/∂y = H + ½ ∂H/∂yᵀ (Δy − Δy_free)
//! ```
//!
//! where a part of a surface that faces nothing at y_½ has its slip at y. Momentum is conserved at
//! either place, angular momentum at y_½.
//!
//! Δy_free = 0, except for a pair that was open at the step's start: what slips before it touches
//! does not count. Its S is the velocity at the end of the stage, v(Δy) = v'·(Δy − Δy_free),
//! divided by v'; on a spring, the share of Δy in which the gap is negative. The force of a contact
//! that conserves acts over the whole step, and so does its S: its work −qS is never positive. Ṡ is
//! this velocity, or S over the time in which it slips; in load steps, the time of their formulas.
//!
//! A pair that slips has q = r(λ, Ṡ) d and is the normal row with the direction ∇g − ∂r/∂|λ| Σ d_α
//! H_α; one that sticks has rows of its own with the multipliers q, S = 0 or, on a spring, S = (q −
//! q_s)/k. A spring that slipped in the last step continues to do so while its traction in stick
//! would exceed r at its slip rate, even if stick could carry it. Its states change between
//! iterates like all others: from one slip to the opposite one through stick.
//!
//! In the plane d = ±1 is a state. In space it is an unknown, with the unit vector e across it and
//! the row that nothing slips across it,
//!
//! ```text
//! e·S = 0,   δd = e δθ,   δq = r δθ:      e·∂S/∂y δy − (d·S/r) δq = −e·S,     force  δq Σ e_α H_α
//! ```
//!
//! which remains valid as a stick across d where nothing slips along it. A slip without traction,
//! as in the iterate in which a pair closes, has the direction of S; where a pair pulls, it keeps
//! it. On a spring, d is that of q_s + kS, so that its row is that of a spring of stiffness k
//! r/|q_s + kS| across d. The components of q_s are those along tangents that turn with the normal,
//! and between steps about it (`friction_state.rs`). There q acts along H(y_s): in the averaged
//! forces of the next step and in what is recorded.

use carom_contact::{
    Along, ContactError, FrictionPair, FrictionState, Law, Pair, Radius, Row, Rows, Tangential, inner, length,
};

use crate::contact::loose::{hold, may_be_held};
use crate::model::{Contact, Model, NoValue};
use crate::stage::balance::contact_weights;
use crate::stage::equations::Equations;
use crate::stage::evaluation::Evaluation;

/// Angle by which a slip may miss its direction, unless it is shorter than ROUND_OFF / ANGLE times
/// the tolerance of gaps.
const ANGLE: f64 = 1e-10;
const ROUND_OFF: f64 = 1e-2;

impl Model {
    /// Whether a contact has friction.
    pub(crate) fn has_friction(&self) -> bool {
        self.contacts.iter().any(|contact| contact.friction.is_some())
    }

    /// The laws of the secondary nodes of each contact at a time; none without friction. `pairs`:
    /// those of each contact at the start of the step, of which those between nodes have the laws
    /// of their places.
    ///
    /// # Errors
    /// If a coefficient has no value.
    pub(crate) fn friction_laws(&self, time: f64, pairs: &[Vec<Pair>]) -> Result<Vec<Vec<Law>>, NoValue> {
        let of = |(contact, pairs): (&Contact, &Vec<Pair>)| {
            let Some(friction) = &contact.friction else { return Ok(Vec::new()) };
            friction.laws(time, (&*contact.kinematics, pairs), (&self.reference, self.dimension))
        };
        self.contacts.iter().zip(pairs).map(of).collect()
    }

    /// The law of a pair that a step may have found, where `laws` has those of nodes; none without
    /// friction.
    ///
    /// # Errors
    /// If a coefficient has no value.
    pub(crate) fn law_of(
        &self,
        (k, pair): (usize, &Pair),
        laws: &[Vec<Law>],
        time: f64,
    ) -> Result<Option<Law>, NoValue> {
        let contact = &self.contacts[k];
        let Some(friction) = &contact.friction else { return Ok(None) };
        let Some(law) = laws[k].get(pair.node) else { return Ok(None) };
        if !friction.acts_on(pair.node) {
            return Ok(Some(*law));
        }
        let between = (&*contact.kinematics, pair);
        let of_place = friction.law_between(time, between, (&self.reference, self.dimension))?;
        Ok(Some(of_place.unwrap_or(*law)))
    }

    /// Energy of the tangential springs of closed pairs.
    pub(crate) fn stick_energy<'a>(&self, pairs: impl Iterator<Item = &'a [Pair]>) -> f64 {
        let of = |(contact, pairs): (&Contact, &'a [Pair])| {
            let closed = pairs.iter().filter(|pair| pair.active);
            let square = |pair: &Pair| inner(pair.tangential.traction, pair.tangential.traction);
            let energy = |pair: &Pair| Some(0.5 * square(pair) / contact.stick_spring(pair)?);
            closed.filter_map(energy).sum::<f64>()
        };
        self.contacts.iter().zip(pairs).map(of).sum()
    }
}

/// Part of the motion of a pair that counts as slip.
#[derive(Clone, Copy)]
pub(crate) enum Counted {
    /// This share of the step's increment.
    Share(f64),
    /// What gives the velocity at the end of the stage.
    Velocity,
}

/// A pair measured where its slip is.
pub(crate) struct Slipping {
    pub pair: Pair,
    /// The positions at the end of the step, if that is there and not at its middle.
    pub end: Option<Vec<f64>>,
}

/// A closed pair that rubs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rubbing {
    /// d; zero in stick.
    pub direction: Along,
    /// The traction of a slip.
    pub radius: Radius,
    /// Factor between S and the rate of slip.
    pub rate: f64,
}

/// The rows of a pair, one per tangent, in the rows of all.
pub(crate) fn rows_of(slips: &Rows, pair: usize) -> std::ops::Range<usize> {
    let tangents = slips.dimension() - 1;
    pair * tangents..(pair + 1) * tangents
}

/// S of a pair.
fn slip_of(slips: &Rows, pair: usize) -> Along {
    let mut slip = [0.0; 2];
    slip.iter_mut().zip(rows_of(slips, pair)).for_each(|(s, row)| *s = slips.row(row).gap);
    slip
}

impl Evaluation {
    /// S of a pair with friction.
    pub fn slip_of(&self, (contact, pair): (usize, usize)) -> Along {
        slip_of(&self.slips[contact], pair)
    }

    /// The rows H of a pair with friction, one per tangent.
    pub(crate) fn slip_rows(&self, (contact, pair): (usize, usize)) -> impl Iterator<Item = Row<'_>> {
        let slips = &self.slips[contact];
        rows_of(slips, pair).map(|row| slips.row(row))
    }
}

impl Equations<'_> {
    /// Whether the friction of a contact is on springs, and the stiffness of a pair's.
    pub(crate) fn stick_spring(&self, contact: usize, pair: &Pair) -> Option<f64> {
        self.model.contacts[contact].stick_spring(pair)
    }

    /// Adds the rows H of a closed pair at y_½, with S as their gaps, and returns what counts in
    /// it; the pair keeps the tangents there, and sticks without traction where supports hold both
    /// sides and have not dragged it. `gap`: that of the pair.
    pub(crate) fn slip_into(
        &self,
        contact: usize,
        pair: &mut Pair,
        gap: f64,
        middle: &[f64],
        increment: &[f64],
        slips: &mut Rows,
    ) -> Result<Counted, ContactError> {
        let kinematics = &self.model.contacts[contact].kinematics;
        let at = self.measured_for_slip(contact, pair, middle, increment, slips)?;
        let part = self.part(contact, pair, gap, slips);
        let first = slips.len();
        let y = at.end.as_deref().unwrap_or(middle);
        kinematics.slip(&at.pair, y, increment, slips)?;
        pair.tangential.tangents = slips.tangents(first);
        if may_be_held(self.model, self.model.contacts[contact].node(pair)) {
            let mut gaps = Rows::new(self.model.dimension);
            kinematics.measure(&mut at.pair.clone(), y, &mut gaps)?;
            let start = self.state.past(contact, pair);
            let before = start.map_or([0.0; 2], |pair| pair.tangential.traction);
            if hold(self.model, gaps.row(0), slips, first, increment, before) == 0 {
                pair.tangential.friction_state = FrictionState::Stick;
                pair.tangential.traction = [0.0; 2];
                pair.tangential.before = [0.0; 2];
            }
        }
        for row in first..slips.len() {
            let counted = |(dof, slope): (usize, f64)| slope * self.counted(dof, part, increment);
            let slip = slips.row(row).entries().map(counted).sum();
            *slips.gap_mut(row) = slip;
        }
        Ok(part)
    }

    /// A pair measured at the middle of the step, or at its end if it faces nothing before: beside
    /// an end of the primary a part of a surface gains its partner within the step.
    pub(crate) fn measured_for_slip(
        &self,
        contact: usize,
        pair: &Pair,
        middle: &[f64],
        increment: &[f64],
        rows: &mut Rows,
    ) -> Result<Slipping, ContactError> {
        let kinematics = &self.model.contacts[contact].kinematics;
        let mut measure = |y: &[f64]| {
            let mut at = *pair;
            kinematics.measure(&mut at, y, rows)?;
            rows.pop();
            Ok(at)
        };
        let at_middle = measure(middle)?;
        if at_middle.active || !pair.active {
            return Ok(Slipping { pair: at_middle, end: None });
        }
        let end: Vec<f64> = middle.iter().zip(increment).map(|(y, d)| y + 0.5 * d).collect();
        Ok(Slipping { pair: measure(&end)?, end: Some(end) })
    }

    /// S of a pair that closes in an iterate; 0 if it has none.
    pub(crate) fn slip(&self, contact: usize, pair: &mut Pair, middle: &[f64], increment: &[f64]) -> Along {
        let mut rows = Rows::new(self.model.dimension);
        self.slip_into(contact, pair, 0.0, middle, increment, &mut rows)
            .map_or([0.0; 2], |_| slip_of(&rows, 0))
    }

    /// Sets the traction of a closed pair from its slip.
    pub(crate) fn rub(&self, contact: usize, pair: &mut Pair, slip: Along, part: Counted) -> Rubbing {
        let law = self.laws[contact][pair.node];
        let rate = self.rate(part);
        let radius = law.slip(-pair.lambda, length(slip) * rate);
        if let Some(stiffness) = self.stick_spring(contact, pair) {
            let trial = self.trial(contact, pair, stiffness, slip);
            let tangential = &mut pair.tangential;
            if inner(tangential.friction_state.direction(), trial) > 0.0 {
                tangential.friction_state = FrictionState::of(trial, 0.0);
            }
            tangential.traction = trial;
        } else if self.model.dimension == 3
            && radius.value == 0.0
            && pair.tangential.friction_state != FrictionState::Stick
            && slip != [0.0; 2]
        {
            pair.tangential.friction_state = FrictionState::of(slip, 0.0);
        }
        let direction = pair.tangential.friction_state.direction();
        if pair.tangential.friction_state != FrictionState::Stick {
            pair.tangential.traction = direction.map(|d| d * radius.value);
        }
        Rubbing { direction, radius, rate }
    }

    /// Traction that a pair on a spring would have in stick, and the one at which it slips: a
    /// spring that slipped in the last step continues to do so at its slip rate.
    fn yields_at(
        &self,
        contact: usize,
        pair: &Pair,
        stiffness: f64,
        slip: Along,
        part: Counted,
    ) -> (Along, f64) {
        let trial = self.trial(contact, pair, stiffness, slip);
        let law = self.laws[contact][pair.node];
        let pressure = (-pair.lambda).max(0.0);
        let start = self.state.past(contact, pair).map(|old| old.tangential.friction_state.direction());
        let slipped = start.is_some_and(|direction| inner(direction, trial) > 0.0);
        let slips = law.slip(pressure, length(slip) * self.rate(part)).value;
        (trial, if slipped { slips } else { law.grip(pressure) })
    }

    /// A closed pair of an iterate as the law sees it. On a spring, what slips is what exceeds its
    /// stretch at the edge of the cone: an iterate beyond the opposite edge sticks before it slips
    /// there, since from one edge to the other Newton's method would find no tangent between them.
    pub(crate) fn rubs(&self, evaluation: &Evaluation, (contact, p): (usize, usize)) -> FrictionPair {
        let pair = &evaluation.at.pairings[contact].pairs[p];
        let Tangential { friction_state, traction, .. } = pair.tangential;
        let slip = evaluation.slip_of((contact, p));
        let Some(stiffness) = self.stick_spring(contact, pair) else {
            let cone = self.laws[contact][pair.node].grip(-pair.lambda);
            return FrictionPair { friction_state, traction, slip, cone };
        };
        let gap = evaluation.rows[contact].row(p).gap;
        let part = self.part(contact, pair, gap, &mut Rows::new(self.model.dimension));
        let (trial, cone) = self.yields_at(contact, pair, stiffness, slip, part);
        let direction = friction_state.direction();
        let beyond = (inner(direction, trial) - cone) / stiffness;
        FrictionPair { friction_state, traction: trial, slip: direction.map(|d| d * beyond), cone }
    }

    /// The state in which a spring begins, by the projection of its traction.
    fn begin_spring(&self, contact: usize, pair: &mut Pair, slip: Along, part: Counted) {
        if let Some(stiffness) = self.stick_spring(contact, pair) {
            let (trial, edge) = self.yields_at(contact, pair, stiffness, slip, part);
            pair.tangential.friction_state =
                if length(trial) <= edge { FrictionState::Stick } else { FrictionState::of(trial, 0.0) };
        }
    }

    /// The traction of a pair whose spring of this stiffness would stick.
    fn trial(&self, contact: usize, pair: &Pair, stiffness: f64, slip: Along) -> Along {
        let is_stretched = self.state.past(contact, pair).is_some();
        let before = if is_stretched { pair.tangential.before } else { [0.0; 2] };
        [0, 1].map(|i| before[i] + stiffness * slip[i])
    }

    /// Slip per traction of a row that friction constrains by a spring; none without a spring. The
    /// traction of a slip turns with that of its spring.
    pub(crate) fn spring_yields(&self, contact: usize, pair: &Pair, slip: Along) -> Option<f64> {
        let stiffness = self.stick_spring(contact, pair)?;
        let share = match pair.tangential.friction_state {
            FrictionState::Stick => 1.0,
            FrictionState::Slip(_) => {
                length(self.trial(contact, pair, stiffness, slip)) / length(pair.tangential.traction)
            }
        };
        Some(share / stiffness)
    }

    /// The components of the rows by which friction constrains a closed pair: every tangent of one
    /// that sticks, and in space what is across the direction of a slip with a traction.
    pub(crate) fn prevented(&self, contact: usize, pair: &Pair) -> impl Iterator<Item = Along> {
        let tangents = self.model.dimension - 1;
        let rows = match pair.tangential.friction_state {
            FrictionState::Stick => [[1.0, 0.0], [0.0, 1.0]].into_iter().take(tangents),
            FrictionState::Slip([along, other]) => {
                let turns = tangents == 2 && inner(pair.tangential.traction, [along, other]) > 0.0;
                [[-other, along], [0.0; 2]].into_iter().take(usize::from(turns))
            }
        };
        rows.filter(move |_| self.model.contacts[contact].friction.is_some())
    }

    /// Adds the friction of a pair with this gap: the rows of its slip, the direction of its force,
    /// and what acts beyond that. `begins`: it was open in the iterate before.
    pub(crate) fn add_friction(
        &self,
        contact: usize,
        pair: &mut Pair,
        gap: f64,
        begins: bool,
        evaluation: &mut Evaluation,
    ) -> Result<(), ContactError> {
        let weight = contact_weights(&self.stage, self.model.contacts[contact].at_the_end).0;
        let Evaluation { at, middle, rows, turned, slips, rests, forces, measure, .. } = evaluation;
        let rows = &rows[contact];
        let turned = &mut turned[contact];
        let slips = &mut slips[contact];
        let p = rows.len() - 1;
        if !pair.active {
            rows_of(slips, p).for_each(|_| slips.push_open());
            if turned.len() < rows.len() {
                turned.push_open();
            }
            return Ok(());
        }
        // Not there yet unless it is a discrete gradient.
        if turned.len() < rows.len() {
            turned.push_row(rows.row(p));
        }
        let part = self.slip_into(contact, pair, gap, middle, &at.increment, slips)?;
        let slip = slip_of(slips, p);
        if begins {
            self.begin_spring(contact, pair, slip, part);
        }
        let Rubbing { direction, radius, .. } = self.rub(contact, pair, slip, part);
        let traction = pair.tangential.traction;
        let mut rest = [0.0; 2];
        for (i, row) in rows_of(slips, p).map(|row| slips.row(row)).enumerate() {
            let turn = direction[i] * radius.by_pressure;
            let along = turned.gradient_mut(p).iter_mut().zip(row.gradient);
            along.for_each(|(along, h)| *along -= turn * h);
            rest[i] = traction[i] + turn * pair.lambda;
            row.add_to(weight * rest[i], &mut forces.contact);
            row.add_to(weight * traction[i], &mut forces.friction);
        }
        rests[contact].push(rest);
        if let Some(stiffness) = self.stick_spring(contact, pair) {
            evaluation.stick_springs += 0.5 * inner(traction, traction) / stiffness;
            return Ok(());
        }
        for along in self.prevented(contact, pair) {
            let open = inner(along, slip) - self.stretch(contact, pair, along, at.stiffer);
            let missed = self.weight_of_slip(pair, slip) * open.abs();
            (measure.gap, measure.may_depend) = (measure.gap.max(missed), true);
        }
        Ok(())
    }

    /// Factor of a slip that is prevented, as a gap: of one across a slip, its angle counts too.
    pub(crate) fn weight_of_slip(&self, pair: &Pair, slip: Along) -> f64 {
        let gap = self.model.gap_tolerance;
        let turns = pair.tangential.friction_state != FrictionState::Stick;
        if turns { (gap / (ANGLE * length(slip) + ROUND_OFF * gap)).max(1.0) } else { 1.0 }
    }

    pub(crate) fn part(&self, contact: usize, pair: &Pair, gap: f64, rows: &mut Rows) -> Counted {
        if !self.closes(contact, pair) || self.model.contacts[contact].conserves() {
            return Counted::Share(1.0);
        }
        if self.stick_spring(contact, pair).is_none() {
            return Counted::Velocity;
        }
        let start = self.open_at_start(contact, pair, rows);
        Counted::Share(if start > 0.0 { (gap / (gap - start)).clamp(0.0, 1.0) } else { 1.0 })
    }

    /// Factor between S and the rate of slip.
    fn rate(&self, part: Counted) -> f64 {
        match part {
            Counted::Velocity => self.stage.velocity.slope,
            Counted::Share(share) if share > 0.0 => (share * self.duration).recip(),
            Counted::Share(_) => 0.0,
        }
    }

    /// A component of Δy − Δy_free.
    pub(crate) fn counted(&self, dof: usize, part: Counted, increment: &[f64]) -> f64 {
        let velocity = &self.stage.velocity;
        match part {
            Counted::Share(share) => share * increment[dof],
            Counted::Velocity => increment[dof] + velocity.at_start[dof] / velocity.slope,
        }
    }

    /// Share of the step after the touch of a pair that closes, which approaches with its velocity
    /// at the start, or at the mean one if that is larger.
    pub(crate) fn since_touch(&self, contact: usize, pair: &Pair, gap: Row, rows: &mut Rows) -> f64 {
        let start = self.open_at_start(contact, pair, rows);
        let approach = (-gap.along(&self.state.v)).max(start / self.duration);
        if start > 0.0 { 1.0 - start / (self.duration * approach) } else { 1.0 }
    }

    /// Gap of a pair at the step's start; 0 of a part of a surface that faces nothing there.
    fn open_at_start(&self, contact: usize, pair: &Pair, rows: &mut Rows) -> f64 {
        self.gap_at_start(contact, pair, rows).ok().filter(|gap| gap.is_finite()).unwrap_or(0.0)
    }

    /// Whether a pair was open at the step's start.
    pub(crate) fn closes(&self, contact: usize, pair: &Pair) -> bool {
        !self.stage.is_static() && self.state.past(contact, pair).is_none()
    }
}

/// Force on a secondary side of the tractions that are not in the direction of λ: −Σ (q + d ∂r/∂|λ|
/// λ) ∂S/∂y_N over the closed pairs.
pub(crate) fn secondary_friction(evaluation: &Evaluation, contact: usize) -> [f64; 3] {
    let mut force = [0.0; 3];
    if evaluation.slips[contact].is_empty() {
        return force;
    }
    let pairs = evaluation.at.pairings[contact].pairs.iter().enumerate();
    let closed = pairs.filter(|(_, pair)| pair.active);
    for ((p, _), rest) in closed.zip(&evaluation.rests[contact]) {
        for (row, rest) in evaluation.slip_rows((contact, p)).zip(rest) {
            let along = row.normal();
            (0..3).for_each(|i| force[i] -= rest * along[i]);
        }
    }
    force
}
