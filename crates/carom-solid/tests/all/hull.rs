//! Hulls of curved lines and cells: known control points, and sampled points that they contain.

use carom_algebra::Vector;
use carom_solid::shape::{Domain, Line2, Line3, Line4, Shape, Tet4, Tri3, Tri6, Tri10};
use carom_solid::{Bounds, Hull, line_shape};

use super::random::lists;

/// A line's control points are weights of its nodes, so the box of them is that of known weights,
/// wherever the nodes are. The rows are linearly independent: none is within the hull of others.
#[test]
fn lines_have_the_control_points_of_the_books() {
    let close = |hull: Hull, rows: &[&[f64]]| {
        for seed in 0..200 {
            let node = |a: usize| [0, 1, 2].map(|i| ((a * 7 + i * 3 + seed * 31) as f64 * 12.9898).sin());
            let nodes: Vec<[f64; 3]> = (0..rows.len()).map(node).collect();
            let point = |row: &&[f64]| {
                [0, 1, 2].map(|i| row.iter().zip(&nodes).map(|(weight, x)| weight * x[i]).sum::<f64>())
            };
            let (found, exact) = (hull.bounds(|a| &nodes[a]), rows.iter().map(point).collect::<Bounds>());
            for (found, exact) in [(found.low(), exact.low()), (found.high(), exact.high())] {
                let error = (0..3).map(|i| (found[i] - exact[i]).abs()).fold(0.0, f64::max);
                assert!(error < 1e-14, "{rows:?}: {found:?} {exact:?}");
            }
        }
    };
    close(Hull::line(1, 1.2), &[&[1.0]]);
    close(Hull::line(2, 1.0), &[&[1.0, 0.0], &[0.0, 1.0]]);
    close(Hull::line(2, 1.2), &[&[1.1, -0.1], &[-0.1, 1.1]]);
    close(Hull::line(3, 1.0), &[&[1.0, 0.0, 0.0], &[-0.5, -0.5, 2.0], &[0.0, 1.0, 0.0]]);
    let sixth = |row: [f64; 4]| row.map(|x| x / 6.0);
    let (near, far) = (sixth([-5.0, 2.0, 18.0, -9.0]), sixth([2.0, -5.0, -9.0, 18.0]));
    close(Hull::line(4, 1.0), &[&[1.0, 0.0, 0.0, 0.0], &near, &far, &[0.0, 1.0, 0.0, 0.0]]);
}

fn holds(bounds: &Bounds, values: &[f64], nodes: &[[f64; 3]]) {
    let at = |i: usize| values.iter().zip(nodes).map(|(v, x)| v * x[i]).sum::<f64>();
    assert!(bounds.grown(1e-13).contains(&[at(0), at(1), at(2)]));
}

/// The box contains the cell, and is no larger than that of the nodes if the cell is straight.
fn check<const R: usize, const N: usize, S: Shape<R, N>>(nodes: &[[f64; 3]]) {
    let steps = 10_usize;
    let samples = (0..(steps + 1).pow(R as u32)).map(|code| {
        let unit = |i: usize| (code / (steps + 1).pow(i as u32) % (steps + 1)) as f64 / steps as f64;
        Vector(std::array::from_fn(|i| if R == 1 { 2.0 * unit(i) - 1.0 } else { unit(i) }))
    });
    let inside = samples.filter(|xi| S::Domain::excess(xi) <= 0.0);
    let values: Vec<Vec<f64>> = inside.map(|xi| S::values(&xi).to_vec()).collect();
    let places: Vec<Vec<f64>> = S::NODES.iter().map(|xi| xi.0.to_vec()).collect();
    check_hull(&Hull::of::<R, N, S>(), nodes, &values, &places);
}

fn check_hull(hull: &Hull, nodes: &[[f64; 3]], values: &[Vec<f64>], places: &[Vec<f64>]) {
    let bounds = hull.bounds(|a| &nodes[a]);
    values.iter().for_each(|values| holds(&bounds, values, nodes));
    // Where all nodes are at one place, every control point is there: the sum of its weights is 1.
    let one = hull.bounds(|_| &[1.0]);
    assert!((one.low()[0] - 1.0).abs() < 1e-13 && (one.high()[0] - 1.0).abs() < 1e-13);
    let (tight, box_of_nodes) = (hull.bounds(|a| &places[a]), places.iter().collect::<Bounds>());
    let dimension = places[0].len();
    assert!(box_of_nodes.grown(1e-14).contains(&tight.low()[..dimension]));
    assert!(box_of_nodes.grown(1e-14).contains(&tight.high()[..dimension]));
}

#[test]
fn a_hull_holds_what_is_curved() {
    lists(256, 31, &|x| {
        let (nodes, reach) = (x[..30].as_chunks::<3>().0, 1.15 + 0.15 * x[30]);
        check::<1, 2, Line2>(nodes);
        check::<1, 3, Line3>(nodes);
        check::<1, 4, Line4>(nodes);
        check::<2, 3, Tri3>(nodes);
        check::<2, 6, Tri6>(nodes);
        check::<2, 10, Tri10>(nodes);
        check::<3, 4, Tet4>(nodes);
        for count in 1..=4 {
            let bounds = Hull::line(count, reach).bounds(|a| &nodes[a]);
            for k in -100..=100 {
                holds(&bounds, &line_shape(count, reach * f64::from(k) / 100.0).values[..count], nodes);
            }
        }
    });
}
