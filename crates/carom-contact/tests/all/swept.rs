//! Exact queries, a slow oracle that shares no code with the test, and the degenerate ones.

use std::f64::consts::TAU;

use carom_algebra::Vector;
use carom_contact::{Crossings, Swept, SweptTest};
use carom_solid::FacetShape;
use carom_solid::shape::line_shape;

const SHAPES: [FacetShape; 3] = [FacetShape::L2, FacetShape::L3, FacetShape::L4];

/// Deterministic numbers in −1..1 (SplitMix64).
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> Vector<2> {
        Vector([self.next(), self.next()])
    }
}

#[derive(Clone, Debug)]
struct Query {
    shape: FacetShape,
    node: [Vector<2>; 2],
    facet: [Vec<Vector<2>>; 2],
}

impl Query {
    /// A curve x = at(ξ) at the start and at the end, of any degree up to the shape's.
    fn new(shape: FacetShape, node: [[f64; 2]; 2], curves: [&dyn Fn(f64) -> [f64; 2]; 2]) -> Self {
        let places: &[f64] = match shape {
            FacetShape::Point => &[0.0],
            FacetShape::L2 => &[-1.0, 1.0],
            FacetShape::L3 => &[-1.0, 1.0, 0.0],
            _ => &[-1.0, 1.0, -1.0 / 3.0, 1.0 / 3.0],
        };
        let facet = curves.map(|curve| places.iter().map(|&xi| Vector(curve(xi))).collect());
        Self { shape, node: node.map(Vector), facet }
    }

    fn random(shape: FacetShape, numbers: &mut Numbers) -> Self {
        let mut curve = || (0..shape.nodes()).map(|_| numbers.vector()).collect::<Vec<_>>();
        let before = curve();
        let mut now = curve();
        if numbers.next() > 0.0 {
            // A facet that hardly moves.
            let amount = 0.1 * numbers.next();
            now = before.iter().zip(&now).map(|(b, n)| *b + (*n - *b) * amount).collect();
        }
        Self { shape, node: [numbers.vector(), numbers.vector()], facet: [before, now] }
    }

    fn each(&self, map: impl Fn(Vector<2>) -> Vector<2>) -> Self {
        let facet = self.facet.each_ref().map(|f| f.iter().map(|&x| map(x)).collect());
        Self { shape: self.shape, node: self.node.map(&map), facet }
    }

    /// Scaled, rotated, translated.
    fn moved(&self, scale: f64, angle: f64, shift: Vector<2>) -> Self {
        let (sin, cos) = angle.sin_cos();
        self.each(|x| Vector([cos * x[0] - sin * x[1], sin * x[0] + cos * x[1]]) * scale + shift)
    }

    /// f(ξ, θ), from the shape functions.
    fn distance(&self, xi: f64, theta: f64) -> Vector<2> {
        let [f, g] = self.difference(xi);
        f + g * theta
    }

    /// f(ξ, 0) and ∂f/∂θ.
    fn difference(&self, xi: f64) -> [Vector<2>; 2] {
        let values = line_shape(self.shape.nodes(), xi).values;
        let at = |end: usize| {
            let on = self.facet[end].iter().zip(values).fold(Vector::ZERO, |sum, (x, w)| sum + *x * w);
            self.node[end] - on
        };
        [at(0), at(1) - at(0)]
    }

    fn answer(&self, crossings: Crossings, separation: f64) -> Swept {
        let facet = self.facet.each_ref().map(Vec::as_slice);
        SweptTest::new(self.shape).first(self.node, facet, crossings, separation)
    }

    fn all(&self) -> Swept {
        self.answer(Crossings::All, 0.0)
    }

    /// Every θ of contact, ascending, with ξ: roots of the resultant f₀ × f_θ of degree ≤ 6 in ξ,
    /// between its stationary points.
    fn exact(&self) -> Vec<(f64, f64)> {
        let resultant = |xi: f64| {
            let [f, g] = self.difference(xi);
            f.dot(&g.turned_right())
        };
        let mut found: Vec<_> = roots(&polynomial(resultant))
            .into_iter()
            .filter_map(|xi| {
                let [f, g] = self.difference(xi);
                let theta = -f.dot(&g) / g.dot(&g);
                (0.0..=1.0).contains(&theta).then_some((theta, xi))
            })
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    }

    /// Whether the node moves inwards at a contact.
    fn goes_in(&self, (theta, xi): (f64, f64)) -> bool {
        let h = 1e-6;
        let tangent = self.distance(xi - h, theta) - self.distance(xi + h, theta);
        self.difference(xi)[1].dot(&tangent.turned_right()) < 0.0
    }
}

/// Coefficients of powers of ξ of a polynomial of degree 6, by divided differences.
fn polynomial(at: impl Fn(f64) -> f64) -> Vec<f64> {
    const N: usize = 7;
    let places: Vec<f64> = (0..N).map(|k| (TAU * (k as f64 + 0.5) / (2 * N) as f64).cos()).collect();
    let mut newton: Vec<f64> = places.iter().map(|&x| at(x)).collect();
    for order in 1..N {
        for k in (order..N).rev() {
            newton[k] = (newton[k] - newton[k - 1]) / (places[k] - places[k - order]);
        }
    }
    let mut powers = vec![0.0; N];
    for k in (0..N).rev() {
        for i in (1..N).rev() {
            powers[i] = powers[i - 1] - places[k] * powers[i];
        }
        powers[0] = newton[k] - places[k] * powers[0];
    }
    powers
}

/// Roots in −1..1 with a change of sign: a polynomial is monotone between the roots of its
/// derivative.
fn roots(powers: &[f64]) -> Vec<f64> {
    if powers.len() <= 1 {
        return Vec::new();
    }
    let at = |x: f64| powers.iter().rev().fold(0.0, |sum, c| sum * x + c);
    let slope: Vec<f64> = powers.iter().enumerate().skip(1).map(|(i, c)| i as f64 * c).collect();
    let mut ends = vec![-1.0];
    ends.extend(roots(&slope));
    ends.push(1.0);
    let mut found = Vec::new();
    for ends in ends.windows(2) {
        let mut low = ends[0];
        let mut high = ends[1];
        if at(low) * at(high) >= 0.0 {
            continue;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if at(low) * at(middle) <= 0.0 { high = middle } else { low = middle }
        }
        found.push(0.5 * (low + high));
    }
    found
}

/// A query rotated, scaled, and far from the origin, with the bound of the change of the
/// positions by round-off.
fn everywhere(query: &Query, mut check: impl FnMut(&Query, f64)) {
    let mut numbers = Numbers(7);
    check(query, 1e-15);
    for _ in 0..200 {
        let scale = 10.0_f64.powf(4.0 * numbers.next());
        check(&query.moved(scale, TAU * numbers.next(), Vector::ZERO), 1e-15 * scale);
        check(&query.moved(1.0, TAU * numbers.next(), numbers.vector() * 1e6), 1e-9);
    }
}

/// The answer of a query is the first contact at an exact θ, within the stated tolerance.
fn meets_at(query: &Query, exact: f64, crossings: &[Crossings]) {
    everywhere(query, |query, rounding| {
        for &crossings in crossings {
            // Beside an end, round-off decides.
            let Swept::Hit { theta, .. } = query.answer(crossings, rounding) else {
                panic!("missed {exact}: {query:?}")
            };
            assert!(theta <= exact + 1e-8 && exact - theta < 1.5e-5, "{theta} for {exact}: {query:?}");
        }
    });
}

const BOTH: &[Crossings] = &[Crossings::All, Crossings::Inward];

/// Curves are traversed from right to left: their outer side is above.
const PARABOLA: &dyn Fn(f64) -> [f64; 2] = &|xi| [-xi, xi * xi];

#[test]
fn a_parabola_is_met_at_four_ninths() {
    for shape in [FacetShape::L3, FacetShape::L4] {
        let node = [[1.0 / 3.0, 1.0], [1.0 / 3.0, -1.0]];
        meets_at(&Query::new(shape, node, [PARABOLA; 2]), 4.0 / 9.0, BOTH);
    }
}

#[test]
fn a_parabola_that_turns_over_is_met_at_one_third() {
    for shape in [FacetShape::L3, FacetShape::L4] {
        let node = [[0.5, 0.5], [0.5, -0.75]];
        meets_at(&Query::new(shape, node, [PARABOLA, &|xi| [-xi, -xi * xi]]), 1.0 / 3.0, BOTH);
    }
}

#[test]
fn the_first_of_three_crossings_of_a_cubic_is_found() {
    // Node and curve pass y = 0 at x = −1/2, 0, 1/2: inwards, outwards, inwards, if the outer side
    // is on the left.
    let cubic = |x: f64| [x, x * x * x - 0.25 * x];
    let node = [[-1.0, 0.0], [1.0, 0.0]];
    let up = Query::new(FacetShape::L4, node, [&|xi| cubic(-xi); 2]);
    meets_at(&up, 0.25, BOTH);
    // Traversed the other way, the first crossing is outwards.
    let down = Query::new(FacetShape::L4, node, [&cubic; 2]);
    everywhere(&down, |query, _| {
        let Swept::Hit { theta, .. } = query.answer(Crossings::Inward, 0.0) else { panic!("{query:?}") };
        assert!(theta <= 0.5 + 1e-8 && theta > 0.5 - 1.5e-5);
        let Swept::Hit { theta, .. } = query.all() else { panic!("{query:?}") };
        assert!(theta <= 0.25 + 1e-8 && theta > 0.25 - 1.5e-5);
    });
}

#[test]
fn grazing_is_decided_within_the_tolerance() {
    let at = |h: f64| {
        let node = [[-0.5, h], [0.5, h]];
        Query::new(FacetShape::L3, node, [PARABOLA; 2])
    };
    everywhere(&at(0.0), |query, _| {
        assert!(matches!(query.all(), Swept::Hit { theta, .. } if theta < 0.5 + 1e-6 && theta > 0.49));
    });
    // Along a chord of the parabola: h = 1e-12 meets it at ½ − 1e-6.
    everywhere(&at(1e-12), |query, _| assert!(matches!(query.all(), Swept::Hit { .. })));
    everywhere(&at(-1e-5), |query, _| assert_eq!(query.all(), Swept::Clear));
    let precise = |h: f64, separation: f64| {
        let query = at(h);
        let facet = query.facet.each_ref().map(Vec::as_slice);
        let mut test = SweptTest::new(FacetShape::L3).with_tolerance(1e-12);
        test.first(query.node, facet, Crossings::All, separation)
    };
    assert_eq!(precise(-1e-11, 0.0), Swept::Clear);
    assert!(matches!(precise(-1e-11, 1e-10), Swept::Hit { .. }));
    let Swept::Hit { theta, .. } = precise(1e-12, 0.0) else { panic!("missed") };
    assert!(theta <= 0.5 - 0.999e-6 && theta > 0.5 - 4e-6, "{theta}");
}

#[test]
fn motion_along_one_line_is_met_at_the_end() {
    for shape in SHAPES {
        let line: &dyn Fn(f64) -> [f64; 2] = &|xi| [0.5 + 0.5 * xi, 0.0];
        let query = Query::new(shape, [[-0.5, 0.0], [0.5, 0.0]], [line; 2]);
        // Round-off decides on which side of the line.
        meets_at(&query, 0.5, &[Crossings::All]);
        let apart = Query::new(shape, [[-0.5, 0.0], [-0.001, 0.0]], [line; 2]);
        everywhere(&apart, |query, _| assert_eq!(query.all(), Swept::Clear));
    }
}

#[test]
fn a_start_in_contact_is_decided_by_the_direction_of_motion() {
    let from = |to: [f64; 2]| Query::new(FacetShape::L3, [[0.25, 0.0625], to], [PARABOLA; 2]);
    for crossings in [Crossings::All, Crossings::Inward] {
        // Binary numbers: exactly on the curve.
        assert_eq!(from([0.25, 0.5]).answer(crossings, 0.0), Swept::Clear);
        assert_eq!(from([0.25, 0.5]).answer(crossings, 1e-6), Swept::Clear);
        assert!(matches!(from([0.25, 0.0]).answer(crossings, 0.0), Swept::Hit { theta: 0.0, .. }));
        // Without motion, nothing is proved.
        assert!(matches!(from([0.25, 0.0625]).answer(crossings, 0.0), Swept::Hit { theta: 0.0, .. }));
        // Closer than the separation, on either side.
        let near = |y: f64, to: f64| {
            Query::new(FacetShape::L3, [[0.25, y], [0.25, to]], [PARABOLA; 2]).answer(crossings, 1e-6)
        };
        for start in [0.0625 - 5e-7, 0.0625 + 5e-7] {
            assert!(matches!(near(start, 0.0), Swept::Hit { theta: 0.0, .. }));
            assert_eq!(near(start, 0.5), Swept::Clear);
        }
    }
    // Leaves the right branch, and meets the left one.
    let across = from([-1.0, 0.5]);
    assert!(matches!(across.all(), Swept::Hit { theta, .. } if theta > 0.5));
}

#[test]
fn a_shared_vertex_is_met_by_both_facets() {
    for shape in SHAPES {
        let left: &dyn Fn(f64) -> [f64; 2] = &|xi| [-0.5 - 0.5 * xi, 0.0];
        let right: &dyn Fn(f64) -> [f64; 2] = &|xi| [0.5 - 0.5 * xi, 0.1 - 0.1 * xi];
        for side in [left, right] {
            // The right one ends at the origin with ξ = 1, where the left one starts.
            meets_at(&Query::new(shape, [[0.0, 1.0], [0.0, -3.0]], [side; 2]), 0.25, BOTH);
        }
    }
}

#[test]
fn facets_and_nodes_of_one_point_and_positions_that_are_not_finite() {
    for shape in SHAPES {
        let point: &dyn Fn(f64) -> [f64; 2] = &|_| [0.0, 0.0];
        let at = |a: [f64; 2], b: [f64; 2]| Query::new(shape, [a, b], [point; 2]).all();
        assert_eq!(at([1.0, 0.0], [1.0, 0.0]), Swept::Clear);
        assert!(matches!(at([0.0, 0.0], [0.0, 0.0]), Swept::Hit { theta: 0.0, .. }));
        assert!(
            matches!(at([1.0, 0.0], [-1.0, 0.0]), Swept::Hit { theta, .. } if theta <= 0.5 && theta > 0.49)
        );
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(matches!(at([bad, 0.0], [5.0, 0.0]), Swept::Hit { theta: 0.0, .. }));
            let broken = Query::new(shape, [[5.0, 0.0]; 2], [point, &|_| [0.0, bad]]);
            assert!(matches!(broken.all(), Swept::Hit { theta: 0.0, .. }));
        }
    }
}

#[test]
fn no_crossing_of_random_curves_is_missed() {
    let mut numbers = Numbers(1);
    let mut hits = 0;
    let mut clear = 0;
    let mut apart = 0;
    for round in 0..30_000 {
        let query = Query::random(SHAPES[round % 3], &mut numbers);
        let exact = query.exact();
        for crossings in [Crossings::All, Crossings::Inward] {
            let counts = |c: &&(f64, f64)| crossings == Crossings::All || query.goes_in(**c);
            let first = exact.iter().find(counts);
            match (query.answer(crossings, 0.0), first) {
                (Swept::Clear, Some(first)) => panic!("missed {first:?} of {exact:?}: {query:?}"),
                (Swept::Clear, None) => clear += 1,
                (Swept::Hit { theta, xi }, first) => {
                    hits += 1;
                    assert!(first.is_none_or(|f| theta <= f.0 + 1e-9), "{theta} {exact:?}: {query:?}");
                    // A false or early hit is near a contact.
                    assert!(query.distance(xi, theta).norm() < 6e-5, "{theta} {xi} {query:?}");
                    apart += usize::from(first.is_none_or(|f| f.0 - theta > 1e-4));
                }
            }
        }
    }
    assert!(hits > 5_000 && clear > 5_000, "{hits} {clear}");
    assert!(apart < hits / 500, "{apart} of {hits} are far from the exact θ");
}

#[test]
fn answers_do_not_depend_on_earlier_queries_or_on_the_place() {
    let mut numbers = Numbers(3);
    let mut test = SweptTest::new(FacetShape::L4);
    for _ in 0..2_000 {
        let query = Query::random(FacetShape::L4, &mut numbers);
        let facet = query.facet.each_ref().map(Vec::as_slice);
        let reused = test.first(query.node, facet, Crossings::All, 0.0);
        assert_eq!(reused, query.all());
        // Powers of two change nothing but the exponents.
        let scaled = query.each(|x| x * 1024.0).all();
        assert_eq!(scaled, reused);
    }
}
