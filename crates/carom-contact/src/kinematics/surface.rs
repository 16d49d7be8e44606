//! A primary side as a chain of curved facets in global node numbers, with neighbours, and the
//! search for facets near a node's path.

use std::collections::HashMap;

use carom_solid::{Bounds, FacetShape, Hull, Tree};

use super::projection::Facet;
use crate::places::Places;

/// Facets of a side, all of one shape, and their neighbours.
#[derive(Clone, Debug)]
pub struct Surface {
    shape: FacetShape,
    nodes: Vec<usize>,
    orientations: Vec<f64>,
    neighbours: Vec<[Option<usize>; 2]>,
}

impl Surface {
    /// Facets as lists of global nodes (start, end, interior), traversed with the body on their
    /// left; `orientations` only matters for points
    /// ([`Mesh::orientation`](carom_solid::Mesh::orientation)).
    pub fn new(shape: FacetShape, facets: &[Vec<usize>], orientations: &[f64]) -> Self {
        let end = |facet: &[usize]| facet[shape.nodes().min(2) - 1];
        let starts: HashMap<usize, usize> = facets.iter().enumerate().map(|(k, f)| (f[0], k)).collect();
        let ends: HashMap<usize, usize> = facets.iter().enumerate().map(|(k, f)| (end(f), k)).collect();
        let neighbours_of = |f: &Vec<usize>| [ends.get(&f[0]).copied(), starts.get(&end(f)).copied()];
        let none = |_| [None, None];
        let neighbours = match shape {
            FacetShape::Point => facets.iter().map(none).collect(),
            FacetShape::L2 | FacetShape::L3 | FacetShape::L4 => facets.iter().map(neighbours_of).collect(),
        };
        Self { shape, nodes: facets.concat(), orientations: orientations.to_vec(), neighbours }
    }

    /// Shape of every facet.
    pub fn shape(&self) -> FacetShape {
        self.shape
    }

    /// Number of facets.
    pub fn facets(&self) -> usize {
        self.neighbours.len()
    }

    /// A facet.
    pub(crate) fn facet(&self, facet: usize) -> Facet<'_> {
        let n = self.shape.nodes();
        Facet {
            shape: self.shape,
            nodes: &self.nodes[facet * n..(facet + 1) * n],
            orientation: self.orientations[facet],
        }
    }

    /// The facet that follows (or precedes) it in the direction of traversal.
    pub fn neighbour(&self, facet: usize, forward: bool) -> Option<usize> {
        self.neighbours[facet][usize::from(forward)]
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
    tree: Option<Tree>,
    found: Vec<usize>,
}

impl Search {
    /// For the facets of a surface.
    pub(crate) fn new(surface: &Surface) -> Self {
        Self { hull: Hull::line(surface.shape.nodes(), 1.0), tree: None, found: Vec::new() }
    }

    /// Updates to the motion from `before` to `now`, with a `margin` around facets relative to
    /// their size. Returns whether any of these nodes' paths is near the path of a facet.
    pub(crate) fn update(
        &mut self,
        surface: &Surface,
        nodes: &[usize],
        margin: f64,
        before: Places,
        now: Places,
    ) -> bool {
        let hull = &self.hull;
        let swept = |facet: usize| {
            let nodes = surface.facet(facet).nodes;
            let [old, new] = [before, now].map(|y| hull.bounds(|a| y.coordinates(nodes[a])));
            let bounds = old.union(&new);
            bounds.grown(margin * bounds.size())
        };
        match &mut self.tree {
            Some(tree) => _ = tree.update(swept),
            None => self.tree = Some(Tree::new(surface.facets(), swept)),
        }
        let mut all = Bounds::EMPTY;
        for &node in nodes {
            all.add(before.coordinates(node));
            all.add(now.coordinates(node));
        }
        self.tree.as_ref().is_some_and(|tree| tree.bounds().meets(&all.grown(PATH_MARGIN * all.size())))
    }

    /// Facets whose path is near a node's path, ascending.
    pub(crate) fn near(&mut self, node: usize, before: Places, now: Places) -> &[usize] {
        let mut path = Bounds::EMPTY;
        path.add(before.coordinates(node));
        path.add(now.coordinates(node));
        if let Some(tree) = &self.tree {
            tree.find_into(&path.grown(PATH_MARGIN * path.size()), &mut self.found);
        }
        &self.found
    }
}

/// Margin around a node's path in the search for facets, relative to the path's size.
const PATH_MARGIN: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_loop_has_neighbours_everywhere_and_an_open_chain_has_two_ends() {
        let closed = Surface::new(FacetShape::L2, &[vec![0, 1], vec![1, 2], vec![2, 0]], &[1.0; 3]);
        assert_eq!(closed.neighbour(2, true), Some(0));
        assert_eq!(closed.neighbour(0, false), Some(2));
        let open = Surface::new(FacetShape::L3, &[vec![0, 1, 7], vec![1, 2, 8]], &[1.0; 2]);
        assert_eq!((open.neighbour(0, false), open.neighbour(1, true)), (None, None));
        assert_eq!(open.facet(1).nodes, [1, 2, 8]);
    }
}
