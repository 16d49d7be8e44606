//! Exact queries of edges against edges, an oracle of many starts of Newton's method, and starts in
//! contact.

use carom_algebra::{Mat, Vector};
use carom_contact::kinematics::space::patch::cross;
use carom_contact::{SpaceHit, SweptEdges};
use carom_solid::shape::line_shape;

use crate::swept::Numbers;
use crate::swept_patches::rotation;

/// Nodes of A and B at the start and at the end.
#[derive(Clone, Debug)]
struct Query {
    edges: [[Vec<Vector<3>>; 2]; 2],
    outwards: Vector<3>,
}

/// Nodes of a curve of a degree, ends first.
fn curve(degree: usize, at: impl Fn(f64) -> [f64; 3]) -> Vec<Vector<3>> {
    let place = |k: usize| match k {
        0 => -1.0,
        1 => 1.0,
        k => 2.0 * (k - 1) as f64 / degree as f64 - 1.0,
    };
    (0..=degree).map(|k| Vector(at(place(k)))).collect()
}

impl Query {
    fn each(&self, map: impl Fn(Vector<3>) -> Vector<3>) -> Self {
        let edges = self
            .edges
            .each_ref()
            .map(|both| both.each_ref().map(|nodes| nodes.iter().map(|&x| map(x)).collect::<Vec<_>>()));
        Self { edges, outwards: map(self.outwards) - map(Vector::ZERO) }
    }

    fn answer(&self, separation: f64) -> Option<SpaceHit> {
        let edges = self.edges.each_ref().map(|both| both.each_ref().map(Vec::as_slice));
        SweptEdges::default().first(edges, self.outwards, separation)
    }

    /// f, ∂f/∂θ, ∂f/∂a and ∂f/∂b.
    fn at(&self, xi: [f64; 2], theta: f64) -> [Vector<3>; 4] {
        let mut columns = [Vector::ZERO; 4];
        for of in 0..2 {
            let [before, now] = [&self.edges[0][of], &self.edges[1][of]];
            let shape = line_shape(before.len(), xi[of]);
            let sign = [1.0, -1.0][of];
            for (k, (before, now)) in before.iter().zip(now).enumerate() {
                let x = *before * (1.0 - theta) + *now * theta;
                columns[0] += x * (sign * shape.values[k]);
                columns[1] += (*now - *before) * (sign * shape.values[k]);
                columns[2 + of] += x * (sign * shape.first[k]);
            }
        }
        columns
    }

    /// Whether A moves into the body of B there.
    fn is_inwards(&self, xi: [f64; 2], theta: f64) -> bool {
        let [_, moved, a, b] = self.at(xi, theta);
        let normal = cross(a, -b);
        normal.dot(&moved) * normal.dot(&self.outwards) < 0.0
    }

    /// θ of the crossings inwards that Newton's method finds from many starts.
    fn crossings(&self) -> Vec<f64> {
        let mut found = Vec::new();
        for code in 0..6 * 6 * 6 {
            let part = |k: u32| f64::from(code / 6_i32.pow(k) % 6) / 5.0;
            let mut xi = [2.0 * part(0) - 1.0, 2.0 * part(1) - 1.0];
            let mut theta = part(2);
            for _ in 0..12 {
                let [f, by_theta, by_a, by_b] = self.at(xi, theta);
                let step = Mat([by_theta.0, by_a.0, by_b.0]).transposed().inverse().apply(&-f);
                theta += step[0];
                xi = [xi[0] + step[1], xi[1] + step[2]];
            }
            let inside = (0.0..=1.0).contains(&theta) && xi.iter().all(|x| x.abs() <= 1.0);
            if inside && self.at(xi, theta)[0].norm() < 1e-12 && self.is_inwards(xi, theta) {
                found.push(theta);
            }
        }
        found.sort_by(f64::total_cmp);
        found
    }
}

/// The answer is the first contact at an exact θ, within the tolerance, rotated, scaled, and in
/// half of the rounds far from the origin.
fn meets_at(query: &Query, exact: f64) {
    let mut numbers = Numbers(17);
    for round in 0..200 {
        let turn = rotation(&mut numbers);
        let scale = 10.0_f64.powf(4.0 * numbers.next());
        let shift = if round % 2 == 0 { Vector::ZERO } else { Vector([1e6, -1e6, 1e6]) * scale };
        let moved = query.each(|x| turn.apply(&x) * scale + shift);
        let rounding = if round % 2 == 0 { 1e-15 } else { 2e-9 };
        let Some(hit) = moved.answer(rounding * scale) else { panic!("missed {exact}: {moved:?}") };
        assert!(hit.theta <= exact + 1e-8 && exact - hit.theta < 2e-4, "{hit:?} for {exact}: {moved:?}");
    }
}

#[test]
fn a_parabola_is_met_by_a_falling_line_at_three_eighths() {
    // (s, 0, s²) for 0 ≤ s ≤ 1 against (½, t, z), z = 1 − 2θ: ¼ = 1 − 2θ.
    for degrees in [[2, 1], [2, 2], [3, 1], [3, 3]] {
        let parabola = || curve(degrees[0], |x| [0.5 * (x + 1.0), 0.0, 0.25 * (x + 1.0) * (x + 1.0)]);
        let line = |z: f64| curve(degrees[1], |x| [0.5, x, z]);
        for (a, outwards) in [(0, -1.0), (1, 1.0)] {
            let mut edges = [1.0, -1.0].map(|z| [parabola(), line(z)]);
            edges.iter_mut().for_each(|both| both.rotate_left(a));
            meets_at(&Query { edges, outwards: Vector([0.0, 0.0, outwards]) }, 3.0 / 8.0);
        }
    }
}

#[test]
fn a_line_that_tilts_meets_a_line_at_two_thirds() {
    // (0, 0, 0)–(1, 0, 0) against (½, −1, 1)–(½, 1, 1), whose first end falls to z = −2.
    let fixed = || vec![Vector([0.0, 0.0, 0.0]), Vector([1.0, 0.0, 0.0])];
    let tilted = |z: f64| vec![Vector([0.5, -1.0, z]), Vector([0.5, 1.0, 1.0])];
    let edges = [1.0, -2.0].map(|z| [tilted(z), fixed()]);
    meets_at(&Query { edges, outwards: Vector([0.0, 0.0, 1.0]) }, 2.0 / 3.0);
}

#[test]
fn starts_in_contact_and_motion_outwards_and_beside() {
    let across = |z: f64| vec![Vector([0.3, -1.0, z]), Vector([0.3, 1.0, z])];
    let fixed = |from: f64| vec![Vector([from, 0.0, 0.0]), Vector([from + 1.0, 0.0, 0.0])];
    let query = |from: [f64; 2], x: f64| Query {
        edges: from.map(|z| [across(z), fixed(x)]),
        outwards: Vector([0.0, 0.0, 1.0]),
    };
    assert_eq!(query([0.0, 1.0], 0.0).answer(1e-9), None);
    assert_eq!(query([-1.0, 1.0], 0.0).answer(1e-9), None);
    assert_eq!(query([1.0, -1.0], 0.4).answer(1e-9), None);
    assert!(query([0.0, -1.0], 0.0).answer(1e-9).is_some_and(|hit| hit.theta == 0.0));
    assert!(query([0.0, 0.0], 0.0).answer(1e-9).is_some());
    assert!(query([1.0, -1.0], f64::NAN).answer(1e-9).is_some_and(|hit| hit.theta == 0.0));
    // Through an end of either.
    assert!(query([1.0, -1.0], 0.3).answer(1e-9).is_some_and(|hit| (hit.theta - 0.5).abs() < 1e-4));
}

#[test]
fn no_crossing_of_random_curves_is_missed() {
    let mut numbers = Numbers(23);
    let mut hits = 0;
    let mut clear = 0;
    let mut apart = 0;
    for round in 0..4_000 {
        let bend = 0.4 * numbers.next().abs();
        let mut vector = |size: f64| Vector(std::array::from_fn(|_| size * numbers.next()));
        let motion = vector(1.0);
        let outwards = Vector([0.0, 0.0, 1.0]);
        let a: Vec<_> =
            curve(1 + round % 3, |x| [x, 0.0, 0.5]).into_iter().map(|x| x + vector(bend)).collect();
        let b: Vec<_> =
            curve(1 + round / 3 % 3, |x| [0.0, x, 0.0]).into_iter().map(|x| x + vector(bend)).collect();
        let moved = |from: &[Vector<3>], by: Vector<3>, vector: &mut dyn FnMut(f64) -> Vector<3>| {
            from.iter().map(|x| *x + by + vector(bend)).collect::<Vec<_>>()
        };
        let fall = vector(1.0) + motion + Vector([0.0, 0.0, -0.8]);
        let later = [moved(&a, fall, &mut vector), moved(&b, motion, &mut vector)];
        let query = Query { edges: [[a, b], later], outwards };
        let first = query.crossings().first().copied();
        match (query.answer(0.0), first) {
            (None, Some(first)) => panic!("missed {first}: {query:?}"),
            (None, None) => clear += 1,
            (Some(SpaceHit { theta, xi }), first) => {
                hits += 1;
                assert!(first.is_none_or(|first| theta <= first + 1e-9), "{theta} {first:?}: {query:?}");
                // A false or early hit is near a contact.
                assert!(query.at(xi, theta)[0].norm() < 1e-3, "{theta} {xi:?} {query:?}");
                apart += usize::from(first.is_none_or(|first| first - theta > 1e-3));
            }
        }
    }
    assert!(hits > 1_000 && clear > 1_000, "{hits} {clear}");
    assert!(apart < hits / 50, "{apart} of {hits} are far from the crossing that was found");
}
