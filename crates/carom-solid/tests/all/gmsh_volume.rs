//! Volumes of Gmsh: an eighth of the unit ball at orders 1 to 3, and files written by Carom.

use std::fmt::Write as _;

use carom_solid::generate::{Frame, ball, cylinder, extrusion};
use carom_solid::gmsh::{self, Fault, MshError};
use carom_solid::{Element, Facet, Mesh};

fn read(name: &str) -> Mesh {
    let path = format!("{}/msh/{name}.msh", env!("CARGO_MANIFEST_DIR"));
    gmsh::read(&std::fs::read(path).unwrap()).unwrap().volume("eighth").unwrap()
}

/// ∫ x·n / 3 and |∫ n| of facets.
fn volume(mesh: &Mesh, facets: &[Facet]) -> (f64, f64) {
    let shape = mesh.element.facet_shape();
    let (mut flux, mut normal) = (0.0, [0.0; 3]);
    for facet in facets {
        for (xi, weight) in shape.rule(10) {
            let functions = shape.functions(xi);
            let sum = |values: &[f64]| {
                [0, 1, 2]
                    .map(|i| facet.nodes.iter().zip(values).map(|(&n, v)| v * mesh.nodes[n][i]).sum::<f64>())
            };
            let x = sum(&functions.values);
            let area = shape.area_vector([0, 1].map(|c| sum(&functions.slopes[c])), 1.0);
            (0..3).for_each(|i| normal[i] += weight * area[i]);
            flux += weight * (0..3).map(|i| x[i] * area[i]).sum::<f64>();
        }
    }
    (flux / 3.0, normal.iter().map(|n| n * n).sum::<f64>().sqrt())
}

/// Closed, outward, on the true sphere and planes, and the closer to π/6 the higher the order.
#[test]
fn an_eighth_of_a_ball() {
    let exact = std::f64::consts::PI / 6.0;
    let mut before = f64::INFINITY;
    for (name, element) in [
        ("eighth_order1_41_ascii", Element::Tet4),
        ("eighth_order2_41_ascii", Element::Tet10),
        ("eighth_order3_41_binary", Element::Tet20),
    ] {
        let mesh = read(name);
        assert_eq!((mesh.element, mesh.cell_count()), (element, 29));
        assert!(mesh.repairs.is_empty(), "{:?}", mesh.repairs);
        let skin = mesh.skin();
        let (found, open) = volume(&mesh, &skin);
        assert!(open < 1e-13, "{open}");
        let error = (found - exact).abs();
        // Both curved degrees miss the volume by O(h⁴).
        assert!(error < 0.5 * before, "{name}: {error} after {before}");
        before = error;
        let names: Vec<_> = mesh.sides.keys().map(String::as_str).collect();
        assert_eq!(names, ["plane_x", "plane_y", "plane_z", "sphere"]);
        assert_eq!(mesh.sides.values().map(Vec::len).sum::<usize>(), skin.len());
        for (axis, side) in names[..3].iter().enumerate() {
            assert!(mesh.side_nodes(side).unwrap().iter().all(|&n| mesh.nodes[n][axis].abs() < 1e-12));
        }
        for n in mesh.side_nodes("sphere").unwrap() {
            let radius = mesh.nodes[n].iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!((radius - 1.0).abs() < 1e-9, "{name}: {radius}");
        }
        assert!(mesh.scaled_jacobian().unwrap() > 0.1);
    }
}

/// Hexahedra of Gmsh above a quarter of a ring: closed, with the volume of the ring, and the cells
/// of our extrusion of the quadrangles below them.
#[test]
fn hexahedra_and_their_base() {
    let exact = 0.375 * std::f64::consts::PI;
    for (name, element, tolerance) in [
        ("sector_order1", Element::Hex8, 0.03),
        ("sector_order2", Element::Hex27, 3e-4),
        ("sector_order2_22_binary", Element::Hex27, 3e-4),
    ] {
        let path = format!("{}/msh/{name}.msh", env!("CARGO_MANIFEST_DIR"));
        let file = gmsh::read(&std::fs::read(path).unwrap()).unwrap();
        let (mesh, plane) = (file.volume("wedge").unwrap(), file.body("sector").unwrap());
        assert_eq!((mesh.element, mesh.cell_count()), (element, 24));
        assert!(mesh.repairs.iter().all(|repair| repair.contains("mirrored")), "{:?}", mesh.repairs);
        let skin = mesh.skin();
        let (found, open) = volume(&mesh, &skin);
        assert!(open < 1e-13 && (found / exact - 1.0).abs() < tolerance, "{name}: {found}");
        let made = extrusion(&plane, 0.5, 2).unwrap();
        assert_eq!(made.element, element);
        assert_eq!(made.nodes.len(), mesh.nodes.len());
        let places = |mesh: &Mesh| {
            let rounded = |&n: &usize| [0, 1, 2].map(|i| (mesh.nodes[n][i] * 1e7).round() as i64);
            let cell = |c: usize| {
                let mut nodes: Vec<_> = mesh.cell(c).iter().map(rounded).collect();
                nodes.sort_unstable();
                nodes
            };
            let mut cells: Vec<_> = (0..mesh.cell_count()).map(cell).collect();
            cells.sort_unstable();
            cells
        };
        assert_eq!(places(&made), places(&mesh), "{name}");
        let lengths = |mesh: &Mesh, names: [&str; 6]| names.map(|name| mesh.sides[name].len());
        assert_eq!(
            lengths(&mesh, ["inner", "outer", "plane_x", "plane_y", "sector", "lid"]),
            lengths(&made, ["inner", "outer", "plane_x", "plane_y", "bottom", "top"])
        );
    }
}

/// Version 2.2 in binary is the same mesh as version 4.1 in text, whose decimals are exact.
#[test]
fn versions_and_encodings_agree() {
    let (text, binary) = (read("eighth_order2_41_ascii"), read("eighth_order2_22_binary"));
    let places = |mesh: &Mesh| {
        let mut cells: Vec<Vec<Vec<i64>>> = (0..mesh.cell_count())
            .map(|c| {
                let rounded = |&n: &usize| mesh.nodes[n].iter().map(|x| (x * 1e9).round() as i64).collect();
                mesh.cell(c).iter().map(rounded).collect()
            })
            .collect();
        cells.sort_unstable();
        cells
    };
    assert_eq!(places(&text), places(&binary));
}

/// What is written is read bitwise, hexahedra as well.
#[test]
fn volumes_are_written_and_read() {
    let frame = Frame::along([1.0, 0.0, 1.0], [0.0; 3]).unwrap();
    for element in [Element::Tet4, Element::Tet10, Element::Tet20, Element::Hex8, Element::Hex27] {
        let part = ball(element, 1.0, [0.1, 0.2, 0.3], 0.9, [true, false, false]).unwrap();
        let pin = cylinder(element, 0.2, 1.0, &frame, 0.4, [false; 3]).unwrap();
        let file = gmsh::read(gmsh::write_msh41(&[("part", &part), ("pin", &pin)]).as_bytes()).unwrap();
        for (name, mesh) in [("part", &part), ("pin", &pin)] {
            let back = file.volume(name).unwrap();
            assert_eq!((&back.nodes, &back.cells, &back.sides), (&mesh.nodes, &mesh.cells, &mesh.sides));
            assert!(back.repairs.is_empty());
        }
    }
}

/// Tetrahedra on given corners as a file of version 2.2.
fn file(nodes: &[[f64; 3]], cells: &[[usize; 4]]) -> Result<Mesh, MshError> {
    let mut text = String::from(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"part\"\n$EndPhysicalNames\n",
    );
    let _ = writeln!(text, "$Nodes\n{}", nodes.len());
    for (k, [x, y, z]) in nodes.iter().enumerate() {
        let _ = writeln!(text, "{} {x} {y} {z}", k + 1);
    }
    let _ = writeln!(text, "$EndNodes\n$Elements\n{}", cells.len());
    for (k, [a, b, c, d]) in cells.iter().enumerate() {
        let _ = writeln!(text, "{} 4 2 1 1 {a} {b} {c} {d}", k + 1);
    }
    gmsh::read((text + "$EndElements\n").as_bytes())?.volume("part")
}

const CORNERS: [[f64; 3]; 6] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 0.0, -1.0]];

/// Mirrored cells are turned; flat, overlapping and crowded ones, and bodies that hang together at
/// an edge, are named with their cells and line.
#[test]
fn faults_are_named() {
    let mirrored = file(&CORNERS[..4], &[[1, 3, 2, 4]]).unwrap();
    assert_eq!(mirrored.repairs.len(), 1);
    assert!(mirrored.scaled_jacobian().unwrap() > 0.0);

    let flat = file(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]], &[[1, 2, 3, 4]]);
    let flat = flat.unwrap_err();
    assert!(matches!(flat.fault, Fault::Folded { cell: 1, .. }), "{flat}");

    // Both on the side of the origin of the facet 2 3 4.
    let inside = [CORNERS[0], CORNERS[1], CORNERS[2], CORNERS[3], [0.1, 0.1, 0.1]];
    let overlap = file(&inside, &[[1, 2, 3, 4], [5, 2, 3, 4]]).unwrap_err();
    assert!(matches!(overlap.fault, Fault::SameSide { a: 1, b: 2, .. }), "{overlap}");
    assert!(
        overlap.to_string().starts_with("line ") && overlap.to_string().contains("[2, 3, 4]"),
        "{overlap}"
    );

    let mut three = inside.to_vec();
    three[4] = CORNERS[4];
    three.push([2.0, 2.0, 2.0]);
    let crowded = file(&three, &[[1, 2, 3, 4], [5, 2, 4, 3], [6, 2, 4, 3]]).unwrap_err();
    assert!(matches!(&crowded.fault, Fault::Crowded { cells, .. } if cells[..] == [1, 2, 3]), "{crowded}");

    // Two tetrahedra that share an edge only.
    let hinge = [CORNERS[0], CORNERS[1], CORNERS[2], CORNERS[3], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
    let hinge = file(&hinge, &[[1, 2, 3, 4], [1, 2, 5, 6]]).unwrap_err();
    assert!(matches!(&hinge.fault, Fault::Pinched { facets: 4, start: 1, end: 2, .. }), "{hinge}");
}
