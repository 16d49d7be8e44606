//! Exact queries in space, an oracle of many starts of Newton's method, and the degenerate ones.

use carom_algebra::{Mat, Vector};
use carom_contact::kinematics::space::patch::cross;
use carom_contact::{SpaceHit, SweptPatch};
use carom_solid::FacetShape;

use crate::swept::Numbers;

const SHAPES: [FacetShape; 5] =
    [FacetShape::T3, FacetShape::T6, FacetShape::T10, FacetShape::Q4, FacetShape::Q9];

#[derive(Clone, Debug)]
struct Query {
    shape: FacetShape,
    node: [Vector<3>; 2],
    facet: [Vec<Vector<3>>; 2],
}

/// ξ of the nodes of a shape, from the values of its functions there.
fn nodes(shape: FacetShape) -> Vec<[f64; 2]> {
    let grid = || (0..=12).flat_map(|i| (0..=12).map(move |j| (i, j)));
    let place = |(i, j): (i32, i32)| match shape.corners() {
        3 => [f64::from(i) / 12.0, f64::from(j) / 12.0],
        _ => [f64::from(i) / 6.0 - 1.0, f64::from(j) / 6.0 - 1.0],
    };
    let is_node = |a: usize, xi: [f64; 2]| {
        let values = shape.functions(xi).values;
        (0..shape.nodes()).all(|b| (values[b] - f64::from(u8::from(a == b))).abs() < 1e-12)
    };
    let at = |a: usize| grid().map(place).find(|&xi| is_node(a, xi)).expect("a node of the grid");
    (0..shape.nodes()).map(at).collect()
}

impl Query {
    /// A surface x = at(ξ) at the start and at the end, of any degree up to the shape's.
    fn new(shape: FacetShape, node: [[f64; 3]; 2], surfaces: [&dyn Fn([f64; 2]) -> [f64; 3]; 2]) -> Self {
        let facet = surfaces.map(|at| nodes(shape).into_iter().map(|xi| Vector(at(xi))).collect());
        Self { shape, node: node.map(Vector), facet }
    }

    /// A facet whose nodes are moved by up to `bend`, and that moves by up to 1.
    fn random(shape: FacetShape, numbers: &mut Numbers) -> Self {
        let bend = 0.4 * numbers.next().abs();
        let mut vector = |size: f64| Vector(std::array::from_fn(|_| size * numbers.next()));
        let motion = vector(1.0);
        let before: Vec<_> =
            nodes(shape).into_iter().map(|[x, y]| Vector([x, y, 0.0]) + vector(bend)).collect();
        let now = before.iter().map(|x| *x + motion + vector(bend)).collect();
        Self {
            shape,
            node: [vector(1.0) + Vector([0.2, 0.2, 0.5]), vector(1.0) + Vector([0.2, 0.2, -0.5]) + motion],
            facet: [before, now],
        }
    }

    fn each(&self, map: impl Fn(Vector<3>) -> Vector<3>) -> Self {
        let facet = self.facet.each_ref().map(|f| f.iter().map(|&x| map(x)).collect());
        Self { shape: self.shape, node: self.node.map(&map), facet }
    }

    /// f, ∂f/∂θ and ∂f/∂ξ.
    fn at(&self, xi: [f64; 2], theta: f64) -> [Vector<3>; 4] {
        let functions = self.shape.functions(xi);
        let mut columns = [
            self.node[0] * (1.0 - theta) + self.node[1] * theta,
            self.node[1] - self.node[0],
            Vector::ZERO,
            Vector::ZERO,
        ];
        for (k, (before, now)) in self.facet[0].iter().zip(&self.facet[1]).enumerate() {
            let x = *before * (1.0 - theta) + *now * theta;
            columns[0] += x * -functions.values[k];
            columns[1] += (*now - *before) * -functions.values[k];
            (0..2).for_each(|i| columns[2 + i] += x * -functions.slopes[i][k]);
        }
        columns
    }

    fn answer(&self, separation: f64) -> Option<SpaceHit> {
        let facet = self.facet.each_ref().map(Vec::as_slice);
        SweptPatch::new(self.shape).first(self.node, facet, separation)
    }

    /// θ of the crossings to the inner side that Newton's method finds from many starts.
    fn crossings(&self) -> Vec<f64> {
        let mut found = Vec::new();
        let inside = |[x, y]: [f64; 2]| match self.shape.corners() {
            3 => x >= 0.0 && y >= 0.0 && x + y <= 1.0,
            _ => x.abs() <= 1.0 && y.abs() <= 1.0,
        };
        for code in 0..5 * 5 * 5 {
            let part = |k: u32| f64::from(code / 5_i32.pow(k) % 5) / 4.0;
            let mut xi = [part(0), part(1)];
            let mut theta = part(2);
            if self.shape.corners() == 4 {
                xi = xi.map(|x| 2.0 * x - 1.0);
            }
            for _ in 0..12 {
                let [f, by_theta, by_xi, by_eta] = self.at(xi, theta);
                let step = Mat([by_theta.0, by_xi.0, by_eta.0]).transposed().inverse().apply(&-f);
                theta += step[0];
                xi = [xi[0] + step[1], xi[1] + step[2]];
            }
            let [f, by_theta, by_xi, by_eta] = self.at(xi, theta);
            let inwards = by_theta.dot(&cross(by_xi, by_eta)) < 0.0;
            if f.norm() < 1e-12 && (0.0..=1.0).contains(&theta) && inside(xi) && inwards {
                found.push(theta);
            }
        }
        found.sort_by(f64::total_cmp);
        found
    }
}

/// The rotation of a random unit quaternion.
pub(crate) fn rotation(numbers: &mut Numbers) -> Mat<3> {
    let q: [f64; 4] = std::array::from_fn(|_| numbers.next());
    let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [w, x, y, z] = q.map(|q| q / norm);
    Mat([
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ])
}

/// The answer is the first contact at an exact θ, within the tolerance, rotated, scaled, and in
/// half of the rounds far from the origin.
fn meets_at(query: &Query, exact: f64) {
    meets_in(0..100, query, exact);
}

fn meets_in(rounds: impl Iterator<Item = usize>, query: &Query, exact: f64) {
    let mut numbers = Numbers(11);
    for round in rounds {
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
fn a_paraboloid_is_met_where_its_equation_says() {
    // z = x² + y² at (¼ + θ/4, ¼) and 1 − 2θ: θ² + 34 θ − 14 = 0.
    let exact = 303.0_f64.sqrt() - 17.0;
    let surface: &dyn Fn([f64; 2]) -> [f64; 3] = &|[x, y]| [x, y, x * x + y * y];
    for shape in [FacetShape::T6, FacetShape::T10, FacetShape::Q9] {
        meets_at(&Query::new(shape, [[0.25, 0.25, 1.0], [0.5, 0.25, -1.0]], [surface; 2]), exact);
    }
}

#[test]
fn a_triangle_that_tilts_is_met_at_two_thirds() {
    let flat: &dyn Fn([f64; 2]) -> [f64; 3] = &|[x, y]| [x, y, 0.0];
    let tilted: &dyn Fn([f64; 2]) -> [f64; 3] = &|[x, y]| [x, y, 1.0 - x - y];
    for shape in SHAPES {
        meets_at(&Query::new(shape, [[0.25, 0.25, 1.0], [0.25, 0.25, 0.0]], [flat, tilted]), 2.0 / 3.0);
    }
}

#[test]
fn motion_in_the_plane_of_a_triangle_is_met_at_its_edge() {
    let flat: &dyn Fn([f64; 2]) -> [f64; 3] = &|[x, y]| [x, y, 0.0];
    for shape in &SHAPES[..3] {
        // Far from the origin, round-off decides on which side of the plane.
        let query = Query::new(*shape, [[-0.5, 0.25, 0.0], [0.5, 0.25, 0.0]], [flat; 2]);
        meets_in((0..100).step_by(2), &query, 0.5);
    }
}

#[test]
fn starts_in_contact_vertices_and_rest() {
    let flat: &dyn Fn([f64; 2]) -> [f64; 3] = &|[x, y]| [x, y, 0.0];
    for shape in SHAPES {
        let from = |a: [f64; 3], b: [f64; 3]| Query::new(shape, [a, b], [flat; 2]);
        let corner = if shape.corners() == 3 { [0.0; 2] } else { [-1.0; 2] };
        let [x, y] = corner;
        // Through a vertex.
        meets_at(&from([x, y, 1.0], [x, y, -3.0]), 0.25);
        // On the surface: away from it, into it, and at rest.
        assert_eq!(from([0.25, 0.25, 0.0], [0.3, 0.25, 1.0]).answer(1e-9), None);
        let inwards = from([0.25, 0.25, 0.0], [0.3, 0.25, -1.0]).answer(1e-9);
        assert!(inwards.is_some_and(|hit| hit.theta == 0.0), "{inwards:?}");
        assert!(from([0.25, 0.25, 0.0], [0.25, 0.25, 0.0]).answer(1e-9).is_some());
        // From inside to outside, and beside it.
        assert_eq!(from([0.25, 0.25, -1.0], [0.25, 0.25, 1.0]).answer(1e-9), None);
        assert_eq!(from([1.5, 1.5, 1.0], [1.5, 1.5, -1.0]).answer(1e-9), None);
        let bad = from([f64::NAN, 0.0, 1.0], [0.25, 0.25, -1.0]).answer(1e-9);
        assert!(bad.is_some_and(|hit| hit.theta == 0.0));
    }
}

#[test]
fn no_crossing_of_random_surfaces_is_missed() {
    let mut numbers = Numbers(5);
    let mut hits = 0;
    let mut clear = 0;
    let mut apart = 0;
    for round in 0..4_000 {
        let query = Query::random(SHAPES[round % 5], &mut numbers);
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
