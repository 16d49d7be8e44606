//! The start of a run with closed contacts: which pairs press, and which accelerate apart.

use std::collections::BTreeMap;

use carom_contact::{Pairing, Rows, length};
use carom_mechanics::model::{Contact, Friction, Model};
use carom_mechanics::{Grid, Implicit, InitialState, Linear, Settings, Simulation, Tangent, each_slip};
use carom_run::Setup;
use carom_time::Scheme;

use super::common::case;

/// A block on a base.
const BLOCK: &str = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]
body = [
    { name = "block", material = "rubber", element = "Q4", mesh = { shape = "rectangle", min = [0.0, 0.0], max = [2.0, 1.0], cells = [4, 1] } },
    { name = "base", material = "rubber", element = "Q4", mesh = { shape = "rectangle", min = [-1.0, -1.0], max = [3.0, 0.0], cells = [1, 1] } },
]
support = [{ on = ["base.bottom"], fix = ["x", "y"] }]
contact = [{ name = "strike", secondary = "block.bottom", primary = "base.top" }]
time = { scheme = { kind = "chung-hulbert", rho_inf = 0.8 }, step = 1e-3, end = 1.0 }
"#;

/// With so many contacts between the same nodes, and friction.
fn block_on_base(contacts: usize, mu: f64) -> Model {
    let case = case::<&str>(BLOCK, &[]);
    let built = || Setup::new(&case).build().unwrap();
    let mut model = built();
    model.contacts.extend((1..contacts).flat_map(|_| built().contacts));
    for contact in model.contacts.iter_mut().filter(|_| mu > 0.0) {
        contact.friction = Some(Friction::coulomb(mu, contact.kinematics.nodes()));
    }
    model
}

/// The start of a run from rest, with all pairs closed.
fn started(model: Model) -> Simulation {
    let (y, mut apart) = (&model.initial_position, model.initial_position.clone());
    model.parts[0].nodes().for_each(|node| apart[2 * node + 1] += 0.1);
    let closed = |contact: &Contact| {
        let mut pairing = Pairing::default();
        contact.kinematics.search(&apart, y, &mut pairing, &mut Vec::new());
        assert_eq!(pairing.pairs.len(), 5);
        pairing.pairs.iter_mut().for_each(|pair| pair.active = true);
        pairing.pairs
    };
    let pairs = model.contacts.iter().map(closed).collect();
    let before = InitialState {
        y: y.clone(),
        v: vec![0.0; model.dofs()],
        pairs,
        slid: BTreeMap::new(),
        memory: Vec::new(),
    };
    let settings = Settings {
        tolerance: 1e-9,
        max_iterations: 20,
        tangent: Tangent::Full,
        linear: Linear::Direct,
        mixing: 0,
    };
    let stepper = Implicit::new(Box::new(Scheme::chung_hulbert(0.8).unwrap()), settings);
    let grid = Grid { dt: 1e-3, steps: 1000, phase: 0.0, guard: None, floor: 0.0 };
    Simulation::new(model, Box::new(stepper), grid, true, Some(before), 1).unwrap()
}

/// Under forces of any sign closed pairs at rest press or part: M a + Gᵀλ + Hᵀq = f with λ ≤ 0,
/// G a ≥ 0, λ G a = 0 and |q| ≤ −μλ. Without friction that has one solution a. To find it, some
/// pairs have to be let go, and some of these held again.
#[test]
fn closed_pairs_press_or_accelerate_apart() {
    for (contacts, mu) in [(1, 0.0), (2, 0.0), (1, 0.3)] {
        let (mut let_go, mut kept) = (0, 0);
        for seed in 0..100 {
            let mut model = block_on_base(contacts, mu);
            let wave = |dof: usize| ((dof * 7 + seed * 31) as f64 * 12.9898).sin();
            model.gravity = (0..model.dofs()).map(wave).collect();
            let sim = started(model);
            let (model, state) = (sim.model(), sim.state());

            let mut forces = vec![0.0; model.dofs()];
            model.mass.multiply_into(&state.a, &mut forces);
            forces.iter_mut().zip(&model.gravity).for_each(|(sum, f)| *sum -= f);
            let size = state.a.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
            for (contact, pairs) in model.contacts.iter().zip(&state.pairs) {
                for pair in pairs.iter().filter(|pair| pair.active) {
                    let mut rows = Rows::new(2);
                    contact.kinematics.measure(&mut pair.clone(), &state.y, &mut rows).unwrap();
                    rows.row(0).add_to(pair.lambda, &mut forces);
                    let apart = rows.row(0).along(&state.a);
                    assert!(pair.lambda <= 1e-12 && apart >= -1e-11 * size, "{seed}: {apart} {pair:?}");
                    assert!((pair.lambda * apart).abs() < 1e-11 * size, "{seed}: {apart} {pair:?}");
                    assert!(length(pair.tangential.traction) <= -mu * pair.lambda + 1e-11, "{pair:?}");
                    *(if pair.lambda < 0.0 { &mut kept } else { &mut let_go }) += 1;
                }
            }
            each_slip(model, state, |_, _, traction, row| row.add_to(traction, &mut forces));
            let missing = model.free.iter().map(|&dof| forces[dof].abs()).fold(0.0, f64::max);
            assert!(missing < 1e-11, "{contacts} {mu} {seed}: {missing:e}");
        }
        assert!(kept > 100 && let_go > 100, "{kept} {let_go}");
    }
}
