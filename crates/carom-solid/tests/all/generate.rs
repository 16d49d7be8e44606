//! Every generator at every order: counts, quality, boundary on the true curve, outward normals, no
//! duplicate or unused node.

use std::collections::HashSet;

use carom_algebra::{Mat, Vector};
use carom_solid::generate::{MeshError, disc, half_disc, interval, rectangle};
use carom_solid::quadrature::triangle;
use carom_solid::shape::{Shape, Tri3, Tri6, Tri10};
use carom_solid::{Element, Mesh};

mod free;
pub(super) mod solids;

/// ∂x/∂ξ at a point of a cell.
fn gradient<const D: usize, const N: usize, S: Shape<D, N>>(x: &[Vector<D>; N], xi: &Vector<D>) -> Mat<D> {
    let gradients = S::gradients(xi);
    (0..N).fold(Mat::ZERO, |sum, a| sum + x[a].outer(&gradients[a]))
}

const TRIANGLES: [Element; 3] = [Element::T3, Element::T6, Element::T10];

fn angle(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1]).to_degrees()
}

fn places(mesh: &Mesh) -> &[[f64; 2]] {
    mesh.nodes.of_dimension()
}

fn smallest_angle(mesh: &Mesh) -> f64 {
    let mut least = f64::INFINITY;
    for cell in 0..mesh.cell_count() {
        let c = mesh.cell(cell);
        let [p, q, r] = [c[0], c[1], c[2]].map(|n| places(mesh)[n]);
        least = [angle(p, q, r), angle(q, r, p), angle(r, p, q)].into_iter().fold(least, f64::min);
    }
    least
}

fn all_nodes_used_and_none_twice(mesh: &Mesh) {
    let used: HashSet<usize> = mesh.cells.iter().copied().collect();
    assert_eq!(used.len(), mesh.nodes.len());
    let near = 1e-9 * mesh.diameter();
    for (i, a) in places(mesh).iter().enumerate() {
        for b in &places(mesh)[..i] {
            assert!((a[0] - b[0]).abs().max((a[1] - b[1]).abs()) > near, "{a:?} twice");
        }
    }
}

/// Facets are consecutive, their nodes run from start to end, and their cells lie on the left.
fn walked_with_the_body_on_the_left(mesh: &Mesh, side: &str) {
    let nodes = places(mesh);
    let facets = &mesh.sides[side];
    for pair in facets.windows(2) {
        assert_eq!(pair[0].nodes[1], pair[1].nodes[0]);
    }
    for facet in facets {
        let (a, b) = (nodes[facet.nodes[0]], nodes[facet.nodes[1]]);
        let cell = mesh.cell(facet.cell);
        assert!(facet.nodes.iter().all(|n| cell.contains(n)));
        let third = cell[..3].iter().find(|n| !facet.nodes[..2].contains(n)).unwrap();
        assert!(angle(a, b, nodes[*third]) > 0.0);
        let mut along = 0.0;
        for &n in &facet.nodes[2..] {
            let x = nodes[n];
            let next = (x[0] - a[0]) * (b[0] - a[0]) + (x[1] - a[1]) * (b[1] - a[1]);
            assert!(next > along);
            along = next;
        }
    }
}

#[test]
fn intervals() {
    for element in [Element::L2, Element::L3, Element::L4] {
        let mesh = interval(element, -1.0, 2.0, 5).unwrap();
        assert_eq!(mesh.nodes.len(), element.degree() * 5 + 1);
        assert_eq!(mesh.cell_count(), 5);
        assert_eq!(
            (&mesh.nodes[mesh.sides["left"][0].nodes[0]], mesh.sides["left"][0].cell),
            (&[-1.0][..], 0)
        );
        assert_eq!(
            (&mesh.nodes[mesh.sides["right"][0].nodes[0]], mesh.sides["right"][0].cell),
            (&[2.0][..], 4)
        );
        let mut places: Vec<f64> = mesh.nodes.iter().map(|x| x[0]).collect();
        places.sort_unstable_by(f64::total_cmp);
        let step = 3.0 / (5 * element.degree()) as f64;
        assert!(places.windows(2).all(|w| (w[1] - w[0] - step).abs() < 1e-14));
    }
}

#[test]
fn rectangles() {
    for element in TRIANGLES {
        let mesh = rectangle(element, [0.0, -0.5], [1.0, 0.0], [8, 4]).unwrap();
        assert_eq!(mesh.nodes.len(), (element.degree() * 8 + 1) * (element.degree() * 4 + 1));
        assert_eq!(mesh.cell_count(), 64);
        all_nodes_used_and_none_twice(&mesh);
        assert!((smallest_angle(&mesh) - 45.0).abs() < 1e-12);
        for (side, axis, value, first) in [
            ("bottom", 1, -0.5, [0.0, -0.5]),
            ("right", 0, 1.0, [1.0, -0.5]),
            ("top", 1, 0.0, [1.0, 0.0]),
            ("left", 0, 0.0, [0.0, 0.0]),
        ] {
            walked_with_the_body_on_the_left(&mesh, side);
            let nodes = mesh.side_nodes(side).unwrap();
            assert_eq!(nodes.len(), mesh.sides[side].len() * element.degree() + 1);
            assert!(nodes.iter().all(|&n| mesh.nodes[n][axis] == value));
            assert_eq!(mesh.nodes[nodes[0]], first);
        }
    }
}

#[test]
fn discs() {
    let (radius, center) = (0.5, [0.25, 1.0]);
    for element in TRIANGLES {
        let k = element.degree();
        for (n, size) in [(1, 0.9), (4, 0.125), (5, 0.1)] {
            let mesh = disc(element, radius, center, size).unwrap();
            let m = k * n;
            assert_eq!((mesh.cell_count(), mesh.nodes.len()), (6 * n * n, 1 + 3 * m * (m + 1)));
            assert_eq!(mesh.sides["arc"].len(), 6 * n);
            let half = half_disc(element, radius, center, size).unwrap();
            assert_eq!((half.cell_count(), half.nodes.len()), (3 * n * n, 1 + m + 3 * m * (m + 1) / 2));
            assert_eq!((half.sides["arc"].len(), half.sides["axis"].len()), (3 * n, 2 * n));
            for mesh in [&mesh, &half] {
                all_nodes_used_and_none_twice(mesh);
                for side in mesh.sides.keys() {
                    walked_with_the_body_on_the_left(mesh, side);
                }
                assert!(smallest_angle(mesh) > 43.0, "{}", smallest_angle(mesh));
                for n in mesh.side_nodes("arc").unwrap() {
                    let r = (mesh.nodes[n][0] - center[0]).hypot(mesh.nodes[n][1] - center[1]);
                    assert!((r / radius - 1.0).abs() < 1e-15, "{:e}", r / radius - 1.0);
                }
                for cell in 0..mesh.cell_count() {
                    let on_arc = mesh.sides["arc"].iter().filter(|f| f.cell == cell).count();
                    assert!(on_arc <= 1);
                }
            }
            // The loop closes; its nodes are equally spaced in angle.
            let arc = &mesh.sides["arc"];
            assert_eq!(arc[0].nodes[0], arc[6 * n - 1].nodes[1]);
            let nodes = mesh.side_nodes("arc").unwrap();
            assert_eq!(nodes.len(), 6 * n * k);
            for pair in nodes.windows(2) {
                let turned = angle(center, places(&mesh)[pair[0]], places(&mesh)[pair[1]]);
                assert!((turned - 360.0 / nodes.len() as f64).abs() < 1e-11);
            }
            // The half's arc runs from bottom to top, its axis back down, exactly on the axis.
            let (arc, axis) = (half.side_nodes("arc").unwrap(), half.side_nodes("axis").unwrap());
            assert_eq!([arc[0], axis[0]].map(|n| places(&half)[n]), [[0.25, 0.5], [0.25, 1.5]]);
            assert_eq!((arc[0], axis[0]), (axis[axis.len() - 1], arc[arc.len() - 1]));
            assert!(axis.iter().all(|&n| half.nodes[n][0] == 0.25));
            assert_eq!(axis.len(), 2 * n * k + 1);
        }
    }
}

/// The half-disc is the right half of the disc, node for node.
#[test]
fn the_half_disc_is_half_the_disc() {
    let whole = disc(Element::T10, 1.0, [0.0, 0.0], 0.25).unwrap();
    let half = half_disc(Element::T10, 1.0, [0.0, 0.0], 0.25).unwrap();
    for x in places(&half) {
        for mirrored in [*x, [-x[0], x[1]]] {
            let near = |y: &[f64]| (y[0] - mirrored[0]).hypot(y[1] - mirrored[1]) < 1e-15;
            assert!(whole.nodes.iter().any(near), "{mirrored:?}");
        }
    }
}

/// The inner node of a curved T10 carries 4/9 of the arc's rise: the map's third derivatives are of
/// third order in the size.
#[test]
fn curved_cells_have_smooth_maps() {
    let roughness = |size: f64| {
        let mesh = disc(Element::T10, 1.0, [0.0, 0.0], size).unwrap();
        let cell = mesh.cell(mesh.sides["arc"][0].cell);
        // Coefficients of the cubic bubble and of the edges' cubic parts: third differences of the
        // nodes.
        let x = |a: usize| &mesh.nodes[cell[a]];
        let mut most: f64 = 0.0;
        for i in 0..2 {
            let edge =
                |a: usize, b: usize, c: usize, d: usize| x(d)[i] - 3.0 * x(c)[i] + 3.0 * x(b)[i] - x(a)[i];
            let mixed = x(1)[i] - 2.0 * x(4)[i] + x(3)[i] - (x(5)[i] - 2.0 * x(9)[i] + x(8)[i]);
            for d in [edge(0, 3, 4, 1), edge(1, 5, 6, 2), edge(2, 7, 8, 0), mixed] {
                most = most.max(d.abs());
            }
        }
        most
    };
    let order = (roughness(0.125) / roughness(0.0625)).log2();
    assert!(order > 2.9, "order {order}");
}

#[test]
fn impossible_shapes_are_refused() {
    let message = |r: Result<Mesh, MeshError>| r.unwrap_err().to_string();
    assert!(message(rectangle(Element::T3, [0.0, 0.0], [1.0, 0.0], [1, 1])).contains("[1.0, 0.0]"));
    assert!(message(rectangle(Element::T3, [0.0, 0.0], [1.0, 1.0], [0, 1])).contains("[0, 1]"));
    assert!(message(rectangle(Element::L2, [0.0, 0.0], [1.0, 1.0], [1, 1])).contains("L2"));
    assert!(message(disc(Element::T3, -1.0, [0.0, 0.0], 0.1)).contains("radius -1"));
    assert!(message(half_disc(Element::T3, 1.0, [0.0, 0.0], f64::NAN)).contains("size NaN"));
    assert!(interval(Element::L2, 0.0, f64::INFINITY, 3).is_err());
}

/// Smallest over largest Jacobian of a curved cell: 1 if straight, ≤ 0 if folded.
#[test]
fn curved_cells_are_nowhere_near_folding() {
    fn least<const N: usize, S: Shape<2, N>>(mesh: &Mesh) -> f64 {
        let ratio = |cell: usize| {
            let x: [Vector<2>; N] = std::array::from_fn(|a| Vector(places(mesh)[mesh.cell(cell)[a]]));
            let points = triangle(10).points.into_iter().chain(S::NODES);
            let jacobians: Vec<f64> = points.map(|xi| gradient::<2, N, S>(&x, &xi).det()).collect();
            let extreme = |f: fn(f64, f64) -> f64| jacobians.iter().copied().reduce(f).unwrap();
            extreme(f64::min) / extreme(f64::max)
        };
        (0..mesh.cell_count()).map(ratio).fold(f64::INFINITY, f64::min)
    }
    // One ring, six arcs of 60°: the worst case; from four rings on, arcs of 15° and less.
    for (size, bound) in [(1.0, 0.7), (0.25, 0.85), (0.1, 0.95)] {
        let quadratic = least::<6, Tri6>(&disc(Element::T6, 1.0, [0.0, 0.0], size).unwrap());
        let cubic = least::<10, Tri10>(&disc(Element::T10, 1.0, [0.0, 0.0], size).unwrap());
        assert!(quadratic.min(cubic) > bound, "size {size}: {quadratic}, {cubic}");
    }
}

/// Three by two, then a hexagon in a circle of radius 2: 3√3/2 r².
#[test]
fn areas() {
    for element in TRIANGLES {
        let area = rectangle(element, [0.0, -0.5], [3.0, 1.5], [5, 2]).unwrap().area();
        assert!((area - 6.0).abs() < 1e-13, "{element:?}: {area}");
        let hexagon = disc(element, 2.0, [1.0, 1.0], 2.0).unwrap().area();
        assert!((hexagon - 6.0 * 3.0_f64.sqrt()).abs() < 1e-13, "{element:?}: {hexagon}");
    }
}

/// A half is rounded up in every unit: 0.3/0.2 is 1.4999999999999998.
#[test]
fn the_mesh_of_a_disc_does_not_depend_on_the_unit() {
    let cells = |unit: f64| disc(Element::T3, 0.3 * unit, [0.0, 0.0], 0.2 * unit).unwrap().cell_count();
    assert_eq!([cells(1.0), cells(10.0), cells(1000.0)], [24; 3]);
}
