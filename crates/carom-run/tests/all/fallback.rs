//! Steps of backward Euler with contact implicit in velocity where a run would stop: they finish
//! it, and keep what every step keeps.

use carom_run::case::{Document, read};
use carom_run::{GridReport, LogEvent, Setup, Simulation, State};

use super::common::{DISCS, case, dot, momenta, simulation};

const FALLBACK: &str = "time.fallback=velocity";

/// A guard that an undamped scheme does not satisfy where contact begins, unless it may bisect its
/// steps: these runs may not.
const TIGHT: [&str; 3] = [
    "time.energy_guard=1e-4",
    "time.step=0.01",
    "time.scheme={ kind = \"newmark\", beta = 0.25, gamma = 0.5 }",
];

/// A stiff cube that falls askew on a plane and slides.
const CUBE: &str = r#"
dimension = 3
[[material]]
name = "steel"
law = "neo-hookean"
density = 1.0
young = 2e3
poisson = 0.3
[[body]]
name = "cube"
material = "steel"
element = "Hex8"
mesh = { shape = "box", min = [0.0, 0.0, 0.01], max = [1.0, 1.0, 1.01], cells = [2, 2, 2] }
velocity = { linear = [0.3, 0.2, -2.0], angular = [0.4, 0.0, 0.0], about = [0.5, 0.5, 0.5] }
[[contact]]
name = "floor"
secondary = "cube.skin"
primary = { plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] } }
[time]
end = 0.3
step = 0.01
scheme = { kind = "newmark", beta = 0.25, gamma = 0.5 }
energy_guard = 1e-4
"#;

/// Runs to the end or to where it stops; after each step, `check` sees the states before and after
/// it and whether the fallback took it.
fn run(mut sim: Simulation, mut check: impl FnMut(&Simulation, &State, bool)) -> (Simulation, u32, bool) {
    sim.limit_bisections(0);
    let mut fallbacks = 0;
    while !sim.finished() {
        let (before, mut report) = (sim.state().clone(), GridReport::default());
        if sim.advance(&mut report).is_err() {
            return (sim, fallbacks, false);
        }
        let logged = report.events.iter().filter(|e| matches!(e, LogEvent::Fallback { .. })).count();
        assert_eq!(logged, report.fallbacks as usize);
        fallbacks += report.fallbacks;
        check(&sim, &before, report.fallbacks > 0);
    }
    (sim, fallbacks, true)
}

/// Whether nothing is lost but what the ledger says, and nothing penetrates.
fn is_sound(sim: &Simulation) {
    let ledger = &sim.state().ledger;
    let guard = sim.grid().guard.unwrap();
    assert!(ledger.created.most() <= guard * ledger.scale(), "{:e}", ledger.created.most() / ledger.scale());
    let depths = carom_mechanics::penetration(sim.model(), sim.state());
    assert!(depths.constrained <= 1e-10 * sim.model().scale, "{:e}", depths.constrained);
}

#[test]
fn two_discs_collide_although_the_guard_stops_them() {
    let (_, none, finished) = run(simulation(DISCS, &TIGHT), |_, _, _| ());
    assert!(!finished && none == 0);

    let mut worst = 0.0_f64;
    let sets = [&TIGHT[..], &[FALLBACK]].concat();
    let (sim, fallbacks, finished) = run(simulation(DISCS, &sets), |sim, _, _| {
        is_sound(sim);
        let [x, y, _] = momenta(sim, &sim.state().v);
        worst = worst.max(x.abs()).max(y.abs());
    });
    assert!(finished && fallbacks > 0 && fallbacks < 40, "{finished} {fallbacks}");
    let mass = sim.model().parts.iter().map(|part| part.total_mass).sum::<f64>();
    assert!(worst < 1e-12 * 1.5 * mass, "{worst:e}");
    // They separate: the impulse is more than what stops them.
    assert!(sim.state().impulses[0][0].abs() > 1.2 * 1.5 * 0.5 * mass, "{:?}", sim.state().impulses);
    assert_eq!(sim.state().pairs[0].iter().filter(|pair| pair.active).count(), 0);
}

/// Backward Euler, with contact forces in the balance at the end of the step: Δy·(M Δv/Δt + f_int −
/// f_cont) = 0, so that the work of contact closes the ledger up to ½|Δv|² and the convexity of U.
#[test]
fn the_ledger_has_the_work_of_the_impulses() {
    let sets = [&TIGHT[..], &[FALLBACK, "contact.strike.persistency=none"]].concat();
    let mut checked = 0;
    run(simulation(DISCS, &sets), |sim, before, fell_back| {
        let (model, state) = (sim.model(), sim.state());
        let whole = state.carried.dt().is_some_and(|dt| (dt / sim.dt() - 1.0).abs() < 1e-9);
        if !fell_back || !whole {
            return;
        }
        let moved: Vec<f64> = state.y.iter().zip(&before.y).map(|(a, b)| a - b).collect();
        let jump: Vec<f64> = state.v.iter().zip(&before.v).map(|(a, b)| a - b).collect();
        let mut inertia = vec![0.0; model.dofs()];
        model.mass.multiply_into(&jump, &mut inertia);
        let work = dot(&moved, &inertia) / sim.dt() + dot(&moved, &state.f_internal);
        let of_contact = state.ledger.contact_work - before.ledger.contact_work;
        let scale = state.ledger.scale();
        assert!((work - of_contact).abs() < 1e-10 * scale, "{work:e} {of_contact:e} of {scale:e}");
        // Dissipation is that of the method: never negative here.
        assert!(state.ledger.dissipation() - before.ledger.dissipation() > -1e-9 * scale);
        checked += 1;
    });
    assert!(checked > 0);
}

#[test]
fn a_cube_lands_on_a_plane_in_space() {
    assert!(!run(simulation(CUBE, &[""; 0]), |_, _, _| ()).2);
    // Nothing acts along the plane.
    let along = |sim: &Simulation| {
        let mut momentum = vec![0.0; sim.state().v.len()];
        sim.model().mass.multiply_into(&sim.state().v, &mut momentum);
        [0, 1].map(|axis| momentum.iter().skip(axis).step_by(3).sum::<f64>())
    };
    let sim = simulation(CUBE, &[FALLBACK]);
    let before = along(&sim);
    let (sim, fallbacks, finished) = run(sim, |sim, _, _| is_sound(sim));
    assert!(finished && fallbacks > 0, "{fallbacks}");
    for (before, now) in before.into_iter().zip(along(&sim)) {
        assert!((now - before).abs() < 1e-12, "{before} {now}");
    }
}

#[test]
fn a_run_that_fell_back_resumes_with_the_same_bits() {
    let sets = [&TIGHT[..], &[FALLBACK, "time.end=0.2"]].concat();
    let (mut middle, mut before) = (None, None);
    let (whole, ..) = run(simulation(DISCS, &sets), |sim, start, fell_back| {
        if fell_back && middle.is_none() {
            before = Some(postcard::to_stdvec(start).unwrap());
            middle = Some(postcard::to_stdvec(sim.state()).unwrap());
        }
    });
    let case = case(DISCS, &sets);
    for bytes in [before, middle] {
        let state = postcard::from_bytes(&bytes.expect("the fallback took a step")).unwrap();
        let (resumed, _, finished) = run(Setup::new(&case).threads(2).resume(state).unwrap(), |_, _, _| ());
        assert!(finished && resumed.state() == whole.state());
    }
}

#[test]
fn what_it_is_not_built_for_is_refused() {
    let refused = |sets: &[&str]| {
        let sets: Vec<String> = [&[FALLBACK], sets].concat().iter().map(|set| (*set).to_owned()).collect();
        let document = Document::parse("case.toml", DISCS, &sets).unwrap();
        read(&document).err().map(|problems| document.diagnose_all(&problems).to_string()).unwrap_or_default()
    };
    for (sets, why) in [
        (&["time.scheme={ kind = \"static\" }"][..], "no velocities"),
        (&["time.scheme={ kind = \"moreau-jean\", theta = 0.5 }"], "own contact law"),
        (&["time.scheme={ kind = \"central-difference\" }"], "own contact law"),
        (&["contact.strike.enforcement=penalty"], "eject nodes"),
        (&["contact.strike.mu=0.3"], "normal impulses"),
        (&["time.scheme={ kind = \"energy-momentum\" }", "contact.strike.restitution=1.0"], "inelastic"),
        (&["contact.strike.law=predictor"], "no predictor"),
        (&["contact.strike.detection=trajectory"], "closest points"),
        (&["body.left.mass=redistributed"], "without mass"),
    ] {
        let said = refused(sets);
        assert!(
            said.contains("fallback = \"velocity\" cannot be used") && said.contains(why),
            "{sets:?}: {said}"
        );
    }
    assert_eq!(refused(&["time.scheme={ kind = \"energy-momentum\" }"]), "");
    // All reasons at once: to follow one of them must not lead to another.
    let said = refused(&["contact.strike.enforcement=augmented", "contact.strike.mu=0.3"]);
    assert!(said.contains("not in rounds") && said.contains("normal impulses"), "{said}");
}
