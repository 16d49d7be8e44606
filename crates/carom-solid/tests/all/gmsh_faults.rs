//! Damaged and invalid mesh files give an error with place and cause, or a reported repair; never a
//! panic, never a wrong mesh.

use std::path::PathBuf;

use carom_solid::gmsh::{self, Fault, MshError, Place};
use carom_solid::{Element, Mesh, Positions, generate};

use super::random::{integer, lists};

fn fixtures() -> Vec<(String, Vec<u8>)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("msh");
    let mut all: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|extension| extension == "msh"))
        .map(|p| (p.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(&p).unwrap()))
        .collect();
    all.sort_unstable();
    assert!(all.len() >= 21);
    all
}

/// Calls everything on a file.
fn everything(bytes: &[u8]) {
    let Ok(file) = gmsh::read(bytes) else { return };
    for name in file.names(2) {
        let _ = file.body(name);
    }
    for name in file.names(1) {
        let _ = file.bar(name);
    }
    for name in file.names(3) {
        let _ = file.volume(name);
    }
}

#[test]
fn cut_files_are_errors() {
    for (name, bytes) in fixtures() {
        let last = bytes.len() - 1;
        for end in (0..last).step_by(7).chain(last.saturating_sub(200)..last) {
            let error = gmsh::read(&bytes[..end]).map(|_| ()).expect_err(&format!("{name} cut at {end}"));
            assert!(!error.why().is_empty() && !error.help().is_empty());
        }
        assert!(gmsh::read(&bytes[..last]).is_ok(), "only the last end of line is missing");
    }
}

/// Calls everything on fixtures of which up to five bytes are replaced by one of the given ones.
fn bent(bytes: &[u8]) {
    let files = fixtures();
    lists(4000, 12, &|x| {
        let mut file = files[integer(x[0], 21)].1.clone();
        for [at, byte] in &x[2..].as_chunks::<2>().0[..=integer(x[1], 5)] {
            let at = integer(*at, file.len());
            file[at] = bytes[integer(*byte, bytes.len())];
        }
        everything(&file);
    });
}

#[test]
fn bent_bytes_never_panic() {
    let all: Vec<u8> = (0..=u8::MAX).collect();
    bent(&all);
}

#[test]
fn bent_digits_never_panic() {
    bent(b"0123456789- ");
}

/// Two triangles on the unit square, version 2.2.
const SQUARE: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 7 \"low\"\n2 8 \"plate\"\n$EndPhysicalNames\n\
    $Nodes\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n9 5 5 0\n$EndNodes\n\
    $Elements\n3\n1 1 2 7 1 2 1\n2 2 2 8 1 1 2 3\n3 2 2 8 1 1 3 4\n$EndElements\n";

fn with(old: &str, new: &str) -> Result<Mesh, MshError> {
    assert!(SQUARE.contains(old), "{old}");
    gmsh::read(SQUARE.replacen(old, new, 1).as_bytes())?.body("plate")
}

fn fault(old: &str, new: &str) -> (Place, Fault) {
    let error = with(old, new).expect_err(new);
    (error.place, error.fault)
}

#[test]
fn the_square_is_sound() {
    let mesh = with("5 5 0", "5 5 0").unwrap();
    assert_eq!(mesh.nodes.len(), 4);
    assert_eq!(mesh.repairs, ["nodes of the file that belong to no cell were dropped: 1"]);
    // Several blanks and tabs separate numbers as one does.
    let spaced = with("2 8 \"plate\"", " 2\t8   \"plate\" ").unwrap();
    assert_eq!(spaced.nodes.len(), 4);
    // The line runs from 2 to 1; the side has the body on its left.
    assert_eq!(mesh.sides["low"][0].nodes, [0, 1]);
    assert!(gmsh::read(SQUARE.replace('\n', "\r\n").as_bytes()).unwrap().body("plate").is_ok());
}

#[test]
fn faults_say_where_and_what() {
    use Place::{File, Line};
    assert_eq!(fault("$MeshFormat", "$Mesh"), (Line(1), Fault::NotMsh));
    assert_eq!(fault("2.2 0", "4 0"), (Line(2), Fault::Version("4".into())));
    assert!(matches!(fault("2.2 0 8", "2.2 2 8"), (Line(2), Fault::Header(_))));
    assert_eq!(fault("5\n1 0 0 0", "500\n1 0 0 0").0, Line(10), "counted before it is believed");
    assert!(matches!(fault("5\n1 0 0 0", "6\n1 0 0 0"), (Line(16), Fault::Unexpected { .. })));
    assert!(matches!(fault("5\n1 0 0 0", "4\n1 0 0 0"), (Line(15), Fault::Unexpected { .. })));
    assert!(matches!(
        fault("5\n1 0 0 0", "99999999999999999999\n1 0 0 0"),
        (Line(10), Fault::Unexpected { .. })
    ));
    assert!(matches!(fault("3 1 1 0", "3 1 1"), (Line(13), Fault::ShortLine(_))));
    assert_eq!(fault("3 1 1 0", "3 1 1 0 7"), (Line(13), Fault::LongLine("7".into())));
    assert!(matches!(fault("3 1 1 0", "3 1 one 0"), (Line(13), Fault::Unexpected { .. })));
    assert_eq!(fault("3 1 1 0", "3 1 nan 0"), (Line(13), Fault::NotFinite(3)));
    assert_eq!(fault("3 1 1 0", "2 1 1 0"), (Line(13), Fault::TagTwice { what: "node", tag: 2 }));
    assert_eq!(fault("1 1 3 4", "1 1 3 6"), (Line(21), Fault::NoNode { cell: 3, node: 6 }));
    assert_eq!(fault("3 2 2 8", "3 34 2 8"), (Line(21), Fault::UnknownType { cell: 3, kind: 34 }));
    let names = vec!["plat".to_owned()];
    assert_eq!(
        fault("plate", "plat"),
        (
            File,
            Fault::NoName {
                what: "surface",
                name: "plate".into(),
                names,
                elsewhere: vec!["curve \"low\"".into()]
            }
        )
    );
    assert!(with("plate", "plat").unwrap_err().why().contains("the physical surfaces are: plat"));
    assert!(matches!(
        fault("3\n1 1 2 7 1 2 1\n2 2 2 8 1 1 2 3\n3 2 2 8 1 1 3 4\n", "1\n1 1 2 7 1 2 1\n"),
        (File, Fault::NoCells { .. })
    ));
    assert!(matches!(
        fault("3 2 2 8 1 1 3 4", "3 9 2 8 1 1 3 4 1 3 4"),
        (Line(21), Fault::MixedOrders { .. })
    ));
    assert!(matches!(fault("3 2 2 8 1 1 3 4", "3 3 2 8 1 1 2 3 4"), (Line(21), Fault::MixedKinds { .. })));
    assert!(matches!(fault("4 0 1 0", "4 0 1 0.5"), (Line(14), Fault::NotFlat { node: 4, axis: 'z', .. })));
    assert!(matches!(fault("4 0 1 0", "4 0.5 0.5 0"), (Line(21), Fault::Folded { cell: 3, .. })));
    assert!(matches!(fault("4 0 1 0", "4 2 0.5 0"), (Line(21), Fault::Overlap { a: 2, b: 3, .. })));
    assert!(matches!(fault("3 2 2 8 1 1 3 4", "3 2 2 8 1 1 2 3"), (Line(21), Fault::Overlap { .. })));
    let torn = "3 2 2 8 1 1 9 4";
    let torn = SQUARE.replace("9 5 5 0", "9 1 1 0").replace("3 2 2 8 1 1 3 4", torn);
    let error = gmsh::read(torn.as_bytes()).unwrap().body("plate").unwrap_err();
    assert!(matches!(error.fault, Fault::Coincident { a: 3, b: 9, .. }), "{error}");
    let again = format!("{SQUARE}$Nodes\n0\n$EndNodes\n");
    assert_eq!(gmsh::read(again.as_bytes()).unwrap_err().fault, Fault::SectionTwice("Nodes"));
    assert_eq!(
        gmsh::read(b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n").unwrap_err().fault,
        Fault::NoSection("Nodes")
    );
    let huge = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 9223372036854775807 1 1\n";
    let error = gmsh::read(huge.as_bytes()).unwrap_err();
    assert_eq!(
        (error.place, error.to_string().contains("the file states 9223372036854775807 nodes")),
        (Line(5), true)
    );
}

/// Types by Gmsh's `getElementProperties`, as `Mesh.SecondOrderIncomplete = 1`, high orders and
/// `Recombine` make them: the cause is named, and the option that removes it.
#[test]
fn unsupported_cells_name_the_option() {
    let cell = |dimension: i64, kind: i64, nodes: i64| {
        let rows = (1..=nodes).map(|n| format!("{n} {n} 0 0\n")).collect::<Vec<_>>().concat();
        let tags: Vec<String> = (1..=nodes).map(|n| n.to_string()).collect();
        let file = format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}\n{rows}$EndNodes\n\
             $Elements\n1\n7 {kind} 2 8 1 {}\n$EndElements\n",
            tags.join(" ")
        );
        let file = gmsh::read(file.as_bytes()).unwrap();
        let error = if dimension == 2 { file.body("8") } else { file.volume("8") }.unwrap_err();
        [error.to_string(), error.why(), error.help().to_owned()].join("; ")
    };
    let incomplete = "Mesh.SecondOrderIncomplete = 0";
    for (dimension, kind, nodes, words) in [
        (2, 16, 8, ["a quadrangle of 8 nodes, an incomplete one of order 2", "has 9 nodes", incomplete]),
        (2, 20, 9, ["a triangle of 9 nodes, an incomplete one of order 3", "has 10 nodes", incomplete]),
        (2, 39, 12, ["a quadrangle of 12 nodes, an incomplete one of order 3", "has 16 nodes", incomplete]),
        (3, 17, 20, ["a hexahedron of 20 nodes, an incomplete one of order 2", "has 27 nodes", incomplete]),
        (3, 137, 16, ["a tetrahedron of 16 nodes, an incomplete one of order 3", "has 20 nodes", incomplete]),
        (3, 32, 22, ["a tetrahedron of 22 nodes, an incomplete one of order 4", "has 35 nodes", incomplete]),
        (2, 23, 15, ["a triangle of 15 nodes, of order 4", "up to order 3", "Mesh.ElementOrder"]),
        (3, 92, 64, ["a hexahedron of 64 nodes, of order 3", "up to order 2", "Mesh.ElementOrder"]),
        (3, 6, 6, ["a prism of 6 nodes", "tetrahedra or of hexahedra", "Recombine"]),
        (3, 14, 14, ["a pyramid of 14 nodes", "tetrahedra or of hexahedra", "Recombine"]),
    ] {
        let text = cell(dimension, kind, nodes);
        let places = words.map(|word| text.find(word).unwrap_or_else(|| panic!("{word}: {text}")));
        assert!(places.is_sorted(), "{text}");
    }
}

/// Groups without names are called by their numbers, in both versions of the format.
#[test]
fn unnamed_groups_have_their_numbers() {
    let names = "$PhysicalNames\n2\n1 7 \"low\"\n2 8 \"plate\"\n$EndPhysicalNames\n";
    let file = gmsh::read(SQUARE.replace(names, "").as_bytes()).unwrap();
    assert_eq!((file.names(1), file.names(2)), (vec!["7"], vec!["8"]));
    let mesh = file.body("8").unwrap();
    assert_eq!((mesh.cell_count(), mesh.sides["7"][0].nodes.as_slice()), (2, &[0, 1][..]));
    // A name that is a number, of another group: the name counts.
    let file = gmsh::read(SQUARE.replace("1 7 \"low\"", "1 9 \"7\"").as_bytes()).unwrap();
    assert!(file.body("plate").unwrap().sides.is_empty());

    let named = gmsh::write_msh41(&[("plate", &with("low", "low").unwrap())]);
    let at = named.find("$PhysicalNames").unwrap()..named.find("$Entities").unwrap();
    let unnamed = [&named[..at.start], &named[at.end..]].concat();
    let file = gmsh::read(unnamed.as_bytes()).unwrap();
    assert_eq!((file.names(1), file.names(2)), (vec!["1"], vec!["1"]));
    // The numbers of entities are not those of groups.
    let at = named.find("$Entities").unwrap()..named.find("$Nodes").unwrap();
    let without = [&named[..at.start], &named[at.end..]].concat();
    assert_eq!(gmsh::read(without.as_bytes()).unwrap_err().fault, Fault::NoSection("Entities"));
    let error = gmsh::read(
        without.replace("$PhysicalNames", "$Else").replace("$EndPhysicalNames", "$EndElse").as_bytes(),
    );
    let error = error.unwrap().body("1").unwrap_err();
    assert_eq!(error.why(), "the file contains no physical surface, nor another physical group");
}

/// A curve between two cells of the body is no part of its boundary, and is not dropped silently.
#[test]
fn facets_inside_a_body_are_noted() {
    let mesh = with("1 1 2 7 1 2 1\n", "1 1 2 7 1 2 1\n4 1 2 7 1 1 3\n").map(|_| ());
    assert!(mesh.is_err(), "four cells where three are stated");
    let both = SQUARE.replace("3\n1 1 2 7 1 2 1\n", "4\n1 1 2 7 1 2 1\n4 1 2 7 1 1 3\n");
    let mesh = gmsh::read(both.as_bytes()).unwrap().body("plate").unwrap();
    assert_eq!(mesh.sides["low"].len(), 1);
    let note = "1 of 2 edges of the physical curve \"low\" lie inside the body, between two of its cells, and are not in its side";
    assert_eq!(mesh.repairs[0], note);
    let only = SQUARE.replace("1 1 2 7 1 2 1\n", "1 1 2 7 1 3 1\n");
    let mesh = gmsh::read(only.as_bytes()).unwrap().body("plate").unwrap();
    assert_eq!((mesh.sides.len(), mesh.repairs[0].as_str()), (0, note.replace("1 of 2", "1 of 1").as_str()));

    let cube = generate::cuboid(Element::Hex8, [0.0; 3], [2.0, 1.0, 1.0], [2, 1, 1]).unwrap();
    let mut split = cube.clone();
    // The face between the two cells joins the left one.
    let inner = cube.cell(0).iter().copied().filter(|n| cube.cell(1).contains(n)).collect::<Vec<_>>();
    assert_eq!(inner.len(), 4);
    split.sides.get_mut("left").unwrap().push(carom_solid::Facet { cell: 0, nodes: inner });
    let read = gmsh::read(gmsh::write_msh41(&[("cube", &split)]).as_bytes()).unwrap().volume("cube").unwrap();
    assert_eq!(read.sides, cube.sides);
    let note = "1 of 2 faces of the physical surface \"left\" lie inside the body, between two of its cells, and are not in its side";
    assert_eq!(read.repairs, [note]);
}

/// Two bodies of one file with a common edge; their nodes are connected in neither of them.
#[test]
fn joints_of_bodies() {
    let two = SQUARE.replace("3 2 2 8 1 1 3 4", "3 2 2 9 1 1 3 4").replace("1 1 2 7 1 2 1", "1 1 2 7 1 1 3");
    let file = gmsh::read(two.as_bytes()).unwrap();
    let joint = file.joint(2, ["plate", "9"]).unwrap().unwrap();
    assert_eq!((joint.facets, joint.nodes, joint.sides.as_slice()), (1, 2, &["low".to_owned()][..]));
    assert_eq!(joint.extent, [[0.0; 3], [1.0, 1.0, 0.0]]);
    // A common corner is no joint.
    let apart = two.replace("9 5 5 0", "9 0 -1 0").replace("3 2 2 9 1 1 3 4", "3 2 2 9 1 1 9 2");
    assert!(gmsh::read(apart.as_bytes()).unwrap().joint(2, ["plate", "9"]).unwrap().is_some());
    let corner = two.replace("9 5 5 0", "9 -1 0 0").replace("3 2 2 9 1 1 3 4", "3 2 2 9 1 1 4 9");
    assert_eq!(gmsh::read(corner.as_bytes()).unwrap().joint(2, ["plate", "9"]), Ok(None));
}

#[test]
fn planes_and_clockwise_cells_are_put_right() {
    let lifted = SQUARE.replace(" 0\n", " 2.5\n");
    let mesh = gmsh::read(lifted.as_bytes()).unwrap().body("plate").unwrap();
    assert!(mesh.repairs[0].contains("z = 2.5"), "{:?}", mesh.repairs);
    let turned = with("3 2 2 8 1 1 3 4", "3 2 2 8 1 3 1 4").unwrap();
    assert_eq!(turned.repairs[0], "1 of 2 cells were clockwise; their nodes were reordered");
    assert_eq!(turned.cell(1), [2, 3, 0]);
}

/// Mirrored meshes of every order: all cells are clockwise, and the repaired body equals the mesh
/// mirrored by hand.
#[test]
fn clockwise_cells_of_every_order() {
    for element in [Element::T3, Element::T6, Element::T10, Element::Q4, Element::Q9] {
        let disc = match element {
            Element::Q4 | Element::Q9 => {
                let mut mesh = generate::rectangle(element, [0.5, 0.0], [1.5, 1.0], [3, 2]).unwrap();
                // A quarter of a ring: x is the radius, y a quarter of the angle.
                mesh.nodes.iter_mut().for_each(|x| {
                    let (sin, cos) = (x[1] * std::f64::consts::FRAC_PI_2).sin_cos();
                    x.copy_from_slice(&[x[0] * cos, x[0] * sin]);
                });
                mesh.sides = [("arc".to_owned(), mesh.sides["right"].clone())].into();
                mesh
            }
            _ => generate::half_disc(element, 0.5, [0.0, 1.0], 0.2).unwrap(),
        };
        let mut mirrored = disc.clone();
        mirrored.nodes.iter_mut().for_each(|x| x[0] = -x[0]);
        let read =
            gmsh::read(gmsh::write_msh41(&[("disc", &mirrored)]).as_bytes()).unwrap().body("disc").unwrap();
        let all = disc.cell_count();
        assert_eq!(
            read.repairs,
            [format!("{all} of {all} cells were clockwise; their nodes were reordered")]
        );
        assert_eq!(read.nodes, mirrored.nodes);
        assert!(
            carom_solid::body(read.clone(), carom_solid::Law::NeoHookean { lambda: 1.0, mu: 1.0 }, 1.0, 1.0)
                .is_ok()
        );
        let back: Vec<usize> = disc.side_nodes("arc").unwrap().into_iter().rev().collect();
        assert_eq!(read.side_nodes("arc").unwrap(), back);
    }
}

/// An edge node moved across the cell folds it; one moved too far along its edge does as well.
#[test]
fn folded_cells_are_found() {
    for (element, pulled) in [
        (Element::T6, [0.9, 0.9]),
        (Element::T10, [0.9, 0.2]),
        (Element::T10, [0.7, 0.0]),
        (Element::Q9, [0.5, 0.6]),
        (Element::Q9, [0.8, 0.0]),
    ] {
        let mut mesh = generate::rectangle(element, [0.0, 0.0], [1.0, 1.0], [1, 1]).unwrap();
        let n = mesh.sides["bottom"][0].nodes[2];
        mesh.nodes[n].copy_from_slice(&pulled);
        let file = gmsh::read(gmsh::write_msh41(&[("plate", &mesh)]).as_bytes()).unwrap();
        let error = file.body("plate").unwrap_err();
        assert!(matches!(error.fault, Fault::Folded { .. }), "{element:?} {error}");
        assert!(matches!(error.place, Place::Line(_)));
    }
}

/// A quadrilateral of degree 1 folds at a corner where it is not convex.
#[test]
fn folded_quadrilaterals_are_found() {
    let mut mesh = generate::rectangle(Element::Q4, [0.0, 0.0], [1.0, 1.0], [1, 1]).unwrap();
    let n = (0..4).find(|&n| mesh.nodes[n] == [1.0, 1.0]).unwrap();
    let read = |mesh: &Mesh| gmsh::read(gmsh::write_msh41(&[("plate", mesh)]).as_bytes())?.body("plate");
    mesh.nodes[n].copy_from_slice(&[0.51, 0.51]);
    assert!(read(&mesh).is_ok());
    mesh.nodes[n].copy_from_slice(&[0.49, 0.49]);
    let error = read(&mesh).unwrap_err();
    let Fault::Folded { jacobian, at, .. } = &error.fault else { panic!("{error}") };
    assert!(*jacobian < 0.0 && at[..] == [0.49, 0.49], "{error}");
}

/// Neighbours of order 2 with different nodes on their common edge leave a gap.
#[test]
fn edges_share_their_nodes() {
    let mut mesh = generate::rectangle(Element::T6, [0.0, 0.0], [1.0, 1.0], [1, 1]).unwrap();
    let shared: Vec<usize> =
        mesh.cell(0)[3..].iter().copied().filter(|n| mesh.cell(1)[3..].contains(n)).collect();
    let new = mesh.nodes.len();
    mesh.nodes = Positions::new(2, [mesh.nodes.flat(), &[0.501, 0.5]].concat());
    let place = mesh.cells.iter().rposition(|n| *n == shared[0]).unwrap();
    mesh.cells[place] = new;
    let error =
        gmsh::read(gmsh::write_msh41(&[("plate", &mesh)]).as_bytes()).unwrap().body("plate").unwrap_err();
    assert!(matches!(error.fault, Fault::EdgeNodes { .. }), "{error}");
}

/// Writing and reading back is bitwise exact.
#[test]
fn round_trip() {
    for element in [Element::Q4, Element::Q9] {
        let prism = generate::rectangle(element, [0.0, -1e-3 / 3.0], [1.0, 0.0], [7, 3]).unwrap();
        let file = gmsh::read(gmsh::write_msh41(&[("prism", &prism)]).as_bytes()).unwrap();
        assert_eq!(file.body("prism").unwrap(), prism);
    }
    for element in [Element::T3, Element::T6, Element::T10] {
        let mut disc = generate::disc(element, 1.0 / 3.0, [0.1, 0.7], 0.11).unwrap();
        disc.nodes[0][0] += 1e-17;
        let half = generate::half_disc(element, 0.5, [0.0, 2.0], 0.13).unwrap();
        let prism = generate::rectangle(element, [0.0, -1e-3 / 3.0], [1.0, 0.0], [7, 3]).unwrap();
        let plate = generate::rectangle(element, [0.0, -2.0], [1e5, -1.0], [3, 3]).unwrap();
        let bodies = [("disc", &disc), ("half", &half), ("prism", &prism), ("plate", &plate)];
        let file = gmsh::read(gmsh::write_msh41(&bodies).as_bytes()).unwrap();
        assert_eq!(file.names(2), ["disc", "half", "prism", "plate"]);
        for (name, mesh) in bodies {
            assert_eq!(file.body(name).unwrap(), *mesh, "{name}");
        }
    }
}

/// Bodies from Gmsh are unchanged by writing and reading.
#[test]
fn round_trip_of_gmsh() {
    for (name, bytes) in fixtures().into_iter().filter(|(name, _)| name.starts_with("impact")) {
        let file = gmsh::read(&bytes).unwrap();
        let bodies = ["cylinder", "prism"].map(|b| file.body(b).unwrap());
        let text = gmsh::write_msh41(&[("cylinder", &bodies[0]), ("prism", &bodies[1])]);
        let again = gmsh::read(text.as_bytes()).unwrap();
        assert_eq!(["cylinder", "prism"].map(|b| again.body(b).unwrap()), bodies, "{name}");
    }
}
