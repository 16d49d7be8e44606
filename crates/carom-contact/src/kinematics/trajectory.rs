//! Crossing of trajectories, eqs. (6)–(8): y_N(θ) = y_S(ξ, θ), both moving on straight lines from θ
//! = 0 to θ = 1.
//!
//! The facet is divided into chords. A chord's ends and the node move linearly, so "on the chord's
//! line" is a quadratic in θ, of which every root is found. Each root starts a Newton iteration on
//! the curve itself. The smallest admissible θ is the crossing.

use carom_algebra::Vector;

use super::projection::Facet;
use crate::places::Places;

/// θ may lie outside [0, 1], and |ξ| above 1, by this much: a node exactly on the surface must be
/// detected.
const TOLERANCE: f64 = 1e-6;
const CHORDS: usize = 6;

/// Intersection of a node's path with a facet's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    pub theta: f64,
    pub xi: f64,
}

fn lerp(a: Vector<2>, b: Vector<2>, t: f64) -> Vector<2> {
    a * (1.0 - t) + b * t
}

/// First crossing from the outer to the inner side of the facet, if any.
pub(crate) fn crossing(facet: Facet, before: Places, now: Places, node: usize) -> Option<Crossing> {
    let mut first: Option<Crossing> = None;
    for k in 0..CHORDS {
        let ends = [k, k + 1].map(|i| 2.0 * i as f64 / CHORDS as f64 - 1.0);
        let at = |xi: f64, y: Places| {
            let shape = facet.shape.at(xi);
            facet.nodes.iter().enumerate().fold(Vector::ZERO, |sum, (i, &n)| sum + y.at(n) * shape.values[i])
        };
        let [a0, a1] = [at(ends[0], before), at(ends[0], now)];
        let [b0, b1] = [at(ends[1], before), at(ends[1], now)];
        let (p0, p1) = (before.at(node) - a0, now.at(node) - a1);
        let (e0, e1) = (b0 - a0, b1 - a1);
        for theta in linear_cross_roots(e0, e1, p0, p1).into_iter().flatten() {
            let (e, p) = (e0 * (1.0 - theta) + e1 * theta, p0 * (1.0 - theta) + p1 * theta);
            let along = p.dot(&e) / e.dot(&e);
            if !(-0.5..=1.5).contains(&along) {
                continue;
            }
            let start = Crossing { theta, xi: ends[0] + (ends[1] - ends[0]) * along };
            if let Some(found) = polished(facet, before, now, node, start)
                && first.is_none_or(|f| found.theta < f.theta)
            {
                first = Some(found);
            }
        }
    }
    first
}

/// Roots θ of (e₀ + θ Δe) × (p₀ + θ Δp) = 0 near [0, 1].
fn linear_cross_roots(e0: Vector<2>, e1: Vector<2>, p0: Vector<2>, p1: Vector<2>) -> [Option<f64>; 2] {
    let cross = |u: Vector<2>, v: Vector<2>| u[0] * v[1] - u[1] * v[0];
    let (de, dp) = (e1 - e0, p1 - p0);
    let (a, b, c) = (cross(de, dp), cross(e0, dp) + cross(de, p0), cross(e0, p0));
    let admissible = |theta: f64| (theta.is_finite() && (-0.1..=1.1).contains(&theta)).then_some(theta);
    let discriminant = b * b - 4.0 * a * c;
    if a.abs() <= 1e-14 * (b.abs() + c.abs()) || discriminant < 0.0 {
        return [if b == 0.0 { None } else { admissible(-c / b) }, None];
    }
    let q = -0.5 * (b + b.signum() * discriminant.sqrt());
    [admissible(q / a), if q == 0.0 { None } else { admissible(c / q) }]
}

/// Newton on the curve from a chord's root. Only inward crossings count: the node's velocity
/// relative to the surface is opposite to its normal.
fn polished(facet: Facet, before: Places, now: Places, node: usize, start: Crossing) -> Option<Crossing> {
    let Crossing { mut theta, mut xi } = start;
    for _ in 0..20 {
        let shape = facet.shape.at(xi);
        let (mut position, mut tangent, mut velocity) = (Vector::ZERO, Vector::ZERO, Vector::ZERO);
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
            let valid = (-TOLERANCE..=1.0 + TOLERANCE).contains(&theta) && xi.abs() <= 1.0 + TOLERANCE;
            return (inwards && valid).then_some(Crossing { theta, xi });
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use carom_solid::FacetShape;

    use super::*;

    /// Facet along x traversed so that its normal is +y, i.e. from right to left.
    const FACET: Facet = Facet { shape: FacetShape::L4, nodes: &[1, 2, 3, 4], orientation: 1.0 };

    fn scene(from: [f64; 2], to: [f64; 2], bulge: f64) -> (Vec<f64>, Vec<f64>) {
        let curve = [[1.0, 0.0], [-1.0, 0.0], [1.0 / 3.0, bulge], [-1.0 / 3.0, bulge]];
        let with = |node: [f64; 2]| [&node[..], curve.as_flattened()].concat();
        (with(from), with(to))
    }

    fn crossed(before: &[f64], now: &[f64]) -> Option<Crossing> {
        crossing(FACET, Places::new(before, 2), Places::new(now, 2), 0)
    }

    #[test]
    fn meets_a_cubic_where_the_node_is_on_it() {
        let (before, now) = scene([0.2, 1.0], [0.3, -1.0], 0.2);
        let found = crossed(&before, &now).unwrap();
        let y = lerp(Places::new(&before, 2).at(0), Places::new(&now, 2).at(0), found.theta);
        let surface = FACET.at(Places::new(&before, 2), found.xi).position;
        assert!((y - surface).norm() < 1e-12);
    }

    #[test]
    fn passes_right_through_a_thin_body_are_seen_and_exits_are_not() {
        let (before, now) = scene([0.0, 5.0], [0.0, -5.0], 0.0);
        assert!((crossed(&before, &now).unwrap().theta - 0.5).abs() < 1e-12);
        assert!(crossed(&now, &before).is_none());
    }

    #[test]
    fn touching_at_the_start_counts_within_the_tolerance() {
        let (before, now) = scene([0.0, -1e-9], [0.0, -0.1], 0.0);
        assert!(crossed(&before, &now).is_some());
        let (before, now) = scene([2.0, 1.0], [2.0, -1.0], 0.0);
        assert!(crossed(&before, &now).is_none());
    }

    #[test]
    fn moving_facets_are_met_where_they_will_be() {
        let (before, mut now) = scene([0.1, 1.0], [0.1, 1.0], 0.1);
        for y in now[2..].as_chunks_mut::<2>().0 {
            y[1] += 2.0;
        }
        let found = crossed(&before, &now).unwrap();
        assert!(found.theta > 0.4 && found.theta < 0.5);
    }
}
