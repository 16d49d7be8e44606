//! A primary side as a chain of curved facets in global node numbers, with neighbours, and the
//! search for facets near a node's path.

use std::collections::{HashMap, HashSet};

use carom_algebra::Vector;
use carom_solid::{Bounds, FacetShape, Hull, Tree};

use super::apart::Apart;
use super::drift::Drift;
use super::facets::Facets;
use super::mirror::{Continuation, Continuations, contains, is_mirror, reflected};
use super::projection::Facet;
use crate::constants::{KINK, PATH_MARGIN};
use crate::places::Places;

/// The facets of a side in the plane, all of one shape, and their neighbours. The rest of the
/// boundary of the body may follow them, so that a node near the end of the side is told from one
/// that is behind it.
#[derive(Clone, Debug)]
pub struct Surface {
    pub(crate) shape: FacetShape,
    pub(crate) nodes: Vec<usize>,
    orientations: Vec<f64>,
    neighbours: Vec<[Option<usize>; 2]>,
    /// Number of facets of the side, which come before those of the rest of the boundary.
    side: usize,
    /// Number of facets of the side and of its siblings, the adjoining sides, which come next.
    siblings: usize,
    is_whole: bool,
    /// Continuations of the surface where facets begin that are no surface.
    continuations: Continuations,
}

/// The turn of the tangent at the joint of two facets, as the cosine and the sine of its angle;
/// left turns are positive.
pub(crate) struct Kink {
    pub(crate) cosine: f64,
    pub(crate) sine: f64,
}

impl Kink {
    /// The kink between two tangents.
    pub(crate) fn between([here, there]: [Vector<2>; 2]) -> Self {
        let size = here.norm() * there.norm();
        let sine = (here[0] * there[1] - here[1] * there[0]) / size;
        Self { cosine: here.dot(&there) / size, sine }
    }

    /// Whether the joint is smooth, but for this kink.
    pub(crate) fn is_small(&self) -> bool {
        self.cosine > KINK.cosine
    }
}

impl Surface {
    /// A side from its facets, given as lists of global nodes (start, end, interior), traversed
    /// with the body on their left; `orientations` only matters for points
    /// ([`Mesh::orientation`](carom_solid::Mesh::orientation)).
    ///
    /// # Panics
    /// For facets in space, whose sides are of type [`Boundary`](crate::Boundary).
    pub fn new(shape: FacetShape, facets: &[Vec<usize>], orientations: &[f64]) -> Self {
        assert!(shape.dimension() < 3, "contact of surfaces in space");
        let end = |facet: &[usize]| facet[shape.nodes().min(2) - 1];
        let starts: HashMap<usize, usize> = facets.iter().enumerate().map(|(k, f)| (f[0], k)).collect();
        let ends: HashMap<usize, usize> = facets.iter().enumerate().map(|(k, f)| (end(f), k)).collect();
        let neighbours_of = |f: &Vec<usize>| [ends.get(&f[0]).copied(), starts.get(&end(f)).copied()];
        let none = |_| [None, None];
        let neighbours: Vec<[Option<usize>; 2]> = match shape {
            FacetShape::Point => facets.iter().map(none).collect(),
            _ => facets.iter().map(neighbours_of).collect(),
        };
        let nodes = facets.concat();
        let orientations = orientations.to_vec();
        let is_whole = neighbours.iter().flatten().all(Option::is_some);
        Self {
            shape,
            nodes,
            orientations,
            neighbours,
            side: facets.len(),
            siblings: facets.len(),
            is_whole,
            continuations: Continuations::default(),
        }
    }

    /// Adds the `rest` of the boundary of the body, whose facets are traversed with the body on
    /// their left and only tell where the side ends. The first `siblings` of them belong to sides
    /// that other contacts keep the same nodes away from: a joint with one belongs to the facet
    /// that ends there.
    #[must_use]
    pub fn bounded_by(self, rest: &[Vec<usize>], siblings: usize) -> Self {
        let of_side = self.nodes.chunks_exact(self.shape.nodes()).map(<[usize]>::to_vec);
        let facets: Vec<Vec<usize>> = of_side.chain(rest.iter().cloned()).collect();
        let orientations: Vec<f64> =
            self.orientations.iter().copied().chain(rest.iter().map(|_| 1.0)).collect();
        Self {
            side: self.side,
            siblings: self.side + siblings,
            ..Self::new(self.shape, &facets, &orientations)
        }
    }

    /// Marks the facets that lie in a plane of symmetry at the positions `y`; `bodies`: a box
    /// around all bodies; `is_fixed`: whether a node is fixed along an axis.
    #[must_use]
    pub fn with_mirrors(
        mut self,
        y: &[f64],
        bodies: &Bounds,
        is_fixed: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let dimension = self.shape.dimension();
        let is_mirror = |facet: &[usize]| is_mirror(facet, y, dimension, bodies, &is_fixed);
        self.continuations.mark(Continuation::Mirror, self.nodes.chunks_exact(self.shape.nodes()), is_mirror);
        self
    }

    /// Marks the facets that a tie has closed, given by their nodes in ascending order: where one
    /// begins the surface goes on along the other body.
    #[must_use]
    pub fn with_closed(mut self, closed: &HashSet<Vec<usize>>) -> Self {
        if !closed.is_empty() {
            let facets = self.nodes.chunks_exact(self.shape.nodes());
            self.continuations.mark(Continuation::Tied, facets, |facet| contains(closed, facet));
        }
        self
    }

    /// Continuation of the surface where a facet begins.
    pub(crate) fn continuation(&self, facet: usize) -> Continuation {
        self.continuations.of(facet)
    }

    /// Number of facets of the side.
    pub fn facets(&self) -> usize {
        self.side
    }

    /// Whether a facet belongs to a side with which this one forms one surface.
    pub(crate) fn is_of_sibling(&self, facet: usize) -> bool {
        (self.side..self.siblings).contains(&facet)
    }

    /// Whether the facets form closed loops: the whole boundary of the body is known.
    pub(crate) fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// Whether a facet belongs to the side.
    pub(crate) fn is_of_side(&self, facet: usize) -> bool {
        facet < self.side
    }

    /// A facet of the boundary.
    pub fn facet(&self, facet: usize) -> Facet<'_> {
        Facet { shape: self.shape, nodes: self.nodes_of(facet), orientation: self.orientations[facet] }
    }

    /// The facet that follows (or precedes) a facet in the direction of traversal.
    pub fn neighbour(&self, facet: usize, forward: bool) -> Option<usize> {
        self.neighbours[facet][usize::from(forward)]
    }

    /// The facet that follows (or precedes) a facet in the direction of traversal, if it belongs to
    /// the side and is a surface.
    pub(crate) fn neighbour_of_side(&self, facet: usize, forward: bool) -> Option<usize> {
        let is_met = |&facet: &usize| self.is_of_side(facet) && !self.is_mirror(facet);
        self.neighbour(facet, forward).filter(is_met)
    }

    /// Nodes of the side at convex corners of the boundary, ascending: kinks of more than 30° at
    /// these positions, flat over all nodes.
    pub fn corners(&self, y: &[f64]) -> Vec<usize> {
        let y = Places::new(y, self.shape.dimension());
        let mut corners = Vec::new();
        for (facet, neighbours) in self.neighbours.iter().enumerate() {
            let Some(next) = neighbours[1] else { continue };
            let on_side = self.is_of_side(facet) || self.is_of_side(next);
            if on_side && self.is_corner(facet, next, y) {
                corners.push(self.facet(next).nodes[0]);
            }
        }
        corners.sort_unstable();
        corners
    }

    /// Whether the joint of a facet and the one that follows it is a convex corner.
    pub(crate) fn is_corner(&self, facet: usize, next: usize, y: Places) -> bool {
        let kink = self.kink(facet, next, y);
        // With the body on the left, a convex joint turns left.
        kink.sine > 0.0 && kink.cosine < KINK.cosine
    }

    /// Whether the joint of a facet and the one that follows it is a concave corner.
    pub(crate) fn is_notch(&self, facet: usize, next: usize, y: Places) -> bool {
        let kink = self.kink(facet, next, y);
        kink.sine < 0.0 && kink.cosine < KINK.cosine
    }

    /// Whether the joint of a facet and the one that follows it is smooth, but for a small kink.
    pub(crate) fn is_blunt(&self, facet: usize, next: usize, y: Places) -> bool {
        self.kink(facet, next, y).is_small()
    }

    /// Normals of the `facets` that meet at a node, there and at the nodes beside it: a bent facet
    /// faces elsewhere in its middle.
    pub(super) fn normals_at<'a>(
        &'a self,
        node: usize,
        facets: &'a [usize],
        y: Places<'a>,
    ) -> impl Iterator<Item = Vector<2>> + Clone + 'a {
        facets.iter().flat_map(move |&facet| {
            let facet = self.facet(facet);
            let place = facet.nodes.iter().position(|&other| other == node).unwrap_or_default();
            let xi = facet.coordinate(place);
            let beside = 2.0 / (facet.nodes.len() - 1) as f64;
            [xi, (xi - beside).max(-1.0), (xi + beside).min(1.0)].map(|xi| facet.at(y, xi).normal)
        })
    }

    /// The facets next to a facet at a convex corner.
    pub(crate) fn across_corners<'a>(
        &'a self,
        facet: usize,
        y: Places<'a>,
    ) -> impl Iterator<Item = usize> + 'a {
        [false, true].into_iter().filter_map(move |forward| {
            let next = self.neighbour(facet, forward)?;
            let [first, second] = if forward { [facet, next] } else { [next, facet] };
            self.is_corner(first, second, y).then_some(next)
        })
    }

    /// Tangents of a facet and of the one that follows it at their joint. Behind a plane of
    /// symmetry the mirror image of the facet follows, and behind a convex corner with a facet that
    /// a tie has closed the other body, taken for the mirror image.
    pub(crate) fn tangents_at_joint(&self, facet: usize, next: usize, y: Places) -> [Vector<2>; 2] {
        let here = self.facet(facet).tangent(y, 1.0);
        let there = self.facet(next).tangent(y, -1.0);
        let mirrored = |tangent, along: Vector<2>| reflected(tangent, along * along.norm().recip());
        let is_convex = || {
            let size = here.norm() * there.norm();
            here.dot(&there) < KINK.cosine * size && here[0] * there[1] > here[1] * there[0]
        };
        let is_continued = |facet: usize| match self.continuation(facet) {
            Continuation::None => false,
            Continuation::Mirror => true,
            Continuation::Tied => is_convex(),
        };
        match [facet, next].map(is_continued) {
            [false, false] => [here, there],
            [false, true] => [here, mirrored(here, there)],
            [true, false] => [mirrored(there, here), there],
            [true, true] => [here, here],
        }
    }

    /// The kink between a facet and the one that follows it.
    pub(crate) fn kink(&self, facet: usize, next: usize, y: Places) -> Kink {
        Kink::between(self.tangents_at_joint(facet, next, y))
    }

    /// Distance between a facet's ends.
    pub(crate) fn length(&self, facet: usize, y: Places) -> f64 {
        let nodes = self.facet(facet).nodes;
        (y.at(nodes[1]) - y.at(nodes[0])).norm()
    }
}

/// Bounding boxes of the facets' paths during a step. They contain curved facets, so no near facet
/// is missed. A cache that never changes a result; O(facets) per update, O(log facets) per query.
#[derive(Debug)]
pub(crate) struct Search {
    hull: Hull,
    tree: Tree,
    found: Vec<usize>,
    apart: Apart,
    /// The frame of the boxes.
    drift: Drift,
    /// Distance from the paths of the nodes within which facets are found.
    reach: f64,
    /// Distance from the paths of facets within which nodes are near them, whatever their size.
    around: f64,
}

impl Search {
    /// A search for facets of a surface that come near the given nodes.
    pub(crate) fn new(surface: &Surface, nodes: &[usize]) -> Self {
        let hull = Hull::line(surface.shape.nodes(), 1.0);
        let both = surface.nodes.iter().chain(nodes).copied();
        let apart = Apart::new(both, surface.shape.dimension(), hull.weight());
        Self {
            hull,
            tree: Tree::default(),
            found: Vec::new(),
            apart,
            drift: Drift::default(),
            reach: 0.0,
            around: 0.0,
        }
    }

    /// Finds facets up to a distance from the paths of the nodes.
    pub(crate) fn reach_out(&mut self, reach: f64) {
        self.reach = reach;
    }

    /// Finds facets whose paths are within this distance, however small they are. Called before the
    /// first search.
    pub(crate) fn look_around(&mut self, distance: f64) {
        self.around = distance;
    }

    /// Whether no node comes near a facet, as far as it is known without [`Self::update`].
    pub(crate) fn is_apart(&self, margin: f64, before: Places, now: Places) -> bool {
        self.apart.holds(margin, [before.flat(), now.flat()])
    }

    /// Updates the boxes to the motion from `before` to `now`, with a `margin` around facets
    /// relative to their size. Returns whether the path of one of the given nodes may be near that
    /// of a facet.
    pub(crate) fn update(
        &mut self,
        surface: &Surface,
        nodes: &[usize],
        margin: f64,
        before: Places,
        now: Places,
    ) -> bool {
        if self.is_apart(margin, before, now) {
            return false;
        }
        let hull = &self.hull;
        let all_nodes = surface.nodes.iter().copied();
        self.drift = Drift::of(all_nodes, surface.shape.dimension(), [before.flat(), now.flat()]);
        let drift = self.drift;
        let swept = |facet: usize| {
            let nodes = surface.facet(facet).nodes;
            let [old, new] = [before, now].map(|y| hull.bounds(|a| y.coordinates(nodes[a])));
            let bounds = drift.path(old, new);
            bounds.grown((margin * bounds.size()).max(self.around))
        };
        self.tree.place(surface.all(), swept);
        let mut all = Bounds::EMPTY;
        let mut longest = 0.0_f64;
        for &node in nodes {
            let path = self.box_of(node, before, now);
            all = all.union(&path);
            longest = longest.max(path.size());
        }
        let all = all.grown(PATH_MARGIN * longest + self.reach);
        let facets = self.tree.bounds();
        self.apart.searched([&facets, &all], [margin, PATH_MARGIN], now.flat());
        facets.meets(&all)
    }

    /// Finds the facets whose path is near a node's path, ascending.
    pub(crate) fn find(&mut self, node: usize, before: Places, now: Places) {
        let path = self.path(node, before, now).grown(self.reach);
        self.tree.find_into(&path, &mut self.found);
    }

    /// The box of a node's path in the search for facets.
    pub(crate) fn path(&self, node: usize, before: Places, now: Places) -> Bounds {
        let path = self.box_of(node, before, now);
        path.grown(PATH_MARGIN * path.size())
    }

    fn box_of(&self, node: usize, before: Places, now: Places) -> Bounds {
        let [old, new] = [before, now].map(|y| Bounds::of(y.coordinates(node)));
        self.drift.path(old, new)
    }

    /// The frame of the boxes.
    pub(crate) fn drift(&self) -> Drift {
        self.drift
    }

    /// The hierarchy of the bounding boxes of the paths of facets.
    pub(crate) fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Removes those of the found facets that do not meet a condition.
    pub(crate) fn retain(&mut self, mut possible: impl FnMut(usize) -> bool) {
        self.found.retain(|&facet| possible(facet));
    }

    /// The facets that the last search found near the path of a node, ascending.
    pub(crate) fn found(&self) -> &[usize] {
        &self.found
    }
}
