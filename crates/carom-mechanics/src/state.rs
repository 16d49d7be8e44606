//! All data that determine the next step. A clone is a checkpoint.

use carom_contact::{Pair, Pairing};
use carom_solid::Configuration;
use educe::Educe;
use serde::{Deserialize, Serialize};

use crate::check::overlapping::Overlap;
use crate::materials::Materials;
use crate::model::Model;
use crate::stage::renewal::FrozenTangent;

/// Bisections of a grid step that the fallback takes, and of the next one.
pub(crate) const FEW: u32 = 4;

/// Energies and works (`ledger.rs`), cumulative from the start of the run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// ½ vᵀM v.
    pub kinetic: f64,
    /// U, of the bodies and of penalty springs.
    pub strain: f64,
    /// The contribution of the springs.
    pub springs: f64,
    /// The contribution of tangential springs to that.
    pub stick_springs: f64,
    /// Potential of constant conservative loads.
    pub potential: f64,
    /// Total energy at the start.
    pub total_at_start: f64,
    /// Work of loads without potential, of supports and of moving primaries.
    pub external_work: f64,
    /// Work on the momentum of velocities that `external_work` lacks (`works.rs`). Contact of
    /// explicit schemes adds the work of its forces over the tolerance of gaps.
    pub unbooked: f64,
    /// Δy·x of forces from which accelerations still differ (`works.rs`).
    pub relaxing: f64,
    /// Work of the contact forces on the bodies, and the jumps of kinetic energy at activation.
    pub contact_work: f64,
    /// Work of friction on the bodies.
    pub friction_work: f64,
    /// Slip so far.
    pub rubbed: SlipTotals,
    /// Energy that conserving contact with a restitution has still to return; negative if it
    /// created some (`restitution.rs`).
    pub owed: f64,
    /// Largest kinetic + strain energy at the end of a step so far.
    pub largest: f64,
    /// Energy created so far.
    pub created: Created,
    /// Energy that materials have dissipated.
    pub materials: f64,
    /// Part of the impulses of contact that projections and changes of the step move between
    /// velocities and algorithmic accelerations.
    pub algorithmic_impulse: [f64; 3],
}

impl Ledger {
    /// Sum of kinetic, strain and potential energy.
    pub fn total(&self) -> f64 {
        self.kinetic + self.strain + self.potential
    }

    /// Energy dissipated by the scheme, beyond what materials dissipate; negative if created.
    pub fn dissipation(&self) -> f64 {
        self.external_work + self.contact_work + self.friction_work
            - (self.total() - self.total_at_start)
            - self.materials
    }

    /// Change of the energy since the start beyond the work of loads and supports.
    pub fn drift(&self) -> f64 {
        self.total() - self.total_at_start - self.external_work
    }
}

/// What pairs with friction did so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SlipTotals {
    /// Σ over the pairs of the time in which they were closed, and in which they stuck.
    pub contact_time: f64,
    /// See `contact_time`.
    pub stick_time: f64,
    /// Largest slip of a pair since it closed.
    pub farthest: f64,
}

/// The running minimum of E, and what rose above it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Created {
    pub(crate) lowest: f64,
    /// [`Ledger::unbooked`] at that minimum.
    pub(crate) unbooked: f64,
    /// Largest rise so far beyond what was not booked since then.
    pub(crate) most: f64,
    /// Σ |ΔW_ext| so far, and W_ext at its last term.
    pub(crate) worked: f64,
    pub(crate) work: f64,
}

impl Created {
    /// The most that was created so far.
    pub fn most(&self) -> f64 {
        self.most
    }
}

/// Contact's part of the algorithmic accelerations.
#[derive(Debug, Default, Educe, PartialEq, Serialize, Deserialize)]
#[educe(Clone)]
pub struct Carried {
    /// Step with which it counts; 0 before the first one.
    pub(crate) dt: f64,
    /// Contact's part of Σ M a on each secondary side.
    pub(crate) forces: Vec<[f64; 3]>,
}

impl Carried {
    /// At the start, where accelerations satisfy the balance.
    pub(crate) fn at_start(forces: &[[f64; 3]]) -> Self {
        Self { dt: 0.0, forces: forces.to_vec() }
    }

    /// The last step that was taken, a bisected one too; none before the first.
    pub fn dt(&self) -> Option<f64> {
        (self.dt > 0.0).then_some(self.dt)
    }
}

/// Data of the previous step, for a two-step scheme or a guess.
#[derive(Debug, Default, Educe, PartialEq, Serialize, Deserialize)]
#[educe(Clone)]
pub struct Previous {
    /// Size of that step, which must equal the next one.
    pub dt: f64,
    /// Increment of positions over it.
    pub increment: Vec<f64>,
    /// Velocities at its start.
    pub velocity: Vec<f64>,
    /// Means over it.
    pub means: Means,
}

/// Means over a step, weighting start and stages as its velocity update; flat over all dofs.
#[derive(Debug, Default, Educe, PartialEq, Serialize, Deserialize)]
#[educe(Clone)]
pub struct Means {
    /// Contact forces.
    pub contact: Vec<f64>,
    /// The part of friction in them; empty without friction.
    pub friction: Vec<f64>,
    /// Loads without gravity.
    pub loads: Vec<f64>,
    /// Forces of moving supports; zero at other dofs.
    pub supports: Vec<f64>,
    /// Accelerations of moving supports; zero at other dofs.
    pub accelerations: Vec<f64>,
    /// Contact force on each secondary side.
    pub contact_forces: Vec<[f64; 3]>,
}

impl Means {
    /// Zero means.
    pub fn new(dofs: usize, contacts: usize) -> Self {
        let mut means = Self::default();
        means.clear(dofs, contacts);
        means
    }

    /// Resets to zero.
    pub(crate) fn clear(&mut self, dofs: usize, contacts: usize) {
        for mean in [&mut self.contact, &mut self.loads, &mut self.supports, &mut self.accelerations] {
            mean.clear();
            mean.resize(dofs, 0.0);
        }
        self.friction.clear();
        self.contact_forces.clear();
        self.contact_forces.resize(contacts, [0.0; 3]);
    }
}

/// The half-step velocity of an explicit scheme, which leads the state's time.
#[derive(Debug, Default, Educe, PartialEq, Serialize, Deserialize)]
#[educe(Clone)]
pub struct HalfStepVelocity {
    /// v_{n+½}, for which y_{n+1} = y_n + Δt v_{n+½} is admissible.
    pub velocity: Vec<f64>,
    /// Its Δt; 0 if not yet known. A step of another size starts from v_n.
    pub dt: f64,
    /// The longest step since a pair went behind its facet; Δt if none is.
    pub longest: f64,
}

/// A state that a model cannot be continued from.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the state belongs to another model: {what}")]
pub struct OtherModel {
    what: String,
}

/// The state at the end of a step.
#[derive(Debug, Default, Educe, PartialEq, Serialize, Deserialize)]
#[educe(Clone)]
pub struct State {
    /// Step on the grid of times.
    pub step: u64,
    /// Time; step·Δt on the grid.
    pub time: f64,
    /// Positions, flat.
    pub y: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Algorithmic accelerations: carried, never recomputed from the balance.
    pub a: Vec<f64>,
    /// M⁻¹GᵀP/Δt of the impulses of the last step that are not in `a`; empty where all are.
    pub jumps: Vec<f64>,
    /// Internal forces at `y`.
    pub f_internal: Vec<f64>,
    /// Loads at `y` without gravity, for the next step.
    pub f_external: Vec<f64>,
    /// Σ Gᵀλ of the contacts, for the next step.
    pub f_contact: Vec<f64>,
    /// The part of friction in it; empty without friction.
    pub f_friction: Vec<f64>,
    /// The part in it of contacts that act entirely at the end of a step; empty without.
    pub f_at_end: Vec<f64>,
    /// The part of friction in that; empty without.
    pub f_friction_at_end: Vec<f64>,
    /// Force on the secondary side of each contact.
    pub contact_forces: Vec<[f64; 3]>,
    /// Impulse of each contact on its secondary side since the start, projections included.
    pub impulses: Vec<[f64; 3]>,
    /// Contact's part of the algorithmic accelerations.
    pub carried: Carried,
    /// Pairs of each contact.
    pub pairs: Vec<Vec<Pair>>,
    /// Energies and works.
    pub ledger: Ledger,
    /// The previous step, for a two-step scheme and for load steps of materials that remember; none
    /// at the start and after an activation without a projection of velocities.
    pub previous: Option<Previous>,
    /// For an explicit scheme.
    pub half_step: HalfStepVelocity,
    /// The data of the reused factor.
    pub frozen: FrozenTangent,
    /// Recently bisected grid steps.
    pub bisection: Bisection,
    /// What has overlapped without a contact, each pair once; a body with itself if it has crossed
    /// itself.
    pub overlaps: Vec<Overlap>,
    /// What the materials remember.
    pub materials: Materials,
}

/// A vector of a state over all dofs.
pub(crate) struct OverDofs<'a> {
    /// Name in messages.
    what: &'static str,
    /// Whether it may be empty.
    may_lack: bool,
    pub(crate) values: &'a mut Vec<f64>,
}

impl State {
    /// Positions and memory of the materials, at which forces and tangents are asked for.
    pub fn configuration(&self) -> Configuration<'_> {
        Configuration { before: None, y: &self.y, past: self.materials.past(0.0) }
    }

    /// Every vector over the dofs.
    pub(crate) fn over_dofs(&mut self) -> Vec<OverDofs<'_>> {
        let always = |what, values| OverDofs { what, may_lack: false, values };
        let may_lack = |what, values| OverDofs { what, may_lack: true, values };
        let mut all = vec![
            always("positions", &mut self.y),
            always("velocities", &mut self.v),
            always("accelerations", &mut self.a),
            may_lack("jumps of velocities", &mut self.jumps),
            always("internal forces", &mut self.f_internal),
            always("loads", &mut self.f_external),
            always("contact forces", &mut self.f_contact),
            may_lack("forces of friction", &mut self.f_friction),
            may_lack("contact forces at the end of steps", &mut self.f_at_end),
            may_lack("friction at the end of steps", &mut self.f_friction_at_end),
            may_lack("velocities at half a step", &mut self.half_step.velocity),
        ];
        if let Some(Previous { increment, velocity, means, .. }) = &mut self.previous {
            let of_step = [
                increment,
                velocity,
                &mut means.contact,
                &mut means.loads,
                &mut means.supports,
                &mut means.accelerations,
            ];
            all.extend(of_step.map(|values| always("values of a previous step", values)));
            all.push(may_lack("means of friction", &mut means.friction));
        }
        all
    }

    /// Every list of a resultant for each contact, with its name in messages.
    pub(crate) fn over_contacts(&mut self) -> Vec<(&'static str, &mut Vec<[f64; 3]>)> {
        let mut all = vec![
            ("contacts with forces", &mut self.contact_forces),
            ("contacts with impulses", &mut self.impulses),
            ("contacts with forces in accelerations", &mut self.carried.forces),
        ];
        if let Some(previous) = &mut self.previous {
            all.push(("contacts with means", &mut previous.means.contact_forces));
        }
        all
    }

    /// Smallest J over all quadrature points: known from the pass that computed the forces, or
    /// found by one of its own.
    pub fn min_det_f(&self, model: &Model) -> f64 {
        let found = || model.min_det_f(&self.y, self.materials.past(0.0).memory);
        self.materials.min_det_f.unwrap_or_else(found)
    }

    /// Whether every vector, and node and facet of every pair, exist in this model, and all
    /// positions, velocities and accelerations are finite.
    ///
    /// # Errors
    /// What does not.
    pub fn fits(&self, model: &Model) -> Result<(), OtherModel> {
        let is = |what: &str, got: usize, wanted: usize| {
            let what = format!("it has {got} {what}, this one {wanted}");
            if got == wanted { Ok(()) } else { Err(OtherModel { what }) }
        };
        let mut copy = self.clone();
        for OverDofs { what, may_lack, values } in copy.over_dofs() {
            if !(may_lack && values.is_empty()) {
                is(what, values.len(), model.dofs())?;
            }
        }
        is("contacts with pairs", self.pairs.len(), model.contacts.len())?;
        for (what, resultants) in copy.over_contacts() {
            is(what, resultants.len(), model.contacts.len())?;
        }
        let is_finite = |dof: usize| (self.y[dof] + self.v[dof] + self.a[dof]).is_finite();
        if let Some(dof) = (0..model.dofs()).find(|&dof| !is_finite(dof)) {
            let what = format!("position, velocity or acceleration {dof} is not finite");
            return Err(OtherModel { what });
        }
        is("numbers of memory", self.materials.memory.len(), model.memory())?;
        if let Some(point) = &self.frozen.point {
            is("positions of a factor", point.at.len(), model.dofs())?;
        }
        for (pairs, contact) in self.pairs.iter().zip(&model.contacts) {
            let nodes = contact.kinematics.secondary().len();
            if let Some(pair) = pairs.iter().find(|pair| pair.node >= nodes) {
                let what = format!("node {} of contact \"{}\" with {nodes} nodes", pair.node, contact.name);
                return Err(OtherModel { what });
            }
            if !pairs.is_sorted_by_key(|pair| pair.node) {
                let what = format!("the pairs of contact \"{}\" are not in the order of nodes", contact.name);
                return Err(OtherModel { what });
            }
            let facets = |pair: &Pair| contact.kinematics.facets(pair.node);
            if let Some(pair) = pairs.iter().find(|pair| pair.facet >= facets(pair)) {
                let facet = pair.facet;
                let facets = facets(pair);
                let what = format!(
                    "facet {facet} of the primary of contact \"{}\", which has {facets}",
                    contact.name
                );
                return Err(OtherModel { what });
            }
        }
        Ok(())
    }

    /// The closed pair at this state, the start of a step, of a pair within the step or at its end.
    pub(crate) fn past(&self, contact: usize, pair: &Pair) -> Option<&Pair> {
        self.closed(contact, pair.node.wrapping_add_signed(pair.handed))
    }

    /// The first closed pair of a secondary node.
    pub(crate) fn closed(&self, contact: usize, node: usize) -> Option<&Pair> {
        let pairs = &self.pairs[contact];
        let first = pairs.partition_point(|other| other.node < node);
        pairs[first..].iter().take_while(|other| other.node == node).find(|pair| pair.active)
    }

    /// Impulse of all contacts on their secondary sides since the start.
    pub fn impulse(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.impulses.iter().map(|impulse| impulse[i]).sum())
    }

    /// Becomes a copy of another state, in reused memory, whose positions, velocities,
    /// accelerations, internal forces, memory and half-step velocities are not copied: a step
    /// overwrites them. Contact forces are zero.
    pub(crate) fn follow(&mut self, start: &Self) {
        let Self { step, time, y, f_external, f_friction, contact_forces, impulses, .. } = start;
        let Self { carried, pairs, ledger, previous, half_step, frozen, .. } = start;
        let Self { bisection, overlaps, materials, .. } = start;
        self.step = *step;
        self.time = *time;
        for vector in [
            &mut self.y,
            &mut self.v,
            &mut self.a,
            &mut self.f_internal,
            &mut self.f_contact,
            &mut self.half_step.velocity,
        ] {
            vector.resize(y.len(), 0.0);
        }
        self.jumps.clear();
        self.f_contact.fill(0.0);
        self.f_external.clone_from(f_external);
        self.f_friction.clone_from(f_friction);
        self.f_at_end.clear();
        self.f_friction_at_end.clear();
        self.contact_forces.clone_from(contact_forces);
        self.impulses.clone_from(impulses);
        self.carried.clone_from(carried);
        self.pairs.clone_from(pairs);
        self.ledger.clone_from(ledger);
        self.previous.clone_from(previous);
        self.half_step.dt = half_step.dt;
        self.half_step.longest = half_step.longest;
        self.frozen.clone_from(frozen);
        self.bisection = *bisection;
        self.overlaps.clone_from(overlaps);
        self.materials.follow(materials);
    }

    /// Opens the pairs of single nodes for which a field of pressure presses, which have no
    /// multiplier.
    pub(crate) fn open_covered(&mut self, model: &Model) {
        for (contact, pairs) in model.contacts.iter().zip(&mut self.pairs) {
            let covered = pairs.iter_mut().filter(|pair| pair.lambda == 0.0 && contact.bounds(pair));
            covered.for_each(|pair| pair.active = false);
        }
    }

    /// Takes over the pairs at the end of a solve.
    pub(crate) fn take_pairs(&mut self, pairings: &[Pairing]) {
        self.pairs.iter_mut().zip(pairings).for_each(|(pairs, pairing)| pairs.clone_from(&pairing.pairs));
    }
}

/// Bisected grid steps: after several in a row the next 1, 3, 7, … start with half the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bisection {
    /// Remaining grid steps that start with half the step.
    left: u32,
    /// Their number after the next bisected step.
    next: u32,
    /// Whether the fallback took the last grid step.
    fell_back: bool,
}

impl Bisection {
    /// Largest number of grid steps that start with half the step before a full one is tried.
    const MOST: u32 = 63;

    /// Initial number of bisections of the next grid step.
    pub(crate) fn level(self) -> u32 {
        u32::from(self.left > 0)
    }

    /// Update after a grid step; `bisected`: whether the full step was rejected.
    #[must_use]
    pub(crate) fn after(self, bisected: bool) -> Self {
        match (self.left, bisected) {
            (0, false) => Self::default(),
            (0, true) => {
                Self { left: self.next, next: (2 * self.next + 1).min(Self::MOST), fell_back: false }
            }
            (left, _) => Self { left: left - 1, next: self.next, fell_back: false },
        }
    }

    /// Update after a grid step that the fallback took.
    #[must_use]
    pub(crate) fn after_fallback(self) -> Self {
        Self { fell_back: true, ..self.after(true) }
    }

    /// Bisections of the next grid step, of at most so many: after one that the fallback took it is
    /// likely to take the next one, too.
    pub(crate) fn limit(self, most: u32) -> u32 {
        if self.fell_back { most.min(FEW) } else { most }
    }
}
