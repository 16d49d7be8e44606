//! Friction in space: the plane is a slice of it, no direction is special, forces and moments
//! balance, the law holds at every node, and runs resume with the same bits.

use carom_contact::{FrictionState, Pair, Tangential, length};
use carom_run::model::Contact;
use carom_run::recording::Rows;
use carom_run::{GridReport, Simulation, State};

use super::common::{case as case_of, finish, on_threads, simulation, turned};
use super::space::apart;
use super::space_contact::{BALL, IMPACT, momenta, slab, turned_impact};

/// One of every family.
pub(super) const SCHEMES: [&str; 6] = [
    "{ kind = \"chung-hulbert\", rho_inf = 0.8 }",
    "{ kind = \"hht\", alpha = 0.1 }",
    "{ kind = \"bathe\", rho_inf = 0.0 }",
    "{ kind = \"energy-momentum\" }",
    "{ kind = \"central-difference\" }",
    "{ kind = \"moreau-jean\", theta = 0.5 }",
];

/// Settings of a scheme: the discrete gradient has its law, explicit schemes lumped masses and
/// short steps.
pub(super) fn of(scheme: &str, mu: &str) -> Vec<String> {
    let mut sets = vec![format!("time.scheme={scheme}"), format!("contact.strike.mu={mu}")];
    if scheme.contains("energy") {
        sets.push("material.rubber.law=\"saint-venant-kirchhoff\"".into());
    }
    if scheme.contains("central") {
        sets.extend(["ball", "block"].map(|body| format!("body.{body}.mass=\"lumped\"")));
        sets.push("time.step=5e-4".into());
    }
    if scheme.contains("moreau") {
        sets.push("time.step=2e-3".into());
    }
    sets.push("time.end=0.03".into());
    sets
}

/// Not with a discrete gradient: it is corrected along the motion of all nodes of a facet, of which
/// a slab has more, and other nodes stick.
#[test]
fn an_impact_of_slabs_with_friction_is_that_of_the_plane() {
    for scheme in &SCHEMES[..3] {
        let bound = 1e-8;
        let sets = of(scheme, "0.3");
        let plane = finish(simulation(IMPACT, &sets));
        let sets: Vec<&str> = sets.iter().map(String::as_str).filter(|set| !set.contains("mu=")).collect();
        let mut slabs = slab(&sets);
        slabs.push("contact.strike.mu=0.3".into());
        let space = finish(simulation(IMPACT, &slabs));
        let slips = |sim: &Simulation, stick: bool| {
            let counts = |pair: &&Pair| {
                pair.active && (pair.tangential.friction_state == FrictionState::Stick) == stick
            };
            sim.state().pairs[0].iter().filter(counts).count()
        };
        assert!(slips(&plane, true) + slips(&plane, false) > 2, "{scheme}");
        let worst = apart(&plane, &space);
        assert!(worst < bound, "{scheme}: {worst:e}");
        let [a, b] = [&plane, &space].map(|sim| sim.state().ledger.friction_work);
        // The slab is half as thick.
        assert!(a < -1e-3 && (b / (0.5 * a) - 1.0).abs() < 1e3 * bound, "{scheme}: {a} {b}");
    }
}

#[test]
fn a_turned_impact_with_friction_is_the_same() {
    for scheme in [SCHEMES[0], SCHEMES[3], SCHEMES[4]] {
        let (still, worst) =
            turned_impact(&of(scheme, "0.2"), "axis = [2.0, 3.0, 6.0], angle = 50.0", turned);
        assert!(still.state().ledger.friction_work < 0.0, "{scheme}");
        assert!(worst < 1e-9, "{scheme}: {worst:e}");
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn sum(a: [f64; 3], factor: f64, b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + factor * b[i])
}

/// The slip of a pair for motions `moved` at positions `y`, from the positions of its nodes alone:
/// that of the node beyond the point of the facet closest to it, along the facet, and what the
/// facet turns under the gap, W Δy with
///
/// W = (P; −φᵃ P + g φᵃ,_α τ^α ⊗ n),   P = 1 − n ⊗ n
fn slip_of(contact: &Contact, pair: &Pair, y: &[f64], moved: &[f64]) -> [f64; 3] {
    let vector = |values: &[f64], node: usize| -> [f64; 3] { std::array::from_fn(|i| values[3 * node + i]) };
    let node = contact.kinematics.secondary()[pair.node];
    let (nodes, shape) = (contact.kinematics.facet_nodes(pair), contact.facets[0].0);
    let (x, mut xi) = (vector(y, node), [pair.xi, pair.eta]);
    let (mut arm, mut tangents, mut dual, mut functions);
    let mut steps = 0;
    loop {
        functions = shape.functions(xi);
        (arm, tangents) = (x, [[0.0; 3]; 2]);
        for (k, &node) in nodes.iter().enumerate() {
            arm = sum(arm, -functions.values[k], vector(y, node));
            (0..2).for_each(|i| tangents[i] = sum(tangents[i], functions.slopes[i][k], vector(y, node)));
        }
        let [t, s] = tangents;
        let (a, b, c) = (dot(t, t), dot(t, s), dot(s, s));
        let det = a * c - b * b;
        dual = [sum(t.map(|t| c / det * t), -b / det, s), sum(s.map(|s| a / det * s), -b / det, t)];
        // The gap is small: Gauss and Newton's method converges fast.
        let step = dual.map(|dual| dot(dual, arm));
        steps += 1;
        if step[0].abs().max(step[1].abs()) < 1e-14 || steps == 40 {
            break;
        }
        xi = [xi[0] + step[0], xi[1] + step[1]];
    }
    let [t, s] = tangents;
    let normal: [f64; 3] = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        t[j] * s[k] - t[k] * s[j]
    });
    let normal = normal.map(|n| n / dot(normal, normal).sqrt());
    let gap = dot(arm, normal);
    let mut slip = vector(moved, node);
    let mut tilt = [0.0; 3];
    for (k, &node) in nodes.iter().enumerate() {
        let moved = vector(moved, node);
        slip = sum(slip, -functions.values[k], moved);
        for i in 0..2 {
            tilt = sum(tilt, gap * functions.slopes[i][k] * dot(moved, normal), dual[i]);
        }
    }
    sum(sum(slip, -dot(slip, normal), normal), 1.0, tilt)
}

/// The traction of a pair as a vector.
fn traction_of(pair: &Pair) -> [f64; 3] {
    let Tangential { tangents: [first, second], traction, .. } = pair.tangential;
    sum(first.map(|t| traction[0] * t), traction[1], second)
}

/// |q| ≤ μ|λ|, nothing slips in stick, and in slip q has that size and the direction of a slip that
/// is computed from positions alone; where friction acts over whole steps, between pairs that stay
/// closed.
#[test]
fn every_node_obeys_the_law() {
    for (scheme, mu) in [(SCHEMES[0], 0.2), (SCHEMES[3], 0.2), (SCHEMES[4], 0.2)] {
        let mut sets = of(scheme, &mu.to_string());
        sets.extend((!scheme.contains("central")).then(|| "time.step=1e-3".into()));
        let mut sim = simulation(BALL, &sets);
        let (mut sticks, mut slips, mut measured) = (0, 0, 0);
        let closed = |state: &State| -> Vec<_> {
            let closed = state.pairs[0].iter().filter(|pair| pair.active);
            closed.map(|pair| (pair.node, pair.facet)).collect()
        };
        while !sim.finished() {
            let before = sim.state().clone();
            sim.advance(&mut GridReport::default()).unwrap();
            let state = sim.state();
            let is_explicit = !state.half_step.velocity.is_empty();
            // A projection has slip rates at the end of its step.
            let goes_on = is_explicit || closed(&before) == closed(state);
            let (place, moved): (Vec<f64>, Vec<f64>) = if is_explicit {
                (state.y.clone(), state.half_step.velocity.iter().map(|v| state.half_step.dt * v).collect())
            } else {
                let ends = || before.y.iter().zip(&state.y);
                (ends().map(|(a, b)| 0.5 * (a + b)).collect(), ends().map(|(a, b)| b - a).collect())
            };
            let largest = state.pairs[0].iter().map(|pair| pair.lambda.abs()).fold(0.0, f64::max);
            for pair in state.pairs[0].iter().filter(|pair| pair.active && pair.lambda <= 0.0) {
                let (q, cone) = (length(pair.tangential.traction), mu * -pair.lambda);
                let is_stick = pair.tangential.friction_state == FrictionState::Stick;
                *(if is_stick { &mut sticks } else { &mut slips }) += 1;
                assert!(q <= cone + 1e-9 * largest, "{scheme}: {pair:?}");
                assert!(is_stick || q >= cone - 1e-9 * largest, "{scheme}: {pair:?}");
                if goes_on {
                    measured += 1;
                    let slip = slip_of(&sim.model().contacts[0], pair, &place, &moved);
                    let size = dot(slip, slip).sqrt();
                    let traction = traction_of(pair).map(|t| t / q.max(f64::MIN_POSITIVE));
                    let across = sum(slip, -dot(slip, traction), traction);
                    let across = dot(across, across).sqrt();
                    let wrong = if is_stick { size } else { across - 1e-8 * size };
                    assert!(wrong < 1e-11, "{scheme}: {wrong:e} of {size:e}, {pair:?}");
                    assert!(is_stick || dot(slip, traction) > -1e-11, "{scheme}: {pair:?}");
                }
            }
        }
        assert!(sticks > 0 && slips > 10 && measured > 20, "{scheme}: {sticks} {slips} {measured}");
    }
}

/// Momentum, also its moment where the scheme conserves it; friction takes energy, and the ledger
/// is closed.
#[test]
fn momenta_are_conserved_with_friction() {
    for scheme in [SCHEMES[0], SCHEMES[3], SCHEMES[4], SCHEMES[5]] {
        let start = simulation(BALL, &of(scheme, "0.2"));
        let before = momenta(&start);
        let end = finish(start);
        let after = momenta(&end);
        let conserves_moment = scheme.contains("energy") || scheme.contains("central");
        for i in 0..if conserves_moment { 6 } else { 3 } {
            let change = after[i] - before[i];
            assert!(change.abs() < 1e-12, "{scheme} {i}: {change:e}");
        }
        let ledger = &end.state().ledger;
        assert!(ledger.friction_work < 0.0, "{scheme}");
        if scheme.contains("energy") {
            assert!(ledger.dissipation().abs() < 1e-11, "{ledger:?}");
        }
    }
}

/// Corners of the primary meet facets of the secondary side: also of these pairs, rows of contact
/// have the forces on the secondary side.
#[test]
fn recorded_rows_are_forces_on_the_secondary_side() {
    let contact =
        "contact=[{ name = \"strike\", secondary = \"lower.back\", primary = \"upper.front\", mu = 0.3 }]";
    let mut sets = slab(&["time.step=1e-3", "time.end=0.015"]);
    sets.push(contact.to_owned());
    let (case, mut sim) = (case_of(IMPACT, &sets), simulation(IMPACT, &sets));
    let rows = Rows::new(&case, &sim);
    let lower = sim.model().parts.iter().find(|part| part.name == "lower").unwrap().nodes();
    let mut corners = 0;
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        let (mut pressed, mut rubbed) = ([0.0; 3], [0.0; 3]);
        for row in rows.contact(&sim) {
            corners += usize::from(!lower.contains(&(row.node as usize)) && row.traction > 0.0);
            pressed = sum(pressed, -row.multiplier, row.normal);
            rubbed = sum(rubbed, 1.0, row.rubbing);
        }
        let on_lower = |force: &[f64]| {
            let force = |node: usize| -> [f64; 3] { std::array::from_fn(|i| force[3 * node + i]) };
            lower.clone().fold([0.0; 3], |total, node| sum(total, -1.0, force(node)))
        };
        let [all, friction] = [&sim.state().f_contact, &sim.state().f_friction].map(|f| on_lower(f));
        let size = 1e-11 * dot(all, all).sqrt();
        for (found, expected) in [(rubbed, friction), (sum(pressed, 1.0, rubbed), all)] {
            assert!((0..3).all(|i| (found[i] - expected[i]).abs() <= size), "{found:?} {expected:?}");
        }
    }
    assert!(corners > 10, "{corners}");
}

/// A formula, so that friction is in the model.
#[test]
fn a_coefficient_of_zero_is_no_friction_in_space() {
    for scheme in [SCHEMES[0], SCHEMES[4]] {
        let none = finish(simulation(BALL, &of(scheme, "0.0")));
        let zero = finish(simulation(BALL, &of(scheme, "\"0*t\"")));
        assert!(zero.model().contacts[0].friction.is_some());
        assert_eq!(zero.state().ledger.friction_work, 0.0, "{scheme}");
        let worst =
            none.state().y.iter().zip(&zero.state().y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-9, "{scheme}: {worst:e}");
    }
}

#[test]
fn a_resumed_run_with_friction_in_space_ends_with_the_same_bits() {
    for scheme in [SCHEMES[0], SCHEMES[2], SCHEMES[3], SCHEMES[4], SCHEMES[5]] {
        let mut sets = of(scheme, "0.2");
        sets.push("time.end=0.02".into());
        let mut whole = simulation(BALL, &sets);
        let mut checkpoint = None;
        while !whole.finished() {
            let closed = whole.state().pairs[0].iter().any(|pair| pair.active);
            if checkpoint.is_none() && closed {
                checkpoint = Some(postcard::to_stdvec(whole.state()).unwrap());
            }
            whole.advance(&mut GridReport::default()).unwrap();
        }
        let state = postcard::from_bytes(&checkpoint.expect("contact")).unwrap();
        let resumed = finish(carom_run::Setup::new(&case_of(BALL, &sets)).resume(state).unwrap());
        assert_eq!(resumed.state(), whole.state(), "{scheme}");
    }
}

#[test]
fn threads_change_no_bit_of_an_impact_with_friction() {
    for scheme in [SCHEMES[0], SCHEMES[4], SCHEMES[5]] {
        let mut sets = of(scheme, "0.2");
        sets.push("time.end=0.02".into());
        let [one, two] = [1, 2].map(|threads| finish(on_threads(BALL, &sets, threads)));
        assert!(one.state().ledger.friction_work < 0.0, "{scheme}");
        assert!(one.state().y == two.state().y && one.state().v == two.state().v, "{scheme}");
    }
}

/// A block without transverse contraction, of which one side is held across its motion, slides, or
/// sticks on a slight slope: a tangent of the nodes of that side is held, and takes no part of
/// their cone.
#[test]
fn nodes_held_along_a_tangent_obey_the_law_along_the_other_one() {
    let block = |motion: &str, scheme: &str| {
        let step = if scheme.contains("central") { "1e-3" } else { "4e-3" };
        format!(
            r#"
dimension = 3
material = [{{ name = "stiff", law = "saint-venant-kirchhoff", density = 1.0, young = 1e3, poisson = 0.0 }}]
body = [{{ name = "block", material = "stiff", element = "Hex8", mass = "lumped", mesh = {{ shape = "box", min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 0.5], cells = [2, 2, 1] }}, {motion} }}]
support = [{{ on = ["block.left"], fix = ["x"] }}]
contact = [{{ name = "floor", secondary = "block.bottom", primary = {{ plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }} }}, mu = 0.3 }}]
time = {{ scheme = {scheme}, step = {step}, end = 0.06 }}
newton = {{ tolerance = 1e-12 }}
"#
        )
    };
    let slides = "velocity = [0.0, 1.0, 0.0], gravity = [0.0, 0.0, -10.0]";
    let leans = "gravity = [0.0, 1.0, -10.0]";
    for scheme in [SCHEMES[0], SCHEMES[4], SCHEMES[5]] {
        for motion in [slides, leans] {
            let mut sim = simulation(&block(motion, scheme), &[] as &[&str]);
            let mut sticks = 0;
            while !sim.finished() {
                sim.advance(&mut GridReport::default()).unwrap();
                for pair in sim.state().pairs[0].iter().filter(|pair| pair.active) {
                    sticks += usize::from(pair.tangential.friction_state == FrictionState::Stick);
                    let ([x, y, _], cone) = (traction_of(pair), 0.3 * pair.lambda.abs());
                    let node = sim.model().contacts[0].kinematics.secondary()[pair.node];
                    let least = if sim.model().reference[3 * node] == 0.0 { 0.0 } else { 1e-12 };
                    assert!(x.abs() <= least, "{scheme} {motion}: {pair:?}");
                    assert!(y.abs() <= cone * (1.0 + 1e-9), "{scheme} {motion}: {pair:?}");
                }
            }
            let [x, y, z] = sim.state().impulses[0];
            assert!(x.abs() < 1e-12 && z > 0.1, "{scheme} {motion}: {x} {z}");
            if motion == slides {
                assert!((y / z + 0.3).abs() < 1e-9, "{scheme}: {y} {z}");
            } else {
                assert!(sticks > 10 && y < 0.0 && y > -0.3 * z, "{scheme}: {sticks} {y} {z}");
            }
        }
    }
}

/// Where all of a contact slips, t = μp at every node, whatever the vibrations of the body, so that
/// J_T = μ J_N.
#[test]
#[ignore = "takes seconds: .ci/nightly"]
fn every_node_of_a_spinning_ball_has_the_force_of_slip() {
    let text = include_str!("../../../../cases/space/spinning-ball.toml");
    let mut sim = simulation(text, &["time.end=0.04", "newton.tolerance=1e-13"]);
    let mut slips = 0;
    while !sim.finished() {
        sim.advance(&mut GridReport::default()).unwrap();
        let active = || sim.state().pairs[0].iter().filter(|pair| pair.active);
        let largest = active().map(|pair| -pair.lambda).fold(0.0, f64::max);
        for pair in active() {
            let q = length(pair.tangential.traction);
            assert!(matches!(pair.tangential.friction_state, FrictionState::Slip(_)), "{pair:?}");
            assert!((q + 0.2 * pair.lambda).abs() <= 1e-10 * 0.2 * largest, "{pair:?} {largest}");
            slips += 1;
        }
    }
    assert!(slips > 25, "{slips}");
}

/// A limited traction has no impulse: nodes that close on a line along which a plane motion is
/// extruded go on alike, and none is stopped by a tensile impulse of the projection.
#[test]
fn a_limited_traction_leaves_what_is_extruded_uniform() {
    let text = r#"
dimension = 3
[[material]]
name = "m"
law = "yeoh"
density = 1.0
c10 = 160.0
c20 = -3.0
c30 = 2.0
bulk = 900.0
[[body]]
name = "block"
material = "m"
element = "Hex27"
mesh = { shape = "extrusion", of = { shape = "rectangle", min = [-0.6, 0.0213], max = [0.6, 0.42], cells = [5, 2] }, height = 1.0, layers = 1 }
velocity = { linear = [0.7, -1.0, 0.0], angular = [0.0, 0.0, 0.8], about = [0.0, 0.3, 0.0] }
gravity = ["0.4*sin(30*t)", "-5+t", "0"]
[[support]]
on = ["block.base", "block.lid"]
fix = ["z"]
[[contact]]
name = "floor"
secondary = "block.bottom"
primary = { plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0] } }
mu = 0.3
mu_dynamic = 0.15
decay = 1.5
shear = 3.0
[time]
end = 0.03
step = 0.002
scheme = { kind = "newmark", rho_inf = 1.0 }
energy_guard = false
"#;
    let sim = finish(simulation(text, &[""; 0]));
    let x = sim.model().reference.as_chunks::<3>().0;
    let v = sim.state().v.as_chunks::<3>().0;
    assert!(sim.state().pairs[0].iter().any(|pair| pair.active));
    for (first, other) in (0..x.len()).flat_map(|a| (0..a).map(move |b| (a, b))) {
        if (x[first][0] - x[other][0]).hypot(x[first][1] - x[other][1]) < 1e-12 {
            let apart = (v[first][0] - v[other][0]).hypot(v[first][1] - v[other][1]);
            assert!(apart < 1e-8, "{:?} {:?}: {apart:e}", x[first], x[other]);
        }
    }
}

/// A block is set down where its nodes lie over the diagonals of a table of triangles, which bend
/// under its weight: all of it rests on the table, and no step is rejected.
#[test]
fn a_block_comes_to_rest_over_kinks() {
    let text = r#"
dimension = 3
[[material]]
name = "m"
law = "neo-hookean"
density = 1.0
young = 1000.0
poisson = 0.3
[[body]]
name = "table"
material = "m"
element = "Tet4"
mesh = { shape = "box", min = [0.0, 0.0, -0.3], max = [1.0, 1.0, 0.0], cells = [4, 4, 1] }
[[body]]
name = "block"
material = "m"
element = "Hex8"
mesh = { shape = "box", min = [0.1, 0.1, 0.0], max = [0.4, 0.4, 0.3], cells = [3, 3, 1] }
gravity = [0.0, 0.0, -1.0]
[[support]]
on = ["table.bottom"]
fix = ["x", "y", "z"]
[[contact]]
name = "c"
secondary = "block.bottom"
primary = "table.top"
mu = 0.3
[time]
end = 4.0
step = 0.4
scheme = { kind = "backward-euler" }
energy_guard = false
"#;
    let mut sim = simulation(text, &[""; 0]);
    while !sim.finished() {
        let mut report = GridReport::default();
        sim.advance(&mut report).unwrap();
        assert_eq!(report.rejected, 0);
    }
    // The normals are vertical but for a fifth of a degree.
    let weight: f64 = -sim.state().pairs[0].iter().map(|pair| pair.lambda).sum::<f64>();
    assert!((weight - 0.027).abs() < 1e-6, "{weight}");
}
