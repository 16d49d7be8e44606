//! The sides of ties: their facets, and the nearest point of one.

use carom_solid::{Bounds, FacetPoint, FacetShape, Mesh, Tree};

/// Part of a facet's size by which a curved one may leave the box of its nodes.
const BULGE: f64 = 0.5;

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

    /// The facets all of whose nodes lie on another side, to within what `reach` says of its
    /// facets.
    pub(super) fn on(
        &self,
        mesh: &Mesh,
        other: &Self,
        reach: impl Fn(&Self, usize) -> f64,
    ) -> Vec<Vec<usize>> {
        let lies_on = |node: &usize| {
            let nearest = other.nearest(place_of(mesh, *node));
            nearest.is_some_and(|(facet, point)| point.distance <= reach(other, facet))
        };
        self.facets.iter().filter(|facet| facet.iter().all(lies_on)).cloned().collect()
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
