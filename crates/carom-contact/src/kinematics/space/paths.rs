//! Boxes of the facets' paths in a step, in the frame of their mean motion: which facets are near a
//! node, and which it may cross.

use carom_solid::{Bounds, Hull, Tree};

use super::boundary::Boundary;
use super::patch::{PatchPoint, place};
use crate::constants::{ON_FACET, ROUND_OFF};
use crate::kinematics::Facets;
use crate::kinematics::drift::Drift;

/// Bounding boxes of the paths of all facets in a step, in memory that searches reuse.
#[derive(Debug, Default)]
pub(super) struct Paths {
    /// Hierarchy of the boxes of the paths of facets, with a margin.
    tree: Tree,
    /// Boxes of the paths of facets without a margin.
    tight: Vec<Bounds>,
    start: Start,
    drift: Drift,
}

/// Distance from a facet at which a node is near it.
#[derive(Clone, Copy)]
pub(super) struct Around {
    /// Relative to the size of the facet's path.
    pub(super) margin: f64,
    /// The largest depth, or distance, at which the gap of a node is zero.
    pub(super) distance: f64,
}

/// Positions and boxes of all facets at the start of a step, which several searches share.
#[derive(Debug, Default)]
struct Start {
    /// Coordinates of the nodes of all facets.
    places: Vec<f64>,
    boxes: Vec<Bounds>,
    /// Position and normal in the middle of each facet.
    middles: Vec<PatchPoint>,
}

impl Start {
    fn update(&mut self, primary: &Boundary, hull: &Hull, y: &[f64]) {
        let places = || primary.nodes().iter().flat_map(|&node| place(y, node).0);
        if !self.places.is_empty() && self.places.iter().copied().eq(places()) {
            return;
        }
        let Self { places: known, boxes, middles } = self;
        known.clear();
        known.extend(places());
        boxes.clear();
        boxes.extend((0..primary.all()).map(|facet| primary.bounds(hull, facet, y)));
        middles.clear();
        middles.extend((0..primary.all()).map(|facet| primary.middle(facet, y)));
    }
}

impl Paths {
    /// Updates the boxes to the motion of a step; those of the hierarchy are grown by `margin` of
    /// their sizes, and at least by `distance`.
    pub(super) fn update(
        &mut self,
        primary: &Boundary,
        hull: &Hull,
        Around { margin, distance }: Around,
        [before, now]: [&[f64]; 2],
    ) {
        self.start.update(primary, hull, before);
        self.drift = Drift::of(primary.nodes().iter().copied(), 3, [before, now]);
        let boxes = self.start.boxes.iter().enumerate();
        self.tight.clear();
        self.tight.extend(boxes.map(|(facet, old)| self.drift.path(*old, primary.bounds(hull, facet, now))));
        let tight = &self.tight;
        self.tree
            .place(tight.len(), |facet| tight[facet].grown((margin * tight[facet].size()).max(distance)));
    }

    /// The middle of a facet at the start of the step.
    pub(super) fn middle(&self, facet: usize) -> PatchPoint {
        self.start.middles[facet]
    }

    /// The hierarchy of the boxes with a margin.
    pub(super) fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Finds the facets near a node's path, ascending.
    pub(super) fn find_into(&self, node: usize, ends: [&[f64]; 2], near: &mut Vec<usize>) {
        self.tree.find_into(&self.path(node, ends), near);
    }

    /// Box of the path of a node.
    pub(super) fn path(&self, node: usize, ends: [&[f64]; 2]) -> Bounds {
        let [old, new] = ends.map(|y| Bounds::of(&place(y, node).0));
        let path = self.drift.path(old, new);
        path.grown(ROUND_OFF * path.size())
    }

    /// The frame of the boxes.
    pub(super) fn drift(&self) -> Drift {
        self.drift
    }

    /// Whether a node may meet a facet on its path, rather than only be near it.
    pub(super) fn may_cross(&self, path: &Bounds, facet: usize) -> bool {
        let tight = &self.tight[facet];
        tight.grown(ON_FACET * tight.size()).meets(path)
    }
}
