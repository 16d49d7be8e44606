//! Partition of the elimination forest into independent parts: a binary tree of parts, of which
//! siblings can be processed in parallel.

use carom_algebra::forest::{Cut, Partition, cut};

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
