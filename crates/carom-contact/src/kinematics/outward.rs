//! Outward normals of a deformable body at its nodes.

use carom_algebra::Vector;

use super::Facets;
use super::obstacle::{Point, dot};
use super::space::Boundary;
use super::surface::Surface;
use crate::constants::PARALLEL;
use crate::places::Places;

/// Boundary of the body to which secondary nodes belong.
#[derive(Clone, Debug)]
pub enum Outward {
    /// Boundary of a body in the plane.
    Plane(Surface),
    /// Boundary of a body in space.
    Space(Boundary),
}

impl Outward {
    /// Unit normals of the facets at a node.
    pub(super) fn normals(&self, node: usize, y: &[f64]) -> Vec<Point> {
        match self {
            Self::Plane(surface) => {
                let has_node = |facet: &usize| surface.nodes_of(*facet).contains(&node);
                let around = (0..surface.all()).filter(has_node);
                let normal = |facet| surface.facet(facet).at(Places::new(y, 2), 0.0).normal;
                around.map(normal).map(|Vector([x, y])| [x, y, 0.0]).collect()
            }
            Self::Space(boundary) => {
                let around = boundary.facets_around(node).iter();
                around.map(|&facet| boundary.middle(facet, y).normal.0).collect()
            }
        }
    }
}

/// Whether one of the vectors `outward` is opposite to a unit normal to within 10°.
pub(super) fn is_opposed(normal: Point, outward: &[Point]) -> bool {
    outward.iter().any(|own| dot(*own, normal) < -PARALLEL.cosine * dot(*own, *own).sqrt())
}
