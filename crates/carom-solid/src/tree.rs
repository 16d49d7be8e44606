//! A bounding volume hierarchy: which of n boxes meet a given one, in O(log n + found).
//!
//! Built top-down by splitting at the median of the boxes' centres along the longest axis (Ericson,
//! Real-Time Collision Detection, §6.2). It has a leaf per box and lies in one array in preorder:
//! to skip a node, a traversal continues at the end of its branch, without a stack. When boxes
//! move, the tree is refitted, O(n). If its quality has degraded, it is rebuilt, O(n log n). The
//! result depends on neither. Existing crates bring a vector library (`bvh` nalgebra, `parry` and
//! `obvhs` glam, the last in single precision, which is not conservative) or cannot be refitted
//! (`rstar`).

use crate::bounds::Bounds;

/// The tree is rebuilt when its boxes, relative to the outermost, have grown by this factor since
/// it was last built.
pub const REBUILT: f64 = 1.5;

/// Hierarchy of the boxes numbered 0, 1, ….
#[derive(Clone, Debug, Default)]
pub struct Tree {
    nodes: Vec<Node>,
    cost: f64,
}

#[derive(Clone, Debug)]
struct Node {
    bounds: Bounds,
    /// End of the node's branch; that of a leaf is the leaf alone.
    end: usize,
    /// Number of a leaf's box.
    item: usize,
}

impl Tree {
    /// Tree of `count` boxes.
    #[must_use]
    pub fn new(count: usize, bounds: impl Fn(usize) -> Bounds) -> Self {
        let mut tree = Self::default();
        let boxes: Vec<_> = (0..count).map(bounds).collect();
        tree.build(&boxes);
        tree
    }

    /// Number of boxes that a query is compared with.
    #[must_use]
    pub fn visited(&self, query: &Bounds) -> usize {
        let mut k = 0;
        let mut count = 0;
        while let Some(node) = self.nodes.get(k) {
            count += 1;
            k = if node.bounds.meets(query) { k + 1 } else { node.end };
        }
        count
    }

    /// Moves the boxes of a tree of `count` boxes, or makes one of an empty tree.
    pub fn place(&mut self, count: usize, bounds: impl Fn(usize) -> Bounds) {
        if self.is_empty() {
            *self = Self::new(count, bounds);
        } else {
            self.update(bounds);
        }
    }

    /// Number of boxes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len().div_ceil(2)
    }

    /// Whether there are no boxes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Box around all boxes.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.nodes.first().map_or(Bounds::EMPTY, |root| root.bounds)
    }

    /// Updates the boxes, and rebuilds the tree if its quality has degraded. Returns whether it
    /// did.
    pub fn update(&mut self, bounds: impl Fn(usize) -> Bounds) -> bool {
        self.refit(bounds);
        // An unbounded box has no size to compare: rebuilt every time.
        let good = self.expense() <= REBUILT * self.cost;
        if !good {
            let mut boxes = vec![Bounds::EMPTY; self.len()];
            let leaves = self.nodes.iter().enumerate().filter(|(k, node)| node.is_leaf(*k));
            leaves.for_each(|(_, leaf)| boxes[leaf.item] = leaf.bounds);
            self.build(&boxes);
        }
        !good
    }

    /// Updates the boxes without changing the tree's structure.
    pub fn refit(&mut self, bounds: impl Fn(usize) -> Bounds) {
        for k in (0..self.nodes.len()).rev() {
            self.nodes[k].bounds = if self.nodes[k].is_leaf(k) {
                bounds(self.nodes[k].item)
            } else {
                let [left, right] = self.branches(k);
                self.nodes[left].bounds.union(&self.nodes[right].bounds)
            };
        }
    }

    /// The boxes that meet another, in an order that depends on the tree's history.
    pub fn meeting(&self, query: &Bounds) -> impl Iterator<Item = usize> {
        let mut k = 0;
        std::iter::from_fn(move || {
            while let Some(node) = self.nodes.get(k) {
                if !node.bounds.meets(query) {
                    k = node.end;
                    continue;
                }
                k += 1;
                if node.end == k {
                    return Some(node.item);
                }
            }
            None
        })
    }

    /// Fills `found` with the boxes that meet another, in ascending order.
    pub fn find_into(&self, query: &Bounds, found: &mut Vec<usize>) {
        found.clear();
        found.extend(self.meeting(query));
        found.sort_unstable();
    }

    /// The item nearest to a point, and its distance according to `distance`, which returns `None`
    /// to exclude an item; the first of equals. An item must lie in its box, round-off included.
    /// With a near item `from`, fewer are asked; the result is the same.
    pub fn nearest(
        &self,
        point: &[f64],
        from: Option<usize>,
        mut distance: impl FnMut(usize) -> Option<f64>,
    ) -> Option<(usize, f64)> {
        let mut best = from.and_then(|item| Some((item, distance(item)?)));
        if !self.nodes.is_empty() {
            self.nearer(0, point, &mut distance, &mut best);
        }
        best
    }

    fn nearer(
        &self,
        k: usize,
        point: &[f64],
        distance: &mut impl FnMut(usize) -> Option<f64>,
        best: &mut Option<(usize, f64)>,
    ) {
        let away = |k: usize| self.nodes[k].bounds.distance(point);
        let node = &self.nodes[k];
        // Where the search began is not asked again.
        let is_known = |item: usize| node.is_leaf(k) && node.item == item;
        if best.is_some_and(|(item, least)| away(k) > least || is_known(item)) {
            return;
        }
        if !node.is_leaf(k) {
            let [left, right] = self.branches(k);
            let (first, second) = if away(right) < away(left) { (right, left) } else { (left, right) };
            self.nearer(first, point, distance, best);
            self.nearer(second, point, distance, best);
        } else if let Some(found) = distance(node.item)
            && best.is_none_or(|(item, least)| found < least || (found == least && node.item < item))
        {
            *best = Some((node.item, found));
        }
    }

    fn branches(&self, k: usize) -> [usize; 2] {
        [k + 1, self.nodes[k + 1].end]
    }

    fn build(&mut self, boxes: &[Bounds]) {
        let centres: Vec<_> = boxes.iter().map(Bounds::centre).collect();
        let mut items: Vec<_> = (0..boxes.len()).collect();
        self.nodes.clear();
        self.nodes.reserve_exact((2 * boxes.len()).saturating_sub(1));
        if !boxes.is_empty() {
            self.split(&mut items, &centres);
        }
        self.refit(|item| boxes[item]);
        self.cost = self.expense();
    }

    /// Appends the branch of some items.
    fn split(&mut self, items: &mut [usize], centres: &[[f64; 3]]) {
        let here = self.nodes.len();
        self.nodes.push(Node { bounds: Bounds::EMPTY, end: 0, item: items[0] });
        if items.len() > 1 {
            let around: Bounds = items.iter().map(|&item| centres[item]).collect();
            let extents = around.extents();
            let axis = (1..3).fold(0, |axis, i| if extents[i] > extents[axis] { i } else { axis });
            let middle = items.len() / 2;
            items.select_nth_unstable_by(middle, |&a, &b| {
                centres[a][axis].total_cmp(&centres[b][axis]).then(a.cmp(&b))
            });
            let (left, right) = items.split_at_mut(middle);
            self.split(left, centres);
            self.split(right, centres);
        }
        self.nodes[here].end = self.nodes.len();
    }

    /// Total edge length of the inner boxes over that of the outermost: proportional to the number
    /// of boxes that a query visits.
    fn expense(&self) -> f64 {
        let edges = |node: &Node| node.bounds.extents().iter().map(|e| e.max(0.0)).sum::<f64>();
        let inner = self.nodes.iter().enumerate().filter(|(k, node)| !node.is_leaf(*k));
        inner.map(|(_, node)| edges(node)).sum::<f64>()
            / self.nodes.first().map_or(0.0, edges).max(f64::MIN_POSITIVE)
    }
}

impl Node {
    /// Whether the node at index `k` is a leaf.
    fn is_leaf(&self, k: usize) -> bool {
        self.end == k + 1
    }
}
