//! Crossing of straight paths in space: x(θ) = y(ξ, θ), the node and the facet both moving on
//! straight lines from θ = 0 to θ = 1.
//!
//! Newton's method from the instant at which the gap vanishes if it changes linearly; unlike in the
//! plane, no certificate says that none was missed.

use carom_algebra::{Mat, Vector};

use super::node_to_patch::WANDER;
use super::patch::{Patch, cross, place};

/// Instant θ in [0, 1] at which a node's path first meets a facet's from outside, if it does.
pub(super) fn crossing(patch: Patch, before: &[f64], now: &[f64], node: usize) -> Option<f64> {
    /// θ and ξ beyond their ranges: a node exactly on the surface has crossed it.
    const TOLERANCE: f64 = 1e-6;
    let gap_at = |y: &[f64]| {
        let xi = patch.closest_point(y, place(y, node), 1.0)?;
        let at = patch.at(y, xi);
        Some(((place(y, node) - at.position).dot(&at.normal), xi))
    };
    let ((old, _), (new, _)) = (gap_at(before)?, gap_at(now)?);
    let length = patch.length(now);
    if old < -TOLERANCE * length || new >= 0.0 {
        return None;
    }
    let mut theta = if old > 0.0 { old / (old - new) } else { 0.0 };
    let mut xi = gap_at(if theta < 0.5 { before } else { now })?.1;
    let lerp = |n: usize, theta: f64| place(before, n) * (1.0 - theta) + place(now, n) * theta;
    for _ in 0..20 {
        let functions = patch.shape.functions(xi);
        let mut miss = lerp(node, theta);
        let mut relative = place(now, node) - place(before, node);
        let mut tangents = [Vector::ZERO; 2];
        for (k, &n) in patch.nodes.iter().enumerate() {
            let x = lerp(n, theta);
            miss += x * -functions.values[k];
            relative += (place(now, n) - place(before, n)) * -functions.values[k];
            (0..2).for_each(|i| tangents[i] += x * functions.slopes[i][k]);
        }
        // miss + relative dθ − τ_α dξ_α = 0
        let matrix = Mat([relative.0, (-tangents[0]).0, (-tangents[1]).0]).transposed();
        let step = matrix.inverse().apply(&-miss);
        (theta, xi) = (theta + step[0], [xi[0] + step[1], xi[1] + step[2]]);
        let size = step.0.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if !size.is_finite() || theta.abs() > 3.0 || patch.furthest(xi).1 > WANDER {
            return None;
        }
        if size <= 1e-12 {
            let inwards = relative.dot(&cross(tangents[0], tangents[1])) < 0.0;
            let valid = (-TOLERANCE..=1.0 + TOLERANCE).contains(&theta) && patch.furthest(xi).1 <= TOLERANCE;
            return (inwards && valid).then_some(theta);
        }
    }
    None
}
