//! A node at a rigid obstacle: its gap, and the derivatives against differences.

use carom_algebra::jacobian_error;
use carom_contact::{Kinematics, NodeToObstacle, Pair, Rows};

/// The gap of the first node, and its gradient over all dofs.
pub(crate) fn measured_in(
    dimension: usize,
    contact: &NodeToObstacle,
    pair: &mut Pair,
    y: &[f64],
) -> (f64, Vec<f64>) {
    let mut rows = Rows::new(dimension);
    contact.measure(pair, y, &mut rows).unwrap();
    let mut gradient = vec![0.0; y.len()];
    rows.row(0).add_to(1.0, &mut gradient);
    (rows.row(0).gap, gradient)
}

/// Gradient and second derivative of the gap are those of differences, in every scene.
pub(crate) fn derivatives_agree(dimension: usize, scenes: &[(NodeToObstacle, Vec<f64>)]) {
    for (k, (contact, y)) in scenes.iter().enumerate() {
        let measured = |pair: &mut Pair, y: &[f64]| measured_in(dimension, contact, pair, y);
        let mut pair = Pair::open(0, 0, 0.0);
        let (_, gradient) = measured(&mut pair, y);
        let gap = |y: &[f64]| vec![measured(&mut pair.clone(), y).0];
        let error = jacobian_error(y, 1e-5, gap, &gradient);
        assert!(error < 1e-9, "scene {k}: {error:e}");
        let mut curvature = vec![0.0; y.len() * y.len()];
        contact.curvature_into(&pair, y, &mut curvature);
        let slope = |y: &[f64]| measured(&mut pair.clone(), y).1;
        let error = jacobian_error(y, 1e-5, slope, &curvature);
        assert!(error < 1e-8, "scene {k}: {error:e}");
    }
}
