//! The opposite of the secondary side of a mortar contact: a side of a body, or a rigid obstacle.

use carom_algebra::Vector;

use super::border::Border;
use super::cut::{Facing, Opposed, Opposites, Region, Regions, Rule};
use crate::kinematics::NodeToObstacle;
use crate::kinematics::facets::Facets;
use crate::kinematics::folds::{Folds, Turns};
use crate::kinematics::gap::Gap;
use crate::kinematics::obstacle::ObstacleGap;
use crate::kinematics::projection::Facet;
use crate::kinematics::surface::Surface;
use crate::pair::{ContactError, Pair};
use crate::places::Places;

/// A side or an obstacle that the secondary side faces.
#[derive(Debug)]
pub(super) enum Opposite {
    Side(Primary),
    Obstacle(Box<NodeToObstacle>),
}

/// The primary side.
#[derive(Debug)]
pub(super) struct Primary {
    pub(super) surface: Surface,
    /// Facets, each followed by the next one along the side if there is one.
    pub(super) order: Vec<usize>,
    /// Place of each facet in `order`.
    pub(super) place: Vec<usize>,
    /// Facets of the body that face the secondary side in other contacts. What is nearer to them
    /// belongs to those.
    siblings: Vec<usize>,
    /// How the boundary folds, where the secondary side is this one.
    pub(super) folds: Option<Box<Folds>>,
}

/// Gap of a point of the secondary side, with its derivatives by the point and the nodes opposite.
#[derive(Clone, Copy, Debug)]
pub(super) enum PointGap {
    Facet(Gap, usize),
    Obstacle(ObstacleGap),
    /// No gap, but what the motion of a border adds to the derivatives.
    Border(Border),
}

impl Primary {
    pub(super) fn new(surface: Surface, folds: Option<Box<Folds>>) -> Self {
        let order = along(&surface);
        let mut place = vec![0; surface.all()];
        order.iter().enumerate().for_each(|(at, &facet)| place[facet] = at);
        let siblings = (0..surface.all()).filter(|&facet| surface.is_of_sibling(facet));
        let siblings = siblings.filter(|&facet| !surface.is_mirror(facet)).collect();
        Self { surface, order, place, siblings, folds }
    }
}

impl Opposite {
    /// Global numbers of the nodes on which the gap over a facet depends beside the point: those of
    /// the facet, or of the carrier of the obstacle.
    pub(super) fn nodes(&self, facet: usize) -> &[usize] {
        match self {
            Self::Side(primary) => primary.surface.facet(facet).nodes,
            Self::Obstacle(obstacle) => obstacle.carriers(),
        }
    }

    /// Global numbers of all nodes of the opposite side.
    pub(super) fn all_nodes(&self) -> &[usize] {
        match self {
            Self::Side(Primary { surface, .. }) => &surface.nodes[..surface.facets() * surface.shape.nodes()],
            Self::Obstacle(obstacle) => obstacle.carriers(),
        }
    }

    /// Global numbers of the nodes of facets that belong to other contacts.
    pub(super) fn sibling_nodes(&self) -> Vec<usize> {
        let Self::Side(Primary { surface, siblings, .. }) = self else { return Vec::new() };
        siblings.iter().flat_map(|&facet| surface.facet(facet).nodes).copied().collect()
    }

    /// A pair of a multiplier with the whole opposite side; none if it has no facets.
    pub(super) fn whole(&self, multiplier: usize) -> Option<Pair> {
        match self {
            Self::Side(Primary { order, .. }) => {
                let first = *order.first()?;
                Some(Pair { reach: order.len(), ..Pair::open(multiplier, first, 0.0) })
            }
            Self::Obstacle(_) => Some(Pair::open(multiplier, 0, 0.0)),
        }
    }

    /// All facets of the opposite side; an obstacle counts as one, 0.
    pub(super) fn facets(&self) -> &[usize] {
        match self {
            Self::Side(primary) => &primary.order,
            Self::Obstacle(_) => &[0],
        }
    }

    /// The facets of the window of a pair.
    pub(super) fn window(&self, pair: &Pair) -> &[usize] {
        match self {
            Self::Side(primary) => primary.window(pair),
            Self::Obstacle(_) => &[0],
        }
    }

    /// Whether a facet belongs to the window of a pair.
    pub(super) fn is_in_window(&self, pair: &Pair, facet: usize) -> bool {
        match self {
            Self::Side(primary) => primary.places_of(pair).contains(primary.place[facet]),
            Self::Obstacle(_) => true,
        }
    }

    /// Degree of the facets; 1 of an obstacle.
    pub(super) fn degree(&self) -> usize {
        match self {
            Self::Side(primary) => primary.surface.shape().degree(),
            Self::Obstacle(_) => 1,
        }
    }

    /// Some facets of the opposite side with their regions at positions `y`, and those of the other
    /// contacts; none of an obstacle.
    pub(super) fn regions(&self, facets: &[usize], y: Places) -> Regions {
        let Self::Side(Primary { surface, siblings, folds, .. }) = self else { return Regions::default() };
        let all = facets.iter().chain(siblings);
        let of_facets = all.map(|&facet| (facet, Region::of(surface, facet, y))).collect();
        let mut turns = Turns::default();
        if let Some(folds) = folds {
            turns.update(folds, surface, y);
        }
        Regions { of_facets, turns }
    }

    /// A function that finds the part of a facet of the secondary side, given by its number, that
    /// faces facets with these regions at positions `y`, with points of quadrature.
    pub(super) fn facing<'a>(
        &'a self,
        regions: &'a Regions,
        rule: &'a Rule,
        y: Places<'a>,
    ) -> impl Fn(usize, Facet) -> Facing + 'a {
        let primary = match self {
            Self::Side(Primary { surface, folds, .. }) => {
                Some(Opposites { surface, folds: folds.as_deref(), regions, y })
            }
            Self::Obstacle(_) => None,
        };
        move |number, own| {
            primary.as_ref().map_or_else(|| Facing::whole(rule), |side| side.facing(number, own, rule))
        }
    }

    /// The gap of a point at a place; none at the centre of a circle, where no direction is
    /// distinguished.
    pub(super) fn gap(&self, point: &Opposed, place: Vector<2>, y: Places) -> Option<PointGap> {
        match self {
            Self::Side(primary) => {
                let facet = primary.surface.facet(point.facet);
                Some(PointGap::Facet(Gap::closest(facet, y, place, point.eta), facet.nodes.len()))
            }
            Self::Obstacle(obstacle) => {
                let [x, z] = place.0;
                obstacle.gap_of_point([x, z, 0.0], y.flat()).map(PointGap::Obstacle)
            }
        }
    }
}

impl PointGap {
    /// Gap g.
    pub(super) fn distance(&self) -> f64 {
        match self {
            Self::Facet(gap, _) => gap.distance,
            Self::Obstacle(gap) => gap.distance,
            Self::Border(_) => 0.0,
        }
    }

    /// Outward normal of the opposite side.
    pub(super) fn normal(&self) -> Vector<2> {
        match self {
            Self::Facet(gap, _) => gap.at.normal,
            Self::Obstacle(gap) => flat(gap.direction()),
            Self::Border(_) => Vector::ZERO,
        }
    }

    /// Number of the point and the nodes opposite.
    pub(super) fn count(&self) -> usize {
        match self {
            Self::Facet(_, nodes) => 1 + nodes,
            Self::Obstacle(gap) => gap.count,
            Self::Border(border) => border.count,
        }
    }

    /// Checks that the closest point is unique.
    ///
    /// # Errors
    /// If it is not; `pair` and the representative node of its multiplier are named.
    pub(super) fn unless_regular(&self, node: usize, pair: &Pair) -> Result<(), ContactError> {
        match self {
            Self::Facet(gap, _) => ContactError::unless_regular(node, pair, gap.a),
            Self::Obstacle(_) | Self::Border(_) => Ok(()),
        }
    }

    /// Calls a function with the gradients of the gap by the point and by each node opposite;
    /// `kept`: an initial depth by which gaps are larger.
    pub(super) fn gradient(&self, kept: f64, mut of: impl FnMut(usize, Vector<2>)) {
        match self {
            Self::Facet(gap, nodes) => gap.gradient(*nodes).enumerate().for_each(|(p, v)| of(p, v)),
            Self::Obstacle(gap) => gap.gradient().map(flat).enumerate().for_each(|(p, v)| of(p, v)),
            Self::Border(border) => border.gradient(kept, of),
        }
    }

    /// Calls a function with the parts of the row of the slip of the point and of each node
    /// opposite.
    pub(super) fn slip(&self, mut of: impl FnMut(usize, Vector<2>)) {
        match self {
            Self::Facet(gap, nodes) => gap.slip(*nodes).enumerate().for_each(|(p, v)| of(p, v)),
            Self::Obstacle(gap) => gap.row(gap.tangent()).map(flat).enumerate().for_each(|(p, v)| of(p, v)),
            Self::Border(_) => {}
        }
    }

    /// Second derivative of the gap by the point and the nodes opposite, two components each,
    /// row-major.
    pub(super) fn curvature_into(&self, matrix: &mut [f64]) {
        match self {
            Self::Facet(gap, nodes) => gap.curvature_into(*nodes, 2, matrix),
            Self::Obstacle(gap) => gap.curvature_into(2, matrix),
            Self::Border(border) => border.curvature_into(matrix),
        }
    }

    /// Derivative of the row of the slip, a matrix as of [`curvature_into`](Self::curvature_into).
    pub(super) fn slip_derivative_into(&self, matrix: &mut [f64]) {
        match self {
            Self::Facet(gap, nodes) => gap.slip_derivative_into(*nodes, matrix),
            Self::Obstacle(gap) => gap.slip_derivative_into(2, gap.tangent(), matrix),
            Self::Border(_) => matrix.fill(0.0),
        }
    }
}

fn flat([x, y, _]: [f64; 3]) -> Vector<2> {
    Vector([x, y])
}

/// The facets of a side that are surfaces, from the starts of its chains on.
fn along(side: &Surface) -> Vec<usize> {
    let mut order = Vec::new();
    let mut seen = vec![false; side.facets()];
    let is_start = |facet: &usize| side.neighbour_of_side(*facet, false).is_none();
    // Loops, which have no start, come last.
    let starts = (0..side.facets()).filter(is_start).chain(0..side.facets());
    for start in starts.filter(|&facet| !side.is_mirror(facet)) {
        let mut next = Some(start);
        while let Some(facet) = next.filter(|&facet| !seen[facet]) {
            seen[facet] = true;
            order.push(facet);
            next = side.neighbour_of_side(facet, true);
        }
    }
    order
}
