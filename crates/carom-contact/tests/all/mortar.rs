//! Weighted gaps: their derivatives against differences, balance of force and moment for any cut,
//! rigid motions, and what they integrate.

use carom_algebra::{Vector, jacobian_error};
use carom_contact::{
    Carrier, Combined, Detection, Kinematics, Mortar, NodeToFacet, NodeToObstacle, Obstacle, Pair,
    Quadrature, Rows, Surface,
};
use carom_solid::FacetShape;

const SHAPES: [FacetShape; 3] = [FacetShape::L2, FacetShape::L3, FacetShape::L4];

/// Two sides over each other, the secondary one above, with their positions.
struct Scene {
    contact: Mortar,
    y: Vec<f64>,
}

/// Nodes of a chain of facets from `from` to `to` at the heights of a curve, numbered from `first`.
fn chain(
    shape: FacetShape,
    [from, to]: [f64; 2],
    count: usize,
    first: usize,
    height: impl Fn(f64) -> f64,
) -> (Vec<Vec<usize>>, Vec<f64>) {
    let k = shape.degree();
    let nodes = count * k + 1;
    let x = |i: usize| from + (to - from) * i as f64 / (nodes - 1) as f64;
    let y = (0..nodes).flat_map(|i| [x(i), height(x(i))]).collect();
    let facet = |f: usize| {
        let at = |i: usize| first + f * k + i;
        [at(0), at(k)].into_iter().chain((1..k).map(at)).collect()
    };
    ((0..count).map(facet).collect(), y)
}

/// Mortar contact of the facets above, the secondary side, with those below.
fn facing(shape: FacetShape, above: &[Vec<usize>], below: &[Vec<usize>], reference: &[f64]) -> Mortar {
    let side = |facets: &[Vec<usize>]| Surface::new(shape, facets, &vec![1.0; facets.len()]);
    let [secondary, primary] = [above, below].map(side);
    let nodes = |facets: &[Vec<usize>], to: &Surface| {
        NodeToFacet::new(facets.concat(), to.clone(), Detection::ClosestPoint)
    };
    let sides = Combined::both(nodes(above, &primary), nodes(below, &secondary).reversed());
    Mortar::new(secondary, primary, reference, sides)
}

/// A secondary side of three facets over a primary one of `count`, which are curved.
fn scene(shape: FacetShape, count: usize, gap: f64) -> Scene {
    let (above, mut y) = chain(shape, [-0.9, 0.8], 3, 0, |x| gap + 0.08 * (2.0 * x).sin());
    let (below, lower) = chain(shape, [1.5, -1.5], count, y.len() / 2, |x| 0.05 * (1.0 - x * x));
    y.extend(lower);
    Scene { contact: facing(shape, &above, &below, &y), y }
}

/// A secondary side of three facets over a circle that is carried by a simplex and may turn.
fn over_a_circle(shape: FacetShape) -> Scene {
    let (above, mut y) = chain(shape, [-0.9, 0.8], 3, 0, |x| 0.05 - 0.2 * x * x);
    let nodes = y.len() / 2;
    let carrier = Carrier { nodes: (nodes..nodes + 3).collect(), origin: [0.3, -0.4, 0.0], length: 2.0 };
    y.extend(carrier.places(2));
    let side = Surface::new(shape, &above, &[1.0; 3]);
    let circle = Obstacle::circle(&[0.0, -0.7], 0.7, false);
    let obstacle = NodeToObstacle::new((0..nodes).collect(), 2, circle).carried_by(carrier);
    Scene { contact: Mortar::with_obstacle(side, obstacle, &y), y }
}

/// A secondary side that lies over both ends of a curved primary facet.
fn overhanging(shape: FacetShape) -> Scene {
    let (above, mut y) = chain(shape, [-0.9, 0.8], 2, 0, |x| 0.3 + 0.08 * (2.0 * x).sin());
    let (below, lower) = chain(shape, [0.5, -0.6], 1, y.len() / 2, |x| 0.05 * (1.0 - x * x));
    y.extend(lower);
    Scene { contact: facing(shape, &above, &below, &y), y }
}

/// A curved secondary facet that turns from 63° to 72° away from a straight primary one, or from an
/// obstacle: its points count partly.
fn steep(shape: FacetShape, opposite: Steep) -> Scene {
    let (above, mut y) = chain(shape, [0.0, 0.4], 1, 0, |x| 0.05 + 2.0 * x + 1.3 * x * x);
    let nodes = y.len() / 2;
    let secondary = Surface::new(shape, &above, &[1.0]);
    let obstacle = match opposite {
        Steep::Facet => {
            let (below, lower) = chain(shape, [1.5, -1.5], 1, nodes, |_| 0.0);
            y.extend(lower);
            return Scene { contact: facing(shape, &above, &below, &y), y };
        }
        Steep::Plane => Obstacle::plane(&[0.0, 0.0], &[0.0, 1.0]),
        Steep::Circle => Obstacle::circle(&[0.1, -3.0], 3.0, false),
    };
    let mut obstacle = NodeToObstacle::new((0..nodes).collect(), 2, obstacle);
    if opposite == Steep::Circle {
        let carrier = Carrier { nodes: (nodes..nodes + 3).collect(), origin: [0.3, -0.4, 0.0], length: 2.0 };
        y.extend(carrier.places(2));
        obstacle = obstacle.carried_by(carrier);
    }
    Scene { contact: Mortar::with_obstacle(secondary, obstacle, &y), y }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Steep {
    Facet,
    Plane,
    Circle,
}

impl Scene {
    fn pairs(&self) -> impl Iterator<Item = Pair> + '_ {
        (0..self.contact.secondary().len()).map(|node| Pair {
            reach: 99,
            active: true,
            lambda: -1.0,
            ..Pair::open(node, 0, 0.0)
        })
    }

    fn row(&self, pair: &Pair, y: &[f64]) -> Rows {
        let mut rows = Rows::new(2);
        self.contact.measure(&mut pair.clone(), y, &mut rows).unwrap();
        rows
    }

    /// Gradient of a gap over all dofs.
    fn gradient(&self, pair: &Pair, y: &[f64]) -> Vec<f64> {
        let mut full = vec![0.0; y.len()];
        self.row(pair, y).row(0).add_to(1.0, &mut full);
        full
    }

    /// The row of a slip over all dofs.
    fn slip(&self, pair: &Pair, y: &[f64]) -> Vec<f64> {
        let mut rows = Rows::new(2);
        self.contact.slip(pair, y, &[], &mut rows).unwrap();
        let mut full = vec![0.0; y.len()];
        rows.row(0).add_to(1.0, &mut full);
        full
    }

    /// A matrix over the nodes of a row as one over all dofs.
    fn full(&self, pair: &Pair, of: impl FnOnce(&mut [f64])) -> Vec<f64> {
        let rows = self.row(pair, &self.y);
        let dofs: Vec<usize> = rows.row(0).entries().map(|(dof, _)| dof).collect();
        let mut matrix = vec![0.0; dofs.len().pow(2)];
        of(&mut matrix);
        let n = self.y.len();
        let mut full = vec![0.0; n * n];
        for (a, row) in dofs.iter().enumerate() {
            for (b, column) in dofs.iter().enumerate() {
                full[row * n + column] = matrix[a * dofs.len() + b];
            }
        }
        full
    }
}

/// Over one facet and over an obstacle nothing is cut, and the derivatives are exact.
#[test]
fn derivatives_agree_with_differences() {
    for (shape, is_rigid) in SHAPES.into_iter().flat_map(|shape| [(shape, false), (shape, true)]) {
        let scene = if is_rigid { over_a_circle(shape) } else { scene(shape, 1, 0.3) };
        for pair in scene.pairs() {
            let gap = |y: &[f64]| vec![scene.row(&pair, y).row(0).gap];
            let error = jacobian_error(&scene.y, 1e-3, gap, &scene.gradient(&pair, &scene.y));
            assert!(error < 1e-9, "{shape:?} {}: gradient {error:e}", pair.node);
            let hessian = scene.full(&pair, |matrix| scene.contact.curvature_into(&pair, &scene.y, matrix));
            let error = jacobian_error(&scene.y, 1e-3, |y| scene.gradient(&pair, y), &hessian);
            assert!(error < 1e-8, "{shape:?} {}: second derivative {error:e}", pair.node);
            let turned = scene
                .full(&pair, |matrix| scene.contact.slip_derivative_into(&pair, &scene.y, &[], 0, matrix));
            let error = jacobian_error(&scene.y, 1e-3, |y| scene.slip(&pair, y), &turned);
            assert!(error < 1e-8, "{shape:?} {}: slip {error:e}", pair.node);
        }
    }
}

/// Where points count partly, the gradient includes the derivative of their weight. The second
/// derivative leaves out that of the normal of the primary side, which is zero of a fixed plane.
#[test]
fn derivatives_of_partly_facing_points_agree_with_differences() {
    for (shape, opposite) in SHAPES
        .into_iter()
        .flat_map(|shape| [Steep::Facet, Steep::Plane, Steep::Circle].map(|opposite| (shape, opposite)))
    {
        let scene = steep(shape, opposite);
        for pair in scene.pairs() {
            let gap = |y: &[f64]| vec![scene.row(&pair, y).row(0).gap];
            let error = jacobian_error(&scene.y, 1e-4, gap, &scene.gradient(&pair, &scene.y));
            assert!(error < 1e-8, "{shape:?} {opposite:?} {}: gradient {error:e}", pair.node);
            if opposite == Steep::Plane {
                let of = |matrix: &mut [f64]| scene.contact.curvature_into(&pair, &scene.y, matrix);
                let hessian = scene.full(&pair, of);
                let error = jacobian_error(&scene.y, 1e-4, |y| scene.gradient(&pair, y), &hessian);
                assert!(error < 1e-7, "{shape:?} {}: second derivative {error:e}", pair.node);
            }
        }
    }
}

/// Over a joint at which the primary turns, where surfaces touch, the second derivative includes
/// the motion of that joint.
#[test]
fn derivatives_over_a_joint_of_the_primary_agree_with_differences() {
    for (shape, turn) in SHAPES.into_iter().flat_map(|shape| [(shape, 0.1), (shape, -0.1)]) {
        let (above, mut y) = chain(shape, [-0.9, 0.8], 1, 0, |x| 0.03 * x);
        let (below, lower) = chain(shape, [1.0, -1.0], 2, y.len() / 2, |x| turn * x.abs());
        y.extend(lower);
        let scene = Scene { contact: facing(shape, &above, &below, &y), y };
        for pair in scene.pairs() {
            let of = |matrix: &mut [f64]| scene.contact.curvature_into(&pair, &scene.y, matrix);
            let hessian = scene.full(&pair, of);
            let error = jacobian_error(&scene.y, 1e-5, |y| scene.gradient(&pair, y), &hessian);
            assert!(error < 1e-6, "{shape:?} {turn} {}: second derivative {error:e}", pair.node);
            let turned = scene
                .full(&pair, |matrix| scene.contact.slip_derivative_into(&pair, &scene.y, &[], 0, matrix));
            let error = jacobian_error(&scene.y, 1e-5, |y| scene.slip(&pair, y), &turned);
            assert!(error < 1e-6, "{shape:?} {turn} {}: slip {error:e}", pair.node);
        }
    }
}

/// Over an end of the primary the gradient includes the motion of that end. Quadrature over parts
/// of curved facets is accurate to 1e-6 here.
#[test]
fn gradients_over_the_ends_of_the_primary_agree_with_differences() {
    for shape in SHAPES {
        let scene = overhanging(shape);
        for pair in scene.pairs() {
            let gap = |y: &[f64]| vec![scene.row(&pair, y).row(0).gap];
            let error = jacobian_error(&scene.y, 1e-4, gap, &scene.gradient(&pair, &scene.y));
            let allowed = if shape == FacetShape::L2 { 1e-9 } else { 1e-5 };
            assert!(error < allowed, "{shape:?} {}: gradient {error:e}", pair.node);
        }
    }
}

/// However the facets are cut, the forces on both sides are opposite and in line.
#[test]
fn force_and_moment_balance_and_rigid_motions_do_nothing() {
    let scenes = |shape: FacetShape| {
        let mut scenes = vec![over_a_circle(shape), overhanging(shape)];
        scenes.extend([Steep::Facet, Steep::Circle].map(|opposite| steep(shape, opposite)));
        for count in [1, 2, 5, 7] {
            let Scene { contact, y } = scene(shape, count, 0.02);
            scenes.push(Scene { contact: contact.integrated(Quadrature::Fixed), y });
            scenes.push(scene(shape, count, 0.02));
        }
        scenes.into_iter().map(move |scene| (shape, scene))
    };
    for (shape, scene) in SHAPES.into_iter().flat_map(scenes) {
        let (s, c) = 0.7_f64.sin_cos();
        let turned = |x: &[f64]| [c * x[0] - s * x[1] + 5.0, s * x[0] + c * x[1] - 3.0];
        let moved: Vec<f64> = scene.y.chunks(2).flat_map(turned).collect();
        for pair in scene.pairs() {
            let force = scene.gradient(&pair, &scene.y);
            let mut sum = Vector::ZERO;
            let mut moment = 0.0;
            for (y, f) in scene.y.as_chunks::<2>().0.iter().zip(force.as_chunks::<2>().0) {
                sum += Vector(*f);
                moment += y[0] * f[1] - y[1] * f[0];
            }
            assert!(sum.norm() < 1e-13 && moment.abs() < 1e-13, "{shape:?}: {sum:?} {moment:e}");
            let [here, there] = [&scene.y, &moved].map(|y| scene.row(&pair, y).row(0).gap);
            assert!((here - there).abs() < 1e-13, "{shape:?}: {here} {there}");
            let mut rows = Rows::new(2);
            scene.contact.slip(&pair, &scene.y, &[], &mut rows).unwrap();
            let spin: Vec<f64> = scene.y.chunks(2).flat_map(|x| [-x[1] + 0.4, x[0] - 2.0]).collect();
            let slid = rows.row(0).along(&spin);
            let alone: Vec<f64> = scene.y.iter().map(|_| 1.0).collect();
            assert!(slid.abs() < 1e-13 && rows.row(0).along(&alone).abs() < 1e-13, "{slid:e}");
        }
    }
}

/// Over a plane the gap of a side at the height h(x) is the mean of h with the weights B_j, however
/// the plane is divided: with B₀ = (1 − s)/2 on the first of three facets and h = x.
#[test]
fn the_gap_is_a_mean() {
    for shape in SHAPES {
        let (above, mut y) = chain(shape, [0.0, 3.0], 3, 0, |x| 1.0 + x);
        let (below, lower) = chain(shape, [9.0, -7.0], 31, y.len() / 2, |_| 0.0);
        let reference = y.iter().copied().chain(lower.iter().copied()).collect::<Vec<f64>>();
        y.extend(lower);
        let contact = facing(shape, &above, &below, &reference);
        let mut rows = Rows::new(2);
        let mut pair = Pair { reach: 99, ..Pair::open(0, 15, 0.0) };
        contact.measure(&mut pair, &y, &mut rows).unwrap();
        // The mean of x over a facet of length 1 is 1/3 with 1 − x and 1/4 with (1 − x)².
        let mean = if shape == FacetShape::L4 { 1.25 } else { 4.0 / 3.0 };
        assert!((rows.row(0).gap - mean).abs() < 1e-14, "{shape:?}: {}", rows.row(0).gap);
    }
}

/// A side that reaches past the end of the primary counts where it is covered, and not at all where
/// less than a twentieth of its polynomial is.
#[test]
fn what_faces_nothing_does_not_count() {
    let (above, mut y) = chain(FacetShape::L2, [0.0, 2.0], 2, 0, |_| 0.1);
    for (end, expected) in
        [(2.0, [0.1, 0.1, 0.1]), (1.5, [0.1, 0.0875, 0.025]), (1.1, [0.1, 0.06, f64::INFINITY])]
    {
        y.truncate(2 * 3);
        let (below, lower) = chain(FacetShape::L2, [end, -1.0], 1, 3, |_| 0.0);
        y.extend(lower);
        let contact = facing(FacetShape::L2, &above, &below, &y);
        let gap = |node: usize| {
            let mut rows = Rows::new(2);
            contact.measure(&mut Pair { reach: 9, ..Pair::open(node, 0, 0.0) }, &y, &mut rows).unwrap();
            rows.row(0).gap
        };
        for (node, expected) in expected.into_iter().enumerate() {
            assert!(
                gap(node) == expected || (gap(node) - expected).abs() < 1e-15,
                "{end} {node}: {}",
                gap(node)
            );
        }
    }
}
