//! The nodes of a divided mesh: one for each place, whatever cell meets it first. What identifies a
//! place is its weights at the corners of a cell, of which on an edge or a face only those of its
//! corners are not zero.

use std::collections::HashMap;

use crate::mesh::{Facet, Mesh};
use crate::positions::Positions;

/// The nodes of the new mesh, each made where it is met first.
pub(super) struct Nodes<'a> {
    mesh: &'a Mesh,
    /// By corners in ascending order, with their weights.
    numbers: HashMap<Vec<(usize, usize)>, usize>,
    coordinates: Vec<f64>,
}

impl<'a> Nodes<'a> {
    pub(super) fn new(mesh: &'a Mesh) -> Self {
        Self { mesh, numbers: HashMap::new(), coordinates: Vec::new() }
    }

    /// The node with these weights at the corners of a cell, there at Σ φᵃ Xᵃ.
    pub(super) fn at(&mut self, weights: &[usize], cell: usize, values: &[f64]) -> usize {
        let mesh = self.mesh;
        let coordinates = &mut self.coordinates;
        let corners = mesh.cell(cell).iter().copied().zip(weights.iter().copied());
        let mut place: Vec<_> = corners.filter(|(_, weight)| *weight > 0).collect();
        place.sort_unstable();
        *self.numbers.entry(place).or_insert_with(|| {
            let nodes = mesh.cell(cell);
            let sum = |i: usize| nodes.iter().zip(values).map(|(&n, v)| mesh.nodes[n][i] * v).sum::<f64>();
            let number = coordinates.len() / mesh.dimension();
            coordinates.extend((0..mesh.dimension()).map(sum));
            number
        })
    }

    pub(super) fn into_mesh(self, cells: Vec<usize>, facet: impl Fn(&Facet) -> Vec<Facet>) -> Mesh {
        let Self { mesh, coordinates, .. } = self;
        let sides =
            mesh.sides.iter().map(|(name, facets)| (name.clone(), facets.iter().flat_map(&facet).collect()));
        Mesh {
            element: mesh.element,
            nodes: Positions::new(mesh.dimension(), coordinates),
            regions: mesh.regions_of_children(cells.len() / mesh.element.nodes()),
            cells,
            sides: sides.collect(),
            repairs: mesh.repairs.clone(),
        }
    }
}
