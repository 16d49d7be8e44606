//! Crossing of straight paths in space: x(θ) = y(ξ, θ), the node and the facet both moving on
//! straight lines from θ = 0 to θ = 1.
//!
//! The certified test of `swept` isolates the first crossing from the outer to the inner side: none
//! is missed. Newton's method polishes θ.

use carom_algebra::{Mat, Vector};
use carom_solid::Net;

use super::patch::{Patch, cross, place};
use crate::constants::{ASTRAY, MEETS, WANDER};
use crate::kinematics::swept::{SpaceHit, SweptPatch};

/// First crossing of the path of a node with that of a facet from outside, at an instant θ in [0,
/// `until`], if there is one.
pub(super) fn crossing(
    swept: &mut SweptPatch,
    patch: Patch,
    [before, now]: [&[f64]; 2],
    until: f64,
    node: usize,
) -> Option<SpaceHit> {
    let ends = |n: usize| {
        let from = place(before, n);
        let to = place(now, n);
        [from, if until < 1.0 { from + (to - from) * until } else { to }]
    };
    let mut places = [[Vector::ZERO; Net::POINTS]; 2];
    for (k, &n) in patch.nodes.iter().enumerate() {
        [places[0][k], places[1][k]] = ends(n);
    }
    let facet = places.each_ref().map(|places| &places[..patch.nodes.len()]);
    let hit = swept.first(ends(node), facet, MEETS * patch.length(before))?;
    let hit = SpaceHit { theta: until * hit.theta, ..hit };
    Some(polished(patch, before, now, node, hit).unwrap_or(hit))
}

/// Crossing of a node and a facet refined by Newton's method from an isolated one; none if that
/// does not lead to a crossing near it.
fn polished(patch: Patch, before: &[f64], now: &[f64], node: usize, hit: SpaceHit) -> Option<SpaceHit> {
    let SpaceHit { mut theta, mut xi } = hit;
    // Relative to the node: exact differences, however far from the origin.
    let [from, to] = [before, now].map(|y| place(y, node));
    let lerp =
        |n: usize, theta: f64| (place(before, n) - from) * (1.0 - theta) + (place(now, n) - to) * theta;
    for _ in 0..20 {
        let functions = patch.shape.functions(xi);
        let mut miss = Vector::ZERO;
        let mut relative = Vector::ZERO;
        let mut tangents = [Vector::ZERO; 2];
        for (k, &n) in patch.nodes.iter().enumerate() {
            let x = lerp(n, theta);
            miss += x * -functions.values[k];
            relative += (place(now, n) - to - (place(before, n) - from)) * -functions.values[k];
            (0..2).for_each(|i| tangents[i] += x * functions.slopes[i][k]);
        }
        // miss + relative dθ − τ_α dξ_α = 0
        let matrix = Mat([relative.0, (-tangents[0]).0, (-tangents[1]).0]).transposed();
        let step = matrix.inverse().apply(&-miss);
        theta += step[0];
        xi = [xi[0] + step[1], xi[1] + step[2]];
        let size = step.0.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if !size.is_finite() || theta.abs() > 3.0 || patch.furthest(xi) > WANDER {
            return None;
        }
        if size <= 1e-12 {
            let inwards = relative.dot(&cross(tangents[0], tangents[1])) < 0.0;
            let valid = (-MEETS..=1.0 + MEETS).contains(&theta) && patch.furthest(xi) <= MEETS;
            let moved = [theta - hit.theta, xi[0] - hit.xi[0], xi[1] - hit.xi[1]];
            let near = moved.iter().all(|x| x.abs() < ASTRAY);
            return (inwards && valid && near).then_some(SpaceHit { theta, xi });
        }
    }
    None
}
