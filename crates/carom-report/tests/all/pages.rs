//! The report of a synthetic run is complete, self-contained, well-formed, and escapes all text
//! from the user.

use std::fs;
use std::path::Path;

use carom_record::{Block, Cell, Column, ContactRow, FieldSet, PointArray, RunWriter};
use carom_report::report;
use serde_json::json;

use super::common;

/// Number of elements of an XML text, which must be well-formed.
fn elements(text: &str) -> usize {
    let mut reader = quick_xml::Reader::from_str(text);
    let mut count = 0;
    loop {
        match reader.read_event().unwrap() {
            quick_xml::events::Event::Eof => return count,
            quick_xml::events::Event::Start(_) | quick_xml::events::Event::Empty(_) => count += 1,
            _ => {}
        }
    }
}

fn check_page(directory: &Path) -> String {
    let page = fs::read_to_string(directory.join("report.html")).unwrap();
    let without_namespace = page.replace("http://www.w3.org/2000/svg", "");
    // One script with its data, and no script from the user.
    let scripts = without_namespace.matches("<script").count();
    assert!(scripts <= 3, "{scripts}");
    for outside in ["http:", "https:", "src=", "url(", "@import", "<script>alert", "<link", "import("] {
        assert!(!without_namespace.contains(outside), "{outside}");
    }
    page
}

#[test]
fn figures_and_page() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("run");
    common::write(&directory, "</title><script>alert(1)</script> & \"more\"", Some("energy <created>: 3 %"));
    let summary = report(&directory).unwrap();
    let names: Vec<_> =
        summary.figures.iter().map(|f| f.file_stem().unwrap().to_str().unwrap().to_string()).collect();
    assert_eq!(names, ["setup", "bodies", "probes", "force", "rotation", "energy", "solver"]);
    assert!(summary.notes.is_empty());
    for figure in &summary.figures {
        let text = fs::read_to_string(figure).unwrap();
        assert!(elements(&text) > 20);
        assert!(!text.contains("NaN") && !text.contains("inf"), "{figure:?}");
    }
    let bodies = fs::read_to_string(&summary.figures[1]).unwrap();
    for part in ["(a)", "(e)", "t = 0 s", "t = 0.75 s", ">yy</tspan>", "0.5 m"] {
        assert!(bodies.contains(part), "{part}");
    }
    let page = check_page(&directory);
    for part in [
        "&lt;script&gt;",
        "failed</span> <span class=\"small\">energy &lt;created&gt;: 3 %",
        "missed",
        "contact “strike”</b>: 0.2 against 0.1; nodes may slip through. Try to swap.",
        "3.317",
        "4 × rejected",
        "<td>assembly</td><td class=\"n\">1.25</td><td class=\"n\">3.13</td><td class=\"n\">50 %</td>",
        "<td>other</td><td class=\"n\">0.5</td><td class=\"n\">1.25</td><td class=\"n\">20 %</td>",
        "<td>Newton iterations</td><td class=\"n\">1532</td><td class=\"n\">3.83</td>",
        r#"<span class="option">--set</span> 'title='\''x'\'''"#,
        "Largest contact force",
    ] {
        assert!(page.contains(part), "{part}");
    }
    // The picture comes before the numbers, warnings, expectations, figures and how it was made.
    let parts = [
        "id=\"animation\" hidden",
        "class=\"numbers\"",
        "id=\"warnings\"",
        "id=\"expectations\"",
        "id=\"figures\"",
        "id=\"made\"",
    ];
    let places = parts.map(|part| page.find(part).unwrap());
    assert!(places.is_sorted(), "{places:?}");
    assert!(page.contains("fields/00000168.vtu"));
    // Every stored component can be chosen, each with its bar.
    for quantity in ["stress yy", "von Mises stress", "displacement x"] {
        assert!(page.contains(&format!(">{quantity}</option>")), "{quantity}");
    }
    assert_eq!(page.matches("Colour bar: ").count(), page.matches("\"rule\":").count());
    // A second report from the same record is identical.
    report(&directory).unwrap();
    assert_eq!(fs::read_to_string(directory.join("report.html")).unwrap(), page);
}

fn bar(directory: &Path, rows: usize, with_fields: bool) {
    let columns = ["step", "time", "active", "total"].map(|name| Column {
        name: name.into(),
        unit: String::new(),
        description: String::new(),
        integer: false,
    });
    let mut manifest = common::manifest(common::case(&json!({"dimension": 1})), columns.to_vec());
    let mut writer = RunWriter::create(directory, &manifest, b"").unwrap();
    for i in 0..rows {
        let t = i as f64 * 0.1;
        writer
            .history(&[i as f64, t, f64::from((3..6).contains(&i)), if i == 2 { f64::NAN } else { t }])
            .unwrap();
        if with_fields {
            let displacement = (0..4).flat_map(|k| [t * f64::from(k), 0.0, 0.0]).collect();
            let (name, unit) = ("displacement".into(), "m".into());
            let fields = FieldSet {
                points: [0.0, 1.0, 0.3, 0.6].map(|x| [x, 0.0, 0.0]).to_vec(),
                blocks: vec![Block {
                    body: "bar".into(),
                    cell: Cell::Curve,
                    degree: 3,
                    connectivity: vec![0, 1, 2, 3],
                }],
                arrays: vec![PointArray { name, unit, components: 3, values: displacement }],
                ..FieldSet::default()
            };
            writer.fields(i as u64, t, &fields).unwrap();
        }
    }
    writer.finish(&mut manifest).unwrap();
}

#[test]
fn dimension_one_shows_displacement_along_the_bar() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("run");
    bar(&directory, 9, true);
    let summary = report(&directory).unwrap();
    let text = fs::read_to_string(&summary.figures[1]).unwrap();
    assert!(text.contains("reference position X (m)") && elements(&text) > 20);
}

#[test]
fn a_case_of_another_version_is_an_error_that_names_what_is_missing() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("run");
    bar(&directory, 3, false);
    let file = directory.join("manifest.json");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("\"thickness\"", "\"thick\"")).unwrap();
    let error = report(&directory).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("missing field `thickness`"), "{error}");
}

#[test]
fn missing_data_are_noted_without_an_error() {
    let scratch = tempfile::tempdir().unwrap();
    for (rows, expected) in [(0, "no rows yet"), (1, "No field files"), (9, "No field files")] {
        let directory = scratch.path().join(format!("run-{rows}"));
        bar(&directory, rows, false);
        let summary = report(&directory).unwrap();
        assert!(summary.notes[0].contains(expected), "{:?}", summary.notes);
        assert!(check_page(&directory).contains(expected));
    }
    assert_eq!(report(scratch.path()).unwrap_err().exit_code(), 2);
}

/// A cube of six tetrahedra around a diagonal that is stretched upwards.
fn cube(directory: &Path) {
    let columns = ["step", "time", "active", "total"].map(|name| Column {
        name: name.into(),
        unit: String::new(),
        description: String::new(),
        integer: false,
    });
    let case = common::case(&json!({
        "dimension": 3, "title": "Cube", "units": {"length": "m", "time": "s", "mass": "kg"},
        "materials": [{"name": "steel", "law": "neo-hookean", "density": 1.0, "lambda": 1.0, "mu": 1.0}],
        "bodies": [{"name": "cube", "material": "steel", "element": "Tet4", "gravity": [0.0, 0.0, -9.81]}],
        "supports": [{"on": ["cube.bottom"], "fix": [0, 1, 2]}],
        "loads": [{"kind": {"pressure": {"on": ["cube.top"], "value": "X + Z*t"}}}],
        "probes": [{"name": "A", "body": "cube", "at": [1.0, 1.0, 1.0]}],
    }));
    let mut manifest = common::manifest(case, columns.to_vec());
    // Corner k is at the bits of k.
    manifest.sides.insert("cube.bottom".into(), vec![vec![0, 3, 1], vec![0, 2, 3]]);
    manifest.sides.insert("cube.top".into(), vec![vec![4, 5, 7], vec![4, 7, 6]]);
    let mut writer = RunWriter::create(directory, &manifest, b"").unwrap();
    for i in 0..6_u32 {
        let t = f64::from(i) * 0.2;
        writer.history(&[f64::from(i), t, 0.0, t]).unwrap();
        let points: Vec<[f64; 3]> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f64::from)).collect();
        let displacement = points.iter().flat_map(|p| [0.0, 0.0, t * p[2]]).collect();
        let stress = points.iter().flat_map(|_| [0.0, 0.0, 3.0 * t, 0.0, 0.0, 0.0]).collect();
        let array = |name: &str, unit: &str, components, values| PointArray {
            name: name.into(),
            unit: unit.into(),
            components,
            values,
        };
        let cells = [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];
        let block =
            Block { body: "cube".into(), cell: Cell::Tetrahedron, degree: 1, connectivity: cells.concat() };
        let mises = points.iter().map(|_| 3.0 * t).collect();
        let arrays = vec![
            array("displacement", "m", 3, displacement),
            array("von_mises", "Pa", 1, mises),
            array("stress", "Pa", 6, stress),
        ];
        writer
            .fields(u64::from(i), t, &FieldSet { points, blocks: vec![block], arrays, ..FieldSet::default() })
            .unwrap();
    }
    writer.finish(&mut manifest).unwrap();
}

#[test]
fn solids_are_drawn_and_have_a_scene() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("run");
    cube(&directory);
    let summary = report(&directory).unwrap();
    let bodies = fs::read_to_string(&summary.figures[1]).unwrap();
    assert!(elements(&bodies) > 10 && bodies.contains("data:image/png"));
    for part in ["(e)", "t = 1", ">vM</tspan>"] {
        assert!(bodies.contains(part), "{part}");
    }
    let page = check_page(&directory);
    for part in ["id=\"animation\" hidden", "class=\"scene\"", "\"packed\":\"", "6 recorded instants"] {
        assert!(page.contains(part), "{part}");
    }
    report(&directory).unwrap();
    assert_eq!(fs::read_to_string(directory.join("report.html")).unwrap(), page);
}

/// A square whose top is pressed at the nodes 2 and 3, which are at 0 and 2 along it.
fn pressed(directory: &Path) {
    let columns = ["step", "time", "active", "total"].map(|name| Column {
        name: name.into(),
        unit: if name == "time" { "s".into() } else { String::new() },
        description: String::new(),
        integer: false,
    });
    let contacts = json!([{"name": "c", "secondary": "block.top", "primary": {"plane": {"point": [0.0, 1.0], "normal": [0.0, -1.0]}}}]);
    let case = common::case(&json!({"title": "Pressed", "contacts": contacts}));
    let mut manifest = common::manifest(case, columns.to_vec());
    manifest.sides.insert("block.top".into(), vec![vec![3, 2]]);
    let mut writer = RunWriter::create(directory, &manifest, b"").unwrap();
    for i in 0..4_u32 {
        let t = f64::from(i) * 0.5;
        writer.history(&[f64::from(i), t, f64::from((1..3).contains(&i)) * 2.0, t]).unwrap();
        let points = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]].to_vec();
        let array = |name: &str, unit: &str, components: usize| PointArray {
            name: name.into(),
            unit: unit.into(),
            components,
            values: vec![0.0; 4 * components],
        };
        let block = Block {
            body: "block".into(),
            cell: Cell::Triangle,
            degree: 1,
            connectivity: vec![0, 1, 2, 0, 2, 3],
        };
        let arrays =
            vec![array("displacement", "m", 3), array("stress", "Pa", 6), array("contact_pressure", "Pa", 1)];
        for (node, x, pressure) in [(2, 2.0, 4.0), (3, 0.0, 8.0)].into_iter().filter(|_| (1..3).contains(&i))
        {
            let row = ContactRow {
                step: u64::from(i),
                time: t,
                contact: "c".into(),
                node,
                point: [x, 1.0, 0.0],
                facet: 0,
                xi: 0.0,
                eta: 0.0,
                gap: 0.0,
                multiplier: -pressure,
                pressure: f64::from(i) * pressure,
                normal: [0.0, -1.0, 0.0],
                friction: "none".into(),
                rubbing: [0.0; 3],
                traction: 0.0,
                slip: 0.0,
                ..ContactRow::default()
            };
            writer.contact(&[row]).unwrap();
        }
        writer
            .fields(u64::from(i), t, &FieldSet { points, blocks: vec![block], arrays, ..FieldSet::default() })
            .unwrap();
    }
    writer.finish(&mut manifest).unwrap();
}

#[test]
fn pressure_is_drawn_over_time_and_arc_length() {
    let scratch = tempfile::tempdir().unwrap();
    let directory = scratch.path().join("run");
    pressed(&directory);
    let summary = report(&directory).unwrap();
    assert!(summary.figures.iter().any(|path| path.ends_with("pressure.svg")), "{:?}", summary.figures);
    let table = fs::read_to_string(directory.join("figures/pressure.csv")).unwrap();
    let rows = ["c,2,2.0,0.5,4.0", "c,3,0.0,0.5,8.0", "c,2,2.0,1.0,8.0", "c,3,0.0,1.0,16.0"];
    assert_eq!(table, format!("contact,node,s,time,pressure\n{}\n", rows.join("\n")));
    check_page(&directory);
    // Beside every chart there is its table.
    for name in ["energy", "solver", "pressure"] {
        assert!(directory.join(format!("figures/{name}.csv")).is_file());
    }
}
