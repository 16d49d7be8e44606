//! Buffers of the explicit stepper.

use carom_algebra::{Couplings, Kind};
use carom_contact::{Along, Pairing, Rows};

use super::forward::Moved;
use super::tied_mass::TiedMass;
use crate::model::{LoadsAt, Model};
use crate::state::State;

/// Buffers of a step.
#[derive(Debug)]
pub(crate) struct Scratch {
    /// v_{n+½} without contact.
    pub free: Vec<f64>,
    /// Forces of contact while they are added up; zero otherwise.
    pub at: Vec<f64>,
    /// Positions at the end of the step.
    pub moved: Moved,
    /// Dofs along which the impulses act.
    pub touched: Vec<usize>,
    pub pairings: Vec<Pairing>,
    pub rows: Vec<Rows>,
    pub impulses: Vec<f64>,
    /// Contact and pair of each impulse.
    pub places: Vec<(usize, usize)>,
    /// Rows that the impulses act along: the gaps of these places, then slips.
    pub acting: Rows,
    /// H of a pair.
    pub slips: Rows,
    /// The components of the rows of slips.
    pub along: Vec<Along>,
    pub kinds: Vec<Kind>,
    /// G M⁻¹Gᵀ over these rows.
    pub matrix: Couplings,
    /// Their motions without forces.
    pub right: Vec<f64>,
    /// Contact, node and facet of the forces before a search.
    pub loaded: Vec<(usize, usize, usize)>,
    pub loads: LoadsAt,
    /// The ties, once they have been factored.
    pub ties: Option<TiedMass>,
}

impl Scratch {
    /// Empty buffers.
    pub(crate) fn new(dimension: usize) -> Self {
        Self {
            free: Vec::new(),
            at: Vec::new(),
            moved: Moved::default(),
            touched: Vec::new(),
            pairings: Vec::new(),
            rows: Vec::new(),
            impulses: Vec::new(),
            places: Vec::new(),
            acting: Rows::new(dimension),
            slips: Rows::new(dimension),
            along: Vec::new(),
            kinds: Vec::new(),
            matrix: Couplings::default(),
            right: Vec::new(),
            loaded: Vec::new(),
            loads: LoadsAt::default(),
            ties: None,
        }
    }

    /// Writes the forces of the last impulses into a state: on its nodes, and on the secondary side
    /// of each contact. They act along the rows that the impulses were found with: where a pair has
    /// gone on to another facet since, its row has another direction.
    pub(crate) fn add_up(&self, model: &Model, state: &mut State) {
        state.f_contact.fill(0.0);
        state.contact_forces.fill([0.0; 3]);
        let count = self.places.len();
        let mut forces = self.acting.iter().zip(&self.impulses);
        for ((row, force), (contact, _)) in forces.by_ref().take(count).zip(&self.places) {
            row.add_to(-force, &mut state.f_contact);
            let normal = row.normal();
            (0..3).for_each(|i| state.contact_forces[*contact][i] += force * normal[i]);
        }
        if !model.has_friction() {
            return;
        }
        state.f_friction.clear();
        state.f_friction.resize(state.y.len(), 0.0);
        let mut on_sides = vec![[0.0; 3]; model.contacts.len()];
        for ((row, force), kind) in forces.zip(&self.kinds[count..]) {
            row.add_to(-force, &mut state.f_friction);
            let Kind::Tangential { of, .. } = *kind else { continue };
            let (contact, _) = self.places[of];
            let along = row.normal();
            (0..3).for_each(|i| on_sides[contact][i] += force * along[i]);
        }
        state.f_contact.iter_mut().zip(&state.f_friction).for_each(|(force, part)| *force += part);
        for (force, friction) in state.contact_forces.iter_mut().zip(on_sides) {
            (0..3).for_each(|i| force[i] += friction[i]);
        }
    }
}
