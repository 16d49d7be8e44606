//! The hierarchy of boxes compared with an exhaustive search, and how many boxes a query visits.

use carom_solid::{Bounds, Tree};

use super::random::{integer, lists};

/// Most boxes of a list.
const MOST: usize = 40;
/// Numbers of three lists of boxes, and one more.
const NUMBERS: usize = 1 + 3 * (1 + 7 * MOST) + 1;

/// Lists of boxes in 1, 2 or 3 dimensions, a third of them points, some duplicated.
fn boxes(x: &[f64]) -> [Vec<Bounds>; 3] {
    let dimension = 1 + integer(x[0], 3);
    let of_list = |x: &[f64]| {
        let one = |x: &[f64]| {
            let place = |x: &[f64]| -> Vec<f64> {
                x[..dimension].iter().map(|x| 0.5 * (integer(*x, 9) as f64 - 4.0)).collect()
            };
            let (a, b) = (place(&x[1..4]), place(&x[4..7]));
            if integer(x[0], 3) == 0 { Bounds::of(&a) } else { [a, b].into_iter().collect() }
        };
        x[1..].chunks_exact(7).take(integer(x[0], MOST)).map(one).collect()
    };
    let lists = &x[1..];
    let size = 1 + 7 * MOST;
    [0, 1, 2].map(|k| of_list(&lists[k * size..(k + 1) * size]))
}

fn check(tree: &Tree, boxes: &[Bounds], queries: &[Bounds]) {
    assert_eq!(tree.len(), boxes.len());
    let mut found = vec![7];
    for query in queries.iter().chain(boxes).chain([&Bounds::EMPTY]) {
        tree.find_into(query, &mut found);
        let all: Vec<_> = (0..boxes.len()).filter(|&k| boxes[k].meets(query)).collect();
        assert_eq!(found, all);
        let point = query.centre();
        let distance = |k: usize| (k % 5 != 4).then(|| boxes[k].distance(&point));
        let first =
            (0..boxes.len()).filter_map(|k| Some((k, distance(k)?))).min_by(|a, b| a.1.total_cmp(&b.1));
        assert_eq!(tree.nearest(&point, None, distance), first);
        let near = (!boxes.is_empty()).then_some(boxes.len() / 2);
        assert_eq!(tree.nearest(&point, near, distance), first);
    }
    let all = boxes.iter().fold(Bounds::EMPTY, Bounds::union);
    assert!(boxes.is_empty() || (tree.bounds().low(), tree.bounds().high()) == (all.low(), all.high()));
}

fn check_changes([first, second, queries]: &[Vec<Bounds>; 3]) {
    let mut tree = Tree::new(first.len(), |k| first[k]);
    check(&tree, first, queries);
    // As many boxes, elsewhere.
    let moved: Vec<_> = (0..first.len()).map(|k| second.get(k).unwrap_or(&first[k]).grown(0.25)).collect();
    let mut refitted = tree.clone();
    refitted.refit(|k| moved[k]);
    check(&refitted, &moved, queries);
    tree.update(|k| moved[k]);
    check(&tree, &moved, queries);
}

#[test]
fn finds_what_all_boxes_one_by_one_find() {
    lists(256, NUMBERS, &|x| check_changes(&boxes(x)));
    check_changes(&[Vec::new(), Vec::new(), Vec::new()]);
}

#[test]
fn numbers_that_are_none_are_found_by_everything() {
    lists(256, NUMBERS, &|x| {
        let ([first, queries, _], bad) = (boxes(x), integer(x[NUMBERS - 1], MOST));
        let mut boxes = first.clone();
        if let Some(one) = boxes.get_mut(bad) {
            *one = Bounds::of(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY]);
        }
        let mut tree = Tree::new(boxes.len(), |k| boxes[k]);
        check(&tree, &boxes, &queries);
        // Restored.
        tree.update(|k| first[k]);
        check(&tree, &first, &queries);
        tree.update(|k| boxes[k]);
        check(&tree, &boxes, &queries);
    });
}

#[test]
fn equal_boxes_one_box_and_none() {
    for count in [0, 1, 2, 3, 1000] {
        let boxes = vec![Bounds::of(&[2.0]); count];
        let mut tree = Tree::new(count, |k| boxes[k]);
        check(&tree, &boxes, &[Bounds::of(&[2.0]), Bounds::of(&[1.9])]);
        assert!(!tree.update(|k| boxes[k]), "nothing has moved");
        assert_eq!((tree.is_empty(), tree.len()), (count == 0, count));
    }
}

/// Boxes of the edges of a regular polygon rotated by an angle and stretched.
fn polygon(count: usize, turned: f64, stretched: f64) -> impl Fn(usize) -> Bounds {
    let at = move |k: usize| {
        let angle = turned + std::f64::consts::TAU * k as f64 / count as f64;
        [stretched * angle.cos(), stretched * angle.sin()]
    };
    move |k| [at(k), at(k + 1)].iter().collect()
}

#[test]
fn a_query_costs_a_logarithm() {
    let mean = |count: usize| {
        let facet = polygon(count, 0.1, 1.0);
        let tree = Tree::new(count, &facet);
        (0..count).map(|k| tree.visited(&facet(k))).sum::<usize>() as f64 / count as f64
    };
    let means = [1_000, 10_000, 100_000].map(mean);
    // Two boxes per level, and a few for neighbours: a decade has 3.3 levels.
    assert!(means[0] < 3.0 * 10.0, "{means:?}");
    assert!(means.windows(2).all(|m| m[1] - m[0] < 3.0 * 3.4), "{means:?}");
}

#[test]
fn a_tree_that_has_become_poor_is_built_anew() {
    let count = 512;
    let mut tree = Tree::new(count, polygon(count, 0.0, 1.0));
    // Uniform scaling and rotation do not degrade a tree.
    assert!(!tree.update(polygon(count, 0.0, 7.0)));
    assert!(!tree.update(polygon(count, 1.0, 1.0)));
    // Neighbouring facets are far apart.
    let facet = polygon(count, 0.0, 1.0);
    let shuffled = |k: usize| facet(k * 201 % count);
    assert!(tree.update(shuffled));
    assert!(!tree.update(shuffled));
    let fresh = Tree::new(count, shuffled);
    let query = shuffled(100);
    assert_eq!(tree.visited(&query), fresh.visited(&query));
}
