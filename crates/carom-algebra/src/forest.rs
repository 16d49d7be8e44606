//! Partition of the elimination forest into independent parts: a binary tree of parts, of which
//! siblings can be processed in parallel. It depends on the forest alone, never on the number of
//! threads.

use std::collections::BinaryHeap;

/// Weight (entries of the factor) below which a part is not worth its own thread.
const LEAF: u64 = 50_000;
/// Largest number of levels of parts.
const DEPTH: usize = 4;
/// Largest share of the heavier of two balanced parts.
const BALANCED: f64 = 0.53;
/// Largest share of a part that may remain above its two child parts.
const OWN: f64 = 0.4;

/// A part of the forest: the columns before `end` that belong to no earlier part, including those
/// of its child parts.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Cut {
    pub(crate) parts: Option<Box<[Cut; 2]>>,
    /// Index one past the last column of the part.
    pub(crate) end: usize,
}

/// A forest cut into independent parts.
pub(crate) struct Partition {
    /// The node at each place of the new order.
    pub(crate) order: Vec<u32>,
    pub(crate) tree: Cut,
}

/// A forest in postorder.
struct Forest {
    /// Number of nodes of each subtree.
    sizes: Vec<u32>,
    /// Weight of each subtree.
    weights: Vec<u64>,
    /// First child of each node.
    child: Vec<u32>,
    /// Next sibling of each node.
    sibling: Vec<u32>,
}

const NONE: u32 = u32::MAX;

/// Divides a forest into parts and permutes its nodes so that those of each part are contiguous and
/// follow those of its child parts. `parent(j)` > j, or none for a root; `weight(j)` is the weight
/// of node j.
pub(crate) fn cut(
    count: usize,
    parent: impl Fn(usize) -> Option<usize>,
    weight: impl Fn(usize) -> u64,
) -> Partition {
    let (post, roots) = postorder(count, &parent);
    let mut rank = vec![0; count];
    post.iter().enumerate().for_each(|(k, &j)| rank[j as usize] = k as u32);
    let mut forest = Forest {
        sizes: vec![1; count],
        weights: post.iter().map(|&j| weight(j as usize)).collect(),
        child: vec![NONE; count],
        sibling: vec![NONE; count],
    };
    for k in 0..count {
        if let Some(p) = parent(post[k] as usize) {
            let p = rank[p] as usize;
            forest.sizes[p] += forest.sizes[k];
            forest.weights[p] += forest.weights[k];
            forest.sibling[k] = std::mem::replace(&mut forest.child[p], k as u32);
        }
    }
    let roots = roots.into_iter().map(|j| rank[j as usize]).collect();
    let mut order = Vec::with_capacity(count);
    let tree = forest.part(roots, 0, &mut order);
    order.iter_mut().for_each(|k| *k = post[*k as usize]);
    Partition { order, tree }
}

/// Postorder of a forest, in which every subtree is contiguous, and its roots; roots and children
/// ascend.
fn postorder(count: usize, parent: &impl Fn(usize) -> Option<usize>) -> (Vec<u32>, Vec<u32>) {
    let mut child = vec![NONE; count];
    let mut sibling = vec![NONE; count];
    let mut roots = Vec::new();
    for j in (0..count).rev() {
        match parent(j) {
            Some(p) => sibling[j] = std::mem::replace(&mut child[p], j as u32),
            None => roots.push(j as u32),
        }
    }
    roots.reverse();
    let mut post = Vec::with_capacity(count);
    let mut path = Vec::new();
    for &root in &roots {
        path.push(root);
        while let Some(&j) = path.last() {
            let next = std::mem::replace(&mut child[j as usize], NONE);
            if next == NONE {
                post.push(j);
                path.pop();
                if let Some(&p) = path.last() {
                    child[p as usize] = sibling[j as usize];
                }
            } else {
                path.push(next);
            }
        }
    }
    (post, roots)
}

impl Forest {
    fn weight(&self, roots: &[u32]) -> u64 {
        roots.iter().map(|&r| self.weights[r as usize]).sum()
    }

    /// Builds the part that consists of the given subtrees and appends its nodes to `order`.
    fn part(&self, mut roots: Vec<u32>, depth: usize, order: &mut Vec<u32>) -> Cut {
        if depth < DEPTH
            && self.weight(&roots) >= 2 * LEAF
            && let Some((mut own, halves)) = self.halves(&roots)
        {
            let parts = Some(Box::new(halves.map(|half| self.part(half, depth + 1, order))));
            own.sort_unstable();
            order.extend(own);
            return Cut { parts, end: order.len() };
        }
        roots.sort_unstable();
        for &root in &roots {
            order.extend(root + 1 - self.sizes[root as usize]..=root);
        }
        Cut { parts: None, end: order.len() }
    }

    /// Moves nodes from the heaviest subtrees to the part itself until the remaining ones split
    /// into balanced halves. Returns none if that moves too many.
    fn halves(&self, roots: &[u32]) -> Option<(Vec<u32>, [Vec<u32>; 2])> {
        let total = self.weight(roots) as f64;
        let mut heap: BinaryHeap<(u64, u32)> = roots.iter().map(|&r| (self.weights[r as usize], r)).collect();
        let mut own = Vec::new();
        let mut left = total;
        loop {
            let heaviest = heap.peek()?.0 as f64;
            if heaviest <= BALANCED * left {
                // Heaviest first, each to the lighter half.
                let mut sorted = heap.clone().into_sorted_vec();
                let mut halves = [Vec::new(), Vec::new()];
                let mut weights = [0, 0];
                while let Some((weight, root)) = sorted.pop() {
                    let lighter = usize::from(weights[1] < weights[0]);
                    halves[lighter].push(root);
                    weights[lighter] += weight;
                }
                if weights[0].max(weights[1]) as f64 <= BALANCED * left {
                    return Some((own, halves));
                }
            }
            let (weight, root) = heap.pop()?;
            own.push(root);
            left -= weight as f64;
            let mut child = self.child[root as usize];
            while child != NONE {
                let weight = self.weights[child as usize];
                left += weight as f64;
                heap.push((weight, child));
                child = self.sibling[child as usize];
            }
            if total - left > OWN * total {
                return None;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Asserts that ancestors of a part's nodes lie in it or in the parts that contain it.
    fn closed(
        tree: &Cut,
        begin: usize,
        ancestors: &[std::ops::Range<usize>],
        of: &impl Fn(usize) -> Option<usize>,
    ) {
        let mut own = begin;
        if let Some(parts) = &tree.parts {
            let [a, b] = &**parts;
            let mut around = ancestors.to_vec();
            around.push(b.end..tree.end);
            closed(a, begin, &around, of);
            closed(b, a.end, &around, of);
            own = b.end;
        }
        for k in own..tree.end {
            let inside = |p: usize| (own..tree.end).contains(&p) || ancestors.iter().any(|r| r.contains(&p));
            assert!(of(k).is_none_or(inside));
        }
    }

    /// Checks that parts are closed under descendants and contiguous, and that every node follows
    /// its children.
    fn check(count: usize, parent: impl Fn(usize) -> Option<usize>, order: &[u32], tree: &Cut) {
        let mut rank = vec![usize::MAX; count];
        order.iter().enumerate().for_each(|(k, &j)| rank[j as usize] = k);
        assert!(rank.iter().all(|&k| k < count) && tree.end == count);
        (0..count).for_each(|j| assert!(parent(j).is_none_or(|p| rank[p] > rank[j])));
        closed(tree, 0, &[], &|k| parent(order[k] as usize).map(|p| rank[p]));
    }

    #[test]
    fn parts_are_closed_and_balanced() {
        // A reversed binary heap; a chain; a forest of stars.
        let n = 4095;
        let binary = |j: usize| (j + 1 < n).then(|| n - 1 - (n - 1 - j - 1) / 2);
        let Partition { order, tree } = cut(n, binary, |_| 1000);
        check(n, binary, &order, &tree);
        let [a, b] = &**tree.parts.as_ref().unwrap();
        assert!(a.parts.is_some() && b.parts.is_some());
        assert!((a.end as f64 / (n / 2) as f64 - 1.0).abs() < 0.1);
        let chain = |j: usize| (j + 1 < n).then_some(j + 1);
        let Partition { order, tree } = cut(n, chain, |_| 1000);
        check(n, chain, &order, &tree);
        assert!(tree.parts.is_none());
        let stars = |j: usize| (j % 10 != 9 && j / 10 * 10 + 9 < n).then_some(j / 10 * 10 + 9);
        let Partition { order, tree } = cut(n, stars, |j| 1 + j as u64 % 7 * 300);
        check(n, stars, &order, &tree);
        assert!(tree.parts.is_some());
        let Partition { order, tree } = cut(0, |_| None, |_| 1);
        assert!(order.is_empty() && tree == Cut { parts: None, end: 0 });
    }
}
