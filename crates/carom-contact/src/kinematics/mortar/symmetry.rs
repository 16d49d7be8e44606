//! Coefficients of the pressure in a plane of symmetry. A whole model has the same coefficient on
//! both sides of the plane, where the slip and the tangential traction are zero: they are odd. Half
//! a model sees half of the coefficient's area, over which the slip is not zero on average: with
//! friction its coefficient would rub.

use carom_algebra::Vector;

use super::opposite::Opposite;
use super::sides::Mortar;
use crate::constants::ROUND_OFF;
use crate::kinematics::InPlane;
use crate::kinematics::facets::Facets;
use crate::kinematics::surface::Surface;

/// The end of a side in a plane of symmetry, with a normal of the plane.
struct EndInPlane {
    node: usize,
    place: Vector<2>,
    normal: Vector<2>,
}

impl Mortar {
    /// The plane of symmetry in which a multiplier stands for the pressure, with the nodes of both
    /// sides there; of an obstacle none.
    pub(super) fn plane_of_symmetry_of(&self, multiplier: usize) -> Option<InPlane> {
        let ends = self.multipliers[multiplier].parts.iter().flat_map(|part| {
            let ends = [(0, false), (self.degree, true)].into_iter();
            let at_end = ends.filter(|(polynomial, _)| *polynomial == part.polynomial);
            at_end.filter_map(|(_, forward)| self.end_in_plane(&self.secondary, part.facet, forward))
        });
        let ends = ends.filter(|end| end.node == self.multipliers[multiplier].node);
        ends.into_iter().find_map(|end| self.with_opposite(&end))
    }

    /// The end of a facet of a side, if it lies in a plane of symmetry in the reference
    /// configuration.
    fn end_in_plane(&self, side: &Surface, facet: usize, forward: bool) -> Option<EndInPlane> {
        let next = side.neighbour(facet, forward).filter(|&next| side.is_mirror(next))?;
        let node = side.facet(facet).nodes[usize::from(forward)];
        let normal = side.facet(next).at(self.reference(), 0.0).normal;
        Some(EndInPlane { node, place: self.reference().at(node), normal })
    }

    /// The node of an end with that of the opposite side in the same plane, if that is symmetric
    /// about it, too.
    fn with_opposite(&self, end: &EndInPlane) -> Option<InPlane> {
        let in_plane = |nodes| InPlane { nodes, normal: end.normal.0 };
        match &self.opposite {
            Opposite::Side(primary) => {
                let side = &primary.surface;
                let ends = (0..side.facets()).flat_map(|facet| [(facet, false), (facet, true)]);
                let mut ends = ends.filter_map(|(facet, forward)| self.end_in_plane(side, facet, forward));
                let other = ends.find(|other| {
                    let apart = other.place - end.place;
                    let size = apart.norm().max(end.place.norm());
                    let is_parallel = 1.0 - other.normal.dot(&end.normal).abs() <= ROUND_OFF;
                    is_parallel && apart.dot(&end.normal).abs() <= ROUND_OFF * size
                })?;
                Some(in_plane(vec![end.node, other.node]))
            }
            Opposite::Obstacle(obstacle) => {
                let [x, y] = end.place.0;
                let [along, across, _] = obstacle.gap_of_point([x, y, 0.0], &self.reference)?.direction();
                let cosine = along * end.normal.0[0] + across * end.normal.0[1];
                (cosine.abs() <= ROUND_OFF).then(|| in_plane(vec![end.node]))
            }
        }
    }
}
