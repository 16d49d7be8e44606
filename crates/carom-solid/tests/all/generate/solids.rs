//! Shapes of space at every order: exact volumes and areas, closed and outward boundaries,
//! conforming cells with certified Jacobians.

use std::collections::HashMap;
use std::f64::consts::PI;

use carom_algebra::{Mat, Vector};
use carom_solid::generate::{
    Frame, MeshError, ball, ball_hexahedra, cylinder, cylinder_hexahedra, disc, extrusion, half_disc,
    interval, rectangle, tube, tube_hexahedra,
};
use carom_solid::shape::{Domain, Hex8, Hex27, Shape, Tet4, Tet10, Tet20};
use carom_solid::{Body, Element, Facet, Mesh};

use crate::validity::cell;

const SOLIDS: [Element; 5] = [Element::Tet4, Element::Tet10, Element::Tet20, Element::Hex8, Element::Hex27];

/// Volume by quadrature of the Jacobian, which is certified positive in every cell.
pub(crate) fn volume(mesh: &Mesh) -> f64 {
    fn of<const N: usize, S: Shape<3, N>>(mesh: &Mesh) -> f64 {
        let rule = S::Domain::rule(8);
        let points: Vec<_> = rule.iter().map(|(xi, w)| (S::gradients(xi).to_vec(), w)).collect();
        integral(mesh, &*cell::<3, N, S>(mesh.element), &points)
    }
    match mesh.element {
        Element::Tet4 => of::<4, Tet4>(mesh),
        Element::Tet10 => of::<10, Tet10>(mesh),
        Element::Tet20 => of::<20, Tet20>(mesh),
        Element::Hex8 => of::<8, Hex8>(mesh),
        _ => of::<27, Hex27>(mesh),
    }
}

/// ∫ det(∂x/∂ξ) from the gradients and weights at quadrature points, of cells that the test of a
/// reference cell certifies.
fn integral(mesh: &Mesh, reference: &dyn Body, points: &[(Vec<Vector<3>>, f64)]) -> f64 {
    let positions = mesh.nodes.of_dimension::<3>();
    let of_cell = |nodes: &[usize]| {
        let x: Vec<[f64; 3]> = nodes.iter().map(|&n| positions[n]).collect();
        assert!(reference.cell_margin(0, x.as_flattened()).is_ok(), "{x:?}");
        let jacobian = |gradients: &[Vector<3>]| {
            let terms = x.iter().zip(gradients).map(|(x, gradient)| Vector(*x).outer(gradient));
            terms.fold(Mat::ZERO, |sum, term| sum + term).det()
        };
        points.iter().map(|(gradients, weight)| weight * jacobian(gradients)).sum::<f64>()
    };
    mesh.cells.chunks_exact(mesh.element.nodes()).map(of_cell).sum()
}

/// Area, ∫ n and ∫ x·n of facets.
fn integrals(mesh: &Mesh, facets: &[Facet]) -> (f64, [f64; 3], f64) {
    let shape = mesh.element.facet_shape();
    let rule: Vec<_> = shape.rule(10).into_iter().map(|(xi, w)| (shape.functions(xi), w)).collect();
    let (mut area, mut normal, mut flux) = (0.0, [0.0; 3], 0.0);
    for facet in facets {
        for (functions, weight) in &rule {
            let sum = |values: &[f64]| {
                let mut sum = [0.0; 3];
                for (n, value) in facet.nodes.iter().zip(values) {
                    (0..3).for_each(|i| sum[i] += value * mesh.nodes[*n][i]);
                }
                sum
            };
            let x = sum(&functions.values);
            let vector = shape.area_vector([0, 1].map(|c| sum(&functions.slopes[c])), 1.0);
            area += weight * vector.iter().map(|v| v * v).sum::<f64>().sqrt();
            (0..3).for_each(|i| normal[i] += weight * vector[i]);
            flux += weight * (0..3).map(|i| x[i] * vector[i]).sum::<f64>();
        }
    }
    (area, normal, flux)
}

pub(crate) fn area(mesh: &Mesh, side: &str) -> f64 {
    integrals(mesh, &mesh.sides[side]).0
}

/// Everything that holds for any solid; returns its volume.
pub(crate) fn sound(mesh: &Mesh) -> f64 {
    let volume = volume(mesh);
    let skin = mesh.skin();
    let (area, normal, flux) = integrals(mesh, &skin);
    // The boundary is closed and outward.
    assert!(normal.iter().all(|n| n.abs() < 1e-12 * area), "{normal:?}");
    assert!((flux - 3.0 * volume).abs() < 1e-11 * (volume + area * mesh.diameter()), "{flux} {volume}");
    // The sides are the boundary, each facet once.
    let mut of_sides: Vec<&Facet> = mesh.sides.values().flatten().collect();
    assert_eq!(of_sides.len(), skin.len());
    of_sides.sort_unstable_by_key(|f| (f.cell, &f.nodes));
    of_sides.dedup();
    assert_eq!(of_sides.len(), skin.len());
    // Facets with the same corners share all nodes, in two cells inside and one on the boundary;
    // each edge of the boundary belongs to two facets of it, in opposite directions.
    let ends = mesh.element.facet_shape().corners();
    let mut facets: HashMap<Vec<usize>, Vec<Vec<usize>>> = HashMap::new();
    for cell in 0..mesh.cell_count() {
        for facet in mesh.element.facets() {
            let mut nodes: Vec<usize> = facet.iter().map(|&a| mesh.cell(cell)[a]).collect();
            let mut corners = nodes[..ends].to_vec();
            corners.sort_unstable();
            nodes.sort_unstable();
            facets.entry(corners).or_default().push(nodes);
        }
    }
    assert!(facets.values().all(|both| both.len() <= 2 && both.iter().all(|nodes| *nodes == both[0])));
    assert_eq!(facets.values().filter(|both| both.len() == 1).count(), skin.len());
    let edges: HashMap<(usize, usize), usize> = skin
        .iter()
        .flat_map(|f| (0..ends).map(|a| (f.nodes[a], f.nodes[(a + 1) % ends])))
        .fold(HashMap::new(), |mut count, edge| {
            *count.entry(edge).or_default() += 1;
            count
        });
    assert!(edges.iter().all(|(&(a, b), n)| *n == 1 && edges.contains_key(&(b, a))));
    // Every node is used, and no two are at one place.
    let mut used = vec![false; mesh.nodes.len()];
    mesh.cells.iter().for_each(|&n| used[n] = true);
    assert!(used.iter().all(|u| *u));
    let mut places: Vec<_> = mesh.nodes.of_dimension::<3>().to_vec();
    places.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap());
    assert!(places.windows(2).all(|pair| pair[0] != pair[1]));
    volume
}

/// Orders of the errors of volume and of a side's area between two sizes.
fn orders(exact: [f64; 2], side: &str, mesh: impl Fn(f64) -> Mesh, sizes: [f64; 2]) -> [f64; 2] {
    let errors = sizes.map(|size| {
        let mesh = mesh(size);
        [(sound(&mesh) - exact[0]).abs(), (area(&mesh, side) - exact[1]).abs()]
    });
    [0, 1].map(|i| (errors[0][i] / errors[1][i]).log2())
}

#[test]
fn balls_converge_with_order_k_plus_1() {
    for element in SOLIDS {
        // An eighth, so that cells are small enough for the order to show.
        let eighth = |size: f64| ball(element, 2.0, [1.0, -0.5, 0.25], size, [true; 3]).unwrap();
        let found = orders([4.0 * PI / 3.0, 2.0 * PI], "sphere", eighth, [PI / 8.0, PI / 16.0]);
        let least = element.degree() as f64 + 0.9;
        assert!(found.iter().all(|order| *order > least), "{element:?}: {found:?}");
    }
}

#[test]
fn cylinders_and_tubes_converge_with_order_k_plus_1() {
    for element in SOLIDS {
        let least = element.degree() as f64 + 0.9;
        let frame = Frame::along([1.0, 2.0, -0.5], [0.5, 0.0, 1.0]).unwrap();
        let sizes = [PI / 8.0, PI / 16.0];
        let solid = |size: f64| cylinder(element, 1.0, 0.5, &frame, size, [false; 3]).unwrap();
        let found = orders([0.5 * PI, PI], "side", solid, sizes);
        assert!(found.iter().all(|order| *order > least), "{element:?}: {found:?}");
        let hollow = |size: f64| tube(element, [0.5, 1.0], 0.5, &frame, size, [false; 3]).unwrap();
        let found = orders([0.375 * PI, 0.5 * PI], "inner", hollow, sizes);
        assert!(found.iter().all(|order| *order > least), "{element:?}: {found:?}");
    }
}

/// Nodes of curved sides lie on the true surface, those of planes in the plane.
#[test]
fn sides_lie_where_they_are_said_to() {
    for element in SOLIDS {
        let center = [1.0, -2.0, 0.5];
        let mesh = ball(element, 0.7, center, 0.3, [true, false, true]).unwrap();
        let from = |n: usize, i: usize| mesh.nodes[n][i] - center[i];
        for n in mesh.side_nodes("sphere").unwrap() {
            let radius = (0..3).map(|i| from(n, i).powi(2)).sum::<f64>().sqrt();
            assert!((radius - 0.7).abs() < 1e-15, "{radius}");
        }
        assert!(mesh.nodes.iter().all(|x| x[0] >= center[0] && x[2] >= center[2]));
        assert!(mesh.side_nodes("plane_x").unwrap().iter().all(|&n| from(n, 0) == 0.0));
        assert!(mesh.side_nodes("plane_z").unwrap().iter().all(|&n| from(n, 2) == 0.0));
        assert_eq!(mesh.sides.len(), 3);

        let frame = Frame::along([0.0, 3.0, 0.0], [0.0; 3]).unwrap();
        let mesh = tube(element, [0.4, 0.5], 2.0, &frame, 0.25, [true, true, false]).unwrap();
        let names: Vec<_> = mesh.sides.keys().map(String::as_str).collect();
        assert_eq!(names, ["inner", "outer", "plane_x", "plane_y", "top"]);
        for (side, axis, value) in [("plane_x", 0, 0.0), ("plane_y", 1, 1.0), ("top", 1, 2.0)] {
            assert!(mesh.side_nodes(side).unwrap().iter().all(|&n| mesh.nodes[n][axis] == value), "{side}");
        }
        for n in mesh.side_nodes("inner").unwrap() {
            assert!((mesh.nodes[n][0].hypot(mesh.nodes[n][2]) - 0.4).abs() < 1e-15);
        }
    }
}

/// Halves, quarters and eighths have their share of the volume and of the whole mesh's surface.
#[test]
fn parts_are_parts_of_the_whole() {
    for element in [Element::Tet4, Element::Tet20] {
        let frame = Frame::along([0.0, 0.0, 1.0], [0.0; 3]).unwrap();
        for symmetry in [[true, false, false], [false, true, false], [true, true, false], [true; 3]] {
            let share = 0.5_f64.powi(symmetry.iter().filter(|cut| **cut).count() as i32);
            let shapes: [&dyn Fn([bool; 3]) -> Mesh; 3] = [
                &|symmetry| ball(element, 1.0, [0.0; 3], 0.5, symmetry).unwrap(),
                &|symmetry| cylinder(element, 1.0, 1.0, &frame, 0.5, symmetry).unwrap(),
                &|symmetry| tube(element, [0.5, 1.0], 1.0, &frame, 0.5, symmetry).unwrap(),
            ];
            for (shape, side) in shapes.iter().zip(["sphere", "side", "outer"]) {
                let (whole, part) = (shape([false; 3]), shape(symmetry));
                assert!((sound(&part) - share * sound(&whole)).abs() < 1e-13, "{side} {symmetry:?}");
                if element == Element::Tet4 {
                    // Of curved facets, the quadrature of the area depends on the order of corners.
                    // Thousands of additions, each rounded.
                    let (found, exact) = (area(&part, side), share * area(&whole, side));
                    assert!((found - exact).abs() < 1e-13 * area(&whole, side), "{side}: {found} {exact}");
                }
                let planes = part.sides.keys().filter(|name| name.starts_with("plane_")).count();
                assert_eq!(planes, symmetry.iter().filter(|cut| **cut).count());
            }
        }
    }
}

/// Six tetrahedra of every hexahedron of the estimate.
#[test]
fn solids_have_the_stated_number_of_cells() {
    let frame = Frame::along([0.0, 0.0, 1.0], [0.0; 3]).unwrap();
    for symmetry in [[false; 3], [true, false, false], [true, true, false]] {
        for size in [0.9, 0.31, 0.17] {
            let cells = |mesh: Result<Mesh, MeshError>| mesh.unwrap().cell_count() as f64;
            let element = Element::Tet4;
            let whole = cells(ball(element, 1.0, [0.0; 3], size, symmetry));
            assert_eq!(whole, 6.0 * ball_hexahedra(1.0, size, symmetry));
            let whole = cells(cylinder(element, 1.0, 2.0, &frame, size, symmetry));
            assert_eq!(whole, 6.0 * cylinder_hexahedra(1.0, 2.0, size, symmetry));
            let whole = cells(tube(element, [0.4, 1.0], 2.0, &frame, size, symmetry));
            assert_eq!(whole, 6.0 * tube_hexahedra([0.4, 1.0], 2.0, size, symmetry));
        }
    }
}

#[test]
fn cells_are_well_shaped_at_any_size() {
    let frame = Frame::along([1.0, 0.0, 0.0], [0.0; 3]).unwrap();
    for element in SOLIDS {
        for size in [2.0, 0.7, 0.35, 0.2] {
            let quality = |mesh: Result<Mesh, MeshError>| mesh.unwrap().scaled_jacobian().unwrap();
            let ball = quality(ball(element, 1.0, [0.0; 3], size, [false; 3]));
            let cylinder = quality(cylinder(element, 1.0, 1.0, &frame, size, [false; 3]));
            let tube = quality(tube(element, [0.5, 1.0], 1.0, &frame, size, [false; 3]));
            assert!(
                ball > 0.2 && cylinder > 0.14 && tube > 0.15,
                "{element:?} {size}: {ball} {cylinder} {tube}"
            );
        }
    }
}

#[test]
fn impossible_solids_are_refused() {
    let message = |r: Result<Mesh, MeshError>| r.unwrap_err().to_string();
    let frame = Frame::along([0.0, 1.0, 1.0], [0.0; 3]).unwrap();
    assert!(message(ball(Element::T6, 1.0, [0.0; 3], 0.5, [false; 3])).contains("T6"));
    assert!(message(ball(Element::Tet4, -1.0, [0.0; 3], 0.5, [false; 3])).contains("radius -1"));
    assert!(message(cylinder(Element::Tet4, 1.0, 0.0, &frame, 0.5, [false; 3])).contains("height = 0"));
    assert!(message(cylinder(Element::Tet4, 1.0, 1.0, &frame, 0.5, [true; 3])).contains("axis [0.0, 0.7"));
    assert!(message(tube(Element::Tet4, [1.0, 1.0], 1.0, &frame, 0.5, [false; 3])).contains("less than"));
    assert!(Frame::along([0.0; 3], [0.0; 3]).is_err());
}

/// Prisms of a disc: its area times the height, on the true cylinder; of squares: the box.
#[test]
fn extrusions_are_area_times_height() {
    for (plane, solid) in
        [(Element::T3, Element::Tet4), (Element::T6, Element::Tet10), (Element::T10, Element::Tet20)]
    {
        let disc = half_disc(plane, 1.0, [0.5, 0.0], 0.3).unwrap();
        let mesh = extrusion(&disc, 0.7, 2).unwrap();
        assert_eq!((mesh.element, mesh.cell_count()), (solid, 6 * disc.cell_count()));
        let names: Vec<_> = mesh.sides.keys().map(String::as_str).collect();
        assert_eq!(names, ["arc", "axis", "bottom", "top"]);
        assert!((sound(&mesh) - 0.7 * area(&mesh, "bottom")).abs() < 1e-13);
        assert!((area(&mesh, "axis") - 1.4).abs() < 1e-13);
        for n in mesh.side_nodes("arc").unwrap() {
            assert!((mesh.nodes[n][0] - 0.5).hypot(mesh.nodes[n][1]) - 1.0 < 1e-15);
        }
    }
    for plane in [Element::T6, Element::Q4, Element::Q9] {
        let square = rectangle(plane, [0.0, 0.0], [2.0, 1.0], [3, 2]).unwrap();
        let mesh = extrusion(&square, 0.5, 1).unwrap();
        assert!((sound(&mesh) - 1.0).abs() < 1e-14);
        let areas = ["bottom", "top", "left", "right", "base", "lid"].map(|side| area(&mesh, side));
        for (found, exact) in areas.into_iter().zip([1.0, 1.0, 0.5, 0.5, 2.0, 2.0]) {
            assert!((found - exact).abs() < 1e-14);
        }
    }
    assert!(extrusion(&interval(Element::L2, 0.0, 1.0, 1).unwrap(), 1.0, 1).is_err());
    assert!(extrusion(&disc(Element::T3, 1.0, [0.0; 2], 1.0).unwrap(), 0.0, 1).is_err());
}
