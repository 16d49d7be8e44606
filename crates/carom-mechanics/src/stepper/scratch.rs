//! Buffers of the explicit stepper.

use carom_algebra::Kind;
use carom_contact::{Along, Pairing, Rows};

use super::tied_mass::TiedMass;
use crate::model::LoadsAt;

/// Buffers of a step.
#[derive(Debug)]
pub(crate) struct Scratch {
    /// v_{n+½} without contact.
    pub free: Vec<f64>,
    /// Positions to be evaluated, and forces of contact.
    pub at: Vec<f64>,
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
            pairings: Vec::new(),
            rows: Vec::new(),
            impulses: Vec::new(),
            places: Vec::new(),
            acting: Rows::new(dimension),
            slips: Rows::new(dimension),
            along: Vec::new(),
            kinds: Vec::new(),
            loaded: Vec::new(),
            loads: LoadsAt::default(),
            ties: None,
        }
    }
}
