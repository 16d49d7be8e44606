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
pub struct Cut {
    /// The two parts into which this one is cut further, if it is.
    pub parts: Option<Box<[Cut; 2]>>,
    /// Index one past the last column of the part.
    pub end: usize,
}

/// A forest cut into independent parts.
pub struct Partition {
    /// The node at each place of the new order.
    pub order: Vec<u32>,
    /// The tree of independent parts.
    pub tree: Cut,
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
pub fn cut(
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
