//! The contact pressure in the fields: uniform pressures are exact at every node of both sides, the
//! resultant is the contact force, and nothing is negative or undefined.

use std::sync::atomic::AtomicBool;

use carom_record::{FieldSet, MemoryRecord, Source};
use carom_run::recording::run_in_memory;

use super::common::case;
use super::rebound::record;

const PLANE: [&str; 5] = ["T3", "T6", "T10", "Q4", "Q9"];
const SPACE: [&str; 5] = ["Tet4", "Tet10", "Tet20", "Hex8", "Hex27"];

/// A body from 0 to `size` along all axes but the last one, and from `bottom` to `bottom` + 1 along
/// that.
fn body(name: &str, element: &str, size: f64, bottom: f64, cells: usize) -> String {
    let (shape, across) = if SPACE.contains(&element) { ("box", 2) } else { ("rectangle", 1) };
    let list = |along: String, last: String| format!("[{}{last}]", format!("{along}, ").repeat(across));
    format!(
        "[[body]]\nname = \"{name}\"\nmaterial = \"m\"\nelement = \"{element}\"\n\
         mesh = {{ shape = \"{shape}\", min = {}, max = {}, cells = {} }}\n",
        list("0.0".into(), bottom.to_string()),
        list(size.to_string(), (bottom + 1.0).to_string()),
        list(cells.to_string(), "2".into()),
    )
}

/// A block on a rough plane bulges, and its walls lean over the plane: they are not loaded.
#[test]
fn walls_that_lean_over_the_contact_are_not_loaded() {
    const BULGES: &str = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 10.0, poisson = 0.3 }]
[[body]]
name = "b"
material = "m"
element = "Q9"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [8, 8] }
[[support]]
on = ["b.top"]
fix = ["x"]
move = { y = "-0.25*t" }
[[contact]]
name = "floor"
secondary = "b.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
mu = 1.0
[time]
end = 1.0
step = 0.25
scheme = { kind = "static" }
"#;
    let most = |side: &str| {
        let run = record(BULGES, &[&format!("contact.floor.secondary={side}")]);
        run.contact.iter().map(|row| row.pressure).fold(0.0, f64::max)
    };
    let [bottom, skin] = ["b.bottom", "b.skin"].map(most);
    assert!(bottom > 7.0 && (skin / bottom - 1.0).abs() < 1e-6, "{bottom} {skin}");
}

/// The record of a static press of the body "upper" with a pressure of 2 on its top.
fn pressed(element: &str, young: f64, bodies: &[String], contact: &str) -> MemoryRecord {
    let in_space = SPACE.contains(&element);
    let (axis, traction, dimension) =
        if in_space { ("z", "[0.0, 0.0, -2.0]", "3") } else { ("y", "[0.0, -2.0]", "2\nplane = \"strain\"") };
    let on = |side: &str| {
        let names = ["upper", "lower"].into_iter().take(bodies.len());
        names.map(|name| format!("\"{name}.{side}\"")).collect::<Vec<_>>().join(", ")
    };
    let front = if in_space {
        format!("[[support]]\non = [{}]\nfix = [\"y\"]\n", on("front"))
    } else {
        String::new()
    };
    let floor = if bodies.len() > 1 {
        format!("[[support]]\non = [\"lower.bottom\"]\nfix = [\"{axis}\"]\n")
    } else {
        String::new()
    };
    let text = format!(
        "dimension = {dimension}\n\
         material = [{{ name = \"m\", law = \"linear-elastic\", density = 1.0, young = {young}, poisson = 0.0 }}]\n\
         {}[[support]]\non = [{}]\nfix = [\"x\"]\n{front}{floor}\
         [[load]]\non = [\"upper.top\"]\ntraction = {traction}\n\
         [[contact]]\nname = \"press\"\n{contact}\n\
         [time]\nend = 1.0\nstep = 1.0\nscheme = {{ kind = \"static\" }}\n\
         [newton]\ntolerance = 1e-12\n[output]\nfields_every = 1\n",
        bodies.concat(),
        on("left"),
    );
    let case = case(&text, &[""; 0]);
    run_in_memory(&case, Source::default(), 1, &mut |_| (), &AtomicBool::new(false)).unwrap().1
}

const SIDES: &str = "secondary = \"upper.bottom\"\nprimary = \"lower.top\"";

fn pressures(fields: &FieldSet) -> &[f64] {
    &fields.array("contact_pressure").unwrap().values
}

/// Points of the plane and of space at which their last coordinate is zero.
fn is_touched(element: &str, point: [f64; 3]) -> bool {
    point[if SPACE.contains(&element) { 2 } else { 1 }] == 0.0
}

#[test]
fn a_uniform_pressure_is_exact_on_both_sides() {
    for element in PLANE.into_iter().chain(SPACE) {
        let bodies = [body("upper", element, 1.0, 0.0, 3), body("lower", element, 1.0, -1.0, 3)];
        let record = pressed(element, 100.0, &bodies, SIDES);
        let fields = record.fields.last().unwrap();
        let mut touched = 0;
        for (point, pressure) in fields.points.iter().zip(pressures(fields)) {
            let expected = if is_touched(element, *point) { 2.0 } else { 0.0 };
            assert!((pressure - expected).abs() < 1e-9, "{element}, {point:?}: {pressure}");
            touched += usize::from(expected > 0.0);
        }
        assert!(touched >= 8, "{element}: {touched} nodes on both sides");
        // The rows of contact.csv are values of the fields.
        assert!(!record.run.contact.is_empty(), "{element}");
        for row in &record.run.contact {
            assert_eq!(row.pressure, pressures(fields)[row.node as usize], "{element}, node {}", row.node);
        }
    }
}

/// The sides of a body that a contact names with its bottom carry none of the pressure there.
#[test]
fn a_sharp_edge_does_not_share_its_pressure() {
    for element in ["T3", "T6", "T10", "Q9", "Tet4", "Tet10", "Tet20", "Hex8", "Hex27"] {
        let normal = if SPACE.contains(&element) { "[0.0, 0.0, 1.0]" } else { "[0.0, 1.0]" };
        let point = if SPACE.contains(&element) { "[0.0, 0.0, 0.0]" } else { "[0.0, 0.0]" };
        let floor = format!(
            "secondary = \"upper.skin\"\nprimary = {{ plane = {{ point = {point}, normal = {normal} }} }}"
        );
        let record = pressed(element, 100.0, &[body("upper", element, 1.0, 0.0, 2)], &floor);
        let fields = record.fields.last().unwrap();
        let bottom = fields.points.iter().zip(pressures(fields)).filter(|(x, _)| is_touched(element, **x));
        for (point, pressure) in bottom {
            assert!((pressure - 2.0).abs() < 1e-9, "{element}, {point:?}: {pressure}");
        }
    }
}

/// ∫ p over the facets of degree 2 at the interface: Simpson's rule on lines, the mean of the
/// mid-side nodes on triangles.
fn resultant(fields: &FieldSet, element: &str, body: usize) -> f64 {
    let faces: &[[usize; 6]] = if element == "Tet10" {
        &[[0, 1, 2, 4, 5, 6], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 2, 3, 6, 9, 7]]
    } else {
        &[[0, 1, 3, 0, 0, 0], [1, 2, 4, 0, 0, 0], [2, 0, 5, 0, 0, 0]]
    };
    let p = pressures(fields);
    let mut sum = 0.0;
    for cell in fields.blocks[body].cells() {
        for face in faces {
            let nodes = face.map(|k| cell[k]);
            let used = if element == "Tet10" { 6 } else { 3 };
            if !nodes[..used].iter().all(|&n| is_touched(element, fields.points[n])) {
                continue;
            }
            let [a, b, c] = [0, 1, 2].map(|k| fields.points[nodes[k]]);
            if element == "Tet10" {
                let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
                sum += area / 3.0 * (p[nodes[3]] + p[nodes[4]] + p[nodes[5]]);
            } else {
                let length = (b[0] - a[0]).abs();
                sum += length / 6.0 * (p[nodes[0]] + p[nodes[1]] + 4.0 * p[nodes[2]]);
            }
        }
    }
    sum
}

/// Of a block on a longer and wider one, with nodes that match and that do not: the pressure is
/// that of a punch, and covers a part of the primary.
#[test]
fn the_resultant_is_the_force_and_nothing_is_negative() {
    for (element, cells) in [("T6", 4), ("T6", 5), ("Tet10", 2), ("Tet10", 3)] {
        let bodies = [body("upper", element, 1.0, 0.0, cells), body("lower", element, 2.0, -1.0, 4)];
        let record = pressed(element, 1e6, &bodies, SIDES);
        let fields = record.fields.last().unwrap();
        for body in 0..2 {
            let found = resultant(fields, element, body);
            assert!((found - 2.0).abs() < 2e-5, "{element}, {cells} cells, body {body}: {found}");
        }
        let least = pressures(fields).iter().copied().fold(f64::INFINITY, f64::min);
        assert!(least >= -1e-9, "{element}, {cells} cells: {least}");
    }
}

/// A block in the corner of a floor and a wall, with other pressures opposite: its contact
/// pressures are these, also at the corner, where both contacts act on one node.
#[test]
fn a_floor_and_a_wall_press_on_their_own_sides() {
    for element in PLANE {
        for method in ["node-to-segment", "mortar"] {
            let run = record(
                IN_A_CORNER,
                &[
                    &format!("body.a.element={element}"),
                    &format!("contact.floor.method={method}"),
                    &format!("contact.wall.method={method}"),
                ],
            );
            let last = run.contact.last().unwrap().step;
            for row in run.contact.iter().filter(|row| row.step == last) {
                let exact = if row.contact == "floor" { 5.0 } else { 3.0 };
                assert!(
                    (row.pressure - exact).abs() < 1e-8,
                    "{element} {method} {} node {}: {}",
                    row.contact,
                    row.node,
                    row.pressure
                );
            }
        }
    }
}

const IN_A_CORNER: &str = r#"
dimension = 2
plane = "stress"
thickness = 0.37
material = [{ name = "m", law = "neo-hookean", density = 1.3, young = 100.0, poisson = 0.3 }]
[[body]]
name = "a"
material = "m"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.3, 0.7], cells = [5, 3] }
[[load]]
on = ["a.top"]
pressure = "5*t"
[[load]]
on = ["a.right"]
pressure = "3*t"
[[contact]]
name = "floor"
secondary = "a.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
[[contact]]
name = "wall"
secondary = "a.left"
primary = { plane = { point = [0.0, 0.0], normal = [1.0, 0.0] } }
[time]
end = 1.0
step = 0.25
scheme = { kind = "static" }
[output]
fields_every = 0
"#;
