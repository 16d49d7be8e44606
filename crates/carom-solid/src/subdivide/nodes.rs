//! The nodes of a divided mesh: one for each place, whatever cell meets it first.

use std::collections::HashMap;

use crate::mesh::{Facet, Mesh};
use crate::positions::Positions;

/// What identifies a node of the new mesh.
#[derive(PartialEq, Eq, Hash)]
pub(super) enum Place {
    Corner(usize),
    /// Between two corners, counted from the smaller one.
    Edge([usize; 2], usize),
    Inside(usize, [usize; 3]),
    /// Between corners, in ascending order, with their weights.
    Among(Vec<(usize, usize)>),
}

/// The nodes of the new mesh, each made where it is met first.
pub(super) struct Nodes<'a> {
    mesh: &'a Mesh,
    numbers: HashMap<Place, usize>,
    coordinates: Vec<f64>,
}

impl<'a> Nodes<'a> {
    pub(super) fn new(mesh: &'a Mesh) -> Self {
        Self { mesh, numbers: HashMap::new(), coordinates: Vec::new() }
    }

    /// The node at a place of a cell, there at Σ φᵃ Xᵃ.
    pub(super) fn at(&mut self, place: Place, cell: usize, values: &[f64]) -> usize {
        let (mesh, coordinates) = (self.mesh, &mut self.coordinates);
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
            cells,
            sides: sides.collect(),
            repairs: mesh.repairs.clone(),
        }
    }
}
