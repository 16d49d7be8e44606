//! Runs of metal that yields: the ledger with every scheme, the same bits when resumed, bisected,
//! on several threads and reduced, contact with friction, order in time.

use std::sync::atomic::AtomicBool;

use carom_record::{LARGEST_VON_MISES, Recorder, Source};
use carom_run::recording::run_in_memory;
use carom_run::{GridReport, Setup, Simulation};

use super::common::{case, finish, momenta, on_threads, schemes, simulation};

/// A block of metal that falls flat and askew on a floor with friction, and yields.
fn block(element: &str, rest: &str) -> String {
    format!(
        r#"
dimension = 2
material = [{{ name = "metal", law = "hencky", density = 1.0, young = 100.0, poisson = 0.3, plastic = {{ yield = 0.5, hardening = 5.0 }} }}]
[[body]]
name = "block"
material = "metal"
element = "{element}"
mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [3, 3] }}
place = {{ rotate = 20.0, about = [0.0, 0.0], shift = [0.0, 0.02] }}
velocity = [0.3, -1.0]
{rest}"#
    )
}

const FLOOR: &str = r#"
[[contact]]
name = "floor"
secondary = "block.skin"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
mu = 0.2
"#;

fn timed(scheme: &str, step: f64, end: f64) -> String {
    format!("[time]\nend = {end}\nstep = {step}\nenergy_guard = false\nscheme = {scheme}\n")
}

/// A block that is stretched and turns freely.
fn flight(scheme: &str, step: f64) -> String {
    let velocity = "velocity = [\"0.6*X - 0.8*Y + 0.1\", \"0.8*X - 0.5*Y\"]";
    block("T6", &timed(scheme, step, 0.4)).replace("velocity = [0.3, -1.0]", velocity)
}

/// Energy–momentum: what is not stored is dissipated by flow, to round-off; momenta are kept. Work
/// of flow takes a good part of the energy.
#[test]
fn energy_and_momentum_leave_nothing_to_the_integrator() {
    let text = flight("{ kind = \"energy-momentum\" }", 0.01) + "[newton]\ntolerance = 1e-12\n";
    for sets in [&[][..], &["body.block.element=\"Q4\"", "body.block.volumetric=\"mean\""]] {
        let mut run = simulation(&text, sets);
        let start = momenta(&run, &run.state().v);
        let energy = run.state().ledger.total();
        let mut before = 0.0;
        while !run.finished() {
            run.advance(&mut GridReport::default()).unwrap();
            let ledger = &run.state().ledger;
            assert!(ledger.materials > before - 1e-14 * energy);
            before = ledger.materials;
            let left = ledger.dissipation() / energy;
            assert!(left.abs() < 1e-10, "{sets:?} {left:e}");
        }
        assert!(before > 0.1 * energy, "{before} of {energy}");
        for (now, start) in momenta(&run, &run.state().v).into_iter().zip(start) {
            assert!((now - start).abs() < 1e-10, "{now} {start}");
        }
    }
}

/// The plastic work approaches one value with every scheme; that of backward Euler, of first order,
/// most slowly.
#[test]
fn every_scheme_books_the_work_of_flow() {
    let lumped = ["body.block.mass=\"lumped\""];
    let reference = finish(simulation(&flight("{ kind = \"energy-momentum\" }", 1e-3), &lumped));
    let expected = reference.state().ledger.materials;
    for (scheme, _) in schemes(false).filter(|(scheme, _)| !scheme.contains("static")) {
        let errors = [8e-3, 4e-3].map(|step| {
            let run = finish(simulation(&flight(&scheme, step), &lumped));
            (run.state().ledger.materials / expected - 1.0).abs()
        });
        assert!(errors[1] < 0.15 && errors[1] < 0.7 * errors[0] + 5e-3, "{scheme}: {errors:?}");
    }
}

/// Order in time of a motion that yields, from steps that resolve the beginning of flow.
#[test]
fn yielding_keeps_the_order_in_time() {
    for scheme in ["{ kind = \"energy-momentum\" }", "{ kind = \"chung-hulbert\", rho_inf = 0.8 }"] {
        let at = |step: f64| finish(simulation(&flight(scheme, step), &[""; 0])).state().y.clone();
        let [coarse, middle, fine] = [2e-3, 1e-3, 5e-4].map(at);
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let order = (apart(&coarse, &middle) / apart(&middle, &fine)).log2();
        assert!(order > 1.8, "{scheme}: {order}");
    }
}

/// A block strikes a floor with friction, resumed in the middle of it on two threads, for every
/// kind of stepper; the same bits.
#[test]
fn a_resumed_impact_has_the_same_bits() {
    for (scheme, mass, step) in [
        ("{ kind = \"energy-momentum\" }", "consistent", 0.01),
        ("{ kind = \"chung-hulbert\", rho_inf = 0.5 }", "consistent", 0.01),
        ("{ kind = \"bathe\", rho_inf = 0.5 }", "consistent", 0.01),
        ("{ kind = \"central-difference\" }", "lumped", 0.002),
        ("{ kind = \"moreau-jean\", theta = 0.5 }", "lumped", 0.01),
    ] {
        let text = block("T6", FLOOR) + &timed(scheme, step, 0.4);
        let sets = [format!("body.block.mass=\"{mass}\"")];
        let mut whole = simulation(&text, &sets);
        let mut checkpoint = None;
        while !whole.finished() {
            if checkpoint.is_none() && whole.state().time > 0.2 {
                checkpoint = Some(postcard::to_stdvec(&whole.state()).unwrap());
            }
            whole.advance(&mut GridReport::default()).unwrap_or_else(|e| panic!("{scheme}: {e}"));
        }
        let state = postcard::from_bytes(&checkpoint.unwrap()).unwrap();
        let resumed = finish(Setup::new(&case(&text, &sets)).threads(2).resume(state).unwrap());
        assert!(resumed.state() == whole.state(), "{scheme}");
        let booked = whole.state().ledger.materials;
        assert!(booked > 0.01, "{scheme}: {booked}");
    }
}

/// A rejected attempt leaves nothing behind, and threads change no bit.
#[test]
fn bisected_steps_and_threads_have_the_same_bits() {
    let rest =
        timed("{ kind = \"chung-hulbert\", rho_inf = 0.8 }", 0.05, 0.4) + "[newton]\nmax_iterations = 4\n";
    let text = block("T6", &(FLOOR.to_owned() + &rest));
    let mut whole = simulation(&text, &[""; 0]);
    let mut other = on_threads(&text, &[""; 0], 2);
    let mut rejected = 0;
    while !whole.finished() {
        let mut resumed = Setup::new(&case(&text, &[""; 0])).resume(whole.state().clone()).unwrap();
        let mut report = GridReport::default();
        whole.advance(&mut report).unwrap();
        resumed.advance(&mut GridReport::default()).unwrap();
        other.advance(&mut GridReport::default()).unwrap();
        assert!(whole.state() == resumed.state() && whole.state() == other.state());
        rejected += report.rejected;
    }
    assert!(rejected > 0);
    assert!(whole.state().ledger.materials > 0.01);
}

/// A state that is reduced to fewer bodies keeps their memory: the next steps are the same.
#[test]
fn a_part_of_a_state_remembers() {
    let second = |name: &str, left: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"metal\"\nelement = \"T6\"\nvelocity = [\"0.6*(X - {left})\", \"-0.5*Y\"]\n\
             mesh = {{ shape = \"rectangle\", min = [{left}, 0.0], max = [{}, 1.0], cells = [2, 2] }}\n",
            left + 1.0
        )
    };
    let rest = timed("{ kind = \"chung-hulbert\", rho_inf = 0.8 }", 0.01, 0.4);
    let head = block("T6", "");
    let head = &head[..head.find("[[body]]").unwrap()];
    let both = format!("{head}{}{}{rest}", second("gone", 3.0), second("kept", 0.0));
    let alone = format!("{head}{}{rest}", second("kept", 0.0));
    let mut large = simulation(&both, &[""; 0]);
    (0..20).for_each(|_| drop(large.step().unwrap()));
    let small = simulation(&alone, &[""; 0]);
    let first = large.model().parts[1].nodes().start;
    let dofs: Vec<usize> = (2 * first..2 * first + small.model().dofs()).collect();
    let part = large.state().restricted(large.model(), small.model(), &dofs, &[]).unwrap();
    let yields = |run: &Simulation, body: usize| {
        run.model().plastic_strain(body, run.state().materials.past(0.0).memory)
    };
    assert!(yields(&large, 1) > 1e-3);
    let mut small = super::common::restored(small, part);
    assert_eq!(yields(&small, 0), yields(&large, 1));
    for _ in 0..10 {
        large.step().unwrap();
        small.step().unwrap();
    }
    let apart = small.state().y.iter().zip(&large.state().y[2 * first..]);
    assert!(apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-10);
}

/// Two blocks that yield, stretched apart through a tie of unmatched meshes, or pressed together by
/// mortar contact with friction: what flow dissipates and the works of contact close the ledger,
/// and a run that is resumed has the same bits.
#[test]
fn yielding_bodies_are_tied_and_touch_by_mortar() {
    let bodies = |lower: &str, upper: &str| {
        let head = block("T6", "");
        let head = head.replace("place = { rotate = 20.0, about = [0.0, 0.0], shift = [0.0, 0.02] }\n", "");
        let other = "[[body]]\nname = \"cap\"\nmaterial = \"metal\"\nelement = \"T6\"\n\
             mesh = { shape = \"rectangle\", min = [0.1, 1.0], max = [0.9, 1.5], cells = [2, 2] }\n";
        let head = head.replace("velocity = [0.3, -1.0]", &format!("velocity = {lower}"));
        format!("{head}{other}velocity = {upper}\n")
    };
    let tie = |method: &str| {
        format!(
            "[[tie]]\nname = \"joint\"\nmethod = \"{method}\"\nsecondary = \"cap.bottom\"\nprimary = \"block.top\"\n"
        )
    };
    let contact = "[[contact]]\nname = \"joint\"\nmethod = \"mortar\"\nmu = 0.3\nsecondary = \"cap.bottom\"\n\
         primary = \"block.top\"\n";
    let apart = "[\"0.2*Y\", \"0.8*(Y - 0.5)\"]";
    for (joint, [lower, upper]) in
        [(tie("mortar"), [apart; 2]), (contact.to_owned(), ["[0.0, 0.0]", "[0.2, -1.0]"])]
    {
        let rest = timed("{ kind = \"energy-momentum\" }", 0.005, 0.2) + "[newton]\ntolerance = 1e-12\n";
        let text = bodies(lower, upper) + &joint + &rest;
        let case = case(&text, &[""; 0]);
        let mut whole = Setup::new(&case).start().unwrap_or_else(|p| panic!("{p:?}"));
        let start = momenta(&whole, &whole.state().v);
        let energy = whole.state().ledger.total();
        let mut resumed = None;
        while !whole.finished() {
            if resumed.is_none() && whole.state().time > 0.08 {
                let state = postcard::from_bytes(&postcard::to_stdvec(&whole.state()).unwrap()).unwrap();
                resumed = Some(Setup::new(&case).threads(2).resume(state).unwrap());
            }
            whole.advance(&mut GridReport::default()).unwrap();
        }
        assert!(finish(resumed.unwrap()).state() == whole.state(), "{joint}");
        let ledger = &whole.state().ledger;
        assert!(ledger.materials > 0.02 * energy, "{joint} {}", ledger.materials / energy);
        assert!((ledger.dissipation() / energy).abs() < 1e-9, "{joint} {:e}", ledger.dissipation() / energy);
        for (now, start) in momenta(&whole, &whole.state().v).into_iter().take(2).zip(start) {
            assert!((now - start).abs() < 1e-10, "{joint} {now} {start}");
        }
    }
}

/// No quadrature point has a stress beyond the yield surface: of the law in logarithmic strains
/// that is Kirchhoff's, J times the recorded one. What is projected to the nodes has.
#[test]
fn largest_stress_is_within_the_yield_surface() {
    let text = block("T6", FLOOR) + &timed("{ kind = \"bathe\", rho_inf = 0.5 }", 0.01, 0.3);
    let stop = AtomicBool::new(false);
    let (_, record) =
        run_in_memory(&case(&text, &[""; 0]), Source::default(), 1, &mut |_| (), &stop).unwrap();
    let run = record.read().unwrap();
    let column = |name: &str| run.column(name).unwrap();
    let mut beyond = 0;
    for (entry, fields) in run.fields.iter().zip(&record.fields) {
        let row = run.times().iter().position(|time| (time - entry.time).abs() < 1e-9).unwrap();
        let bound = (0.5 + 5.0 * column("block.plastic_strain")[row]) / column("min_det_f")[row];
        let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let at_points = largest(&fields.of_cells(LARGEST_VON_MISES).unwrap().values);
        assert!(at_points <= bound * (1.0 + 1e-9), "{at_points} {bound} at {}", entry.time);
        beyond += usize::from(largest(&fields.array("von_mises").unwrap().values) > 1.05 * bound);
    }
    assert!(beyond > 0);
}
