//! The smooth surface that straight facets stand for.

use carom_contact::kinematics::rounding::rounding;
use carom_contact::{Boundary, Surface};
use carom_solid::FacetShape;

/// A chain of chords through points, traversed with the body on its left.
fn chain(points: &[[f64; 2]], closed: bool) -> Surface {
    let n = points.len();
    let count = if closed { n } else { n - 1 };
    let facets: Vec<Vec<usize>> = (0..count).map(|k| vec![k, (k + 1) % n]).collect();
    Surface::new(FacetShape::L2, &facets, &vec![1.0; count])
}

/// Points of an arc of the radius 2 at angles that grow by unequal steps.
fn arc(count: usize, step: f64) -> Vec<[f64; 2]> {
    let angle = |k: usize| step * (k as f64 + 0.1 * (1.7 * k as f64).sin());
    (0..count).map(|k| [2.0 * angle(k).cos(), 2.0 * angle(k).sin()]).collect()
}

#[test]
fn chords_of_a_circle_are_known_to_within_a_percent_of_their_deviation() {
    let mut points = arc(12, 0.15);
    for way in [1.0, -1.0] {
        let side = chain(&points, false);
        for facet in 0..points.len() - 1 {
            let [a, b] = [points[facet], points[facet + 1]];
            let xi = 0.3;
            let at = [0, 1].map(|i| 0.5 * (a[i] * (1.0 - xi) + b[i] * (1.0 + xi)));
            let deviation = 2.0 - f64::hypot(at[0], at[1]);
            let found = way * rounding(&side, facet, [xi, 0.0], points.as_flattened());
            assert!((found - deviation).abs() < 0.02 * deviation, "{facet}: {found} {deviation}");
        }
        // An arc of the same size as the side of a hole.
        points.reverse();
    }
}

#[test]
fn flat_sides_and_kinks_between_them_are_no_arcs() {
    // A roof of 20°, with three facets on either side.
    let slope = f64::tan(0.17);
    let points: Vec<[f64; 2]> = (-3..=3).rev().map(f64::from).map(|x| [x, -slope * x.abs()]).collect();
    let side = chain(&points, false);
    for facet in 0..6 {
        assert!(rounding(&side, facet, [0.0; 2], points.as_flattened()).abs() < 1e-15, "{facet}");
    }
}

/// The mantle of a quarter of a cylinder of the radius 2, by quadrilaterals or triangles.
fn mantle(shape: FacetShape, [round, along]: [usize; 2]) -> (Boundary, Vec<f64>) {
    let mut y = Vec::new();
    for i in 0..=round {
        let angle = 0.5 * std::f64::consts::PI * i as f64 / round as f64;
        (0..=along).for_each(|j| y.extend([2.0 * angle.cos(), 2.0 * angle.sin(), 0.3 * j as f64]));
    }
    let node = |i: usize, j: usize| (along + 1) * i + j;
    let mut facets = Vec::new();
    for i in 0..round {
        for j in 0..along {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            match shape {
                FacetShape::Q4 => facets.push(vec![a, b, c, d]),
                _ => facets.extend([vec![a, b, c], vec![a, c, d]]),
            }
        }
    }
    (Boundary::new(shape, &facets, &[], 0), y)
}

#[test]
fn chords_of_a_cylinder_are_known_up_to_its_edges() {
    for (shape, cells, share) in [
        (FacetShape::Q4, [10, 4], 0.02),
        (FacetShape::Q4, [10, 1], 0.02),
        // The normal of a triangle is that of the cylinder beside its middle.
        (FacetShape::T3, [10, 4], 0.2),
    ] {
        let (side, y) = mantle(shape, cells);
        let xi = if shape == FacetShape::Q4 { [0.2, 0.1] } else { [0.3, 0.3] };
        for facet in 0..side.facets() {
            let at = side.patch(facet).at(&y, xi).position;
            let deviation = 2.0 - f64::hypot(at[0], at[1]);
            let found = rounding(&side, facet, xi, &y);
            assert!((found - deviation).abs() < share * deviation, "{shape:?} {facet}: {found} {deviation}");
        }
    }
}
