//! Which parts of a body's boundary in space can meet each other. With n the outward normals at a
//! node and at a facet of the same piece, and h the height of the middle of the node's facet over
//! the other one in the reference configuration, negative behind it:
//!
//! ```text
//! they meet across free space        n_node · n_facet < −cos 60°, and the node was not behind
//! they lie side by side              n_node · n_facet ≥ −cos 60°
//! they are two faces of one wall     h < 0 close by, with material alone between them: never
//! ```
//!
//! At a node where several facets meet, the most opposed one counts, and the mean of their normals.
//! The flanks of a closed slit have h = 0 and opposed normals: they meet up to the tip. A turn
//! along the boundary, by which the plane tells a wall from a pocket (`../folds.rs`), does not
//! exist in space; whether a node was behind is told from the start of a step (`candidate.rs`), and
//! the two faces of a wall from the reference configuration. Unconnected pieces can always meet, by
//! the rules of two bodies.
//!
//! The secondary one of two places that meet is that of the later piece; within a piece that of the
//! later smooth part of the boundary, parts being separated by kinks of more than 30°; within a
//! part that of the facet whose middle lies further along a direction of the part: that in which
//! its normals point most, across the flanks of a fold. Where they point in several directions
//! alike, as in a tube, all of these count, in shares without a symmetry.

use std::collections::BTreeMap;

use carom_algebra::{Mat, PrincipalAxes, Vector, principal_axes};
use carom_solid::{Bounds, Hull, Tree};

use super::boundary::{Boundary, Height};
use super::patch::{PatchPoint, place};
use crate::constants::{ALIKE, FACING, KINK, MEETS, ROUND_OFF, WALL};
use crate::kinematics::{Facets, Side};

/// Shares of the principal directions of the normals in the order of a smooth part, the strongest
/// first, if all are alike.
const SHARES: [f64; 3] = [1.0, 0.618, 0.382];

/// The order of the places of a boundary, and the faces of its walls, in global node numbers.
#[derive(Debug)]
pub struct PatchFolds {
    /// Smallest global number of a node of the boundary.
    first: usize,
    /// Facets that contain each node, ascending, for all nodes from the smallest on.
    own: Vec<Vec<usize>>,
    /// Facets behind the middle of each facet, across its wall, ascending.
    walls: Vec<Vec<usize>>,
    /// Connected piece and smooth part of each facet, and the coordinate of its middle along the
    /// direction of the order.
    places: Vec<(usize, usize, f64)>,
}

impl PatchFolds {
    /// Orders the places of a boundary at reference positions, flat over all nodes; `piece`: the
    /// connected piece of the body to which each node belongs, from `first_node` on.
    pub fn new(boundary: &Boundary, piece: &[usize], first_node: usize, reference: &[f64]) -> Self {
        let nodes = boundary.nodes();
        let first = nodes.iter().min().copied().unwrap_or(0);
        let count = nodes.iter().max().map_or(0, |last| last + 1 - first);
        let mut own = vec![Vec::new(); count];
        // A plane of symmetry is no surface.
        for facet in (0..boundary.all()).filter(|&facet| !boundary.is_mirror(facet)) {
            boundary.nodes_of(facet).iter().for_each(|node| own[node - first].push(facet));
        }
        let parts = smooth_parts(boundary, reference);
        let directions = directions(boundary, &parts, reference);
        let places = |facet: usize| {
            let nodes = boundary.nodes_of(facet);
            let middle = boundary.middle(facet, reference).position;
            let direction = directions.get(&parts[facet]).copied().unwrap_or(Vector::ZERO);
            (piece[nodes[0] - first_node], parts[facet], middle.dot(&direction))
        };
        let places = (0..boundary.all()).map(places).collect();
        let mut folds = Self { first, own, walls: Vec::new(), places };
        folds.walls = folds.walls_of(boundary, reference);
        folds
    }

    /// Finds the facets behind the middle of every facet across its wall.
    fn walls_of(&self, boundary: &Boundary, reference: &[f64]) -> Vec<Vec<usize>> {
        let hull = Hull::facet(boundary.shape());
        let tree = Tree::new(boundary.all(), |facet| boundary.bounds(&hull, facet, reference));
        let mut normals = Vec::new();
        update_normals(boundary, reference, &mut normals);
        let mut near = Vec::new();
        let of_facet = |own: usize| {
            let point = boundary.middle(own, reference).position;
            let reach = WALL * boundary.patch(own).length(reference);
            let is_behind = |&facet: &usize| {
                let alike = normals[own].dot(&normals[facet]) > ALIKE.cosine;
                if facet == own || alike || self.are_of_different_pieces(own, facet) {
                    return false;
                }
                let Height { distance, height } = boundary.height(facet, point, reference);
                distance < reach && height < -MEETS * boundary.patch(facet).length(reference)
            };
            let mut walls = Vec::new();
            tree.find_into(&Bounds::of(&point.0).grown(reach), &mut walls);
            walls.retain(is_behind);
            walls.retain(|&facet| {
                let other = boundary.middle(facet, reference).position;
                near.clear();
                tree.find_into(&Bounds::of(&point.0).union(&Bounds::of(&other.0)), &mut near);
                let enters = |&between: &usize| {
                    let is_third = between != own && between != facet && !boundary.is_mirror(between);
                    is_third
                        && (other - point).dot(&normals[between]) < 0.0
                        && crosses(boundary, between, [point, other], reference)
                };
                !near.iter().any(enters)
            });
            walls
        };
        (0..boundary.all()).map(of_facet).collect()
    }

    /// Facets that contain a node.
    fn own(&self, node: usize) -> &[usize] {
        node.checked_sub(self.first).and_then(|k| self.own.get(k)).map_or(&[], Vec::as_slice)
    }

    /// Whether a facet lies behind the facet `own` across its wall.
    fn is_behind(&self, own: usize, facet: usize) -> bool {
        self.walls[own].binary_search(&facet).is_ok()
    }

    /// Side in the order of places on which the facet `own` is when it meets another one.
    fn side(&self, own: usize, facet: usize) -> Side {
        if self.is_later(own, facet) { Side::Later } else { Side::Earlier }
    }

    /// Whether a node and a facet may form a pair in which the node is on the given side, as far as
    /// the reference configuration tells.
    pub fn admits(&self, side: Side, node: usize, facet: usize) -> bool {
        let own = self.own(node);
        own.binary_search(&facet).is_err()
            && own.iter().any(|&own| self.side(own, facet) == side && !self.is_behind(own, facet))
    }

    /// Side in the order of places on which a node is that may meet a facet, at positions with the
    /// given normals of the facets' middles; none if the two places cannot meet, or do not face
    /// each other.
    pub fn met(&self, node: usize, facet: usize, normal: impl Fn(usize) -> Vector<3>) -> Option<Side> {
        let own = self.own(node);
        let &one = own.first()?;
        if own.binary_search(&facet).is_ok() {
            return None;
        }
        if self.are_of_different_pieces(one, facet) {
            return Some(self.side(one, facet));
        }
        let mut most = (one, f64::INFINITY);
        let mut mean = Vector::ZERO;
        let there = normal(facet);
        for &own in own {
            let cosine = normal(own).dot(&there);
            mean += normal(own);
            if cosine < most.1 {
                most = (own, cosine);
            }
        }
        let opposed = most.1 < FACING || mean.dot(&there) < FACING * mean.norm();
        (opposed && !self.is_behind(most.0, facet)).then(|| self.side(most.0, facet))
    }

    /// Whether two facets bound different connected pieces of the body.
    pub(super) fn are_of_different_pieces(&self, one: usize, other: usize) -> bool {
        self.places[one].0 != self.places[other].0
    }

    /// Whether a facet bounds another connected piece of the body than that of a node.
    pub(super) fn is_of_another_piece(&self, node: usize, facet: usize) -> bool {
        self.own(node).first().is_some_and(|&own| self.are_of_different_pieces(own, facet))
    }

    /// Whether the body consists of several connected pieces.
    pub(super) fn has_pieces(&self) -> bool {
        self.places.iter().any(|place| place.0 != self.places[0].0)
    }

    /// Whether a facet comes later in the order of places than another one.
    pub(super) fn is_later(&self, facet: usize, other: usize) -> bool {
        let here = self.places[facet];
        let there = self.places[other];
        let order = (here.0, here.1).cmp(&(there.0, there.1)).then(here.2.total_cmp(&there.2));
        order.then(facet.cmp(&other)).is_gt()
    }
}

/// Updates the outward normals at the middles of all facets.
pub fn update_normals(boundary: &Boundary, y: &[f64], normals: &mut Vec<Vector<3>>) {
    normals.clear();
    normals.extend((0..boundary.all()).map(|facet| boundary.middle(facet, y).normal));
}

/// Whether a segment crosses a facet, taken as the triangles between its corners.
fn crosses(boundary: &Boundary, facet: usize, [from, to]: [Vector<3>; 2], y: &[f64]) -> bool {
    let nodes = boundary.nodes_of(facet);
    let corners = &nodes[..boundary.shape().corners()];
    let volume =
        |a: Vector<3>, b: Vector<3>, c: Vector<3>, d: Vector<3>| Mat([(b - a).0, (c - a).0, (d - a).0]).det();
    (2..corners.len()).any(|k| {
        let [a, b, c] = [corners[0], corners[k - 1], corners[k]].map(|node| place(y, node));
        if volume(a, b, c, from) * volume(a, b, c, to) >= 0.0 {
            return false;
        }
        let around = [volume(from, to, a, b), volume(from, to, b, c), volume(from, to, c, a)];
        // A segment through an edge crosses both facets.
        let least = ROUND_OFF * around.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
        around.iter().all(|part| *part >= -least) || around.iter().all(|part| *part <= least)
    })
}

/// The direction along which each smooth part is ordered. It turns with the body.
fn directions(boundary: &Boundary, parts: &[usize], reference: &[f64]) -> BTreeMap<usize, Vector<3>> {
    let mut normals: BTreeMap<usize, Mat<3>> = BTreeMap::new();
    for (facet, part) in parts.iter().enumerate() {
        let PatchPoint { normal, tangents: [a, b], .. } = boundary.middle(facet, reference);
        let area = Mat([normal.0, a.0, b.0]).det().abs();
        *normals.entry(*part).or_insert(Mat::ZERO) += normal.outer(&normal) * area;
    }
    let direction = |(part, sum): (usize, Mat<3>)| {
        let PrincipalAxes { values, axes } = principal_axes(&sum);
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
        let mut along = Vector::ZERO;
        for (share, &axis) in SHARES.iter().zip(&order) {
            let strength = values[axis] / values[order[0]];
            let axis = Vector(axes.transposed().0[axis]);
            along += axis * (share * strength * strength);
        }
        (part, along)
    };
    normals.into_iter().map(direction).collect()
}

/// Smooth part of the boundary to which each facet belongs, named by the first facet of that part.
/// A plane of symmetry is a part of its own: the flanks of a slit that ends there are two.
fn smooth_parts(boundary: &Boundary, reference: &[f64]) -> Vec<usize> {
    let mut part = vec![usize::MAX; boundary.all()];
    let mut next = Vec::new();
    for begin in 0..boundary.all() {
        if part[begin] == usize::MAX {
            part[begin] = begin;
            next.push(begin);
        }
        while let Some(facet) = next.pop() {
            for edge in 0..boundary.shape().corners() {
                let Some(other) = boundary.across(facet, edge) else { continue };
                let [here, there] = boundary.normals_at_edge(facet, edge, 0.5, reference);
                let goes_on = boundary.is_mirror(facet) == boundary.is_mirror(other);
                if part[other] == usize::MAX && goes_on && here.dot(&there) > KINK.cosine {
                    part[other] = begin;
                    next.push(other);
                }
            }
        }
    }
    part
}
