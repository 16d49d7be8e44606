//! Augmented Lagrangians end where multipliers do, whatever their springs; and what holds for
//! multipliers: resumed runs, momentum, the ledger, no friction for μ = 0.

use carom_contact::FrictionState;
use carom_run::{GridReport, Simulation, State};

use super::common::{DISCS, finish, momenta, resumes_with_the_same_bits, simulation};
use super::space_contact::{self, BALL};

/// One of every family of implicit schemes; undamped ones with few nodes amplify round-off.
const SCHEMES: [&str; 5] = [
    r#"{ kind = "chung-hulbert", rho_inf = 0.5 }"#,
    r#"{ kind = "hht", alpha = 0.1 }"#,
    r#"{ kind = "bathe", rho_inf = 0.0 }"#,
    r#"{ kind = "tr-bdf2" }"#,
    r#"{ kind = "energy-momentum" }"#,
];

fn discs(scheme: &str, enforcement: &str, mu: &str) -> Vec<String> {
    vec![
        format!("time.scheme={scheme}"),
        format!("contact.strike.enforcement={enforcement}"),
        format!("contact.strike.mu={mu}"),
        "time.end=0.3".into(),
    ]
}

/// Largest differences of positions and of velocities.
fn apart(a: &Simulation, b: &Simulation) -> [f64; 2] {
    let largest = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    [largest(&a.state().y, &b.state().y), largest(&a.state().v, &b.state().v)]
}

/// From the same state in every step: over many steps, schemes with little damping amplify the
/// tolerances of both. A step that one of them bisected has the answer of shorter steps.
#[test]
#[ignore = "takes seconds: .ci/nightly"]
fn every_step_is_that_of_multipliers() {
    for (k, scheme) in SCHEMES.into_iter().enumerate() {
        // The search for friction contains that for pressures.
        for mu in if k % 2 == 0 { &["0.0", "0.2"][..] } else { &["0.2"] } {
            let run = |enforcement: &str| simulation(DISCS, &discs(scheme, enforcement, mu));
            let (mut exact, mut augmented) = (run("multiplier"), run("augmented"));
            let mut closed = 0;
            let mut rubbed = 0.0;
            let mut bisected = 0;
            while !exact.finished() {
                augmented.restore(exact.state().clone()).unwrap();
                let mut report = GridReport::default();
                exact.advance(&mut report).unwrap();
                augmented.advance(&mut report).unwrap();
                if report.rejected > 0 {
                    bisected += 1;
                    continue;
                }
                let [place, speed] = apart(&exact, &augmented);
                // The tolerance of gaps is 1e-10, and that of velocities over a step 1e-7.
                assert!(place < 1e-9 && speed < 1e-6, "{scheme} {mu}: {place:e} {speed:e}");
                // And that of works: of the velocities, times the momentum, which is 0.3.
                let [a, b] = [&exact, &augmented].map(|sim| &sim.state().ledger);
                let works = [
                    a.contact_work - b.contact_work,
                    a.friction_work - b.friction_work,
                    a.dissipation() - b.dissipation(),
                ];
                assert!(works.iter().all(|work| work.abs() < 1e-7), "{scheme} {mu}: {works:?}");
                let b = augmented.state();
                assert_eq!(b.ledger.springs, 0.0);
                closed += usize::from(b.pairs[0].iter().any(|pair| pair.active));
                rubbed = b.ledger.friction_work;
            }
            assert!(closed > 10 && (rubbed < 0.0) == (*mu != "0.0"), "{scheme} {mu}: {closed} {rubbed}");
            assert!(bisected <= 1, "{scheme} {mu}: {bisected}");
        }
    }
}

/// Over six orders of magnitude of their stiffness, with the same nodes in the same states. Where a
/// step was bisected, the answer is that of shorter steps: the first round of very soft springs may
/// cycle between stick and slip.
#[test]
fn the_springs_do_not_matter() {
    let states = |sim: &Simulation| {
        let pairs = sim.state().pairs[0].iter().filter(|pair| pair.active);
        pairs
            .map(|pair| (pair.node, pair.tangential.friction_state == FrictionState::Stick))
            .collect::<Vec<_>>()
    };
    let mut exact = simulation(DISCS, &discs(SCHEMES[0], "multiplier", "0.2"));
    let mut others: Vec<Simulation> = ["1e-2", "1.0", "1e2", "1e4"]
        .iter()
        .map(|stiffness| {
            let mut sets = discs(SCHEMES[0], "augmented", "0.2");
            sets.push(format!("contact.strike.stiffness={stiffness}"));
            simulation(DISCS, &sets)
        })
        .collect();
    let (mut both, mut bisected) = ([false; 2], [0; 4]);
    while !exact.finished() {
        let before = exact.state().clone();
        let mut report = GridReport::default();
        exact.advance(&mut report).unwrap();
        assert_eq!(report.rejected, 0);
        let expected = states(&exact);
        expected.iter().for_each(|(_, sticks)| both[usize::from(*sticks)] = true);
        for (k, other) in others.iter_mut().enumerate() {
            other.restore(before.clone()).unwrap();
            let mut report = GridReport::default();
            other.advance(&mut report).unwrap();
            if report.rejected > 0 {
                bisected[k] += 1;
                continue;
            }
            assert_eq!(states(other), expected, "{k}: {}", exact.state().time);
            let [place, _] = apart(&exact, other);
            assert!(place < 1e-9, "{k}: {place:e}");
        }
    }
    assert_eq!(both, [true; 2]);
    assert!(bisected[0] <= 1 && bisected[1..] == [0; 3], "{bisected:?}");
}

#[test]
fn a_resumed_run_continues_with_the_same_bits() {
    for scheme in SCHEMES {
        let sets = discs(scheme, "augmented", "0.1");
        let touches = |state: &State| state.pairs[0].iter().any(|pair| pair.active);
        resumes_with_the_same_bits(DISCS, &sets, touches);
    }
}

#[test]
fn momentum_is_conserved() {
    for scheme in SCHEMES {
        let start = simulation(DISCS, &discs(scheme, "augmented", "0.2"));
        let before = momenta(&start, &start.state().v);
        let with = finish(start);
        let after = momenta(&with, &with.state().v);
        for i in 0..2 {
            assert!((after[i] - before[i]).abs() < 1e-12, "{scheme}: {before:?} {after:?}");
        }
        assert!(with.state().ledger.friction_work < 0.0, "{scheme}");
    }
}

#[test]
fn a_coefficient_of_zero_is_no_friction() {
    // A formula, so that friction is in the model.
    let run = |mu: &str| simulation(DISCS, &discs(SCHEMES[0], "augmented", mu));
    let (mut zero, mut none) = (run("\"0*t\""), run("0.0"));
    while !none.finished() {
        for sim in [&mut zero, &mut none] {
            sim.advance(&mut GridReport::default()).unwrap();
        }
        let [place, speed] = apart(&zero, &none);
        assert!(place < 1e-8 && speed < 1e-6, "{place:e} {speed:e}");
    }
    assert_eq!(zero.state().ledger.friction_work, 0.0);
}

/// Directions of slips are unknowns, as with multipliers.
#[test]
fn in_space_the_answer_is_that_of_multipliers_too() {
    for scheme in [SCHEMES[0], SCHEMES[4]] {
        let run = |enforcement: &str| {
            let mut sets = vec![
                format!("time.scheme={scheme}"),
                "contact.strike.mu=0.2".into(),
                format!("contact.strike.enforcement={enforcement}"),
                "time.end=0.03".into(),
            ];
            if scheme.contains("energy") {
                sets.push("material.rubber.law=\"saint-venant-kirchhoff\"".into());
            }
            finish(simulation(BALL, &sets))
        };
        let (exact, augmented) = (run("multiplier"), run("augmented"));
        let [place, speed] = apart(&exact, &augmented);
        assert!(place < 1e-8 && speed < 1e-6, "{scheme}: {place:e} {speed:e}");
        let before = space_contact::momenta(&simulation(BALL, &[] as &[&str]));
        let after = space_contact::momenta(&augmented);
        for i in 0..3 {
            assert!((after[i] - before[i]).abs() < 1e-11, "{scheme}: {before:?} {after:?}");
        }
        let [a, b] = [&exact, &augmented].map(|sim| sim.state().ledger.friction_work);
        assert!(a < 0.0 && (a - b).abs() < 1e-8, "{scheme}: {a} {b}");
    }
}

/// Where supports hold the nodes of both sides, there is nothing to find.
#[test]
fn what_cannot_close_is_said() {
    let text = r#"
dimension = 2
[[material]]
name = "rubber"
law = "linear-elastic"
density = 1.0
young = 1.0
poisson = 0.0
[[body]]
name = "block"
material = "rubber"
element = "T3"
mesh = { shape = "rectangle", min = [0.0, 0.1], max = [1.0, 1.1], cells = [2, 2] }
[[support]]
on = ["block.bottom"]
move = { x = "0", y = "-0.3*t" }
[[contact]]
name = "floor"
secondary = "block.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
enforcement = "augmented"
[time]
end = 1.0
step = 0.5
scheme = { kind = "static" }
"#;
    let mut sim = simulation(text, &[] as &[&str]);
    let error = loop {
        if let Err(error) = sim.advance(&mut GridReport::default()) {
            break error.to_string();
        }
    };
    assert!(
        error.contains("did not close its contacts in") || error.contains("prevent it from moving"),
        "{error}"
    );
}

/// Where a corner of one side is beside a node of the other, the rows of both are nearly the same,
/// and the gaps that rounds leave tell them apart. A drop onto a layer that rubs loses what it
/// loses with multipliers: velocities were projected with huge impulses of opposite signs, each of
/// which rubbed, so that friction took up to 96 % of the energy or gave 20 %.
#[test]
fn corners_beside_nodes_do_not_rub_against_each_other() {
    let drop = |low: [f64; 2], cells: [usize; 2], method: &str, scheme: &str| {
        let [block, layer] = low;
        let [of_block, of_layer] = cells;
        let symmetry = if block == 0.0 { ", { on = [\"p.left\", \"b.left\"], fix = [\"x\"] }" } else { "" };
        format!(
            r#"
            dimension = 2
            material = [
              {{ name = "hard", law = "neo-hookean", density = 1000.0, young = 4e6, poisson = 0.4 }},
              {{ name = "soft", law = "neo-hookean", density = 1000.0, young = 1e6, poisson = 0.3 }},
            ]
            support = [{{ on = ["p.bottom"], fix = ["x", "y"] }}{symmetry}]
            contact = [{{ name = "k", secondary = "b.bottom", primary = "p.top", method = "{method}", mu = 0.2 }}]
            time = {{ end = 0.006, step = 0.0003, scheme = {scheme} }}
            [[body]]
            name = "b"
            material = "hard"
            element = "T3"
            mesh = {{ shape = "rectangle", min = [{block}, 0.0005], max = [0.3, 0.3], cells = [{of_block}, 2] }}
            velocity = [0.0, -1.5]
            [[body]]
            name = "p"
            material = "soft"
            element = "T3"
            mesh = {{ shape = "rectangle", min = [{layer}, -0.4], max = [0.8, 0.0], cells = [{of_layer}, 2] }}
            "#
        )
    };
    let cases = [
        drop([0.0, 0.0], [3, 8], "node-to-segment", "{ kind = \"bathe\", rho_inf = 0.5 }"),
        drop([-0.3, -0.8], [6, 16], "mortar", "{ kind = \"tr-bdf2\" }"),
    ];
    for case in cases {
        let [multiplier, augmented] = ["multiplier", "augmented"].map(|enforcement| {
            let end = finish(simulation(&case, &[format!("contact.k.enforcement={enforcement}")]));
            let ledger = &end.state().ledger;
            [ledger.friction_work, ledger.contact_work].map(|work| work / ledger.total_at_start)
        });
        for (one, other) in multiplier.iter().zip(&augmented) {
            assert!(*one < 0.0 && (one - other).abs() < 0.01, "{multiplier:?} {augmented:?}");
        }
    }
}

/// A block is pressed on another one and dragged: its nodes slide over joints of curved facets, and
/// where the springs of the first rounds have let them sink they come back to the facet over which
/// they lie. The force of every node is that with multipliers.
#[test]
fn nodes_that_slide_over_joints_have_the_forces_of_multipliers() {
    let text = r#"
dimension = 3
[[material]]
name = "soft"
law = "neo-hookean"
density = 1.0
young = 1.0
poisson = 0.3
[[material]]
name = "stiff"
law = "neo-hookean"
density = 1.0
young = 3.0
poisson = 0.3
[[body]]
name = "upper"
material = "stiff"
element = "Hex27"
mesh = { shape = "extrusion", of = { shape = "rectangle", min = [-0.4, 0.0], max = [0.0, 0.3], cells = [4, 2] }, height = 0.2, layers = 1 }
[[body]]
name = "lower"
material = "soft"
element = "Hex27"
mesh = { shape = "extrusion", of = { shape = "rectangle", min = [-0.8, -0.4], max = [0.8, 0.0], cells = [8, 3] }, height = 0.2, layers = 1 }
[[support]]
on = ["upper.base", "upper.lid", "lower.base", "lower.lid"]
fix = ["z"]
[[support]]
on = ["lower.bottom"]
fix = ["x", "y"]
[[support]]
on = ["upper.top"]
move = { y = "-0.06*min(t, 1)", x = "0.3*max(0, t - 1)" }
[[contact]]
name = "c"
secondary = "upper.bottom"
primary = "lower.top"
enforcement = "multiplier"
[time]
end = 1.5
step = 0.05
scheme = { kind = "static" }
"#;
    let mut runs = ["multiplier", "augmented"]
        .map(|enforcement| simulation(text, &[format!("contact.c.enforcement={enforcement}")]));
    while !runs[0].finished() {
        runs.iter_mut().for_each(|run| run.advance(&mut GridReport::default()).unwrap());
        let whole = runs[0].state().contact_forces[0][1].abs();
        let pressing = |run: &Simulation| {
            let pairs = run.state().pairs[0].iter().filter(|pair| pair.active);
            let mut forces = std::collections::BTreeMap::new();
            pairs.for_each(|pair| *forces.entry(pair.node).or_insert(0.0) += pair.lambda);
            forces
        };
        let [exact, found] = runs.each_ref().map(pressing);
        for (node, force) in &exact {
            let other = found.get(node).copied().unwrap_or(0.0);
            assert!((force - other).abs() <= 1e-7 * whole, "{node}: {force} {other} of {whole}");
        }
    }
}
