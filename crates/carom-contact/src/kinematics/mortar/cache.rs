//! Quadrature points and gaps of the secondary facets at one configuration.

use super::cut::Regions;
use super::joint::Joint;
use super::multipliers::MOST;
use super::patch::Patch;

/// A secondary facet at one configuration.
#[derive(Debug, Default)]
pub(super) struct Faced {
    /// Whether its points have been found.
    pub(super) is_measured: bool,
    /// Points of quadrature, by the facet of the primary that they face, and the terms of the
    /// gradient from the motion of the ends of the primary (`border.rs`).
    pub(super) patches: Vec<Patch>,
    /// Joints of the primary over the facet.
    pub(super) joints: Vec<Joint>,
    /// Range of ξ that faces the primary.
    pub(super) ends: Option<[f64; 2]>,
    /// For each polynomial the one whose multiplier carries it, once it is known.
    pub(super) carriers: Option<[usize; MOST]>,
}

/// The facets at one configuration, measured when they are first asked for: few are near the other
/// side.
#[derive(Debug, Default)]
pub(super) struct Cache {
    /// Positions of the nodes of both sides.
    pub(super) places: Vec<f64>,
    /// Facets of the primary with their regions.
    pub(super) regions: Regions,
    /// The facets of the secondary side.
    pub(super) of_facets: Vec<Faced>,
}
