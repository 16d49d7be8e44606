//! Friction: none for μ = 0, to the last bit; resumed runs; momentum and the ledger of two discs that
//! rub; Coulomb's law at every node.

use carom_contact::Hold;
use carom_run::{GridReport, Simulation, State};

use super::common::{DISCS, case as case_of, finish, momenta, simulation};

const SCHEMES: [&str; 5] = [
    r#"{ kind = "chung-hulbert", rho_inf = 0.5 }"#,
    r#"{ kind = "newmark", beta = 0.25, gamma = 0.5 }"#,
    r#"{ kind = "hht", alpha = 0.1 }"#,
    r#"{ kind = "bathe", rho_inf = 0.5 }"#,
    r#"{ kind = "tr-bdf2" }"#,
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
        assert!(apart(&little.state().y, &with.state().y) < 1e-7, "{scheme}");
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

/// |q| ≤ μ|λ|, with equality in slip, at the end of every step, and no traction where a projection pulls; and
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
            for pair in pairs.iter().filter(|pair| pair.active) {
                let (q, cone) = (pair.tangential.traction, 0.2 * (-pair.lambda).max(0.0));
                assert!(q.abs() <= cone + 1e-9 * largest, "{scheme}: {pair:?}");
                match pair.tangential.hold {
                    Hold::Stick => sticks += 1,
                    hold => {
                        slips += 1;
                        assert!((q - hold.sign() * cone).abs() < 1e-9 * largest, "{scheme}: {pair:?}");
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
