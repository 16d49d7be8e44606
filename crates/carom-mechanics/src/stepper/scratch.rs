//! Buffers of the explicit stepper.

use carom_contact::{Pairing, Rows};

use crate::model::LoadsAt;

/// Buffers of a step.
#[derive(Debug, Default)]
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
    /// Contact, node and facet of the forces before a search.
    pub loaded: Vec<(usize, usize, usize)>,
    pub loads: LoadsAt,
}
