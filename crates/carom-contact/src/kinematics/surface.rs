//! A primary side as a chain of curved facets in global node numbers, with neighbours and a conservative search.

use std::collections::HashMap;

use carom_algebra::Vector;
use carom_solid::FacetShape;

use super::projection::Facet;
use crate::places::Places;

/// Facets of a side, all of one shape, and who follows whom.
#[derive(Clone, Debug)]
pub struct Surface {
    shape: FacetShape,
    nodes: Vec<usize>,
    orientations: Vec<f64>,
    neighbours: Vec<[Option<usize>; 2]>,
}

/// Axis-parallel box.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: [f64; 2],
    high: [f64; 2],
}

impl Bounds {
    const EMPTY: Self = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };

    fn add(&mut self, x: &Vector<2>) {
        for i in 0..2 {
            self.low[i] = self.low[i].min(x[i]);
            self.high[i] = self.high[i].max(x[i]);
        }
    }

    fn size(&self) -> f64 {
        (self.high[0] - self.low[0]).max(self.high[1] - self.low[1])
    }

    fn grown(mut self, by: f64) -> Self {
        for i in 0..2 {
            self.low[i] -= by;
            self.high[i] += by;
        }
        self
    }

    fn meets(&self, other: &Self) -> bool {
        (0..2).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }
}

impl Surface {
    /// Facets as lists of global nodes (start, end, interior), walked with the body on their left; `orientations` counts for points alone
    /// ([`Mesh::orientation`](carom_solid::Mesh::orientation)).
    pub fn new(shape: FacetShape, facets: &[Vec<usize>], orientations: &[f64]) -> Self {
        let end = |facet: &[usize]| facet[shape.nodes().min(2) - 1];
        let starts: HashMap<usize, usize> = facets.iter().enumerate().map(|(k, f)| (f[0], k)).collect();
        let ends: HashMap<usize, usize> = facets.iter().enumerate().map(|(k, f)| (end(f), k)).collect();
        let follows = |f: &Vec<usize>| [ends.get(&f[0]).copied(), starts.get(&end(f)).copied()];
        let none = |_| [None, None];
        let neighbours = match shape {
            FacetShape::Point => facets.iter().map(none).collect(),
            FacetShape::L2 | FacetShape::L3 | FacetShape::L4 => facets.iter().map(follows).collect(),
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

    /// The facet that follows (or precedes) along the walk.
    pub fn neighbour(&self, facet: usize, forward: bool) -> Option<usize> {
        self.neighbours[facet][usize::from(forward)]
    }

    /// Distance between a facet's ends.
    pub(crate) fn length(&self, facet: usize, y: Places) -> f64 {
        let nodes = self.facet(facet).nodes;
        (y.at(nodes[1]) - y.at(nodes[0])).norm()
    }

    /// Box around a facet's path; a polynomial leaves the box of its nodes by less than a third of its size.
    fn swept(&self, facet: usize, before: Places, now: Places) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for &n in self.facet(facet).nodes {
            bounds.add(&before.at(n));
            bounds.add(&now.at(n));
        }
        bounds.grown(0.35 * bounds.size())
    }

    /// Facets whose path comes near a node's path, in ascending order.
    pub(crate) fn near<'a>(
        &'a self,
        node: usize,
        before: Places<'a>,
        now: Places<'a>,
    ) -> impl Iterator<Item = usize> + 'a {
        let mut path = Bounds::EMPTY;
        path.add(&before.at(node));
        path.add(&now.at(node));
        let path = path.grown(0.1 * path.size());
        (0..self.facets()).filter(move |&f| self.swept(f, before, now).meets(&path))
    }

    /// Whether the path of any of the nodes comes near the path of the side as a whole.
    pub(crate) fn any_near(&self, nodes: &[usize], before: Places, now: Places) -> bool {
        let mut side = Bounds::EMPTY;
        for f in 0..self.facets() {
            let b = self.swept(f, before, now);
            side.add(&Vector(b.low));
            side.add(&Vector(b.high));
        }
        let mut others = Bounds::EMPTY;
        for &n in nodes {
            others.add(&before.at(n));
            others.add(&now.at(n));
        }
        side.meets(&others.grown(0.1 * others.size()))
    }
}

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
