//! Contact of a body with itself against the same contact of two bodies, and against half of the
//! body on a plane; continued from a state, bit for bit.

use carom_run::case::Case;
use carom_run::{Setup, Simulation};

use super::common::continues_with_the_same_bits;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/self/");

fn simulation(case: &Case) -> Simulation {
    Setup::new(case).start().unwrap()
}

fn advanced(case: &Case, steps: usize) -> Simulation {
    let mut simulation = simulation(case);
    for _ in 0..steps {
        simulation.step().unwrap();
    }
    simulation
}

/// Strips of which the left one moves to the right.
fn strips(bodies: &str, between: &str) -> Case {
    let text = format!(
        r#"
        dimension = 2
        material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 1.0, poisson = 0.0 }}]
        contact = [{{ name = "joint", {between} }}]
        time = {{ end = 8.0, step = 0.05, scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }} }}
        # Where a node crosses a joint, what the iteration leaves depends on the numbers of nodes.
        newton = {{ tolerance = 1e-12 }}
        {bodies}
        # Tolerances are relative to the largest body: it is the same with one body and with two.
        [[body]]
        name = "other"
        material = "m"
        element = "T6"
        mesh = {{ shape = "rectangle", min = [-10.0, 5.0], max = [10.0, 6.0], cells = [20, 1] }}
        "#
    );
    Case::from_text(&text, &[]).unwrap()
}

fn body(name: &str, surface: &str) -> String {
    format!(
        r#"
        [[body]]
        name = "{name}"
        material = "m"
        element = "T6"
        mesh = {{ file = "{ROOT}strips.msh", surface = "{surface}", slits = true }}
        velocity = ["if(X < 0, 0.1, 0)", "0"]
        "#
    )
}

#[test]
fn pieces_of_one_body_move_like_bodies() {
    let one = strips(&body("both", "both"), r#"between = ["both"]"#);
    let two = strips(
        &(body("first", "first") + &body("second", "second")),
        r#"secondary = "second.joint", primary = "first.face""#,
    );
    same(&one, &two, 1e-12);
}

/// With a pressure field, which the later piece carries, without friction and with it.
#[test]
#[ignore = "takes seconds: .ci/nightly"]
fn pieces_of_one_body_press_on_average_like_bodies() {
    for (speed, mortar) in [("0", r#"method = "mortar""#), ("0.06", r#"method = "mortar", mu = 0.2"#)] {
        let across = |body: String| body.replace(r#""0"]"#, &format!(r#""if(X < 0, {speed}, 0)"]"#));
        let one = strips(&across(body("both", "both")), &format!(r#"between = ["both"], {mortar}"#));
        let two = strips(
            &across(body("first", "first") + &body("second", "second")),
            &format!(r#"secondary = "second.joint", primary = "first.face", {mortar}"#),
        );
        same(&one, &two, 1e-10);
    }
}

/// They also rub, because the first one moves across. They are flush: contact of the sides that
/// meet has no choice of what else to press on. When the first one moves slowly all nodes stick at
/// first, with slips that are round-off.
#[test]
#[ignore = "takes seconds: .ci/nightly"]
fn pieces_of_one_body_rub_like_bodies() {
    assert!((rub_like_bodies("0.06") / -1.87e-4 - 1.0).abs() < 0.01);
    assert!(rub_like_bodies("0.02") < 0.0);
}

/// The work of friction.
fn rub_like_bodies(speed: &str) -> f64 {
    let across = |body: String| body.replace(r#""0"]"#, &format!(r#""if(X < 0, {speed}, 0)"]"#));
    let one = strips(&across(body("both", "both")), r#"between = ["both"], mu = 0.2"#);
    let two = strips(
        &across(body("first", "first") + &body("second", "second")),
        r#"secondary = "second.joint", primary = "first.face", mu = 0.2"#,
    );
    let [a, b] = same(&one, &two, 1e-10).map(|simulation| simulation.state().ledger.friction_work);
    assert!((a - b).abs() < 1e-12, "{a} {b}");
    a
}

/// Runs both, which must end with the same positions; slips are found to 1e-10.
fn same(one: &Case, two: &Case, tolerance: f64) -> [Simulation; 2] {
    let both = [one, two].map(|case| advanced(case, 160));
    let [one, two] = &both;
    let active = |simulation: &Simulation| simulation.state().pairs[0].iter().filter(|p| p.active).count();
    assert!(one.state().impulses[0][0] != 0.0 && active(one) == active(two));
    let (a, b) = (&one.state().y, &two.state().y);
    assert_eq!(a.len(), b.len());
    let difference = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(difference < tolerance, "{difference:e}");
    both
}

/// The second strip, of length 3, rests on the end of the first one, of length 10, which is held at
/// its other end: by their contact alone, in load steps. Under gravity g along the strips, with ν =
/// 0, the joint presses with ρg·3 and moves by −ρg·10 (3 + 10/2)/E. Without friction nothing holds
/// the second strip across.
#[test]
fn a_piece_of_a_body_rests_on_another_one() {
    let resting = |contact: &str| {
        let text = format!(
            r#"
            dimension = 2
            material = [{{ name = "m", law = "linear-elastic", density = 1.0, young = 1.0, poisson = 0.0 }}]
            support = [{{ on = ["both.left"], fix = ["x", "y"] }}]
            contact = [{{ name = "joint", between = ["both"], {contact} }}]
            time = {{ end = 1.0, step = 1.0, scheme = {{ kind = "static" }} }}
            [[body]]
            name = "both"
            material = "m"
            element = "T6"
            mesh = {{ file = "{ROOT}strips.msh", surface = "both", slits = true }}
            gravity = [-1e-4, 0.0]
            "#
        );
        Case::from_text(&text, &[]).unwrap()
    };
    let stopped = simulation(&resting(r#"method = "mortar""#)).step().unwrap_err().to_string();
    assert!(stopped.contains(r#"a piece of body "both" is free to"#), "{stopped}");

    let rested = advanced(&resting(r#"method = "mortar", mu = 0.5"#), 1);
    let x = &rested.model().reference;
    let joint = (0..x.len() / 2).filter(|n| x[2 * n].abs() < 1e-12);
    for node in joint {
        let moved = rested.state().y[2 * node] - x[2 * node];
        assert!((moved / -0.008 - 1.0).abs() < 1e-9, "{moved}");
    }
}

/// Before the ring touches itself, and after.
#[test]
#[ignore = "takes seconds: .ci/nightly"]
fn a_pinched_ring_moves_like_half_of_it_on_a_plane() {
    for method in ["node-to-segment", "mortar"] {
        let method_set = format!("contact.fold.method={method}");
        let sets = [&*method_set];
        let case = |name: &str| Case::from_file(format!("{ROOT}{name}.toml"), &sets).unwrap();
        let [ring, half] = ["pinched", "halved"].map(|name| advanced(&case(name), 390));
        assert!(ring.state().pairs[0].iter().any(|pair| pair.active));
        let place = |simulation: &Simulation, at: [f64; 2]| {
            let model = simulation.model();
            let x = &model.reference;
            let is_there = |&n: &usize| (x[2 * n] - at[0]).hypot(x[2 * n + 1] - at[1]) < 1e-12;
            let node = (0..x.len() / 2).find(is_there).unwrap();
            [simulation.state().y[2 * node], simulation.state().y[2 * node + 1]]
        };
        // On average the flanks meet the axis in different ways: neither is held to it.
        let [side, near] = if method == "mortar" { [2e-5, 1e-4] } else { [1e-9, 5e-6] };
        for (at, tolerance) in [([0.45, 0.0], side), ([0.0, 0.5], near), ([0.0, 0.4], near)] {
            let [a, b] = [&ring, &half].map(|simulation| place(simulation, at));
            let apart = (a[0] - b[0]).hypot(a[1] - b[1]);
            assert!(apart < tolerance, "{method}, {at:?}: {a:?} {b:?}, {apart:e}");
        }
    }
}

#[test]
fn a_run_that_is_continued_from_its_state_is_the_same() {
    let ring = Case::from_file(format!("{ROOT}ring.toml"), &[]).unwrap();
    continues_with_the_same_bits(&ring, advanced(&ring, 225), 20);
    let pieces = strips(&body("both", "both"), r#"between = ["both"], method = "mortar""#);
    continues_with_the_same_bits(&pieces, advanced(&pieces, 70), 20);
}

/// Two rectangles of triangles in the format of Gmsh, each with a surface of its own and both with
/// "both".
fn rectangles(of: [(&str, [f64; 4], [usize; 2]); 2]) -> String {
    let (mut nodes, mut cells, mut names) = (Vec::new(), Vec::new(), vec!["2 9 \"both\"".to_owned()]);
    for (k, (name, [left, right, bottom, top], [n, m])) in of.into_iter().enumerate() {
        let first = nodes.len() + 1;
        for (i, j) in (0..=n).flat_map(|i| (0..=m).map(move |j| (i, j))) {
            let x = left + (right - left) * i as f64 / n as f64;
            let y = bottom + (top - bottom) * j as f64 / m as f64;
            nodes.push(format!("{} {x} {y} 0", nodes.len() + 1));
        }
        let at = |i: usize, j: usize| first + i * (m + 1) + j;
        for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))) {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            for triangle in [[a, b, c], [a, c, d]] {
                let triangle = triangle.map(|node| node.to_string()).join(" ");
                for tag in [k + 1, 9] {
                    cells.push(format!("{} 2 2 {tag} {tag} {triangle}", cells.len() + 1));
                }
            }
        }
        names.push(format!("2 {} \"{name}\"", k + 1));
    }
    let list = |name: &str, lines: Vec<String>| {
        format!("${name}\n{}\n{}\n$End{name}\n", lines.len(), lines.join("\n"))
    };
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n".to_owned()
        + &list("PhysicalNames", names)
        + &list("Nodes", nodes)
        + &list("Elements", cells)
}

/// Two squares with one node in common: which facet follows which is not known there.
#[test]
fn a_boundary_that_meets_itself_in_a_node_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let apart = rectangles([("low", [0.0, 1.0, 0.0, 1.0], [1, 1]), ("high", [1.0, 2.0, 1.0, 2.0], [1, 1])]);
    // The corners at (1, 1) are the nodes 4 and 5.
    let joined = apart.replace(" 5 7 8\n", " 4 7 8\n").replace(" 5 8 6\n", " 4 8 6\n");
    let refused = "the boundary of body \"squares\" meets itself in the single node at [1, 1]";
    for (text, expected) in [(apart, None), (joined, Some(refused))] {
        let mesh = folder.path().join("squares.msh");
        std::fs::write(&mesh, text).unwrap();
        let text = format!(
            r#"
            dimension = 2
            material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 1.0, poisson = 0.3 }}]
            contact = [{{ name = "itself", between = "all" }}]
            time = {{ end = 0.1, step = 0.1, scheme = {{ kind = "newmark", rho_inf = 1 }} }}
            [[body]]
            name = "squares"
            material = "m"
            element = "T3"
            mesh = {{ file = '{}', surface = "both", slits = true }}
            "#,
            mesh.display()
        );
        let problems = Setup::new(&Case::from_text(&text, &[]).unwrap()).start().err();
        assert_eq!(problems.as_ref().map(|problems| problems[0].what.as_str()), expected);
    }
}

/// A small box strikes the end of a plate of one cell at a slant, fast enough to be past it after a
/// step: nothing penetrates at its ends.
#[test]
fn a_piece_that_would_pass_another_one_within_a_step_strikes_it() {
    let folder = tempfile::tempdir().unwrap();
    let plate = ("plate", [-0.5, 0.5, -0.02, 0.0], [20, 1]);
    let box_ = ("box", [-0.99, -0.95, 0.48, 0.52], [2, 2]);
    let mesh = folder.path().join("pieces.msh");
    std::fs::write(&mesh, rectangles([plate, box_])).unwrap();
    let body = |surface: &str| {
        format!(
            r#"
            [[body]]
            name = "{surface}"
            material = "m"
            element = "T3"
            mesh = {{ file = '{}', surface = "{surface}" }}
            velocity = ["if(Y > 0.4, 12, 0)", "if(Y > 0.4, -4, 0)"]
            "#,
            mesh.display()
        )
    };
    let case = |bodies: &str, between: &str| {
        let text = format!(
            r#"
            dimension = 2
            material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 1e4, poisson = 0.3 }}]
            contact = [{{ name = "joint", {between} }}]
            time = {{ end = 0.4, step = 0.2, scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }} }}
            {bodies}
            # Tolerances are relative to the largest body: it is the same with one body and with two.
            [[body]]
            name = "other"
            material = "m"
            element = "T3"
            mesh = {{ shape = "rectangle", min = [-10.0, 5.0], max = [10.0, 6.0], cells = [20, 1] }}
            "#
        );
        Case::from_text(&text, &[]).unwrap()
    };
    let one = case(&body("both"), r#"between = ["both"]"#);
    let two = case(&(body("plate") + &body("box")), r#"secondary = "box.skin", primary = "plate.skin""#);
    let mut simulations = [one, two].map(|case| simulation(&case));
    let reports = simulations.each_mut().map(|simulation| simulation.step().unwrap());
    let [one, two] = &simulations;
    assert!(reports[0].rejected > 0, "no step was rejected");
    assert_eq!(reports[0].rejected, reports[1].rejected);
    let [a, b] = [one, two].map(|simulation| simulation.state().impulse());
    assert!(a[1].abs() > 1e-3, "{a:?}");
    let (y, z) = (&one.state().y, &two.state().y);
    let difference = y.iter().zip(z).map(|(y, z)| (y - z).abs()).fold(0.0, f64::max);
    assert!(difference < 1e-9, "{difference:e}; impulses {a:?} {b:?}");
}

/// A ring of triangles that is pressed flat: its inner outline meets itself, facets at the crease
/// pass each other by a little, and no node is deeper than a fiftieth of a facet.
#[test]
fn a_ring_that_is_pressed_flat_is_held_apart() {
    let text = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 0.5, lambda = 300.0, mu = 100.0 }]
[[body]]
name = "ring"
material = "m"
element = "T6"
mesh = { shape = "ring", inner = 0.42, outer = 0.5, center = [0.03, 0.5], size = 0.12 }
[[contact]]
name = "itself"
between = ["ring"]
[[contact]]
name = "floor"
secondary = "ring.outer"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
[[contact]]
name = "press"
secondary = "ring.outer"
primary = { plane = { point = [0.0, 1.0], normal = [0.0, -1.0] }, motion = { y = "-2.0*t" } }
[time]
end = 0.428
step = 0.004
scheme = { kind = "bathe", rho_inf = 0.0 }
"#;
    let mut sim = super::common::simulation(text, &[""; 0]);
    let mut deepest = 0.0_f64;
    while !sim.finished() {
        deepest = deepest.max(sim.step().unwrap().penetration.all);
    }
    assert!(deepest < 0.02 * 0.12, "{deepest:e}");
    assert!(sim.state().pairs[0].iter().any(|pair| pair.active));
}

/// A strip wound to a square spiral whose windings do not touch: the inner face of one winding lies
/// behind the outer face of the next, and overlaps nothing.
#[test]
fn the_windings_of_a_spiral_do_not_overlap() {
    let corners = [
        [0.0, -0.02],
        [1.02, -0.02],
        [1.02, 1.02],
        [-0.02, 1.02],
        [-0.02, 0.04],
        [0.96, 0.04],
        [0.96, 0.96],
        [0.04, 0.96],
        [0.04, 0.1],
        [0.88, 0.1],
        [0.88, 0.14],
        [0.08, 0.14],
        [0.08, 0.92],
        [0.92, 0.92],
        [0.92, 0.08],
        [0.02, 0.08],
        [0.02, 0.98],
        [0.98, 0.98],
        [0.98, 0.02],
        [0.0, 0.02],
    ];
    let turned: Vec<[f64; 2]> = corners.iter().rev().map(|[x, y]| [-x, *y]).collect();
    for (points, method) in [
        (corners.to_vec(), "node-to-segment"),
        (turned.clone(), "node-to-segment"),
        (corners.to_vec(), "mortar"),
        (turned, "mortar"),
    ] {
        let text = format!(
            r#"
            dimension = 2
            material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 1.0, poisson = 0.0 }}]
            contact = [{{ name = "fold", between = ["strip"], method = "{method}" }}]
            time = {{ end = 0.1, step = 0.05, scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }} }}
            [[body]]
            name = "strip"
            material = "m"
            element = "T3"
            mesh = {{ shape = "polygon", points = {points:?}, size = 0.2 }}
            velocity = [0.1, 0.0]
            "#
        );
        let case = Case::from_text(&text, &[""; 0]).unwrap();
        let simulation = advanced(&case, 2);
        let forces = &simulation.state().f_contact;
        assert!(forces.iter().all(|force| *force == 0.0), "{method}");
        assert!((simulation.state().y[0] - points[0][0] - 0.01).abs() < 1e-12);
    }
}
