//! Corners that belong to the contacts of both their sides, met by curved facets: no node of the
//! other body may be inside, and no depth that one contact knows of may stop the other one.

use carom_record::Run;

use super::rebound::record;

/// A run that did not stop before its end.
fn ended(text: &str, end: f64) -> Run {
    let run = record(text, &[]);
    let last = *run.column("time").unwrap().last().unwrap();
    assert!((last - end).abs() < 1e-9, "stopped at {last}");
    run
}

/// The largest depth of the nodes that a contact constrains.
fn deepest(run: &Run) -> f64 {
    run.column("penetration_secondary").unwrap().iter().copied().fold(0.0, f64::max)
}

/// A wedge is driven into a soft block. Its corner dents a facet, whose end then lies on a face of
/// the wedge.
const WEDGE: &str = r#"
dimension = 2
material = [
    { name = "wedge", law = "neo-hookean", density = 5.0, young = 526.16, poisson = 0.3 },
    { name = "block", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 },
]
[[body]]
name = "wedge"
material = "wedge"
element = "T10"
mesh = { shape = "polygon", points = [[0.0, 0.01], [0.56872, 0.8], [-0.38932, 0.8]], size = 0.14372 }
velocity = [0.19658, -0.54117]
[[body]]
name = "block"
material = "block"
element = "T10"
mesh = { shape = "rectangle", min = [-1.0, -0.8], max = [1.0, 0.0], cells = [15, 6] }
[[support]]
on = ["block.bottom"]
fix = ["x", "y"]
[[contact]]
name = "right"
secondary = "block.top"
primary = "wedge.side1"
[[contact]]
name = "left"
secondary = "block.top"
primary = "wedge.side3"
[time]
end = 0.3112
step = 0.00389
scheme = { kind = "chung-hulbert", rho_inf = 0.0 }
[output]
fields_every = 0
"#;

#[test]
fn the_end_of_a_dented_facet_stays_in_front_of_the_face_beside_the_corner() {
    let depth = deepest(&ended(WEDGE, 0.3112));
    assert!(depth < 1e-9, "{depth}");
}

/// A disc meets the corner of a block above its lowest point. A node has entered the top before it
/// was found there, and keeps that depth, while it is as near to the other side.
const DISC: &str = r#"
dimension = 2
material = [
    { name = "disc", law = "neo-hookean", density = 1.0, young = 2382.0, poisson = 0.3 },
    { name = "block", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 },
]
[[body]]
name = "disc"
material = "disc"
element = "T6"
mesh = { shape = "disc", radius = 0.5, center = [-1.1973, 0.46749], size = 0.25 }
velocity = [1.2843, -0.25685]
[[body]]
name = "block"
material = "block"
element = "T6"
mesh = { shape = "rectangle", min = [-1.0, -0.4], max = [1.0, 0.0], cells = [15, 3] }
[[support]]
on = ["block.bottom"]
fix = ["x", "y"]
[[contact]]
name = "top"
secondary = "disc.arc"
primary = "block.top"
[[contact]]
name = "left"
secondary = "disc.arc"
primary = "block.left"
[time]
end = 0.2924
step = 0.0172
scheme = { kind = "bathe", rho_inf = 0.9 }
[output]
fields_every = 0
"#;

/// A depth of 0.0007 is kept, as the warning of the run says.
#[test]
fn a_depth_that_one_contact_keeps_does_not_stop_the_other() {
    let depth = deepest(&ended(DISC, 0.2924));
    assert!((5e-4..1e-3).contains(&depth), "{depth}");
}

/// A polygonal disc falls into a notch. Its corners are held by those of the notch until they are
/// between two facets, and then begin with a depth.
const NOTCH: &str = r#"
dimension = 2
material = [
    { name = "disc", law = "neo-hookean", density = 1.0, young = 1000.0, poisson = 0.3 },
    { name = "block", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 },
]
[[body]]
name = "disc"
material = "disc"
element = "T3"
mesh = { shape = "disc", radius = 0.2354, center = [0.0073407, 0.2454], size = 0.078465 }
velocity = [-0.13291, -1.6692]
[[body]]
name = "block"
material = "block"
element = "T10"
mesh = { shape = "polygon", points = [[-1.0, -0.8], [1.0, -0.8], [1.0, 0.0], [0.2031, 0.0], [0.0, -0.48796], [-0.2031, 0.0], [-1.0, 0.0]], size = 0.20996 }
[[support]]
on = ["block.side1"]
fix = ["x", "y"]
[[contact]]
name = "right"
secondary = "disc.arc"
primary = "block.side4"
enforcement = "penalty"
stiffness = 65.563
[[contact]]
name = "left"
secondary = "disc.arc"
primary = "block.side5"
enforcement = "penalty"
stiffness = 65.563
[time]
end = 0.20475
step = 0.0020475
scheme = { kind = "energy-momentum" }
[output]
fields_every = 0
"#;

#[test]
fn springs_that_begin_with_a_depth_create_no_energy() {
    let run = ended(NOTCH, 0.20475);
    let energy = run.column("total").unwrap();
    let largest = energy.iter().copied().fold(0.0, f64::max);
    assert!(largest < (1.0 + 1e-9) * energy[0], "{largest}");
}
