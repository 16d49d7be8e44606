//! Coefficients of the pressure in a plane of symmetry. A whole model has the same coefficient on
//! both sides of the plane, where the slip and the tangential traction are zero: they are odd. Half
//! a model sees half of the coefficient's area, over which the slip is not zero on average: with
//! friction its coefficient would rub.

use carom_algebra::Vector;

use super::opposite::Opposite;
use super::sides::Mortar;
use crate::kinematics::facets::Facets;
use crate::kinematics::surface::Surface;

/// Distance from a plane, relative to the size of the model, and cosine that count as zero.
const FLAT: f64 = 1e-9;

/// A place at which a side meets a plane of symmetry, with a normal of the plane.
struct Meeting {
    place: Vector<2>,
    normal: Vector<2>,
}

impl Mortar {
    /// Whether a multiplier stands for the pressure in a plane of symmetry of both sides.
    pub(super) fn meets_plane_of_symmetry(&self, multiplier: usize) -> bool {
        self.multipliers[multiplier].parts.iter().any(|part| {
            let ends = [(0, false), (self.degree, true)];
            let at_end = ends.into_iter().filter(|(polynomial, _)| *polynomial == part.polynomial);
            let mut meetings =
                at_end.filter_map(|(_, forward)| self.meeting(&self.secondary, part.facet, forward));
            meetings.any(|meeting| self.is_symmetric(&meeting))
        })
    }

    /// Where a facet of a side meets a plane of symmetry in the reference configuration.
    fn meeting(&self, side: &Surface, facet: usize, forward: bool) -> Option<Meeting> {
        let next = side.neighbour(facet, forward).filter(|&next| side.is_mirror(next))?;
        let node = side.facet(facet).nodes[usize::from(forward)];
        let normal = side.facet(next).at(self.reference(), 0.0).normal;
        Some(Meeting { place: self.reference().at(node), normal })
    }

    /// Whether the opposite side is symmetric about the same plane.
    fn is_symmetric(&self, at: &Meeting) -> bool {
        match &self.opposite {
            Opposite::Side(primary) => {
                let side = &primary.surface;
                let ends = (0..side.facets()).flat_map(|facet| [(facet, false), (facet, true)]);
                let mut meetings = ends.filter_map(|(facet, forward)| self.meeting(side, facet, forward));
                meetings.any(|other| {
                    let apart = other.place - at.place;
                    apart.dot(&at.normal).abs() <= FLAT * apart.norm().max(at.place.norm())
                })
            }
            Opposite::Obstacle(obstacle) => {
                let [x, y] = at.place.0;
                let gap = obstacle.gap_of_point([x, y, 0.0], &self.reference);
                let along =
                    |direction: [f64; 3]| direction[0] * at.normal.0[0] + direction[1] * at.normal.0[1];
                // One that is carried may move across the plane.
                obstacle.carriers().is_empty() && gap.is_some_and(|gap| along(gap.direction()).abs() <= FLAT)
            }
        }
    }
}
