//! The sides of ties: their facets, and the nearest point of one.

use carom_solid::{Bounds, FacetPoint, FacetShape, Mesh, Tree};

/// Part of a facet's size by which a curved one may leave the box of its nodes.
const BULGE: f64 = 0.5;

/// Distance along the nearest facet, as a share of the distance from it, from which on a point is
/// beside a side and not above it.
pub(super) const BESIDE: f64 = 0.1;
/// Distance from a facet, over its length, that is round-off.
const ROUND_OFF: f64 = 1e-9;

/// A side of a tie in the reference configuration.
pub(super) struct TieSide {
    pub(super) shape: FacetShape,
    /// Nodes of its facets, in the numbers of the mesh.
    pub(super) facets: Vec<Vec<usize>>,
    /// Positions of these nodes.
    pub(super) places: Vec<Vec<[f64; 3]>>,
    /// Length of the shortest cell where facets are points.
    shortest: f64,
    tree: Tree,
}

impl TieSide {
    /// The side of a name; none if the mesh has no such side.
    pub(super) fn new(mesh: &Mesh, side: &str) -> Option<Self> {
        let facets: Vec<Vec<usize>> = mesh.sides.get(side)?.iter().map(|facet| facet.nodes.clone()).collect();
        let places: Vec<Vec<[f64; 3]>> =
            facets.iter().map(|nodes| nodes.iter().map(|&node| place_of(mesh, node)).collect()).collect();
        let bounds = |facet: usize| {
            let mut bounds = Bounds::EMPTY;
            places[facet].iter().for_each(|place| bounds.add(place));
            let size = bounds.size();
            bounds.grown(BULGE * size)
        };
        let tree = Tree::new(facets.len(), bounds);
        let size = |cell: usize| {
            let mut bounds = Bounds::EMPTY;
            mesh.cell(cell).iter().for_each(|&node| bounds.add(&place_of(mesh, node)));
            bounds.size()
        };
        let cells = if mesh.dimension() == 1 { mesh.cell_count() } else { 0 };
        let shortest = (0..cells).map(size).fold(f64::INFINITY, f64::min);
        Some(Self { shape: mesh.element.facet_shape(), facets, places, shortest, tree })
    }

    /// The nearest facet and its nearest point.
    pub(super) fn nearest(&self, place: [f64; 3]) -> Option<(usize, FacetPoint)> {
        let distance = |facet: usize| Some(self.shape.closest(&self.places[facet], place).distance);
        let (facet, _) = self.tree.nearest(&place, None, distance)?;
        Some((facet, self.shape.closest(&self.places[facet], place)))
    }

    /// The facets whose nodes, and the middle of straight ones, lie on another side: not beside its
    /// end, and no further away than `reach` says of its facets.
    pub(super) fn on(&self, other: &Self, reach: impl Fn(&Self, usize) -> f64) -> Vec<Vec<usize>> {
        let lies_on = |place: [f64; 3]| {
            other.nearest(place).is_some_and(|(facet, point)| {
                let is_beside = point.beside > BESIDE * point.distance.max(ROUND_OFF * other.length(facet));
                point.distance <= reach(other, facet) && !is_beside
            })
        };
        let middle = |places: &[[f64; 3]]| -> [f64; 3] {
            std::array::from_fn(|i| places.iter().map(|place| place[i]).sum::<f64>() / places.len() as f64)
        };
        let is_closed = |places: &[[f64; 3]]| {
            places.iter().copied().all(lies_on) && (!self.is_straight() || lies_on(middle(places)))
        };
        let facets = self.facets.iter().zip(&self.places);
        facets.filter(|(_, places)| is_closed(places)).map(|(facet, _)| facet.clone()).collect()
    }

    /// Whether facets have no nodes but their corners.
    fn is_straight(&self) -> bool {
        self.shape.degree() == 1
    }

    /// Largest extent of a facet, of a cell if facets are points.
    pub(super) fn length(&self, facet: usize) -> f64 {
        if self.shortest.is_finite() {
            return self.shortest;
        }
        let mut bounds = Bounds::EMPTY;
        self.places[facet].iter().for_each(|place| bounds.add(place));
        bounds.size()
    }
}

/// Position of a node, padded with zeros to space.
pub(super) fn place_of(mesh: &Mesh, node: usize) -> [f64; 3] {
    let place = &mesh.nodes[node];
    std::array::from_fn(|i| place.get(i).copied().unwrap_or(0.0))
}
