//! Crossing of trajectories, eqs. (6)–(8): y_N(θ) = y_S(ξ, θ), both moving on straight lines from θ
//! = 0 to θ = 1.
//!
//! The certified test of `swept` isolates the first crossing from the outer to the inner side: none
//! is missed. Newton's method on the curve itself polishes it to (θ, ξ).

use carom_algebra::Vector;

use super::projection::Facet;
use super::swept::{Crossings, Swept, SweptTest};
use crate::constants::{ASTRAY, MEETS};
use crate::places::Places;

/// Crossing of the path of a node with that of a facet in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The instant θ in the step, 0..1.
    pub theta: f64,
    /// Coordinate on the facet.
    pub xi: f64,
}

/// The point at a share `t` of the way from `a` to `b`.
pub fn lerp(a: Vector<2>, b: Vector<2>, t: f64) -> Vector<2> {
    a * (1.0 - t) + b * t
}

/// First crossing of a node from the outer to the inner side of a facet in a step, if there is one.
pub fn crossing(
    swept: &mut SweptTest,
    facet: Facet,
    before: Places,
    now: Places,
    node: usize,
) -> Option<Crossing> {
    let count = facet.nodes.len();
    let mut places = [[Vector::ZERO; 4]; 2];
    for (places, y) in places.iter_mut().zip([before, now]) {
        for (place, &n) in places.iter_mut().zip(facet.nodes) {
            *place = y.at(n);
        }
    }
    let [old, new] = &places;
    let separation = MEETS * (old[1] - old[0]).norm();
    let path = [before.at(node), now.at(node)];
    match swept.first(path, [&old[..count], &new[..count]], Crossings::Inward, separation) {
        Swept::Clear => None,
        Swept::Hit { theta, xi } => {
            let isolated = Crossing { theta, xi };
            let near = |c: &Crossing| (c.theta - theta).abs() < ASTRAY && (c.xi - xi).abs() < ASTRAY;
            Some(polished(facet, before, now, node, isolated).filter(near).unwrap_or(isolated))
        }
    }
}

/// Crossing refined by Newton's method on the curve. Only inward crossings count: the velocity of
/// the node relative to the surface is opposite to its normal.
fn polished(facet: Facet, before: Places, now: Places, node: usize, start: Crossing) -> Option<Crossing> {
    let Crossing { mut theta, mut xi } = start;
    for _ in 0..20 {
        let shape = facet.shape.at(xi);
        let mut position = Vector::ZERO;
        let mut tangent = Vector::ZERO;
        let mut velocity = Vector::ZERO;
        for (k, &n) in facet.nodes.iter().enumerate() {
            let y = lerp(before.at(n), now.at(n), theta);
            position += y * shape.values[k];
            tangent += y * shape.first[k];
            velocity += (now.at(n) - before.at(n)) * shape.values[k];
        }
        let miss = lerp(before.at(node), now.at(node), theta) - position;
        let relative = now.at(node) - before.at(node) - velocity;
        // miss + relative dθ − tangent dξ = 0
        let det = -relative[0] * tangent[1] + relative[1] * tangent[0];
        if det == 0.0 || !det.is_finite() {
            return None;
        }
        let d_theta = (miss[0] * tangent[1] - miss[1] * tangent[0]) / det;
        let d_xi = (relative[1] * miss[0] - relative[0] * miss[1]) / -det;
        theta += d_theta;
        xi -= d_xi;
        if !theta.is_finite() || theta.abs() > 3.0 || xi.abs() > 3.0 {
            return None;
        }
        if d_theta.abs() <= 1e-13 && d_xi.abs() <= 1e-13 {
            let inwards = relative.dot(&tangent.turned_right()) < 0.0;
            let valid = (-MEETS..=1.0 + MEETS).contains(&theta) && xi.abs() <= 1.0 + MEETS;
            return (inwards && valid).then_some(Crossing { theta, xi });
        }
    }
    None
}
