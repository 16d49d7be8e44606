//! Friction: none for μ = 0; resumed runs; momentum and the ledger of two discs that
//! rub; Coulomb's law at every node; limits and coefficients that change.

use carom_contact::{FrictionState, Pair};
use carom_run::{GridReport, Setup, Simulation, State};

use super::common::{DISCS, case, change, finish, momenta, resumes_with_the_same_bits, simulation};
use super::rebound::record;

/// One of every family.
pub(super) const SCHEMES: [&str; 8] = [
    r#"{ kind = "chung-hulbert", rho_inf = 0.5 }"#,
    r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#,
    r#"{ kind = "hht", alpha = 0.1 }"#,
    r#"{ kind = "bathe", rho_inf = 0.5 }"#,
    r#"{ kind = "tr-bdf2" }"#,
    r#"{ kind = "energy-momentum" }"#,
    r#"{ kind = "central-difference" }"#,
    r#"{ kind = "moreau-jean", theta = 0.5 }"#,
];

fn discs(scheme: &str, mu: f64) -> Vec<String> {
    vec![format!("time.scheme={scheme}"), format!("contact.strike.mu={mu}"), "time.end=0.3".into()]
}

/// Until the first node opens; then round-off decides when nodes do.
#[test]
fn a_coefficient_of_zero_is_no_friction() {
    for scheme in SCHEMES {
        let mut sets = discs(scheme, 0.0);
        sets.push("newton.tolerance=1e-14".into());
        let without = &mut simulation(DISCS, &sets);
        // A formula, so that friction is in the model.
        sets[1] = "contact.strike.mu=\"0*t\"".into();
        let with = &mut simulation(DISCS, &sets);
        assert!(
            with.model().contacts[0].friction.is_some() && without.model().contacts[0].friction.is_none()
        );
        let (mut closed, mut opens) = (0, false);
        while !opens && !with.finished() {
            for sim in [&mut *with, &mut *without] {
                let before = sim.state().clone();
                sim.advance(&mut GridReport::default()).unwrap();
                opens |= before.pairs[0].iter().filter(|pair| pair.active).any(|old| {
                    let mut now = sim.state().pairs[0].iter().filter(|pair| pair.active);
                    !now.any(|pair| pair.node == old.node)
                });
            }
            if !opens {
                let [a, b] = [with.state(), without.state()];
                assert!(apart(&a.y, &b.y) < 1e-12 && apart(&a.v, &b.v) < 1e-12, "{scheme}: {}", a.time);
                closed += usize::from(a.pairs[0].iter().any(|pair| pair.active));
            }
        }
        assert!(closed > 2, "{scheme}");
        assert_eq!(with.state().ledger.friction_work, 0.0, "{scheme}");
    }
}

/// Nothing happens at once: the law is continuous at 0.
#[test]
fn a_little_friction_takes_a_little() {
    // Undamped, and with few nodes, which nodes are in contact depends on round-off.
    for scheme in SCHEMES.iter().filter(|scheme| !scheme.contains("newmark") && !scheme.contains("bathe")) {
        let [little, none] = [1e-10, 0.0].map(|mu| finish(simulation(DISCS, &discs(scheme, mu))));
        assert!(apart(&little.state().y, &none.state().y) < 1e-7, "{scheme}");
        assert!(little.state().ledger.friction_work < 0.0, "{scheme}");
    }
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Closed pairs that stick or that slip.
fn count(state: &State, stick: bool) -> usize {
    let counts =
        |pair: &&Pair| pair.active && (pair.tangential.friction_state == FrictionState::Stick) == stick;
    state.pairs[0].iter().filter(counts).count()
}

/// Resumed where some nodes stick and others slip.
#[test]
fn a_resumed_run_with_friction_continues_with_the_same_bits() {
    for scheme in SCHEMES {
        let sets = discs(scheme, 0.1);
        let both = |state: &State| count(state, false) > 0 && count(state, true) > 0;
        resumes_with_the_same_bits(DISCS, &sets, both);
    }
}

/// |q| ≤ μ|λ|, with equality in slip, and λ ≤ 0, at the end of every step; and momentum is that at
/// the start.
#[test]
fn every_node_obeys_the_law_and_momentum_is_conserved() {
    for scheme in SCHEMES {
        let mut sim = simulation(DISCS, &discs(scheme, 0.2));
        let before = momenta(&sim, &sim.state().v);
        let (mut sticks, mut slips) = (0, 0);
        while !sim.finished() {
            sim.advance(&mut GridReport::default()).unwrap();
            let pairs = &sim.state().pairs[0];
            let largest = pairs.iter().map(|pair| pair.lambda.abs()).fold(0.0, f64::max);
            for pair in pairs.iter().filter(|pair| pair.active) {
                assert!(pair.lambda <= 1e-9 * largest, "{scheme}: {pair:?}");
                let (q, cone) = (pair.tangential.traction[0], 0.2 * (-pair.lambda).max(0.0));
                assert!(q.abs() <= cone + 1e-9 * largest, "{scheme}: {pair:?}");
                match pair.tangential.friction_state {
                    FrictionState::Stick => sticks += 1,
                    friction_state @ FrictionState::Slip(_) => {
                        slips += 1;
                        assert!(
                            (q - friction_state.direction()[0] * cone).abs() <= 1e-9 * largest,
                            "{scheme}: {pair:?}"
                        );
                    }
                }
            }
        }
        assert!(sticks > 0 && slips > 0, "{scheme}: {sticks} {slips}");
        let after = momenta(&sim, &sim.state().v);
        for i in 0..2 {
            assert!((after[i] - before[i]).abs() < 1e-12, "{scheme}: {before:?} {after:?}");
        }
        assert!(lost(&sim) < 0.0, "{scheme}");
    }
}

pub(super) fn lost(sim: &Simulation) -> f64 {
    sim.state().ledger.friction_work
}

/// A block that is thrown along a plane, with other keys of its contact.
pub(super) fn block(contact: &str, scheme: &str) -> String {
    format!(
        r#"
title = "A block that slides"
dimension = 2
material = [{{ name = "stiff", law = "saint-venant-kirchhoff", density = 1.0, young = 1e4, poisson = 0.0 }}]
[[body]]
name = "block"
material = "stiff"
element = "T3"
mass = "lumped"
mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.1], cells = [4, 1] }}
velocity = [1.0, 0.0]
gravity = [0.0, -10.0]
[[contact]]
name = "floor"
secondary = "block.bottom"
primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}
{contact}
[time]
end = 0.2
step = 2e-4
scheme = {scheme}
"#
    )
}

/// Springs of the contact and of its nodes that stick.
pub(super) const SPRINGS: &str = "enforcement = \"penalty\"\nstiffness = 1.0";

fn impulses(contact: &str, scheme: &str) -> [f64; 3] {
    finish(simulation(&block(contact, scheme), &[] as &[&str])).state().impulse()
}

/// Tresca's law alone: every node that is pressed slips against τ times its area, whatever the
/// pressure. Beside Coulomb's law the smaller traction counts.
#[test]
fn a_limited_traction_is_that_stress_times_the_area() {
    for scheme in [SCHEMES[0], SCHEMES[5]] {
        // Of both laws, the one with the smaller traction: μ m g = 0.3, τ A = 0.05 or 5.
        let coulomb = impulses("mu = 0.3", scheme);
        let wide = impulses("mu = 0.3\nshear = 500.0", scheme);
        // A limited traction has no impulse where contact begins.
        assert!((coulomb[0] / wide[0] - 1.0).abs() < 1e-3, "{scheme}: {coulomb:?} {wide:?}");
        let narrow = finish(simulation(&block("mu = 0.3\nshear = 0.05", scheme), &[] as &[&str]));
        let closed = narrow.state().ledger.rubbed.contact_time / 5.0;
        let force = -narrow.state().impulse()[0];
        // Nodes lift off now and then; while all are closed, τ A = 0.05.
        assert!(
            force <= 0.05 * 0.2 + 1e-12 && (force / (0.05 * closed) - 1.0).abs() < 0.02,
            "{scheme}: {force}"
        );
        let alone = impulses("shear = 0.05", scheme)[0];
        assert!((alone + force).abs() < 2e-3 * force, "{scheme}: {alone} {force}");
    }
}

/// A block of the width 1 is dragged over a bed with τ = 0.1; in load steps, τ A.
const DRAGGED: &str = r#"
dimension = 2
material = [{ name = "steel", law = "linear-elastic", density = 1.0, young = 1e3, poisson = 0.0 }]
[[body]]
name = "block"
material = "steel"
element = "Q4"
mesh = { shape = "rectangle", min = [0.1, 0.0], max = [1.1, 0.2], cells = [2, 1] }
[[body]]
name = "bed"
material = "steel"
element = "Q4"
mesh = { shape = "rectangle", min = [-1.0, -0.2], max = [2.0, 0.0], cells = [36, 1] }
[[support]]
name = "ground"
on = ["bed.bottom"]
fix = ["x", "y"]
[[support]]
on = ["block.top"]
move = { x = "0.02*max(t - 1, 0)", y = "-0.002*min(t, 1)" }
[[contact]]
name = "drag"
secondary = "bed.top"
primary = "block.bottom"
shear = 0.1
[time]
end = 2.0
step = 0.1
scheme = { kind = "static" }
"#;

/// The area is that of the nodes of the secondary side under the block: corners of the primary side
/// add none.
#[test]
fn corners_of_the_primary_side_add_no_area() {
    let run = record(DRAGGED, &[]);
    let force = -run.column("ground.reaction_x").unwrap().last().unwrap();
    // At each end the corner may bear in place of a node, that is, of a facet of the length 1/12.
    assert!((force.abs() - 0.1).abs() < 0.1 * 2.0 / 12.0, "{force}");
}

/// Where nodes without an area bear, or nodes have several rows.
#[test]
fn areas_that_are_not_those_of_the_contact_are_told() {
    let told = |text: &str, sets: &[&str]| {
        let warnings = record(text, sets).manifest.warnings;
        let found = warnings.into_iter().filter(|warning| warning.id == "shear-area");
        found.map(|warning| warning.what).collect::<Vec<_>>().join("; ")
    };
    let block = ["contact.drag.secondary=block.bottom", "contact.drag.primary=bed.top"];
    assert_eq!(told(DRAGGED, &block), "");
    let bears = "of the contact force acts at nodes that have no area";
    assert!(told(DRAGGED, &[]).contains(bears));
    let mortar = ["contact.drag.method=mortar", "body.bed.mesh.cells=[6, 1]"];
    assert!(told(DRAGGED, &[block, mortar].concat()).contains(bears));
    // In space, nodes over joints of the bed, whose facets match.
    let in_space = DRAGGED
        .replace("dimension = 2", "dimension = 3")
        .replace("Q4", "Hex8")
        .replace("rectangle", "box")
        .replace(
            "min = [0.1, 0.0], max = [1.1, 0.2], cells = [2, 1]",
            "min = [0.0, 0.0, 0.0], max = [1.0, 1.0, 0.2], cells = [2, 2, 1]",
        )
        .replace(
            "min = [-1.0, -0.2], max = [2.0, 0.0], cells = [36, 1]",
            "min = [-0.5, -0.5, -0.2], max = [2.0, 1.5, 0.0], cells = [5, 4, 1]",
        )
        .replace("fix = [\"x\", \"y\"]", "fix = [\"x\", \"y\", \"z\"]")
        .replace(
            "move = { x = \"0.02*max(t - 1, 0)\", y = ",
            "move = { x = \"0.02*max(t - 1, 0)\", y = \"0\", z = ",
        )
        .replace("shear = 0.1", "shear = 0.1\nenforcement = \"penalty\"\nstiffness = 100.0");
    // Springs over joints are one; with multipliers, nodes in the dent have a row with each facet.
    assert_eq!(told(&in_space, &block), "");
    let rows = told(
        &in_space.replace("enforcement = \"penalty\"\nstiffness = 100.0", "enforcement = \"multiplier\""),
        &block,
    );
    assert!(rows.contains("nodes over joints of the primary side have several rows"), "{rows}");
}

/// At a sharp edge the area of a node would be that of both faces.
#[test]
fn a_limited_traction_needs_a_side_without_edges() {
    let skin = case(DRAGGED, &["contact.drag.secondary=block.skin", "contact.drag.primary=bed.top"]);
    let refused = format!("{:?}", Setup::new(&skin).build().err().unwrap());
    assert!(refused.contains("facets of side block.skin meet at more than 60°"), "{refused}");
}

/// dv/dt = −g [μ_d + (μ_s − μ_d) exp(−c v)] has the closed solution
/// exp(c v) = ((μ_d e^{c v₀} + Δμ) e^{−c μ_d g t} − Δμ)/μ_d.
#[test]
fn a_coefficient_may_depend_on_the_rate_of_slip() {
    let (dynamic, rest, c) = (0.1_f64, 0.2_f64, 2.0_f64);
    let at =
        |t: f64| (((dynamic * c.exp() + rest) * (-c * dynamic * 10.0 * t).exp() - rest) / dynamic).ln() / c;
    let law = "mu = 0.3\nmu_dynamic = 0.1\ndecay = 2.0";
    let on_springs = &format!("{law}\n{SPRINGS}");
    for (contact, scheme) in
        [0, 3, 5, 6, 7].map(|k| (law, SCHEMES[k])).into_iter().chain([(on_springs.as_str(), SCHEMES[0])])
    {
        let sim = finish(simulation(&block(contact, scheme), &[] as &[&str]));
        let velocity = momenta(&sim, &sim.state().v)[0] / 0.1;
        assert!((velocity - at(0.2)).abs() < 2e-3, "{scheme}: {velocity} {}", at(0.2));
    }
}

/// Without inertia.
const RESTS: [&str; 2] = ["body.block.velocity=[0.0, 0.0]", "body.block.gravity=[0.0, 0.0]"];

/// F_T = μ_d F_N of a block that is pressed and dragged without inertia, at the rate of its motion.
#[test]
fn load_steps_slip_against_the_coefficient_of_the_rate_in_their_time() {
    let support = r#"
[[support]]
name = "grip"
on = ["block.top"]
move = { x = "0.05*t", y = "-0.001*min(t, 1)" }
[time]"#;
    for (decay, expected) in [("", 0.1), ("decay = 1e3", 0.1), ("decay = 0.2", 0.1 + 0.2 * (-0.01_f64).exp())]
    {
        let contact = format!("mu = 0.3\nmu_dynamic = 0.1\n{decay}");
        let text = block(&contact, r#"{ kind = "static" }"#).replace("[time]", support);
        let sets = ["time.end=3.0", "time.step=0.1", RESTS[0], RESTS[1]];
        let sim = finish(simulation(&text, &sets));
        let [along, normal, _] = sim.state().contact_forces[0];
        assert!((-along / normal - expected).abs() < 1e-9, "{decay}: {along} {normal}");
    }
}

/// A block that strikes the plane, or lies on it, and slides: J_T = μ_d J_N from the first touch.
#[test]
fn a_node_that_touches_while_it_slides_slips_from_the_start() {
    let schemes = [
        SCHEMES[0],
        SCHEMES[3],
        SCHEMES[5],
        SCHEMES[6],
        SCHEMES[7],
        r#"{ kind = "paoli-schatzman" }"#,
        r#"{ kind = "moreau-jean", theta = 1.0 }"#,
        r#"{ kind = "nonsmooth-generalized-alpha", rho_inf = 0.8 }"#,
    ];
    for scheme in schemes {
        let text = block("mu = 0.3\nmu_dynamic = 0.1", scheme);
        let above = raised(&text);
        let strikes = ["body.block.velocity=[5.0, -1.0]", "body.block.gravity=[0.0, 0.0]", "time.end=0.05"];
        let lies = ["body.block.velocity=[5.0, 0.0]"];
        for (text, sets) in [(&above, &strikes[..]), (&text, &lies[..])] {
            let [along, normal, _] = finish(simulation(text, sets)).state().impulse();
            assert!(normal > 0.05 && (-along / normal - 0.1).abs() < 1e-10, "{scheme}: {along} {normal}");
        }
    }
}

/// The block above the plane.
fn raised(text: &str) -> String {
    text.replace("min = [0.0, 0.0], max = [1.0, 0.1]", "min = [0.0, 0.01], max = [1.0, 0.11]")
}

/// J_T = μ J_N in full slip for every e, and nothing but friction takes energy for e = 1.
#[test]
fn restitution_of_the_conserving_constraint_obeys_the_law() {
    for restitution in [0.0, 0.5, 1.0] {
        let contact = format!("mu = 0.1\nrestitution = {restitution:?}");
        let text = raised(&block(&contact, SCHEMES[5]));
        let sets = ["body.block.velocity=[5.0, -1.0]", "body.block.gravity=[0.0, 0.0]", "time.end=0.05"];
        let sim = finish(simulation(&text, &sets));
        let (ledger, [along, normal, _]) = (&sim.state().ledger, sim.state().impulse());
        assert!((-along / normal - 0.1).abs() < 1e-10, "{restitution}: {along} {normal}");
        let momentum = momenta(&sim, &sim.state().v);
        assert!((momentum[0] - 0.5 - along).abs() < 1e-11, "{momentum:?} {along}");
        assert!(ledger.dissipation().abs() < 1e-11, "{ledger:?}");
        assert!(restitution < 1.0 || (ledger.contact_work + ledger.owed).abs() < 1e-11, "{ledger:?}");
        assert!(restitution > 0.0 || ledger.contact_work < 0.0, "{ledger:?}");
    }
}

/// Where next to nothing is owed, nodes that have opened are not stopped: J_T = μ J_N whatever the
/// last digits of the speed are.
#[test]
fn restitution_stops_no_node_without_pressure() {
    let text = raised(&block("mu = 0.1\nrestitution = 0.5", SCHEMES[5]));
    for digit in 0..20 {
        let speed = 1.0 + 1e-13 * f64::from(digit);
        let sets = [
            format!("body.block.velocity=[5.0, -{speed:?}]"),
            "body.block.gravity=[0.0, 0.0]".into(),
            "time.end=0.05".into(),
        ];
        let [along, normal, _] = finish(simulation(&text, &sets)).state().impulse();
        assert!((-along / normal - 0.1).abs() < 1e-10, "{digit}: {along} {normal}");
    }
}

/// For large μ, with nodes that close in many steps.
#[test]
fn friction_of_a_conserving_contact_never_does_positive_work() {
    let sets = [
        "time.step=2e-3",
        "material.stiff.poisson=0.3",
        "body.block.mass=consistent",
        "body.block.mesh.max=[1.0, 0.2]",
        "body.block.mesh.cells=[4, 2]",
    ];
    for mu in [0.9, 2.0] {
        let mut sim = simulation(&block(&format!("mu = {mu}\npersistency = \"none\""), SCHEMES[5]), &sets);
        let (mut work, mut closes) = (0.0, 0_u32);
        while !sim.finished() {
            let mut report = GridReport::default();
            sim.advance(&mut report).unwrap();
            let now = lost(&sim);
            assert!(now <= work + 1e-13, "{mu} {}: {:e}", sim.state().time, now - work);
            (work, closes) = (now, closes + report.activations);
        }
        assert!(work < 0.0 && closes > 10, "{mu}: {work} {closes}");
    }
}

/// On a plane it is the motion along it of each node, from the touch.
#[test]
fn the_recorded_slip_is_what_follows_the_touch() {
    for scheme in &SCHEMES[..6] {
        let text = block("mu = 0.1", scheme);
        let mut sim = simulation(&text, &["time.step=0.02"]);
        sim.advance(&mut GridReport::default()).unwrap();
        let (state, contact) = (sim.state(), &sim.model().contacts[0]);
        let mut closed = 0;
        for pair in state.pairs[0].iter().filter(|pair| pair.active) {
            let dof = 2 * contact.kinematics.secondary()[pair.node];
            let moved = state.y[dof] - sim.model().reference[dof];
            // Its direction is that of the plane, along −x.
            assert!((pair.tangential.slip[0] + moved).abs() < 1e-12, "{scheme}: {pair:?} {moved}");
            closed += 1;
        }
        assert!(closed > 0, "{scheme}");
        // Half of the step.
        let mut sim = simulation(&raised(&text), &["time.step=0.02", "body.block.velocity=[1.0, -1.0]"]);
        sim.advance(&mut GridReport::default()).unwrap();
        let farthest = sim.state().ledger.rubbed.farthest;
        assert!((0.008..0.0111).contains(&farthest), "{scheme}: {farthest}");
    }
}

/// Zero wins over `shear`: the traction is the smaller one.
#[test]
fn a_coefficient_of_zero_with_a_limit_is_no_friction() {
    for mu in ["0", "\"0\"", "1e-12"] {
        let [along, normal, _] = impulses(&format!("mu = {mu}\nshear = 1.0"), SCHEMES[3]);
        assert!(along.abs() <= 2e-12 * normal && normal > 0.1, "{mu}: {along} {normal}");
    }
}

/// The coefficient of a place is that of its reference position, however far it has slid.
#[test]
fn a_coefficient_that_depends_on_the_place() {
    let sim = finish(simulation(&block("mu = \"0.2 + 0.3*X\"", SCHEMES[3]), &[""; 0]));
    let (model, mut slipping) = (sim.model(), 0);
    let nodes = model.contacts[0].kinematics.secondary();
    for pair in sim.state().pairs[0].iter().filter(|pair| pair.active && pair.lambda < 0.0) {
        if matches!(pair.tangential.friction_state, FrictionState::Slip(_)) {
            let mu = 0.2 + 0.3 * model.reference[2 * nodes[pair.node]];
            let ratio = pair.tangential.traction[0].abs() / -pair.lambda;
            assert!((ratio - mu).abs() < 1e-10, "{ratio} {mu}");
            slipping += 1;
        }
    }
    assert!(slipping > 1, "{slipping}");
}

#[test]
fn a_negative_coefficient_stops_the_run_by_its_name() {
    let text = block("mu = \"0.3 - 10*t\"", SCHEMES[3]);
    let mut sim = simulation(&text, &["time.step=5e-3"]);
    let stopped = loop {
        if let Err(stopped) = sim.advance(&mut GridReport::default()) {
            break stopped.to_string();
        }
    };
    // 0.3 − 10 t is −5.6e-17 at t = 0.03, which is zero.
    let expected = "the step at t = 0.030000 [time] of Δt = 5.000e-3 [time] is rejected: mu of contact \"floor\" is negative at X = ";
    assert!(stopped.starts_with(expected), "{stopped}");
}

/// Drawn by a force along the plane that grows beyond what the weight holds.
#[test]
fn load_steps_that_exceed_what_friction_can_hold_say_so() {
    let pull = r#"
[[load]]
name = "pull"
on = ["block.top"]
traction = ["0.1*t", "-min(t, 1)"]
[time]"#;
    let text = block("mu = 0.25", r#"{ kind = "static" }"#).replace("[time]", pull);
    let mut sim = simulation(&text, &["time.end=6", "time.step=1", RESTS[0], RESTS[1]]);
    let stopped = loop {
        if let Err(stopped) = sim.advance(&mut GridReport::default()) {
            break stopped.to_string();
        }
        assert!(sim.state().time < 2.6);
    };
    let expected =
        "free to move along x: its closed contacts slip, and the load exceeds what friction can carry";
    assert!(stopped.contains(expected), "{stopped}");
}

/// From nothing: what a gap is closed to is more than the body moves at first.
#[test]
fn a_body_at_rest_whose_weight_grows_creates_no_energy() {
    let load = r#"
[[load]]
name = "weight"
body = "block"
body_force = ["0", "-1e4*t^3"]
[time]"#;
    for mu in ["", "mu = 0.3"] {
        let text = block(mu, SCHEMES[6]).replace("[time]", load);
        let mut sim = simulation(&text, &["time.end=0.02", "time.step=1e-4", RESTS[0], RESTS[1]]);
        while !sim.finished() {
            // The guard would stop it.
            sim.step().unwrap();
        }
        let [_, normal, _] = sim.state().impulse();
        // ∫ 1e4 t³ dt, times the mass: the block rests.
        assert!((normal / (0.1 * 1e4 * 0.02_f64.powi(4) / 4.0) - 1.0).abs() < 0.05, "{mu}: {normal}");
    }
}

/// Its forces are round-off, which need not balance.
#[test]
fn friction_does_not_stop_a_body_in_free_flight() {
    let text = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 1932.41, poisson = 0.3 }]
body = [{ name = "a", material = "m", element = "T3", mesh = { shape = "disc", radius = 0.2443, center = [0.11105, 1.43209], size = 0.0814 }, velocity = [0.0, -1.2201] }]
contact = [{ name = "floor", secondary = "a.arc", primary = { plane = { point = [0.0, -1e3], normal = [0.0, 1.0] } }, mu = 0.3 }]
time = { end = 0.076, step = 0.00076, scheme = { kind = "bathe", rho_inf = 0.5 } }
"#;
    let sim = finish(simulation(text, &[""; 0]));
    let model = sim.model();
    for (dof, y) in sim.state().y.iter().enumerate() {
        let exact = model.reference[dof] - if dof % 2 == 1 { 1.2201 * 0.076 } else { 0.0 };
        assert!((y - exact).abs() < 1e-12, "{dof}: {y} {exact}");
    }
}

/// In a plane of symmetry a node moves along the plane only. Where the facet below it leans, its
/// slip depends on its gap, and the problem of stick and slip is singular.
#[test]
fn a_half_model_rubs_with_explicit_and_impulse_schemes() {
    let case = include_str!("../../../../cases/impact/impact.toml");
    // The cylinder has fallen for so long, and reaches the prism at 0.32 s.
    let fall: f64 = 0.3;
    for scheme in [r#"{ kind = "central-difference" }"#, r#"{ kind = "moreau-jean", theta = 0.5 }"#] {
        let sets = [
            &format!("time={{ scheme = {scheme}, step = 3.75e-4, end = {:?} }}", 0.345 - fall),
            "expect=[]",
            "contact.strike.mu=0.3",
            "body.cylinder.mass=lumped",
            "body.prism.mass=lumped",
        ];
        let mut sim = simulation(case, &sets);
        let nodes = sim.model().parts[0].nodes();
        change(&mut sim, |state| {
            for node in nodes {
                state.y[2 * node + 1] -= 0.5 * 9.81 * fall * fall;
                state.v[2 * node + 1] -= 9.81 * fall;
            }
        });
        // The energies of the given state are those after its first step.
        sim.advance(&mut GridReport::default()).unwrap();
        let mut rubs = 0;
        while !sim.finished() {
            let before = sim.state().ledger.total();
            sim.advance(&mut GridReport::default()).unwrap();
            let state = sim.state();
            assert!(state.ledger.total() < before + 1e-3 * state.ledger.kinetic.abs(), "{}", state.time);
            let touching = state.pairs[0].iter().filter(|pair| pair.active);
            rubs += touching.filter(|pair| pair.tangential.traction != [0.0; 2]).count();
        }
        assert!(rubs > 10, "{scheme}: {rubs}");
    }
}

/// A support along x of a straight side leaves a rotation free to first order, until the side has
/// moved. Its reactions then have a moment, and the forces without them none of their own.
#[test]
fn a_block_whose_support_leaves_a_rotation_to_first_order_is_pressed_on_a_rough_plane() {
    let text = r#"
        dimension = 2
        plane = "strain"
        material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 1000.0, poisson = 0.3 }]
        support = [{ on = ["u.top"], fix = ["x"] }]
        load = [{ on = ["u.top"], traction = ["0", "-1"] }]
        time = { end = 1.0, step = 0.05, scheme = { kind = "backward-euler" } }
        [[body]]
        name = "u"
        material = "m"
        element = "T6"
        mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [1, 1] }
        [[contact]]
        name = "c"
        secondary = "u.bottom"
        primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
        mu = 0.3
    "#;
    let force = finish(simulation(text, &[""; 0])).state().contact_forces[0][1];
    // The load, once the block rests: backward Euler damps its vibration.
    assert!((force.abs() - 1.0).abs() < 1e-3, "{force}");
}

/// A block that strikes a plane with v_t = μ v_n, at the edge between stick and slip: friction
/// takes energy, and its impulse is at most μ times the normal one in every row.
#[test]
fn friction_at_the_edge_of_stick_takes_energy() {
    let midpoint = "kind = \"energy-momentum\"";
    let trapezoidal = "kind = \"newmark\", rho_inf = 1.0";
    for (scheme, element) in [(midpoint, "T6"), (midpoint, "T3"), (trapezoidal, "T6")] {
        for enforcement in ["multiplier", "augmented"] {
            let sets = [
                format!("time.scheme={{ {scheme} }}"),
                format!("body.a.element={element}"),
                format!("contact.c.enforcement={enforcement}"),
            ];
            let run = record(OBLIQUE, &sets.each_ref().map(String::as_str));
            let column = |name: &str| run.column(name).unwrap();
            let work = column("friction_work").iter().copied().fold(0.0, f64::max);
            assert!(work < 1e-6, "{scheme} {element} {enforcement}: {work}");
            for (along, across) in column("contact_impulse_x").iter().zip(column("contact_impulse_y")) {
                assert!(
                    along.abs() <= 0.6 * across + 1e-9,
                    "{scheme} {element} {enforcement}: {along} {across}"
                );
            }
        }
    }
}

const OBLIQUE: &str = r#"
dimension = 2
plane = "stress"
thickness = 0.6
material = [{ name = "m", law = "neo-hookean", density = 1.3, young = 100.0, poisson = 0.3 }]
[[body]]
name = "a"
material = "m"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.5, 0.4], cells = [6, 2] }
velocity = [0.6, -1.0]
place = { shift = [0.0, 0.01] }
[[contact]]
name = "c"
secondary = "a.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
mu = 0.6
[time]
end = 0.02
step = 0.001
scheme = { kind = "energy-momentum" }
[output]
fields_every = 0
"#;

/// A block that slides on a floor whose coefficient grows, μ = 0.2 + 0.4 t, has the velocity v₀ −
/// g(0.2 t + 0.2 t²). With `energy-momentum`, whose contact forces are means over a step, the
/// coefficient is that in its middle; that of its end would give 0.01 less.
#[test]
fn a_coefficient_that_grows_is_exact_to_second_order() {
    let text = r#"
dimension = 2
material = [{ name = "stiff", law = "saint-venant-kirchhoff", density = 1.0, young = 1e6, poisson = 0.3 }]
[[body]]
name = "block"
material = "stiff"
element = "Q4"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.2], cells = [4, 1] }
velocity = [3.0, 0.0]
gravity = [0.0, -10.0]
[[contact]]
name = "floor"
secondary = "block.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
mu = "0.2 + 0.4*t"
[time]
end = 0.5
step = 0.01
scheme = { kind = "energy-momentum" }
"#;
    for scheme in [SCHEMES[0], SCHEMES[3], SCHEMES[5]] {
        let run = finish(simulation(text, &[format!("time.scheme={scheme}")]));
        let velocity = momenta(&run, &run.state().v)[0] / 0.2;
        assert!((velocity - 1.5).abs() < 4e-4, "{scheme}: {velocity}");
    }
}

/// A block falls flat on a rough floor. The trapezoidal rule, which is the midpoint rule in other
/// variables, loses nothing: what is lost is the work of contact and friction, also where an
/// impulse of both closes the gaps.
#[test]
fn friction_of_a_node_that_closes_is_counted_once() {
    let text = r#"
dimension = 2
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 1e4, poisson = 0.3 }]
[[body]]
name = "block"
material = "m"
element = "Q4"
mesh = { shape = "rectangle", min = [-1.0, 0.0], max = [1.0, 0.1], cells = [10, 1] }
velocity = [1.0, -0.5]
gravity = [0.0, -5.0]
[[contact]]
name = "floor"
secondary = "block.bottom"
primary = { plane = { point = [0.0, -0.01], normal = [0.0, 1.0] } }
mu = 0.3
[time]
end = 0.03
step = 5e-4
scheme = { kind = "newmark", beta = 0.25, gamma = 0.5 }
energy_guard = false
"#;
    for scheme in [
        r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#,
        r#"{ kind = "chung-hulbert", rho_inf = 1.0 }"#,
        r#"{ kind = "energy-momentum" }"#,
    ] {
        let run = finish(simulation(text, &[format!("time.scheme={scheme}")]));
        let ledger = &run.state().ledger;
        let energy = 0.5 * 0.2 * 1.25;
        assert!(ledger.friction_work < -0.03 * energy, "{scheme}: {:e}", ledger.friction_work);
        assert!(ledger.dissipation().abs() < 3e-3 * energy, "{scheme}: {:e}", ledger.dissipation());
    }
}
