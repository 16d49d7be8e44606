//! Buffers of the explicit stepper.

use carom_algebra::{Couplings, Kind};
use carom_contact::{Along, Pairing, Rows};

use super::forward::Moved;
use super::tied_mass::TiedMass;
use crate::model::LoadsAt;

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
}
