//! Points that nodes carry: chains of them, and the power of their forces.

use carom_mechanics::model::{Circular, Point, Points};

fn point(node: usize, weights: &[(usize, f64)]) -> Point {
    Point { node, weights: weights.to_vec() }
}

#[test]
fn chains_end_at_nodes_that_are_no_points() {
    let given = vec![point(3, &[(2, 0.5), (1, 0.5)]), point(2, &[(0, 0.25), (1, 0.75)])];
    let points = Points::new(1, 4, given).unwrap();
    assert_eq!(points.of(3), Some(&[(0, 0.125), (1, 0.875)][..]));
    let mut forces = [0.0, 0.0, 1.0, 4.0];
    points.pass_on(&mut forces);
    assert_eq!(forces, [0.0, 0.0, 3.0, 4.0]);
    let circular = vec![point(0, &[(1, 1.0)]), point(1, &[(0, 1.0)])];
    assert_eq!(Points::new(1, 2, circular).unwrap_err(), Circular { node: 0 });
}

/// The power of forces is the same before and after: f·(T q) = (Tᵀf)·q.
#[test]
fn gathering_is_the_transpose_of_carrying() {
    let given = vec![point(2, &[(0, 0.3), (1, 0.7)]), point(3, &[(1, 1.0)])];
    let points = Points::new(2, 4, given).unwrap();
    let mut x = vec![1.0, -2.0, 3.0, 0.5, 9.0, 9.0, 9.0, 9.0];
    points.carry(&mut x);
    let mut forces: Vec<f64> = (0..8).map(|i| f64::from(i).cos()).collect();
    let power: f64 = forces.iter().zip(&x).map(|(f, x)| f * x).sum();
    points.gather(&mut forces);
    let gathered: f64 = forces.iter().zip(&x).map(|(f, x)| f * x).sum();
    assert!((power - gathered).abs() < 1e-14);
    assert_eq!(forces[4..], [0.0; 4]);
}
