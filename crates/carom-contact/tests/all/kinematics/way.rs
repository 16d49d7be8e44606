//! The largest depth of a node on its way through a body, between two instants of a step.

use carom_algebra::Vector;
use carom_contact::kinematics::way::{Allowed, KNOWN, Seen, Way, deepest, most_between};
use carom_solid::FacetShape;

/// A depth as a function of θ.
struct Curve<F>(F, f64, usize);

impl<F: Fn(f64) -> f64> Way for Curve<F> {
    fn seen(&mut self, theta: f64) -> Option<Seen> {
        self.2 += 1;
        Some(self.on(theta, self.2, [0.0; 2], (self.0)(theta)))
    }

    fn on(&self, theta: f64, facet: usize, xi: [f64; 2], depth: f64) -> Seen {
        Seen { theta, facet, xi, depth, speed: self.1, limit: 0.01 }
    }

    fn between(&self, _: &Seen, _: &Seen) -> f64 {
        f64::INFINITY
    }

    fn normal(&mut self, _: &Seen) -> Vector<3> {
        Vector::ZERO
    }

    fn allow(&mut self, _: Allowed) {}
}

#[test]
fn a_short_depth_between_two_instants_is_found() {
    // A spike of slope 8, and none of which the limit is 0.01.
    for (at, height) in [(0.5, 0.02), (0.313, 0.02), (0.9117, 0.015), (0.02, 0.03)] {
        let spike = |theta: f64| height - 8.0 * f64::abs(theta - at);
        let mut way = Curve(spike, 8.0, 0);
        let ends = [0.0, 1.0].map(|theta| way.seen(theta).unwrap());
        let found = deepest(&mut way, ends, 8.0).unwrap();
        assert!(found.depth > height / KNOWN && found.depth <= height, "{found:?}");
        assert!(way.2 < 100, "{} instants", way.2);
        let mut flat = Curve(|theta| spike(theta).min(0.0099), 8.0, 0);
        let ends = [0.0, 1.0].map(|theta| flat.seen(theta).unwrap());
        assert!(deepest(&mut flat, ends, 8.0).is_none());
    }
}

#[test]
fn an_offset_is_bounded_by_its_polynomial() {
    // The node slides along a facet that turns: the largest offset of a dense scan is below the
    // and the bound of a short interval is near it.
    let shapes = [
        FacetShape::L2,
        FacetShape::L3,
        FacetShape::L4,
        FacetShape::T3,
        FacetShape::T6,
        FacetShape::T10,
        FacetShape::Q4,
        FacetShape::Q9,
    ];
    for (round, shape) in shapes.into_iter().enumerate() {
        let number = |k: usize| (1.7 * (k + 31 * round) as f64).sin();
        let places = |shift: usize| -> Vec<Vector<3>> {
            (0..=shape.nodes()).map(|n| Vector([0, 1, 2].map(|i| number(shift + 3 * n + i)))).collect()
        };
        let both = [places(0), places(57)];
        let ends = [[0.1, 0.2], [0.6, 0.3]];
        let offset = |late: f64, xi: [f64; 2]| {
            let at = |n: usize| both[0][n] * (1.0 - late) + both[1][n] * late;
            let values = shape.functions(xi).values;
            (0..shape.nodes()).fold(at(shape.nodes()), |sum, n| sum - at(n) * values[n])
        };
        let xi = |t: f64| [0, 1].map(|i: usize| ends[0][i] + t * (ends[1][i] - ends[0][i]));
        let most = |[low, high]: [f64; 2]| {
            let at = [xi(low), xi(high)];
            most_between(shape, at, |end, xi| offset([low, high][end], xi))
        };
        let scan = |low: f64, high: f64| {
            let at = |k: i32| low + (high - low) * f64::from(k) / 500.0;
            (0..=500).map(|k| offset(at(k), xi(at(k))).norm()).fold(0.0, f64::max)
        };
        assert!(scan(0.0, 1.0) <= most([0.0, 1.0]) * (1.0 + 1e-12), "{shape:?}");
        let near = scan(0.4, 0.41);
        let bound = most([0.4, 0.41]);
        assert!(near <= bound * (1.0 + 1e-12) && bound < near * (1.0 + 1e-3), "{shape:?} {near} {bound}");
    }
}
