//! Rings and polygons: areas, angles, sides, graded sizes, invalid input.

use carom_solid::generate::{Refinement, polygon, ring};
use carom_solid::line_shape;

use super::*;

fn area(mesh: &Mesh) -> f64 {
    fn of<const N: usize, S: Shape<2, N>>(mesh: &Mesh) -> f64 {
        let cell = |cell: usize| {
            let x: [Vector<2>; N] = std::array::from_fn(|a| Vector(places(mesh)[mesh.cell(cell)[a]]));
            let rule = triangle(6);
            rule.iter()
                .map(|(xi, w)| {
                    let jacobian = gradient::<2, N, S>(&x, xi).det();
                    assert!(jacobian > 0.0, "cell {cell}");
                    w * jacobian
                })
                .sum::<f64>()
        };
        (0..mesh.cell_count()).map(cell).sum()
    }
    match mesh.element {
        Element::T3 => of::<3, Tri3>(mesh),
        Element::T6 => of::<6, Tri6>(mesh),
        _ => of::<10, Tri10>(mesh),
    }
}

fn mean_edge(mesh: &Mesh) -> f64 {
    let all =
        mesh.cells.chunks(mesh.element.nodes()).flat_map(|c| [[c[0], c[1]], [c[1], c[2]], [c[2], c[0]]]);
    let lengths: Vec<f64> = all
        .map(|[a, b]| (mesh.nodes[a][0] - mesh.nodes[b][0]).hypot(mesh.nodes[a][1] - mesh.nodes[b][1]))
        .collect();
    lengths.iter().sum::<f64>() / lengths.len() as f64
}

#[test]
fn rings() {
    let center = [0.25, -1.0];
    for element in TRIANGLES {
        let k = element.degree();
        for (inner, outer, size) in
            [(0.5, 1.0, 0.1), (0.9, 1.0, 0.1), (0.9, 1.0, 1.0), (0.02, 1.0, 0.2), (0.5, 1.0, 9.0)]
        {
            let mesh = ring(element, inner, outer, center, size).unwrap();
            all_nodes_used_and_none_twice(&mesh);
            assert!(area(&mesh) > 0.0);
            assert!(smallest_angle(&mesh) > 32.0, "{inner} {size}: {}", smallest_angle(&mesh));
            for (side, radius, turn) in [("inner", inner, -1.0), ("outer", outer, 1.0)] {
                walked_with_the_body_on_the_left(&mesh, side);
                let nodes = mesh.side_nodes(side).unwrap();
                assert!(nodes.len() >= 12 * k && nodes.len().is_multiple_of(4 * k));
                assert_eq!(mesh.nodes[nodes[0]], [center[0] + radius, center[1]]);
                for pair in nodes.windows(2) {
                    let turned = angle(center, places(&mesh)[pair[0]], places(&mesh)[pair[1]]);
                    assert!((turned * turn - 360.0 / nodes.len() as f64).abs() < 1e-10);
                }
                for n in nodes {
                    let r = (mesh.nodes[n][0] - center[0]).hypot(mesh.nodes[n][1] - center[1]);
                    assert!((r / radius - 1.0).abs() < 1e-14, "{:e}", r / radius - 1.0);
                }
            }
        }
    }
}

/// Area within a closed side, ½ ∮ x × dx over its facets.
fn enclosed(mesh: &Mesh, side: &str) -> f64 {
    let mut twice = 0.0;
    for facet in &mesh.sides[side] {
        for (xi, w) in [(-0.6_f64.sqrt(), 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.6_f64.sqrt(), 5.0 / 9.0)] {
            let shape = line_shape(facet.nodes.len(), xi);
            let at = |values: &[f64], i: usize| {
                facet.nodes.iter().zip(values).map(|(&n, v)| mesh.nodes[n][i] * v).sum::<f64>()
            };
            let (x, t) = ([0, 1].map(|i| at(&shape.values, i)), [0, 1].map(|i| at(&shape.first, i)));
            twice += w * (x[0] * t[1] - x[1] * t[0]);
        }
    }
    0.5 * twice
}

/// The area within chords converges with h², within T6 and T10 sides with h⁴ (Simpson's and the 3/8
/// rule integrate the arc's rise). The ring's area is their difference, to round-off; its errors
/// would nearly cancel.
#[test]
fn ring_areas_converge() {
    for (element, order, finest) in
        [(Element::T3, 1.9, 2e-3), (Element::T6, 3.9, 3e-7), (Element::T10, 3.9, 2e-7)]
    {
        let made = [0.1, 0.05].map(|size| ring(element, 0.5, 1.0, [0.0, 0.0], size).unwrap());
        for (side, radius, turn) in [("inner", 0.5, -1.0), ("outer", 1.0, 1.0)] {
            let exact = std::f64::consts::PI * radius * radius * turn;
            let [coarse, fine] = made.each_ref().map(|mesh| (enclosed(mesh, side) / exact - 1.0).abs());
            let edges = (made[1].sides[side].len() as f64 / made[0].sides[side].len() as f64).log2();
            let found = (coarse / fine).log2() / edges;
            assert!(
                found > order && fine < finest * (0.25 / radius.powi(4)).max(1.0),
                "{element:?} {found} {fine:e}"
            );
        }
        for mesh in &made {
            let between = enclosed(mesh, "outer") + enclosed(mesh, "inner");
            assert!((area(mesh) / between - 1.0).abs() < 1e-13, "{:e}", area(mesh) / between - 1.0);
        }
    }
}

#[test]
fn a_ring_is_its_own_mirror_image() {
    let mesh = ring(Element::T10, 0.3, 1.0, [0.0, 0.0], 0.2).unwrap();
    for x in &mesh.nodes {
        for mirrored in [[-x[0], x[1]], [x[0], -x[1]]] {
            assert!(
                mesh.nodes.iter().any(|y| (y[0] - mirrored[0]).hypot(y[1] - mirrored[1]) < 1e-15),
                "{x:?}"
            );
        }
    }
}

const COOK: [[f64; 2]; 4] = [[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]];
const NOTCHED: [[f64; 2]; 7] =
    [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.2, 2.0], [2.0, 0.7], [1.8, 2.0], [0.0, 2.0]];
const STAR: [[f64; 2]; 8] =
    [[3.0, 0.0], [1.0, 1.0], [0.0, 3.0], [-1.0, 1.0], [-3.0, 0.0], [-1.0, -1.0], [0.0, -3.0], [1.0, -1.0]];
const THIN: [[f64; 2]; 6] = [[0.0, 0.0], [3.0, 0.0], [3.0, 0.1], [0.1, 0.1], [0.1, 2.0], [0.0, 2.0]];

fn shoelace(points: &[[f64; 2]]) -> f64 {
    let n = points.len();
    let twice: f64 =
        (0..n).map(|i| points[i][0] * points[(i + 1) % n][1] - points[i][1] * points[(i + 1) % n][0]).sum();
    0.5 * twice
}

#[test]
fn polygons() {
    for (points, size, least) in [
        (&COOK[..], 4.0, 30.0),
        (&NOTCHED[..], 0.2, 28.0),
        (&STAR[..], 0.3, 30.0),
        (&THIN[..], 0.5, 26.0),
        // The outline's own angle, 8.83°, remains.
        (&COOK[..3], 400.0, 8.8),
        (&COOK[..3], 3.0, 8.6),
        (&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], 0.05, 30.0),
    ] {
        let backwards: Vec<[f64; 2]> = points.iter().rev().copied().collect();
        for outline in [points, &backwards] {
            for element in TRIANGLES {
                let mesh = polygon(element, outline, size, &[]).unwrap();
                all_nodes_used_and_none_twice(&mesh);
                let exact = shoelace(outline).abs();
                assert!((area(&mesh) / exact - 1.0).abs() < 1e-13, "{:e}", area(&mesh) / exact - 1.0);
                assert!(smallest_angle(&mesh) > least, "{size}: {}", smallest_angle(&mesh));
                for k in 0..outline.len() {
                    let side = format!("side{}", k + 1);
                    walked_with_the_body_on_the_left(&mesh, &side);
                    let nodes = mesh.side_nodes(&side).unwrap();
                    let ends = [nodes[0], nodes[nodes.len() - 1]].map(|n| places(&mesh)[n]);
                    let given = [outline[k], outline[(k + 1) % outline.len()]];
                    let turned = [given[1], given[0]];
                    assert_eq!(ends, if shoelace(outline) > 0.0 { given } else { turned });
                    let facets = &mesh.sides[&side];
                    assert_eq!(nodes.len(), element.degree() * facets.len() + 1);
                }
            }
        }
    }
}

#[test]
fn edges_of_a_polygon_have_the_size() {
    let mesh = polygon(Element::T3, &STAR, 0.1, &[]).unwrap();
    assert!(smallest_angle(&mesh) > 30.0, "{}", smallest_angle(&mesh));
    assert!((mean_edge(&mesh) / 0.1 - 1.0).abs() < 0.02, "{}", mean_edge(&mesh));
}

#[test]
fn a_refined_place_has_its_size_and_the_rest_its_own() {
    let place = Refinement { near: [2.0, 0.7], radius: 0.1, size: 0.02 };
    let mesh = polygon(Element::T3, &NOTCHED, 0.3, &[place]).unwrap();
    assert!(smallest_angle(&mesh) > 30.0, "{}", smallest_angle(&mesh));
    assert!((area(&mesh) / shoelace(&NOTCHED) - 1.0).abs() < 1e-13);
    let size_at = |near: [f64; 2], radius: f64| {
        let within = |n: &usize| (mesh.nodes[*n][0] - near[0]).hypot(mesh.nodes[*n][1] - near[1]) < radius;
        let cells = mesh
            .cells
            .chunks(3)
            .filter(|c| c.iter().all(within))
            .flat_map(|c| [[c[0], c[1]], [c[1], c[2]], [c[2], c[0]]]);
        let lengths: Vec<f64> = cells
            .map(|[a, b]| (mesh.nodes[a][0] - mesh.nodes[b][0]).hypot(mesh.nodes[a][1] - mesh.nodes[b][1]))
            .collect();
        lengths.iter().sum::<f64>() / lengths.len() as f64
    };
    assert!((size_at([2.0, 0.7], 0.1) / 0.02 - 1.0).abs() < 0.15, "{}", size_at([2.0, 0.7], 0.1));
    assert!(size_at([0.5, 1.5], 0.6) > 0.22, "{}", size_at([0.5, 1.5], 0.6));
}

#[test]
fn the_same_polygon_twice_is_the_same_mesh() {
    let place = Refinement { near: [0.0, 0.0], radius: 0.0, size: 0.05 };
    let make = || polygon(Element::T10, &STAR, 0.3, &[place]).unwrap();
    assert_eq!(make(), make());
}

#[test]
fn impossible_outlines_are_rejected() {
    let message =
        |points: &[[f64; 2]], size: f64| polygon(Element::T3, points, size, &[]).unwrap_err().to_string();
    assert!(message(&COOK[..2], 1.0).contains("not 2"));
    assert!(message(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]], 1.0).contains("side1 and side3"));
    assert!(
        message(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]], 1.0)
            .contains("side1 and side3")
    );
    assert!(message(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]], 1.0).contains("side1 and side2"));
    assert!(message(&[[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], 1.0).contains("point 2"));
    assert!(message(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], 1.0).contains("side"));
    assert!(message(&[[0.0, f64::NAN], [1.0, 0.0], [1.0, 1.0]], 1.0).contains("point 1"));
    assert!(message(&COOK, 0.0).contains("size = 0"));
    let place = Refinement { near: [0.0, 0.0], radius: 1.0, size: -1.0 };
    assert!(polygon(Element::T3, &COOK, 1.0, &[place]).unwrap_err().to_string().contains("refine.size = -1"));
    assert!(
        ring(Element::T3, 1.0, 0.5, [0.0, 0.0], 0.1).unwrap_err().to_string().contains("inner 1, outer 0.5")
    );
    assert!(ring(Element::L2, 0.5, 1.0, [0.0, 0.0], 0.1).is_err());
}
