//! Two bars cross edge on edge, between their nodes: no node enters, and only the pair of the edges
//! holds them apart.

use super::common::simulation;
use super::space_contact::momenta;
use carom_run::Simulation;

const CHUNG_HULBERT: &str = "kind = \"chung-hulbert\", rho_inf = 0.5";

/// A bar along x or y, turned on an edge, whose middle is between two nodes.
fn bar(name: &str, axis: &str, height: f64, speed: f64, place: &str) -> String {
    let half = if axis == "x" { [0.5, 0.1, 0.1] } else { [0.1, 0.5, 0.1] };
    let cells = if axis == "x" { [3, 1, 1] } else { [1, 3, 1] };
    let turned = if axis == "x" { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let low = half.map(|x| -x);
    format!(
        "[[body]]\nname = \"{name}\"\nmaterial = \"m\"\nelement = \"Hex8\"\nmass = \"lumped\"\n\
         mesh = {{ shape = \"box\", min = {low:?}, max = {half:?}, cells = {cells:?} }}\n\
         place = {{ rotate = {{ axis = {turned:?}, angle = 45.0 }}, shift = [{place}, {height}] }}\n\
         velocity = [0.0, 0.0, {speed}]\n"
    )
}

/// The upper bar falls on the lower one with the speed 2; the ridges are 0.3 − 0.2 √2 apart.
fn bars(scheme: &str, contact: &str) -> String {
    format!(
        "dimension = 3\n[[material]]\nname = \"m\"\nlaw = \"saint-venant-kirchhoff\"\ndensity = 1.0\n\
         young = 1000.0\npoisson = 0.3\n{}{}[[contact]]\nname = \"cross\"\nsecondary = \"upper.skin\"\n\
         primary = \"lower.skin\"\n{contact}\n[time]\nend = 0.1\nstep = 5e-4\nscheme = {{ {scheme} }}\n\
         [newton]\ntolerance = 1e-12\n",
        bar("lower", "x", 0.0, 0.0, "0.0, 0.0"),
        bar("upper", "y", 0.3, -2.0, "0.03, 0.02"),
    )
}

/// Heights of the upper edge of the lower bar and of the lower edge of the upper one where they
/// cross, from their nodes on both sides.
fn ridges(sim: &Simulation) -> impl Fn(&Simulation) -> [f64; 2] + use<> {
    let start = sim.state().y.clone();
    let half = 0.1 * 2.0_f64.sqrt();
    // Nodes of an edge nearest to the middle, across which it runs from −0.5/3 to 0.5/3.
    let ends = |height: f64, along: usize, middle: f64| -> Vec<usize> {
        let places = start.as_chunks::<3>().0.iter().enumerate();
        let on = |x: &[f64; 3]| (x[2] - height).abs() < 1e-9 && (x[along] - middle).abs() < 0.2;
        places.filter(|(_, x)| on(x)).map(|(node, _)| node).collect()
    };
    let lower = ends(half, 0, 0.0);
    let upper = ends(0.3 - half, 1, 0.02);
    assert!(lower.len() == 2 && upper.len() == 2, "{lower:?} {upper:?}");
    move |sim: &Simulation| {
        let y = sim.state().y.as_chunks::<3>().0;
        let line = |nodes: &[usize]| {
            let (a, b) = (y[nodes[0]], y[nodes[1]]);
            (a, [b[0] - a[0], b[1] - a[1], b[2] - a[2]])
        };
        let ((a, u), (b, v)) = (line(&lower), line(&upper));
        // Where they cross seen from above.
        let det = u[1] * v[0] - u[0] * v[1];
        let (x, z) = (b[0] - a[0], b[1] - a[1]);
        let (s, t) = ((z * v[0] - x * v[1]) / det, (u[0] * z - u[1] * x) / det);
        [a[2] + s * u[2], b[2] + t * v[2]]
    }
}

#[test]
fn bars_that_cross_edge_on_edge_rebound_with_every_scheme() {
    // Depth over the edge of a cell, 0.2: of constraints on positions none. Change of the angular
    // momentum: means of forces at both ends of a step, and impulses along rows at predicted
    // positions, have one of the order of the scheme.
    let cases = [
        (CHUNG_HULBERT, "", 1e-8, 1e-6),
        ("kind = \"bathe\", rho_inf = 0.0", "", 1e-8, 1e-6),
        ("kind = \"energy-momentum\"", "restitution = 1.0", 1e-8, 1e-11),
        (CHUNG_HULBERT, "enforcement = \"penalty\"\nstiffness = 20.0", 0.05, 1e-6),
        ("kind = \"energy-momentum\"", "enforcement = \"penalty\"\nstiffness = 20.0", 0.05, 1e-11),
        (CHUNG_HULBERT, "enforcement = \"augmented\"", 1e-6, 1e-6),
        (CHUNG_HULBERT, "mu = 0.5", 1e-8, 1e-6),
        ("kind = \"central-difference\"", "", 1e-8, 1e-11),
        ("kind = \"paoli-schatzman\"", "", 0.02, 1e-11),
        ("kind = \"moreau-jean\", theta = 0.5", "", 0.02, 1e-6),
    ];
    for (scheme, contact, depth, drift) in cases {
        let mut sim = simulation(&bars(scheme, contact), &[""; 0]);
        let heights = ridges(&sim);
        let before = momenta(&sim);
        let (mut least, mut was_closed) = (f64::INFINITY, false);
        while !sim.finished() {
            if let Err(stopped) = sim.step() {
                panic!("{scheme} {contact}: {stopped}");
            }
            let [lower, upper] = heights(&sim);
            least = least.min(upper - lower);
            was_closed |= sim.state().pairs[0].iter().any(|pair| pair.active);
        }
        let [lower, upper] = heights(&sim);
        assert!(was_closed && upper - lower > 0.005, "{scheme} {contact}: {lower} {upper}");
        assert!(least > -0.2 * depth, "{scheme} {contact}: {least:e}");
        let after = momenta(&sim);
        let change =
            |range: std::ops::Range<usize>| range.map(|i| (after[i] - before[i]).abs()).fold(0.0, f64::max);
        let [linear, angular] = [change(0..3), change(3..6)];
        assert!(linear < 1e-12 && angular < drift, "{scheme} {contact}: {linear:e} {angular:e}");
    }
}

/// Stiff bars, of which the upper one also moves along the lower one. In an impact in which two
/// bodies slide all the time, the tangential impulse is μ times the normal one, against the slip.
/// The edges turn by 0.002 meanwhile.
#[test]
fn bars_that_slide_edge_on_edge_rub_with_every_scheme() {
    let mu = 0.1;
    for (scheme, contact) in [
        (CHUNG_HULBERT, ""),
        (CHUNG_HULBERT, "enforcement = \"penalty\"\nstiffness = 20.0"),
        (CHUNG_HULBERT, "enforcement = \"augmented\""),
        ("kind = \"bathe\", rho_inf = 0.0", ""),
        ("kind = \"energy-momentum\"", ""),
        ("kind = \"central-difference\"", ""),
        ("kind = \"moreau-jean\", theta = 0.5", ""),
        ("kind = \"nonsmooth-generalized-alpha\", rho_inf = 0.5", ""),
    ] {
        let text = bars(scheme, &format!("mu = {mu}\n{contact}"));
        let text = text.replace("velocity = [0.0, 0.0, -2]", "velocity = [1.2, 0.6, -2.0]");
        let text = text.replace("young = 1000.0", "young = 1e5");
        let text = text.replace("end = 0.1\nstep = 5e-4", "end = 0.016\nstep = 5e-5");
        let mut sim = simulation(&text, &[""; 0]);
        while !sim.finished() {
            if let Err(stopped) = sim.step() {
                panic!("{scheme} {contact}: {stopped}");
            }
        }
        let [x, y, z] = sim.state().impulses[0];
        let ratio = x.hypot(y) / z;
        assert!((ratio - mu).abs() < 0.03 * mu, "{scheme} {contact}: {ratio}");
        assert!((y / x - 0.5).abs() < 0.01, "{scheme} {contact}: {x} {y}");
        assert!(x < 0.0 && sim.state().ledger.friction_work < 0.0, "{scheme} {contact}");
    }
}

/// Two clamped bars, of which the upper one is lowered and then drawn along its axis y. The lower
/// one crosses it 1e-3 before a node of its edge.
fn drawn(contact: &str) -> String {
    let bar = |name: &str, half: [f64; 3], cells: [u32; 3], axis: [f64; 3], shift: [f64; 3]| {
        let low = half.map(|x| -x);
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"m\"\nelement = \"Hex8\"\n\
             mesh = {{ shape = \"box\", min = {low:?}, max = {half:?}, cells = {cells:?} }}\n\
             place = {{ rotate = {{ axis = {axis:?}, angle = 45.0 }}, shift = {shift:?} }}\n"
        )
    };
    let height = 0.1 * 2.0_f64.sqrt();
    format!(
        "dimension = 3\n[[material]]\nname = \"m\"\nlaw = \"saint-venant-kirchhoff\"\ndensity = 1.0\n\
         young = 1000.0\npoisson = 0.0\n{}{}[[support]]\non = [\"lower.left\", \"lower.right\"]\n\
         fix = [\"x\", \"y\", \"z\"]\n[[support]]\non = [\"upper.front\", \"upper.back\"]\nfix = [\"x\"]\n\
         move = {{ y = \"-4e-3*max(t-1,0)\", z = \"-5e-4*min(t,1)\" }}\n[[contact]]\nname = \"cross\"\n\
         secondary = \"upper.skin\"\nprimary = \"lower.skin\"\n{contact}\n\
         [time]\nend = 2.0\nstep = 0.025\nscheme = {{ kind = \"static\" }}\n",
        bar("lower", [1.0, 0.05, 0.05], [7, 1, 1], [1.0, 0.0, 0.0], [0.03, -1e-3, 0.0]),
        bar("upper", [0.05, 1.0, 0.05], [1, 8, 1], [0.0, 1.0, 0.0], [0.0, 0.0, height]),
    )
}

/// The node of its edge is not caught by the flank of the other one (a force of 1.8 times the
/// normal one), and in every step of the slip the tangential force is μ times the normal one: it
/// does not begin anew on the next edge.
#[test]
fn bars_slide_over_the_nodes_of_their_edges() {
    let springs = "enforcement = \"penalty\"\nstiffness = 0.5\nstick_stiffness = 0.002\nmu = 0.3";
    for (contact, mu) in [("", 0.0), ("mu = 0.3", 0.3), (springs, 0.3)] {
        let mut sim = simulation(&drawn(contact), &[""; 0]);
        let mut edges = std::collections::BTreeSet::new();
        while !sim.finished() {
            sim.step().unwrap();
            let state = sim.state();
            edges.extend(state.pairs[0].iter().filter(|pair| pair.active).map(|pair| pair.node));
            if state.time > 1.3 {
                let [_, y, z] = state.contact_forces[0];
                assert!((y / z - mu).abs() < 1e-3, "{contact} t = {}: {y} {z}", state.time);
            }
        }
        assert_eq!(edges.len(), 2, "{contact}: {edges:?}");
    }
}

/// Two slabs cross at a right angle and are pressed together; nodes of their long edges coincide.
/// The set-up is symmetric about x = 0 and y = 0, and so are its contact forces, to round-off,
/// whichever numbers edges and nodes have.
#[test]
fn slabs_whose_edges_cross_at_nodes_are_not_pushed_sideways() {
    for enforcement in ["multiplier", "augmented", "penalty"] {
        let text = format!(
            "dimension = 3\n[[material]]\nname = \"m\"\nlaw = \"neo-hookean\"\ndensity = 1.0\nyoung = 2000.0\n\
             poisson = 0.3\n[[body]]\nname = \"a\"\nmaterial = \"m\"\nelement = \"Hex8\"\n\
             mesh = {{ shape = \"box\", min = [-1.0, -0.5, 0.0], max = [1.0, 0.5, 0.5], cells = [4, 2, 1] }}\n\
             [[body]]\nname = \"b\"\nmaterial = \"m\"\nelement = \"Hex8\"\n\
             mesh = {{ shape = \"box\", min = [-0.5, -1.0, -0.5], max = [0.5, 1.0, 0.0], cells = [2, 4, 1] }}\n\
             [[support]]\non = [\"b.bottom\"]\nfix = [\"x\", \"y\", \"z\"]\n\
             [[support]]\non = [\"a.top\"]\nmove = {{ x = \"0\", y = \"0\", z = \"-0.1*t\" }}\n\
             [[contact]]\nname = \"c\"\nsecondary = \"a.skin\"\nprimary = \"b.skin\"\nenforcement = \"{enforcement}\"\n\
             [time]\nend = 1.0\nstep = 0.1\nscheme = {{ kind = \"static\" }}\n"
        );
        let sim = finish(&text);
        let [x, y, z] = sim.state().contact_forces[0];
        assert!(z > 300.0 && x.abs().max(y.abs()) < 1e-10 * z, "{enforcement}: {x:e} {y:e} {z}");
    }
}

/// Two bars fall edge on edge, node on node. Edges bend there, and the normals of the four pairs of
/// edges at the nodes lean to all sides: by symmetry the bars part straight, with friction as
/// without.
#[test]
fn bars_that_cross_at_nodes_part_straight() {
    let at_nodes = |scheme: &str, contact: &str| {
        let text = bars(scheme, contact).replace("[3, 1, 1]", "[4, 1, 1]").replace("[1, 3, 1]", "[1, 4, 1]");
        finish(&text.replace("0.03, 0.02", "0.0, 0.0"))
    };
    for scheme in [
        CHUNG_HULBERT,
        "kind = \"bathe\", rho_inf = 0.0",
        "kind = \"moreau-jean\", theta = 0.5",
        "kind = \"central-difference\"",
    ] {
        let parted = ["", "mu = 0.3"].map(|contact| {
            let sim = at_nodes(scheme, contact);
            let nodes = sim.model().parts[1].nodes();
            let count = nodes.len() as f64;
            let mean =
                |axis: usize| nodes.clone().map(|node| sim.state().v[3 * node + axis]).sum::<f64>() / count;
            let [x, y, z] = [0, 1, 2].map(mean);
            assert!(x.abs().max(y.abs()) < 1e-8 && z > -1.5, "{scheme} {contact}: {x:e} {y:e} {z}");
            z
        });
        assert!((parted[0] - parted[1]).abs() < 1e-6, "{scheme}: {parted:?}");
    }
}

#[test]
fn an_elastic_impact_of_edges_conserves_energy() {
    let text = bars("kind = \"energy-momentum\"", "restitution = 1.0");
    let mut sim = simulation(&text, &[""; 0]);
    let energy = sim.state().ledger.total();
    while !sim.finished() {
        sim.step().unwrap();
    }
    let ledger = &sim.state().ledger;
    assert!((energy + ledger.contact_work - ledger.total()).abs() < 1e-9 * energy);
    // Restitution returns what the impact took.
    assert!(ledger.contact_work.abs() < 1e-3 * energy, "{:e} of {energy}", ledger.contact_work);
}

#[test]
fn a_run_resumed_while_edges_are_in_contact_has_the_same_bits() {
    let text = bars(CHUNG_HULBERT, "");
    let mut sim = simulation(&text, &[""; 0]);
    while !sim.state().pairs[0].iter().any(|pair| pair.active) {
        sim.step().unwrap();
    }
    let mut other = simulation(&text, &[""; 0]);
    other.restore(sim.state().clone()).unwrap();
    for _ in 0..20 {
        sim.step().unwrap();
        other.step().unwrap();
    }
    assert!(sim.state().y == other.state().y && sim.state().v == other.state().v);
    assert_eq!(sim.state().pairs, other.state().pairs);
}

#[test]
fn a_turned_impact_of_edges_is_the_same() {
    let text = bars(CHUNG_HULBERT, "");
    let still = finish(&text);
    let turn = |text: &str| {
        // 120° about the diagonal, x → y → z → x, after the turn of each bar.
        let mut text = text.to_owned();
        for (axis, angle_axis) in [("[1.0, 0.0, 0.0]", 0), ("[0.0, 1.0, 0.0]", 1)] {
            let (axis_of, angle) = composed(angle_axis);
            text = text.replace(
                &format!("axis = {axis}, angle = 45.0"),
                &format!("axis = {axis_of:?}, angle = {angle:?}"),
            );
        }
        text = text.replace("shift = [0.0, 0.0, 0]", "shift = [0, 0.0, 0.0]");
        text = text.replace("shift = [0.03, 0.02, 0.3]", "shift = [0.3, 0.03, 0.02]");
        text.replace("velocity = [0.0, 0.0, -2]", "velocity = [-2, 0.0, 0.0]")
    };
    let turned = finish(&turn(&text));
    let pairs = still.state().y.as_chunks::<3>().0.iter().zip(turned.state().y.as_chunks::<3>().0);
    let apart =
        |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|i| (a[(i + 2) % 3] - b[i]).abs()).fold(0.0, f64::max);
    let worst = pairs.map(apart).fold(0.0, f64::max);
    assert!(still.state().pairs[0].iter().any(|pair| pair.rests || !pair.active));
    assert!(worst < 1e-9, "{worst:e}");
}

/// Axis and angle of a turn by 45° about a coordinate axis, followed by one by 120° about the
/// diagonal, as products of quaternions.
fn composed(axis: usize) -> ([f64; 3], f64) {
    let (s, c) = (std::f64::consts::PI / 8.0).sin_cos();
    let mut first = [c, 0.0, 0.0, 0.0];
    first[1 + axis] = s;
    let [a, b] = [[0.5; 4], first];
    let w = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    let v = [
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ];
    let size = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    (v.map(|x| x / size), 2.0 * size.atan2(w).to_degrees())
}

fn finish(text: &str) -> Simulation {
    let mut sim = simulation(text, &[""; 0]);
    while !sim.finished() {
        sim.step().unwrap();
    }
    sim
}
