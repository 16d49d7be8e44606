//! The drawing of the set-up and its table, in the plane and in space.

use std::fs;
use std::path::Path;

use carom_case::{Document, read};
use carom_record::{Block, Cell, Column, FieldSet, Manifest, PointArray, RunWriter, Source};

/// Writes a run of one row whose body `block` is a cell with these corners.
fn write(directory: &Path, case: &str, sides: &[(&str, Vec<usize>)], kind: Cell, points: &[[f64; 3]]) {
    let case = read(&Document::parse("case", case, &[]).unwrap()).unwrap();
    let facts = case.facts();
    let case = case.to_json().unwrap();
    let columns = ["step", "time"].map(|name| Column {
        name: name.into(),
        unit: String::new(),
        description: String::new(),
        integer: false,
    });
    let mut manifest = Manifest::new("0.1.0", facts, case, Source::default(), columns.to_vec(), 1);
    for (name, nodes) in sides {
        manifest.sides.insert((*name).into(), vec![nodes.clone()]);
    }
    let mut writer = RunWriter::create(directory, &manifest, b"").unwrap();
    writer.history(&[0.0, 0.0]).unwrap();
    let connectivity = (0..points.len()).collect();
    let block = Block { body: "block".into(), cell: kind, degree: 1, connectivity };
    let array = |name: &str, unit: &str, components: usize| PointArray {
        name: name.into(),
        unit: unit.into(),
        components,
        values: vec![0.0; components * points.len()],
    };
    let arrays = vec![array("displacement", "m", 3), array("stress", "Pa", 6)];
    writer
        .fields(
            0,
            0.0,
            &FieldSet { points: points.to_vec(), blocks: vec![block], arrays, ..FieldSet::default() },
        )
        .unwrap();
    writer.finish(&mut manifest).unwrap();
}

const MATERIAL: &str = r#"
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1000.0
young = 1e6
poisson = 0.25
"#;

#[test]
fn the_plane_has_symbols_for_what_is_fixed_and_acts() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("run");
    let case = format!(
        r#"
title = "Block"
dimension = 2
units = {{ length = "mm", time = "s", mass = "t" }}
{MATERIAL}
[[body]]
name = "block"
material = "rubber"
element = "Q4"
mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [2.0, 1.0], cells = [1, 1] }}
gravity = [0.0, -9.81]
[[support]]
on = ["block.left"]
fix = ["x", "y"]
[[support]]
on = ["block.right"]
move = {{ x = "0.1*sin(t)" }}
[[load]]
on = ["block.top"]
pressure = "1e3*X*t"
[[contact]]
name = "floor"
secondary = "block.bottom"
primary = {{ plane = {{ point = [0.0, -0.5], normal = [0.0, 1.0] }} }}
method = "mortar"
mu = 0.3
[[probe]]
name = "A"
body = "block"
at = [1.0, 1.0]
record = ["uy"]
[time]
end = 1.0
step = 0.1
scheme = {{ kind = "hu" }}
"#
    );
    let sides = [
        ("block.left", vec![3, 0]),
        ("block.right", vec![1, 2]),
        ("block.top", vec![2, 3]),
        ("block.bottom", vec![0, 1]),
    ];
    let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    write(&directory, &case, &sides, Cell::Quadrilateral, &corners);
    let summary = carom_report::report(&directory).unwrap();
    let svg = fs::read_to_string(&summary.figures[0]).unwrap();
    assert!(summary.figures[0].ends_with("figures/setup.svg"));
    // Both directions of the left side are fixed at one place.
    assert_eq!(svg.matches("fill=\"#44607c\" stroke=\"#fff\"").count(), 2);
    for part in ["#7a2f8f", "#d55e00", ">block<", ">A<", ">g<"] {
        assert!(svg.contains(part), "{part}");
    }
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    let page = fs::read_to_string(&summary.page).unwrap().replace('\u{a0}', " ");
    for part in [
        "<code>0.1*sin(t)</code>",
        "<code>1e3*X*t</code> MPa",
        "1 cells, 4 nodes, x = 0 to 2, y = 0 to 1 mm",
        "u<sub>x</sub> = u<sub>y</sub> = 0",
        "rigid plane, mortar method, μ = <code>0.3</code>",
        "ν = 0.25",
        "Plane strain, thickness 1 mm",
        "Triangles: fixed directions; double arrows: prescribed motion; arrows: loads and gravity g; diamonds: probes.",
    ] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn sides_in_space_have_a_colour() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("run");
    let case = format!(
        r#"
title = "Cube"
dimension = 3
{MATERIAL}
[[body]]
name = "block"
material = "rubber"
element = "Hex8"
mesh = {{ shape = "box", min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 1.0], cells = [1, 1, 1] }}
[[support]]
on = ["block.bottom"]
fix = ["x", "y", "z"]
[[contact]]
name = "lid"
secondary = "block.top"
primary = {{ plane = {{ point = [0.0, 0.0, 1.5], normal = [0.0, 0.0, -1.0] }} }}
[time]
end = 1.0
step = 0.1
scheme = {{ kind = "hu" }}
"#
    );
    let sides = [("block.bottom", vec![0, 3, 2, 1]), ("block.top", vec![4, 5, 6, 7])];
    let flat = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let corners: Vec<[f64; 3]> = [0.0, 1.0].into_iter().flat_map(|z| flat.map(|[x, y]| [x, y, z])).collect();
    write(&directory, &case, &sides, Cell::Hexahedron, &corners);
    let summary = carom_report::report(&directory).unwrap();
    let svg = fs::read_to_string(&summary.figures[0]).unwrap();
    // The secondary side is seen from above, the support is turned away.
    let outline =
        |color: &str| svg.lines().find(|line| line.contains(&format!("stroke=\"{color}\""))).unwrap();
    assert!(!outline("#d55e00").contains("dasharray") && outline("#44607c").contains("dasharray"));
    assert!(svg.contains("data:image/png") && !svg.contains("NaN"));
    let page = fs::read_to_string(&summary.page).unwrap();
    assert!(page.contains("Triangles: fixed directions. View") && !page.contains("diamonds"));
}
