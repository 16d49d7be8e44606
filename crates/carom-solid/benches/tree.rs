//! The hierarchy of boxes over 10³ to 10⁵ facets of a closed chain in the plane and of a sphere:
//! cost of building per facet, and of a query. Times per box grow logarithmically with the number
//! of boxes; those of the exhaustive search grow linearly.
//!
//!     cargo bench -p carom-solid --bench tree     times, and boxes or queries per second
//!     bench/instructions.py carom-solid           instructions

use std::f64::consts::{PI, TAU};
use std::hint::black_box;

use carom_solid::{Bounds, Hull, Tree};
use divan::Bencher;
use divan::counter::ItemsCount;

const COUNTS: [usize; 3] = [1_000, 10_000, 100_000];
/// Those for which the exhaustive search takes less than a second.
const FEW: [usize; 2] = [1_000, 10_000];

fn main() {
    divan::main();
}

/// Boxes of quadratic facets on a circle.
fn circle(count: usize) -> Vec<Bounds> {
    let hull = Hull::line(3, 1.0);
    let at = |k: f64| {
        let (sin, cos) = (TAU * k / count as f64).sin_cos();
        [cos, sin]
    };
    let facet = |k: f64| [at(k), at(k + 1.0), at(k + 0.5)];
    (0..count).map(|k| facet(k as f64)).map(|nodes| hull.bounds(|a| &nodes[a])).collect()
}

/// Boxes of triangles on a sphere: squares of longitude and latitude, cut in two.
fn sphere(count: usize) -> Vec<Bounds> {
    let rows = (count as f64 / 4.0).sqrt().round() as usize;
    let columns = count / (2 * rows);
    let at = |i: usize, j: usize| {
        let (sin, cos) = (TAU * i as f64 / columns as f64).sin_cos();
        let (ring, height) = (PI * j as f64 / rows as f64).sin_cos();
        [ring * cos, ring * sin, height]
    };
    let square = |i, j| {
        let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[0, 1, 2], [0, 2, 3]].map(|triangle| triangle.iter().map(|&c| corners[c]).collect::<Bounds>())
    };
    (0..rows).flat_map(|j| (0..columns).flat_map(move |i| square(i, j))).collect()
}

fn tree(boxes: &[Bounds]) -> Tree {
    Tree::new(boxes.len(), |k| boxes[k])
}

fn build(bencher: Bencher, boxes: &[Bounds]) {
    bencher.counter(ItemsCount::new(boxes.len())).bench_local(|| tree(black_box(boxes)));
}

fn refit(bencher: Bencher, boxes: &[Bounds]) {
    let mut tree = tree(boxes);
    bencher.counter(ItemsCount::new(boxes.len())).bench_local(|| tree.update(|k| black_box(boxes)[k]));
}

/// Queries with each box: itself and its neighbours.
fn queries(bencher: Bencher, boxes: &[Bounds]) {
    let tree = tree(boxes);
    let mut found = Vec::new();
    bencher.counter(ItemsCount::new(boxes.len())).bench_local(|| {
        let all = boxes.iter().map(|query| {
            tree.find_into(black_box(query), &mut found);
            found.len()
        });
        all.sum::<usize>()
    });
}

#[divan::bench(args = COUNTS)]
fn build_circle(bencher: Bencher, count: usize) {
    build(bencher, &circle(count));
}

#[divan::bench(args = COUNTS)]
fn build_sphere(bencher: Bencher, count: usize) {
    build(bencher, &sphere(count));
}

#[divan::bench(args = COUNTS)]
fn refit_circle(bencher: Bencher, count: usize) {
    refit(bencher, &circle(count));
}

#[divan::bench(args = COUNTS)]
fn refit_sphere(bencher: Bencher, count: usize) {
    refit(bencher, &sphere(count));
}

#[divan::bench(args = COUNTS)]
fn queries_circle(bencher: Bencher, count: usize) {
    queries(bencher, &circle(count));
}

#[divan::bench(args = COUNTS)]
fn queries_sphere(bencher: Bencher, count: usize) {
    queries(bencher, &sphere(count));
}

/// Centres half a facet away from the chain.
#[divan::bench(args = COUNTS)]
fn nearest_circle(bencher: Bencher, count: usize) {
    let boxes = circle(count);
    let tree = tree(&boxes);
    let points: Vec<_> = boxes.iter().map(|b| b.centre().map(|x| x * (1.0 + PI / count as f64))).collect();
    bencher.counter(ItemsCount::new(count)).bench_local(|| {
        let nearest = |point: &[f64; 3]| tree.nearest(point, None, |k| Some(boxes[k].distance(point)));
        points.iter().filter_map(|point| nearest(black_box(point))).map(|(k, _)| k).sum::<usize>()
    });
}

/// The same queries without a tree.
#[divan::bench(args = FEW, sample_count = 5, sample_size = 1)]
fn one_by_one_circle(bencher: Bencher, count: usize) {
    let boxes = circle(count);
    bencher.counter(ItemsCount::new(count)).bench_local(|| {
        let meets = |query: &Bounds| boxes.iter().filter(|b| b.meets(query)).count();
        boxes.iter().map(|query| meets(black_box(query))).sum::<usize>()
    });
}
