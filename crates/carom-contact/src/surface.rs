//! A primary side as a chain of curved facets in global node numbers, with neighbours and a conservative search.

use std::collections::HashMap;

/// Facets of a side and who follows whom.
#[derive(Clone, Debug)]
pub struct Surface {
    nodes: Vec<usize>,
    order: usize,
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

    fn add(&mut self, x: &[f64; 2]) {
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
    /// Facets as lists of 2, 3 or 4 global nodes (start, end, interior), all of one order, walked with the body on their left.
    pub fn new(facets: &[Vec<usize>]) -> Self {
        let order = facets.first().map_or(2, Vec::len);
        let starts: HashMap<usize, usize> = facets.iter().enumerate().map(|(k, f)| (f[0], k)).collect();
        let ends: HashMap<usize, usize> = facets.iter().enumerate().map(|(k, f)| (f[1], k)).collect();
        let neighbours = facets.iter().map(|f| [ends.get(&f[0]).copied(), starts.get(&f[1]).copied()]).collect();
        Self { nodes: facets.concat(), order, neighbours }
    }

    /// Number of facets.
    pub fn facets(&self) -> usize {
        self.neighbours.len()
    }

    /// Global nodes of a facet.
    pub fn facet(&self, facet: usize) -> &[usize] {
        &self.nodes[facet * self.order..(facet + 1) * self.order]
    }

    /// The facet that follows (or precedes) along the walk.
    pub fn neighbour(&self, facet: usize, forward: bool) -> Option<usize> {
        self.neighbours[facet][usize::from(forward)]
    }

    /// Distance between a facet's ends.
    pub(crate) fn length(&self, facet: usize, y: &[[f64; 2]]) -> f64 {
        let nodes = self.facet(facet);
        (y[nodes[1]][0] - y[nodes[0]][0]).hypot(y[nodes[1]][1] - y[nodes[0]][1])
    }

    /// Box around a facet's path; a polynomial leaves the box of its nodes by less than a third of its size.
    fn swept(&self, facet: usize, before: &[[f64; 2]], now: &[[f64; 2]]) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for &n in self.facet(facet) {
            bounds.add(&before[n]);
            bounds.add(&now[n]);
        }
        bounds.grown(0.35 * bounds.size())
    }

    /// Facets whose path comes near a node's path, in ascending order.
    pub(crate) fn near<'a>(
        &'a self,
        node: usize,
        before: &'a [[f64; 2]],
        now: &'a [[f64; 2]],
    ) -> impl Iterator<Item = usize> + 'a {
        let mut path = Bounds::EMPTY;
        path.add(&before[node]);
        path.add(&now[node]);
        let path = path.grown(0.1 * path.size());
        (0..self.facets()).filter(move |&f| self.swept(f, before, now).meets(&path))
    }

    /// Whether the path of any of the nodes comes near the path of the side as a whole.
    pub(crate) fn any_near(&self, nodes: &[usize], before: &[[f64; 2]], now: &[[f64; 2]]) -> bool {
        let mut side = Bounds::EMPTY;
        for f in 0..self.facets() {
            let b = self.swept(f, before, now);
            side.add(&b.low);
            side.add(&b.high);
        }
        let mut others = Bounds::EMPTY;
        for &n in nodes {
            others.add(&before[n]);
            others.add(&now[n]);
        }
        side.meets(&others.grown(0.1 * others.size()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_loop_has_neighbours_everywhere_and_an_open_chain_has_two_ends() {
        let closed = Surface::new(&[vec![0, 1], vec![1, 2], vec![2, 0]]);
        assert_eq!(closed.neighbour(2, true), Some(0));
        assert_eq!(closed.neighbour(0, false), Some(2));
        let open = Surface::new(&[vec![0, 1, 7], vec![1, 2, 8]]);
        assert_eq!((open.neighbour(0, false), open.neighbour(1, true)), (None, None));
        assert_eq!(open.facet(1), [1, 2, 8]);
    }
}
