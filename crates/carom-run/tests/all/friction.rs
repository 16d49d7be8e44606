//! Friction: none for μ = 0, to the last bit; resumed runs; momentum and the ledger of two discs that
//! rub; Coulomb's law at every node; springs, limits and coefficients that change.

use carom_contact::Hold;
use carom_run::{GridReport, Simulation, State};

use super::common::{DISCS, case as case_of, finish, momenta, simulation};

/// One of every family.
const SCHEMES: [&str; 8] = [
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

#[test]
fn no_friction_is_a_coefficient_of_zero_to_the_last_bit() {
    for scheme in SCHEMES {
        let with = finish(simulation(DISCS, &discs(scheme, 0.0)));
        let mut sets = discs(scheme, 0.0);
        sets.remove(1);
        let without = finish(simulation(DISCS, &sets));
        assert_eq!(with.state(), without.state());
        assert_eq!(with.state().ledger.friction_work, 0.0);
        // Nothing happens at once: the law is continuous at 0.
        let little = finish(simulation(DISCS, &discs(scheme, 1e-10)));
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Undamped, and with few nodes, which nodes are in contact depends on round-off.
        let is_smooth = !scheme.contains("newmark") && !scheme.contains("bathe");
        assert!(!is_smooth || apart(&little.state().y, &with.state().y) < 1e-7, "{scheme}");
        assert!(little.state().ledger.friction_work < 0.0, "{scheme}");
    }
}

fn count(state: &State, hold: Hold) -> usize {
    state.pairs[0].iter().filter(|pair| pair.active && pair.tangential.hold == hold).count()
}

/// Resumed where some nodes stick and others slip.
#[test]
fn a_resumed_run_with_friction_ends_with_the_same_bits() {
    for scheme in SCHEMES {
        let sets = discs(scheme, 0.1);
        let mut whole = simulation(DISCS, &sets);
        let mut checkpoint = None;
        while !whole.finished() {
            let state = whole.state();
            let slips = count(state, Hold::Forward) + count(state, Hold::Backward);
            if checkpoint.is_none() && slips > 0 && count(state, Hold::Stick) > 0 {
                checkpoint = Some(postcard::to_stdvec(state).unwrap());
            }
            whole.advance(&mut GridReport::default()).unwrap();
        }
        let state = postcard::from_bytes(&checkpoint.expect("both states at once")).unwrap();
        let resumed = finish(carom_run::Setup::new(&case_of(DISCS, &sets)).resume(state).unwrap());
        assert_eq!(resumed.state(), whole.state(), "{scheme}");
    }
}

/// |q| ≤ μ|λ|, with equality in slip, at the end of every step, except where a projection pulls; and
/// momentum is that at the start.
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
            for pair in pairs.iter().filter(|pair| pair.active && pair.lambda <= 0.0) {
                let (q, cone) = (pair.tangential.traction, 0.2 * (-pair.lambda).max(0.0));
                assert!(q.abs() <= cone + 1e-9 * largest, "{scheme}: {pair:?}");
                match pair.tangential.hold {
                    Hold::Stick => sticks += 1,
                    hold => {
                        slips += 1;
                        assert!((q - hold.sign() * cone).abs() <= 1e-9 * largest, "{scheme}: {pair:?}");
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

fn lost(sim: &Simulation) -> f64 {
    sim.state().ledger.friction_work
}

/// A block that is thrown along a plane, with other keys of its contact.
fn block(contact: &str, scheme: &str) -> String {
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

fn impulses(contact: &str, scheme: &str) -> [f64; 3] {
    finish(simulation(&block(contact, scheme), &[] as &[&str])).state().impulse()
}

/// Tresca's law alone: every node that is pressed slips against τ times its area, whatever the pressure.
/// Beside Coulomb's law the smaller traction counts.
#[test]
fn a_limited_traction_is_that_stress_times_the_area() {
    for scheme in [SCHEMES[0], SCHEMES[5]] {
        // Of both laws, the one with the smaller traction: μ m g = 0.3, τ A = 0.05 or 5.
        let coulomb = impulses("mu = 0.3", scheme);
        let wide = impulses("mu = 0.3\nshear = 500.0", scheme);
        // A limited traction has no impulse where contact begins.
        assert!((coulomb[0] / wide[0] - 1.0).abs() < 1e-3, "{scheme}: {coulomb:?} {wide:?}");
        let narrow = finish(simulation(&block("mu = 0.3\nshear = 0.05", scheme), &[] as &[&str]));
        let closed = narrow.state().ledger.rubbed.closed / 5.0;
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

/// dv/dt = −g [μ_d + (μ_s − μ_d) exp(−c v)] has the closed solution
/// exp(c v) = ((μ_d e^{c v₀} + Δμ) e^{−c μ_d g t} − Δμ)/μ_d.
#[test]
fn a_coefficient_may_depend_on_the_rate_of_slip() {
    let (dynamic, rest, c) = (0.1_f64, 0.2_f64, 2.0_f64);
    let at =
        |t: f64| (((dynamic * c.exp() + rest) * (-c * dynamic * 10.0 * t).exp() - rest) / dynamic).ln() / c;
    for scheme in [SCHEMES[0], SCHEMES[3], SCHEMES[5], SCHEMES[6], SCHEMES[7]] {
        let text = block("mu = 0.3\nmu_dynamic = 0.1\ndecay = 2.0", scheme);
        let sim = finish(simulation(&text, &[] as &[&str]));
        let velocity = momenta(&sim, &sim.state().v)[0] / 0.1;
        assert!((velocity - at(0.2)).abs() < 2e-3, "{scheme}: {velocity} {}", at(0.2));
    }
}

/// A spring that sticks moves by Q/k and returns its energy.
#[test]
fn a_node_on_a_spring_sticks_elastically() {
    let with = "mu = 0.9\nenforcement = \"penalty\"\nstiffness = 1.0\nstick_stiffness = 0.5";
    let sim = finish(simulation(&block(with, SCHEMES[0]), &["body.block.velocity=[1e-4, 0.0]"]));
    let ledger = &sim.state().ledger;
    assert!(ledger.rubbed.stuck > 0.9 * ledger.rubbed.closed, "{:?}", ledger.rubbed);
    // The block falls on its springs, so that nodes bounce and slip then.
    assert!(ledger.friction_work <= 0.0, "{ledger:?}");
    assert!(ledger.stick_springs > 0.0 && ledger.stick_springs < ledger.springs);
}
