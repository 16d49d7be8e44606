//! Friction in space: the plane is a slice of it, no direction is special, forces and moments
//! balance, the law holds at every node, and runs resume with the same bits.

use carom_contact::{Hold, Pair, inner, length};
use carom_run::{GridReport, Simulation};

use super::common::{case as case_of, finish, simulation};
use super::space::apart;
use super::space_contact::{BALL, IMPACT, momenta, slab};

/// One of every family.
const SCHEMES: [&str; 6] = [
    "{ kind = \"chung-hulbert\", rho_inf = 0.8 }",
    "{ kind = \"hht\", alpha = 0.1 }",
    "{ kind = \"bathe\", rho_inf = 0.0 }",
    "{ kind = \"energy-momentum\" }",
    "{ kind = \"central-difference\" }",
    "{ kind = \"moreau-jean\", theta = 0.5 }",
];

/// Settings of a scheme: the discrete gradient has its law, explicit schemes lumped masses and
/// short steps.
fn of(scheme: &str, mu: &str) -> Vec<String> {
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
            let counts = |pair: &&Pair| pair.active && (pair.tangential.hold == Hold::Stick) == stick;
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

/// A vector turned about an axis.
fn turned(x: [f64; 3]) -> [f64; 3] {
    let (n, (s, c)) = ([2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0], 50_f64.to_radians().sin_cos());
    let along: f64 = (0..3).map(|i| n[i] * x[i]).sum();
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        c * x[i] + (1.0 - c) * along * n[i] + s * (n[j] * x[k] - n[k] * x[j])
    })
}

#[test]
fn a_turned_impact_with_friction_is_the_same() {
    for scheme in [SCHEMES[0], SCHEMES[3], SCHEMES[4]] {
        let sets = of(scheme, "0.2");
        let still = finish(simulation(BALL, &sets));
        let place = "{ rotate = { axis = [2.0, 3.0, 6.0], angle = 50.0 } }";
        let vector = |x: [f64; 3]| format!("{:?}", turned(x));
        let mut other = sets.clone();
        other.extend([
            format!("body.ball.place={place}"),
            format!("body.block.place={place}"),
            format!(
                "body.ball.velocity={{ linear = {}, angular = {}, about = {} }}",
                vector([0.5, 0.2, -3.0]),
                vector([1.0, 2.0, 3.0]),
                vector([0.1, -0.05, 0.51])
            ),
        ]);
        let other = finish(simulation(BALL, &other));
        assert!(still.state().ledger.friction_work < 0.0, "{scheme}");
        let pairs = still.state().y.as_chunks::<3>().0.iter().zip(other.state().y.as_chunks::<3>().0);
        for (here, there) in pairs {
            let expected = turned(*here);
            let apart = (0..3).map(|i| (expected[i] - there[i]).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-9, "{scheme}: {apart:e}");
        }
    }
}

/// |q| ≤ μ|λ|, with equality and along the direction in slip; both momenta stay; friction takes energy,
/// and the ledger is closed.
#[test]
fn every_node_obeys_the_law_and_both_momenta_are_conserved() {
    for scheme in [SCHEMES[0], SCHEMES[3], SCHEMES[4], SCHEMES[5]] {
        let mut sim = simulation(BALL, &of(scheme, "0.2"));
        let before = momenta(&sim);
        let (mut sticks, mut slips) = (0, 0);
        while !sim.finished() {
            sim.advance(&mut GridReport::default()).unwrap();
            let pairs = &sim.state().pairs[0];
            let largest = pairs.iter().map(|pair| pair.lambda.abs()).fold(0.0, f64::max);
            for pair in pairs.iter().filter(|pair| pair.active && pair.lambda <= 0.0) {
                let (q, cone) = (pair.tangential.traction, 0.2 * -pair.lambda);
                assert!(length(q) <= cone + 1e-9 * largest, "{scheme}: {pair:?}");
                match pair.tangential.hold {
                    Hold::Stick => sticks += 1,
                    hold @ Hold::Slip(_) => {
                        slips += 1;
                        let along = inner(q, hold.direction());
                        assert!((along - cone).abs() <= 1e-9 * largest, "{scheme}: {pair:?}");
                    }
                }
            }
        }
        assert!(slips > 0, "{scheme}: {sticks} {slips}");
        let after = momenta(&sim);
        let is_exact = scheme.contains("energy") || scheme.contains("central");
        for (i, (a, b)) in before.iter().zip(&after).enumerate() {
            assert!((a - b).abs() < if i < 3 || is_exact { 1e-12 } else { 2e-3 }, "{scheme} {i}: {a} {b}");
        }
        let ledger = &sim.state().ledger;
        assert!(ledger.friction_work < 0.0, "{scheme}");
        if scheme.contains("energy") {
            assert!(ledger.dissipation().abs() < 1e-11, "{ledger:?}");
        }
    }
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
    for scheme in [SCHEMES[0], SCHEMES[4]] {
        let sets = of(scheme, "0.2");
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
