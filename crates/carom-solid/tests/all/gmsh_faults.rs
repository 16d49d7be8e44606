//! Damaged and invalid mesh files give an error with place and cause, or a reported repair; never a
//! panic, never a wrong mesh.

use std::path::PathBuf;

use carom_solid::gmsh::{self, Fault, MshError, Place};
use carom_solid::{Element, Mesh, Positions, generate};

use super::random::{integer, lists};

fn fixtures() -> Vec<(String, Vec<u8>)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/msh");
    let mut all: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
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
    assert_eq!(fault("3 2 2 8", "3 99 2 8"), (Line(21), Fault::UnknownType { cell: 3, kind: 99 }));
    let names = vec!["plat".to_owned()];
    assert_eq!(
        fault("plate", "plat"),
        (File, Fault::NoName { what: "surface", name: "plate".into(), names })
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
    let incomplete = "2\n1 1 2 7 1 2 1\n2 16 2 8 1 1 2 3 4 1 2 3 4\n";
    let rows = "3\n1 1 2 7 1 2 1\n2 2 2 8 1 1 2 3\n3 2 2 8 1 1 3 4\n";
    assert!(matches!(fault(rows, incomplete), (Line(20), Fault::Unsupported { .. })));
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
