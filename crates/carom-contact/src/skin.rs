//! The whole boundary of a body in the plane: how deep a point lies inside.
//!
//! The nearest point of the boundary decides (`depth.rs`). Independent of pairs, sides and history,
//! so that it can judge them.

use carom_algebra::Vector;
use carom_solid::{Bounds, Hull, Tree};

use crate::constants::SHALLOW;
use crate::depth::NearestOnFacet;
use crate::kinematics::{Depth, Facets, Folds, Side, Surface, Turns, amplification};
use crate::places::Places;

/// The whole boundary of a body in the plane, to tell how deep a point lies inside.
#[derive(Debug)]
pub struct Skin {
    surface: Surface,
    hull: Hull,
    tree: Tree,
    /// For nodes of the boundary itself: the order of the facets and the turns of the boundary.
    folds: Option<(Folds, Turns)>,
}

impl Skin {
    /// A closed boundary of all facets of a body in the plane.
    pub fn new(surface: Surface) -> Self {
        let hull = Hull::facet(surface.shape());
        Self { surface, hull, tree: Tree::default(), folds: None }
    }

    /// Allows nodes of the boundary itself to be measured; `piece`: the connected piece of the body
    /// to which each node belongs, from `first_node` on; `reference`: the reference positions, flat
    /// over all nodes.
    #[must_use]
    pub fn with_pieces(self, piece: &[usize], first_node: usize, reference: &[f64]) -> Self {
        let folds = Folds::new(&self.surface, piece, first_node, reference);
        Self { folds: Some((folds, Turns::default())), ..self }
    }

    pub(crate) fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Global numbers of the nodes of a facet.
    pub fn facet_nodes(&self, facet: usize) -> &[usize] {
        self.surface.nodes_of(facet)
    }

    /// Largest ratio of the motion of a point of a facet to that of its nodes: the largest Σ |φᵅ|.
    pub fn amplification(&self) -> f64 {
        amplification(self.surface.shape())
    }

    /// Moves the boundary to positions `y`, flat over all nodes.
    pub fn update(&mut self, y: &[f64]) {
        let surface = &self.surface;
        let hull = &self.hull;
        if let Some((folds, turns)) = &mut self.folds {
            turns.update(folds, surface, Places::new(y, 2));
        }
        self.tree.place(surface.all(), |facet| surface.bounds(hull, facet, y));
    }

    /// Position relative to the boundary of a point, at the positions of the last update, searched
    /// from a facet near it if one is known; `None` without a boundary.
    pub fn depth(&self, point: [f64; 2], from: Option<usize>, y: &[f64]) -> Option<Depth> {
        let surface = &self.surface;
        let at = Vector(point);
        let (facet, _) = self.tree.nearest(&point, from, |facet| {
            (!surface.is_mirror(facet)).then(|| surface.distance(facet, at, y))
        })?;
        Some(surface.depth(facet, at, y))
    }

    /// Position of a node of the boundary relative to those parts of the boundary that it may meet
    /// and that lie on the given side of it in the order of facets, if one is nearer than `reach`.
    pub fn depth_of(&self, node: usize, side: Side, reach: f64, y: &[f64]) -> Option<Depth> {
        let (folds, turns) = self.folds.as_ref()?;
        let places = Places::new(y, 2);
        let point = places.at(node);
        let meets = |facet: usize| folds.admits(side, node, facet) && folds.face(turns, node, facet);
        let mut nearest: Option<(usize, f64)> = None;
        for facet in self.tree.meeting(&Bounds::of(&point.0).grown(reach)).filter(|&facet| meets(facet)) {
            let NearestOnFacet { xi, distance } = self.surface.nearest(facet, point, places);
            // An end next to what the node cannot meet, such as its own facet, is no place to
            // enter.
            let beyond = || self.surface.neighbour(facet, xi > 0.0);
            if xi.abs() >= 1.0 && !beyond().is_some_and(meets) {
                continue;
            }
            let least = nearest.map_or(reach, |(_, least)| least);
            // The first of equals, in whatever order the tree finds them.
            if distance < least || distance == least && nearest.is_some_and(|(first, _)| facet < first) {
                nearest = Some((facet, distance));
            }
        }
        let (facet, _) = nearest?;
        let found = self.surface.depth(facet, point, y);
        // Behind a winding of a spiral, or another part, a node is not inside that facet.
        let is_behind = -found.distance > SHALLOW * self.surface.length(facet, places);
        if is_behind && !self.surface.covers(node, places) {
            return Some(Depth { distance: -found.distance, ..found });
        }
        Some(found)
    }

    /// Distance between a point and the point ξ of a facet, which need not be the nearest one.
    pub fn distance(&self, facet: usize, xi: f64, point: [f64; 2], y: &[f64]) -> f64 {
        (Vector(point) - self.surface.facet(facet).at(Places::new(y, 2), xi).position).norm()
    }

    /// Whether two facets that do not meet at a joint cross each other at the positions of the last
    /// update; curved ones as chains of chords. Pairs that are `known` do not count.
    pub fn crosses_itself(&self, y: &[f64], known: impl Fn(usize, usize) -> bool) -> bool {
        let places = Places::new(y, 2);
        let chords = if self.surface.shape().nodes() == 2 { 1 } else { CHORDS };
        let at = |facet: usize, k: usize| {
            self.surface.facet(facet).at(places, 2.0 * k as f64 / chords as f64 - 1.0).position
        };
        let crossing = |a: usize, b: usize| {
            (0..chords).any(|i| {
                let first = [at(a, i), at(a, i + 1)];
                (0..chords).any(|j| cross(first, [at(b, j), at(b, j + 1)]))
            })
        };
        (0..self.surface.all()).any(|a| {
            let bounds = self.surface.bounds(&self.hull, a, y);
            self.surface.apart_from(a, &bounds, &self.tree).any(|b| b > a && !known(a, b) && crossing(a, b))
        })
    }

    /// Change of a coordinate of a node, apart from a motion of all nodes together, before two
    /// facets that do not meet at a joint can cross; 0 where two are near at the positions of the
    /// last update.
    pub fn clearance_to_itself(&self, y: &[f64]) -> f64 {
        self.surface.clearance(&self.hull, &self.tree, y)
    }
}

/// Number of chords by which a curved facet is approximated.
pub(crate) const CHORDS: usize = 4;

/// Whether two segments cross, their ends not included.
fn cross(a: [Vector<2>; 2], b: [Vector<2>; 2]) -> bool {
    let side = |[p, q]: [Vector<2>; 2], r: Vector<2>| {
        let u = q - p;
        let v = r - p;
        u[0] * v[1] - u[1] * v[0]
    };
    side(a, b[0]) * side(a, b[1]) < 0.0 && side(b, a[0]) * side(b, a[1]) < 0.0
}
