//! Rigid obstacles in space: the plane is a slice of a cylinder, no direction is special, and
//! triangles are the plane or the sphere that they cover.

use std::fmt::Write as _;

use super::common::{finish, simulation, turned};
use super::space::apart;
use carom_run::Simulation;
use carom_run::recording::Rows;

/// A block that falls, turning, beside the summit of a circle, or into one.
const BLOCK: &str = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]
body = [{ name = "block", material = "rubber", element = "Q9", mesh = { shape = "rectangle", min = [-0.8, 0.01], max = [1.2, 0.81], cells = [4, 2] }, velocity = ["0.4 + 0.2*Y", "-3 - 0.2*X"] }]
contact = [{ name = "strike", secondary = "block.bottom", primary = { circle = { center = [0.0, -1.5], radius = 1.5 } } }]
time = { scheme = { kind = "chung-hulbert", rho_inf = 0.8 }, step = 2e-3, end = 0.04 }
newton = { tolerance = 1e-12 }
"#;

const SLAB: [&str; 4] = [
    "dimension=3",
    "body.block.element=\"Hex27\"",
    "body.block.mesh={ shape = \"box\", min = [-0.8, 0.01, 0.0], max = [1.2, 0.81, 0.5], cells = [4, 2, 1] }",
    "body.block.velocity=[\"0.4 + 0.2*Y\", \"-3 - 0.2*X\", 0]",
];

/// The ends are held, as in plane strain.
const HELD: &str = "support=[{ on = [\"block.bottom\", \"block.top\"], fix = [\"z\"] }]";

#[test]
fn a_slab_on_a_cylinder_is_the_plane_on_a_circle() {
    let shapes = [
        (
            "center = [0.0, -1.5], radius = 1.5",
            "point = [0.0, -1.5, 7.0], axis = [0.0, 0.0, -2.0], radius = 1.5",
        ),
        (
            "center = [0.2, 2.0], radius = 2.3, inside = true",
            "point = [0.2, 2.0, 7.0], axis = [0.0, 0.0, 0.1], radius = 2.3, inside = true",
        ),
    ];
    for (circle, cylinder) in shapes {
        for rest in [
            "",
            ", mu = 0.3",
            ", motion = { x = \"0.5*t\", y = \"t\" }",
            ", mass = 0.7, velocity = [1.0, 0.5]",
        ] {
            let (inside, outside) =
                if rest.contains('m') && !rest.contains("mu") { (rest, "") } else { ("", rest) };
            let contact = |side: &str, shape: &str, inside: &str| {
                format!(
                    "contact=[{{ name = \"strike\", secondary = \"block.{side}\", primary = {{ {shape}{inside} }}{outside} }}]"
                )
            };
            let plane = contact("bottom", &format!("circle = {{ {circle} }}"), inside);
            let plane = finish(simulation(BLOCK, &[plane]));
            // Half as thick.
            let inside = inside
                .replace("mass = 0.7, velocity = [1.0, 0.5]", "mass = 0.35, velocity = [1.0, 0.5, 0.0]");
            let space = contact("front", &format!("cylinder = {{ {cylinder} }}"), &inside);
            let sets: Vec<&str> = SLAB.iter().copied().chain([space.as_str(), HELD]).collect();
            let space = finish(simulation(BLOCK, &sets));
            assert!(plane.state().pairs[0].iter().filter(|pair| pair.active).count() > 1, "{circle} {rest}");
            let worst = apart(&plane, &space);
            assert!(worst < 1e-8, "{circle} {rest}: {worst:e}");
        }
    }
}

/// A ball that strikes an obstacle obliquely.
const BALL: &str = r#"
dimension = 3
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]
body = [{ name = "ball", material = "rubber", element = "Tet10", mesh = { shape = "ball", radius = 0.5, center = [0.1, -0.05, 0.51], size = 0.4 }, velocity = { linear = [0.5, 0.2, -3.0], angular = [1.0, 2.0, 3.0], about = [0.1, -0.05, 0.51] } }]
contact = []
time = { scheme = { kind = "chung-hulbert", rho_inf = 0.8 }, step = 2e-3, end = 0.04 }
newton = { tolerance = 1e-12 }
"#;

fn against(primary: &str, rest: &str) -> String {
    format!("contact=[{{ name = \"floor\", secondary = \"ball.sphere\", primary = {{ {primary} }}{rest} }}]")
}

const FRICTION: [&str; 2] = ["", ", mu = 0.3"];

/// The forces of springs change continuously with the shape, also where nodes close.
const SPRINGS: &str = ", enforcement = \"penalty\"";

fn worst(a: &Simulation, b: &Simulation) -> f64 {
    let pairs = a.state().y.iter().zip(&b.state().y);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn a_turned_impact_on_a_cylinder_is_the_same() {
    let cylinder = |turn: &dyn Fn([f64; 3]) -> [f64; 3], velocity: &[f64; 3]| {
        let (point, axis) = (turn([0.3, 0.0, -0.8]), turn([0.4, 1.0, 0.1]));
        let motion: Vec<String> = ["x", "y", "z"]
            .iter()
            .zip(turn(*velocity))
            .map(|(axis, v)| format!("{axis} = \"{v:?}*t\""))
            .collect();
        let motion = motion.join(", ");
        format!("cylinder = {{ point = {point:?}, axis = {axis:?}, radius = 0.8 }}, motion = {{ {motion} }}")
    };
    for law in FRICTION {
        let still = finish(simulation(BALL, &[against(&cylinder(&|x| x, &[0.5, -1.0, 1.0]), law)]));
        assert!(still.state().pairs[0].iter().filter(|pair| pair.active).count() > 3, "{law}");
        let vector = |x: [f64; 3]| format!("{:?}", turned(x));
        let other = finish(simulation(
            BALL,
            &[
                against(&cylinder(&turned, &[0.5, -1.0, 1.0]), law),
                "body.ball.place={ rotate = { axis = [2.0, 3.0, 6.0], angle = 50.0 } }".to_owned(),
                format!(
                    "body.ball.velocity={{ linear = {}, angular = {}, about = {} }}",
                    vector([0.5, 0.2, -3.0]),
                    vector([1.0, 2.0, 3.0]),
                    vector([0.1, -0.05, 0.51])
                ),
            ],
        ));
        let bodies = 3 * still.model().parts[0].nodes().end;
        let pairs =
            still.state().y[..bodies].as_chunks::<3>().0.iter().zip(other.state().y.as_chunks::<3>().0);
        let apart = |(here, there): (&[f64; 3], &[f64; 3])| {
            let expected = turned(*here);
            (0..3).map(|i| (expected[i] - there[i]).abs()).fold(0.0, f64::max)
        };
        let worst = pairs.map(apart).fold(0.0, f64::max);
        assert!(worst < 1e-9, "{law}: {worst:e}");
    }
}

/// Forces of a cylinder without friction point to its axis: momentum along it and its moment about
/// it stay as they are.
#[test]
fn a_cylinder_without_friction_changes_neither_motion_along_nor_about_its_axis() {
    let sets = [
        against("cylinder = { point = [0.3, 0.0, -0.8], axis = [0.0, 1.0, 0.0], radius = 0.8 }", ""),
        "time.scheme={ kind = \"energy-momentum\" }".to_owned(),
        "material.rubber.law=\"saint-venant-kirchhoff\"".to_owned(),
        "contact.floor.restitution=1.0".to_owned(),
    ];
    let conserved = |sim: &Simulation| {
        let (y, v) = (&sim.state().y, &sim.state().v);
        let mut p = vec![0.0; v.len()];
        sim.model().mass.multiply_into(v, &mut p);
        let pairs = y.as_chunks::<3>().0.iter().zip(p.as_chunks::<3>().0);
        pairs.fold([0.0; 2], |[sum, moment], (y, p)| {
            [sum + p[1], moment + (y[2] + 0.8) * p[0] - (y[0] - 0.3) * p[2]]
        })
    };
    let start = simulation(BALL, &sets);
    let (before, energy) = (conserved(&start), start.state().ledger.total());
    let end = finish(start);
    assert!(end.state().pairs[0].iter().any(|pair| pair.active));
    let after = conserved(&end);
    assert!((0..2).all(|i| (before[i] - after[i]).abs() < 1e-11), "{before:?} {after:?}");
    let ledger = &end.state().ledger;
    assert!((energy + ledger.contact_work - ledger.total()).abs() < 1e-9 * energy, "{ledger:?}");
}

/// Triangles as a text in STL.
pub(super) fn stl(triangles: &[[[f64; 3]; 3]]) -> String {
    let mut text = "solid test\n".to_owned();
    for triangle in triangles {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        triangle.iter().for_each(|[x, y, z]| writeln!(text, "vertex {x} {y} {z}").unwrap());
        text.push_str("endloop\nendfacet\n");
    }
    text + "endsolid test\n"
}

/// The case with a surface in a file.
fn on_surface(triangles: &[[[f64; 3]; 3]], rest: &str, law: &str) -> Simulation {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.stl");
    std::fs::write(&file, stl(triangles)).unwrap();
    let shape = format!("surface = {{ file = {:?}{rest} }}", file.display().to_string());
    finish(simulation(BALL, &[against(&shape, law)]))
}

/// A grid of triangles over the square |x|, |y| ≤ size, at a height.
pub(super) fn grid(size: f64, count: usize, height: impl Fn(f64, f64) -> f64) -> Vec<[[f64; 3]; 3]> {
    let at = |i: usize, k: usize| {
        let [x, y] = [i, k].map(|i| size * (2.0 * i as f64 / count as f64 - 1.0));
        [x, y, height(x, y)]
    };
    let cell = |(i, k): (usize, usize)| {
        let [a, b, c, d] = [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)];
        [[a, b, c], [a, c, d]]
    };
    (0..count).flat_map(|i| (0..count).map(move |k| (i, k))).flat_map(cell).collect()
}

#[test]
fn a_plane_of_triangles_is_the_plane() {
    for law in FRICTION {
        let plane = "plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }";
        let plane = finish(simulation(BALL, &[against(plane, law)]));
        assert!(plane.state().pairs[0].iter().filter(|pair| pair.active).count() > 3);
        let surface = on_surface(&grid(2.0, 32, |_, _| 0.0), "", law);
        let error = worst(&plane, &surface);
        assert!(error < 1e-12, "{law}: {error:e}");
        // In other units, with the other side outside.
        let mut reversed = grid(2.0, 7, |_, _| 0.0);
        reversed.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        reversed.iter_mut().flatten().flatten().for_each(|x| *x *= 1024.0);
        let error = worst(&plane, &on_surface(&reversed, ", scale = 0.0009765625, reverse = true", law));
        assert!(error < 1e-12, "{law}: {error:e}");
    }
}

/// Largest distances of nodes from their places on an exact surface, for so many triangles along a
/// side of a square. Triangles of size h are h² off a surface, but their normals, along which the
/// forces act, only h.
fn errors(exact: &str, size: f64, counts: [usize; 3], height: impl Fn(f64, f64) -> f64) -> [f64; 3] {
    let exact = finish(simulation(BALL, &[against(exact, SPRINGS)]));
    assert!(exact.state().pairs[0].iter().filter(|pair| pair.active).count() > 3);
    counts.map(|count| worst(&exact, &on_surface(&grid(size, count, &height), "", SPRINGS)))
}

#[test]
fn a_sphere_of_triangles_approaches_the_sphere() {
    let (radius, depth) = (3.0_f64, 0.01);
    let height = |x: f64, y: f64| (radius * radius - x * x - y * y).sqrt() - radius + depth;
    let sphere = format!("sphere = {{ center = [0.0, 0.0, {:?}], radius = {radius:?} }}", depth - radius);
    let [coarse, middle, fine] = errors(&sphere, 2.0, [10, 20, 40], height);
    assert!(fine < 0.005 && middle < 0.6 * coarse && fine < 0.6 * middle, "{coarse} {middle} {fine}");
}

/// Every edge of a bowl is a groove.
#[test]
fn a_bowl_of_triangles_approaches_the_bowl() {
    let (radius, middle) = (1.2_f64, 1.19);
    let height = |x: f64, y: f64| middle - (radius * radius - x * x - y * y).sqrt();
    let bowl = format!("sphere = {{ center = [0.0, 0.0, {middle:?}], radius = {radius:?}, inside = true }}");
    let [coarse, middle, fine] = errors(&bowl, 0.8, [8, 16, 32], height);
    assert!(fine < 0.005 && middle < 0.6 * coarse && fine < 0.6 * middle, "{coarse} {middle} {fine}");
}

/// Multipliers, with friction, in grooves and off rims: the nodes near the end of the bowl leave.
#[test]
fn a_ball_slides_through_a_bowl_of_triangles() {
    let height = |x: f64, y: f64| 1.19 - (1.44 - x * x - y * y).sqrt();
    for law in FRICTION {
        let end = on_surface(&grid(0.8, 12, height), "", law);
        assert!(end.state().pairs[0].iter().filter(|pair| pair.active).count() > 3, "{law}");
        let ledger = &end.state().ledger;
        assert!(ledger.contact_work <= 0.0 && ledger.friction_work <= 0.0, "{law}: {ledger:?}");
    }
}

/// A block that stands on a rough plane and is struck by a smooth ball: gaps of nodes on the planes
/// of symmetry depend on others, in a contact that has no slip.
#[test]
fn contacts_with_and_without_friction_stand_side_by_side() {
    let floor = "[[contact]]\nname = \"floor\"\nsecondary = \"block.bottom\"\nmu = 0.3\n\
                 primary = { plane = { point = [0.0, 0.0, -0.5], normal = [0.0, 0.0, 1.0] } }\n\n[time]";
    let held = "[[support]]\non = [\"block.bottom\"]\nfix = [\"x\", \"y\", \"z\"]\n";
    let ball = include_str!("../../../../cases/space/ball.toml");
    let text = ball.replace(held, "").replace("[time]", floor);
    assert!(!text.contains(held) && text.contains("mu = 0.3"));
    let sim = finish(simulation(&text, &["time.end=0.0075"]));
    let pressing = |k: usize| sim.state().pairs[k].iter().filter(|pair| pair.lambda < 0.0).count();
    assert!(pressing(0) > 2 && pressing(1) > 2, "{} {}", pressing(0), pressing(1));
}

/// The ellipse p² = p₀² (1 − r²/a²), fitted to the pressures of the nodes of Hertz's contact, each
/// weighted with its area: its radius is Hertz's to half of the spacing of the nodes (A1). Node by
/// node, the pressure of a node-to-facet contact is rougher: 3 % of p₀ (rms) within 0.8 a.
#[test]
fn the_radius_of_a_contact_is_that_of_hertz() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/space/hertz.toml");
    let case = carom_run::case::Case::from_file(path, &[]).unwrap();
    let sim = finish(carom_run::Setup::new(&case).start().unwrap());
    let (a, largest) = (0.1, 69.9582);
    let (mut sums, mut error, mut area) = ([0.0; 5], 0.0, 0.0);
    for row in Rows::new(&case, &sim).contact(&sim) {
        let (r2, p) = (row.point[0].powi(2) + row.point[1].powi(2), row.pressure);
        if !p.is_finite() || p <= 0.0 {
            continue;
        }
        let weight = -row.multiplier / p;
        for (sum, value) in sums.iter_mut().zip([1.0, r2, r2 * r2, p * p, p * p * r2]) {
            *sum += weight * value;
        }
        if r2 < 0.64 * a * a {
            error += weight * (p - largest * (1.0 - r2 / (a * a)).sqrt()).powi(2);
            area += weight;
        }
    }
    let [n, x, xx, y, xy] = sums;
    let slope = (n * xy - x * y) / (n * xx - x * x);
    let (top, found) = ((y - slope * x) / n, ((slope * x - y) / n / slope).sqrt());
    assert!((found - a).abs() < 0.5 * a / 8.0, "{found}");
    assert!((top.sqrt() / largest - 1.0).abs() < 0.03, "{top}");
    let rough = (error / area).sqrt() / largest;
    assert!(rough < 0.035, "{rough}");
}

/// A block pressed down by 2 %, with a surface in place of the plane.
const PRESSED: &str = r#"
dimension = 3
material = [{ name = "rubber", law = "neo-hookean", density = 1.5, young = 2000.0, poisson = 0.25 }]
support = [{ name = "top", on = ["block.back"], fix = ["x", "z"], move = { y = "-0.005*t" } }]
[[body]]
name = "block"
material = "rubber"
element = "Hex8"
mesh = { shape = "box", min = [-0.5, 0.0, -0.5], max = [0.5, 0.25, 0.5], cells = [4, 1, 4] }
[[contact]]
name = "pedestal"
secondary = "block.skin"
primary = { plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0] } }
[time]
end = 1.0
step = 0.25
scheme = { kind = "static" }
"#;

/// Triangles of the upper end of a square pedestal.
fn pedestal(w: f64) -> Vec<[[f64; 3]; 3]> {
    let corners = [[-w, -w], [-w, w], [w, w], [w, -w]];
    let at = |k: usize, height: f64| [corners[k % 4][0], height, corners[k % 4][1]];
    let side = |k: usize| {
        let [a, b, c, d] = [at(k, 0.0), at(k, -1.0), at(k + 1, -1.0), at(k + 1, 0.0)];
        [[a, b, c], [a, c, d]]
    };
    let top = [[at(0, 0.0), at(1, 0.0), at(2, 0.0)], [at(0, 0.0), at(2, 0.0), at(3, 0.0)]];
    top.into_iter().chain((0..4).flat_map(side)).collect()
}

/// The edges of a pedestal are exactly under nodes, or beside them by a millionth of a facet.
#[test]
fn an_edge_at_nodes_presses_like_one_beyond_them() {
    let force = |half_width: f64| {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("pedestal.stl");
        std::fs::write(&file, stl(&pedestal(half_width))).unwrap();
        let file = file.display().to_string();
        let set = format!("contact.pedestal.primary={{ surface = {{ file = {file:?} }} }}");
        let sim = finish(simulation(PRESSED, &[set]));
        let model = sim.model();
        let on_top = |node: &usize| model.reference[3 * node + 1] == 0.25;
        let nodes = (0..model.reference.len() / 3).filter(on_top);
        nodes.map(|node| sim.state().f_internal[3 * node + 1]).sum::<f64>()
    };
    let beyond = force(0.2501);
    for half_width in [0.25, 0.25 - 2.5e-7, 0.25 + 2.5e-7] {
        let at = force(half_width);
        assert!((at - beyond).abs() < 1e-9 * beyond.abs(), "{half_width}: {at} {beyond}");
    }
}
