//! Meshes of Gmsh (made by `scripts/make_meshes.py`): every version, encoding and order
//! gives the same bodies.

use std::f64::consts::PI;
use std::path::PathBuf;

use carom_solid::gmsh::{self, MshFile};
use carom_solid::{Element, Law, Mesh, body};

const ELEMENTS: [Element; 3] = [Element::T3, Element::T6, Element::T10];

fn bytes(name: &str) -> Vec<u8> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("msh").join(name);
    std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn fixture(name: &str) -> MshFile {
    gmsh::read(&bytes(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn variants(order: usize) -> impl Iterator<Item = String> {
    ["41_binary", "41_ascii", "22_binary", "22_ascii"]
        .into_iter()
        .map(move |v| format!("impact_order{order}_{v}.msh"))
}

/// ∫dΩ by the quadrature of the body.
fn area(mesh: &Mesh) -> f64 {
    let body = body(mesh.clone(), Law::NeoHookean { lambda: 1.0, mu: 1.0 }, 1.0, 1.0).unwrap();
    let n = mesh.element.nodes();
    let volumes = |cell| {
        let mut volumes = vec![0.0; n];
        body.cell_volumes(cell, &mut volumes);
        volumes.iter().sum::<f64>()
    };
    (0..mesh.cell_count()).map(volumes).sum()
}

/// Positions of the nodes of every cell, and of every side in order, independent of numbering.
fn geometry(mesh: &Mesh) -> (Vec<Vec<[f64; 2]>>, Vec<(String, Vec<[f64; 2]>)>) {
    let nodes = mesh.nodes.of_dimension();
    let mut cells: Vec<Vec<_>> =
        (0..mesh.cell_count()).map(|c| mesh.cell(c).iter().map(|&n| nodes[n]).collect()).collect();
    cells.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap());
    let places = |side: &String| mesh.side_nodes(side).unwrap().into_iter().map(|n| nodes[n]).collect();
    (cells, mesh.sides.keys().map(|side| (side.clone(), places(side))).collect())
}

fn near(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-14)
}

#[test]
fn versions_and_encodings_give_the_same_bodies() {
    for order in 1..=3 {
        for surface in ["cylinder", "prism"] {
            let bodies: Vec<_> = variants(order).map(|v| fixture(&v).body(surface).unwrap()).collect();
            // Binary files store every bit, texts of Gmsh 16 digits.
            assert_eq!(geometry(&bodies[0]), geometry(&bodies[2]));
            let (cells, sides) = geometry(&bodies[0]);
            for body in &bodies {
                assert_eq!(body.element, ELEMENTS[order - 1]);
                let (other_cells, other_sides) = geometry(body);
                assert!(cells.iter().all(|a| other_cells.iter().any(|b| near(a, b))));
                assert_eq!(cells.len(), other_cells.len());
                assert_eq!(sides.len(), other_sides.len());
                for (a, b) in sides.iter().zip(&other_sides) {
                    assert!(a.0 == b.0 && near(&a.1, &b.1), "{a:?}\n{b:?}");
                }
            }
        }
    }
}

#[test]
fn areas_and_arcs_are_exact() {
    for order in 1..=3 {
        for variant in variants(order) {
            let file = fixture(&variant);
            let (disc, prism) = (file.body("cylinder").unwrap(), file.body("prism").unwrap());
            assert!((area(&prism) - 0.5).abs() < 1e-13, "{}", area(&prism));
            // An arc of angle 2φ between nodes: the chord's error is R²(φ − sin φ cos φ) per facet,
            // φ = π/2/n; that of curved facets is far smaller.
            let miss = PI / 8.0 - area(&disc);
            let arcs = disc.sides["arc"].len() as f64;
            let half = PI / 2.0 / arcs;
            let chord = 0.25 * (half - half.sin() * half.cos()) * arcs;
            match order {
                1 => assert!((miss / chord - 1.0).abs() < 1e-9, "{miss} {chord}"),
                2 => assert!(miss.abs() < 4e-3 * chord, "{miss} {chord}"),
                _ => assert!(miss.abs() < 1e-3 * chord, "{miss} {chord}"),
            }
            for n in disc.side_nodes("arc").unwrap() {
                let radius = disc.nodes[n][0].hypot(disc.nodes[n][1] - 1.0);
                assert!((radius - 0.5).abs() < 1e-12, "{variant}: {:e}", radius - 0.5);
            }
        }
    }
}

/// Facets are consecutive with the body on the left; names apply to the bodies they touch.
#[test]
fn sides_are_walked_with_the_body_on_the_left() {
    for order in 1..=3 {
        for variant in variants(order) {
            let file = fixture(&variant);
            assert_eq!(file.names(2), ["cylinder", "prism"]);
            let (disc, prism) = (file.body("cylinder").unwrap(), file.body("prism").unwrap());
            assert_eq!(disc.sides.keys().collect::<Vec<_>>(), ["arc", "axis"]);
            assert_eq!(prism.sides.keys().collect::<Vec<_>>(), ["axis", "bottom", "right", "top"]);
            for (mesh, middle) in [(&disc, [0.2, 1.0]), (&prism, [0.5, -0.25])] {
                for (side, facets) in &mesh.sides {
                    assert!(facets.windows(2).all(|f| f[0].nodes[1] == f[1].nodes[0]), "{side}");
                    for facet in facets {
                        assert!(facet.nodes.iter().all(|n| mesh.cell(facet.cell).contains(n)));
                        let (a, b) = (&mesh.nodes[facet.nodes[0]], &mesh.nodes[facet.nodes[1]]);
                        let (t, m) = ([b[0] - a[0], b[1] - a[1]], [middle[0] - a[0], middle[1] - a[1]]);
                        assert!(t[0] * m[1] - t[1] * m[0] > 0.0, "{side}");
                        let along: Vec<f64> = [facet.nodes[0]]
                            .iter()
                            .chain(&facet.nodes[2..])
                            .chain(&facet.nodes[1..2])
                            .map(|&n| (mesh.nodes[n][0] - a[0]) * t[0] + (mesh.nodes[n][1] - a[1]) * t[1])
                            .collect();
                        assert!(along.windows(2).all(|w| w[1] > w[0]), "{along:?}");
                    }
                }
            }
            let ends = |mesh: &Mesh, side: &str| {
                let nodes = mesh.side_nodes(side).unwrap();
                [nodes[0], nodes[nodes.len() - 1]].map(|n| mesh.nodes.of_dimension()[n])
            };
            assert!(near(&ends(&disc, "arc"), &[[0.0, 0.5], [0.0, 1.5]]));
            assert!(near(&ends(&prism, "top"), &[[1.0, 0.0], [0.0, 0.0]]));
        }
    }
}

/// Everything saved, including the centre of the arcs and parameters of the nodes: the same body,
/// and the dropped node is reported.
#[test]
fn parameters_are_read_past() {
    for name in ["parametric_41_ascii.msh", "parametric_41_binary.msh"] {
        let file = fixture(name);
        let disc = file.body("cylinder").unwrap();
        assert_eq!(disc.element, Element::T6);
        assert!((area(&disc) - PI / 8.0).abs() < 1e-3);
        assert_eq!(disc.repairs, ["nodes of the file that belong to no cell were dropped: 1"]);
    }
    let [binary, text] = ["parametric_22_binary.msh", "parametric_22_ascii.msh"].map(fixture);
    let [of_41, plain] = ["parametric_41_binary.msh", "impact_order2_22_binary.msh"].map(fixture);
    for name in ["cylinder", "prism"] {
        let [binary, text, of_41, plain] = [&binary, &text, &of_41, &plain].map(|f| f.body(name).unwrap());
        assert_eq!(geometry(&binary), geometry(&of_41));
        assert_eq!(binary.sides.keys().collect::<Vec<_>>(), plain.sides.keys().collect::<Vec<_>>());
        assert_eq!((text.cells, text.sides), (binary.cells, binary.sides));
    }
}

/// Quadrangles and triangles in bodies of their own, and a curved quarter of a ring.
#[test]
fn quadrangles() {
    let file = fixture("quadrangles.msh");
    let [disc, prism] = ["cylinder", "prism"].map(|name| file.body(name).unwrap());
    assert_eq!((disc.element, prism.element, prism.cell_count()), (Element::T3, Element::Q4, 11));
    assert!((area(&prism) - 0.5).abs() < 1e-15, "{}", area(&prism));
    let ends = |side| prism.side_nodes(side).map(|all| [all[0], all[all.len() - 1]]);
    let corners = ["bottom", "right", "top"].map(|side| ends(side).unwrap());
    assert!(corners[0][1] == corners[1][0] && corners[1][1] == corners[2][0]);

    let exact = 0.75 * PI;
    // A quarter of a circle has four edges.
    let chord = 6.0 * (PI / 8.0).sin();
    for (name, element, expected, tolerance) in [
        ("sector_order1.msh", Element::Q4, chord, 1e-12),
        ("sector_order2.msh", Element::Q9, exact, 3e-4),
        ("sector_order2_22_binary.msh", Element::Q9, exact, 3e-4),
    ] {
        let mesh = fixture(name).body("sector").unwrap();
        assert_eq!((mesh.element, mesh.cell_count()), (element, 12), "{name}");
        assert!((area(&mesh) - expected).abs() < tolerance * expected, "{name}: {}", area(&mesh));
        let names: Vec<_> = mesh.sides.keys().map(String::as_str).collect();
        assert_eq!(names, ["inner", "outer", "plane_x", "plane_y"]);
        assert_eq!(mesh.sides.values().map(Vec::len).sum::<usize>(), mesh.skin().len());
        for (side, radius) in [("inner", 1.0), ("outer", 2.0)] {
            for n in mesh.side_nodes(side).unwrap() {
                assert!((mesh.nodes[n][0].hypot(mesh.nodes[n][1]) - radius).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn bars() {
    for name in ["bar.msh", "bar_22.msh"] {
        let bar = fixture(name).bar("bar").unwrap();
        assert_eq!((bar.element, bar.cell_count(), bar.nodes.len()), (Element::L4, 4, 13));
        let at = |side: &str| bar.nodes[bar.sides[side][0].nodes[0]][0];
        assert_eq!((at("left"), at("right")), (0.0, 2.0));
        assert!(bar.repairs.is_empty());
    }
}

/// Two triangles on the unit square in a binary file of either byte order, written according to the
/// format's description.
fn square(version: f64, big_endian: bool) -> Vec<u8> {
    let int = |n: i32| if big_endian { n.to_be_bytes() } else { n.to_le_bytes() }.to_vec();
    let size = |n: i64| if big_endian { n.to_be_bytes() } else { n.to_le_bytes() }.to_vec();
    let double = |x: f64| if big_endian { x.to_be_bytes() } else { x.to_le_bytes() }.to_vec();
    let ints = |all: &[i32]| all.iter().flat_map(|n| int(*n)).collect::<Vec<_>>();
    let sizes = |all: &[i64]| all.iter().flat_map(|n| size(*n)).collect::<Vec<_>>();
    let doubles = |all: &[f64]| all.iter().flat_map(|x| double(*x)).collect::<Vec<_>>();
    let nodes = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let box_of = [0.0, 0.0, 0.0, 1.0, 1.0, 0.0];
    let names =
        b"\n$EndMeshFormat\n$PhysicalNames\n2\n1 7 \"low\"\n2 8 \"plate\"\n$EndPhysicalNames\n".to_vec();
    let start = [format!("$MeshFormat\n{version} 1 8\n").into_bytes(), int(1), names].concat();
    let nodes = if version == 4.1 {
        [
            b"$Entities\n".to_vec(),
            sizes(&[0, 1, 1, 0]),
            [int(1), doubles(&box_of), size(1), int(7), size(2), ints(&[1, -2])].concat(),
            [int(5), doubles(&box_of), size(1), int(-8), size(0)].concat(),
            b"\n$EndEntities\n$Nodes\n".to_vec(),
            sizes(&[1, 4, 1, 4]),
            [ints(&[2, 5, 0]), sizes(&[4, 1, 2, 3, 4]), doubles(nodes.as_flattened())].concat(),
            b"\n$EndNodes\n$Elements\n".to_vec(),
            sizes(&[2, 3, 1, 3]),
            [ints(&[1, 1, 1]), sizes(&[1, 1, 2, 1])].concat(),
            [ints(&[2, 5, 2]), sizes(&[2, 2, 1, 2, 3, 3, 1, 3, 4])].concat(),
        ]
        .concat()
    } else {
        let rows: Vec<u8> = (1..).zip(&nodes).flat_map(|(n, x)| [int(n), doubles(x)].concat()).collect();
        [
            [b"$Nodes\n4\n".to_vec(), rows, b"\n$EndNodes\n$Elements\n3\n".to_vec()].concat(),
            ints(&[1, 1, 2, 1, 7, 1, 2, 1]),
            ints(&[2, 2, 2, 2, 8, 1, 1, 2, 3, 3, 8, 1, 1, 3, 4]),
        ]
        .concat()
    };
    [start, nodes, b"\n$EndElements\n".to_vec()].concat()
}

#[test]
fn byte_orders() {
    for version in [2.2, 4.1] {
        for big_endian in [false, true] {
            let mesh = gmsh::read(&square(version, big_endian)).unwrap().body("plate").unwrap();
            assert_eq!(mesh.nodes.of_dimension(), [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
            assert_eq!(
                (mesh.cells.as_slice(), mesh.sides["low"][0].nodes.as_slice()),
                (&[0, 1, 2, 0, 2, 3][..], &[0, 1][..])
            );
        }
    }
}

fn laminate(regions: &[&str]) -> gmsh::MshFile {
    let bytes = include_bytes!("../../../../cases/materials/laminate.msh");
    gmsh::read(bytes).unwrap().with_regions(regions.iter().map(|&name| name.to_owned()).collect())
}

/// Cells know the group that they come from, also after they are divided and extruded.
#[test]
fn cells_belong_to_regions() {
    let mesh = laminate(&["soft", "stiff"]).body("laminate").unwrap();
    let is_soft = |x: f64| (0.4..1.2).contains(&x);
    let check = |mesh: &Mesh| {
        for cell in 0..mesh.cell_count() {
            let nodes = mesh.cell(cell);
            let middle = nodes.iter().map(|&n| mesh.nodes[n][0]).sum::<f64>() / nodes.len() as f64;
            assert_eq!(mesh.region(cell), usize::from(!is_soft(middle)), "cell {cell} at {middle}");
        }
    };
    check(&mesh);
    check(&mesh.subdivided(3));
    check(&carom_solid::generate::extrusion(&mesh, 0.3, 2).unwrap());
    let groups = ["soft".to_owned(), "stiff".to_owned()];
    let united = laminate(&["soft", "stiff"]).with_union(2, "both", &groups).unwrap();
    assert_eq!(united.body("both").unwrap(), mesh);
    assert!(laminate(&[]).body("laminate").unwrap().regions.is_empty());
}

#[test]
fn a_cell_has_one_region() {
    let fault = |regions: &[&str], body: &str| {
        let error = laminate(regions).body(body).unwrap_err();
        format!("{error}; {}; {}", error.why(), error.help())
    };
    let none = fault(&["soft"], "laminate");
    assert!(none.contains("belongs to none of the groups \"soft\""), "{none}");
    let two = fault(&["stiff", "soft", "laminate"], "laminate");
    assert!(two.contains("belongs to the groups \"stiff\", \"laminate\""), "{two}");
    let empty = fault(&["stiff", "soft"], "soft");
    assert!(empty.contains("no cell of \"soft\" belongs to the physical surface \"stiff\""), "{empty}");
    let unknown = fault(&["stiff", "weak"], "laminate");
    assert!(unknown.contains("no physical surface \"weak\"") && unknown.contains("stiff, soft"), "{unknown}");
}
