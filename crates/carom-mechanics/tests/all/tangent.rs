//! The matrix-free tangent of Newton's linear problem against differences of the whole residual.

use carom_algebra::sums::dot;
use carom_contact::{Along, ConservingUnilateral, FrictionState, Pairing, Penalty, Rows, inner};
use carom_formula::Formula;
use carom_mechanics::contact::constraints::Constraints;
use carom_mechanics::linear::direct::Direct;
use carom_mechanics::linear::iterative::Iterative;
use carom_mechanics::linear::matrices::Matrices;
use carom_mechanics::linear::preconditioner::Preconditioner;
use carom_mechanics::model::{Friction, Load, Loads, LoadsAt, Model, Motion, Motions, OfRows, Springs};
use carom_mechanics::stage::equations::Equations;
use carom_mechanics::stage::evaluation::{Iterate, Spare};
use carom_mechanics::stage::linear_problem::LinearProblem;
use carom_mechanics::start::{Inertia, press, start};
use carom_mechanics::velocity::active_rows::measure_all;
use carom_mechanics::{
    Implicit, Linear, Materials, Settings, State, Stepper, Tangent as FactorRule, Timings, Workspace,
};
use carom_solid::{Configuration, Element, Law, generate};
use carom_time::schemes::energy_momentum::EnergyMomentum;
use carom_time::{ForceRule, Kernel, Memory, Scheme, Stage};

use crate::models::{contact, loaded, model, nodes, parts, tied};

/// An iterate with its tangent.
struct Tangent<'a> {
    equations: &'a Equations<'a>,
    at: Iterate,
    rows: Constraints,
    spare: Spare,
    timings: Timings,
}

impl<'a> Tangent<'a> {
    /// For the pairs of the state, with irregular increments of a given size.
    fn new(equations: &'a Equations<'a>, size: f64) -> Self {
        Self::from(equations, Iterate::at_start(equations.state), size)
    }

    /// The same for other pairs.
    fn from(equations: &'a Equations<'a>, mut at: Iterate, size: f64) -> Self {
        let model = equations.model;
        let mut spare = Spare::default();
        let mut timings = Timings::default();
        model.free.iter().for_each(|&dof| at.increment[dof] = size * wave(dof, 0.3));
        model.points.carry(&mut at.increment);
        let now = equations.evaluate(at, &mut spare, &mut timings).unwrap();
        let rows = Constraints::of(equations, &now);
        Self { equations, at: now.at, rows, spare, timings }
    }

    /// A direction over free dofs and rows.
    fn direction(&self, seed: f64) -> Vec<f64> {
        (0..self.equations.model.free.len() + self.rows.len()).map(|i| wave(i, seed)).collect()
    }

    /// The matrix times a direction.
    fn product(&mut self, u: &[f64]) -> Vec<f64> {
        let Self { equations, at, rows, spare, timings } = self;
        let free = &equations.model.free;
        let mut change = vec![0.0; equations.model.dofs()];
        let (dofs, multipliers) = u.split_at(free.len());
        free.iter().zip(dofs).for_each(|(&dof, u)| change[dof] = *u);
        equations.model.points.carry(&mut change);
        let now = equations.evaluate(at.clone(), spare, timings).unwrap();
        let [mut forces, gaps] =
            LinearProblem::product(equations, &now, rows, [change, multipliers.to_vec()]).unwrap();
        equations.model.points.gather(&mut forces);
        free.iter().map(|&dof| forces[dof]).chain(gaps).collect()
    }

    /// Residual at free dofs and weighted gaps of the rows, at distance `e` along a direction.
    fn residual(&mut self, u: &[f64], e: f64) -> Vec<f64> {
        let Self { equations, at, rows, spare, timings } = self;
        let free = &equations.model.free;
        let mut at = at.clone();
        let (dofs, multipliers) = u.split_at(free.len());
        free.iter().zip(dofs).for_each(|(&dof, u)| at.increment[dof] += e * u);
        equations.model.points.carry(&mut at.increment);
        for (row, u) in rows.list.iter().zip(multipliers) {
            let (k, p) = row.place;
            let slip = &row.slip;
            let pair = &mut at.pairings[k].pairs[p];
            match slip {
                None => pair.lambda += e * u,
                Some(along) => pair.tangential.pull(*along, e * u),
            }
        }
        let now = equations.evaluate(at, spare, timings).unwrap();
        // The direction across a slip turns with it.
        let gap = |(&(k, p), slip): (&(usize, usize), &Option<Along>)| {
            let across = match now.at.pairings[k].pairs[p].tangential.friction_state {
                FrictionState::Slip([x, y]) => slip.map(|_| [-y, x]),
                FrictionState::Stick => *slip,
            };
            across.map_or(now.rows[k].row(p).gap, |along| inner(along, now.slip_of((k, p))))
        };
        let gaps = rows.list.iter().map(|row| gap((&row.place, &row.slip)));
        let gaps = gaps.zip(&rows.list).map(|(gap, row)| row.weight * gap);
        free.iter().map(|&dof| now.residual[dof]).chain(gaps).collect()
    }

    /// Their derivative along the direction, by central differences with steps `h` and 2`h`,
    /// extrapolated.
    fn derivative(&mut self, u: &[f64], h: f64) -> Vec<f64> {
        let mut slope = |h: f64| -> Vec<f64> {
            let plus = self.residual(u, h);
            let minus = self.residual(u, -h);
            plus.iter().zip(&minus).map(|(p, m)| (p - m) / (2.0 * h)).collect()
        };
        let fine = slope(h);
        let coarse = slope(2.0 * h);
        fine.iter().zip(&coarse).map(|(fine, coarse)| (4.0 * fine - coarse) / 3.0).collect()
    }
}

fn wave(i: usize, seed: f64) -> f64 {
    ((i as f64 + seed) * 12.9898).sin()
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| x.abs().max(most))
}

/// Step of all tests with contact.
const DT: f64 = 2e-3;

/// The equations of a step from time 0.
fn equations<'a>(model: &'a Model, state: &'a State, scheme: &dyn Kernel, dt: f64, to: f64) -> Equations<'a> {
    let mut stage = Stage::default();
    scheme.stage_into(0, dt, &Memory { states: &[(&state.y, &state.v, &state.a)], before: None }, &mut stage);
    Equations::new(model, state, stage, to).unwrap()
}

/// A state at some positions, with irregular accelerations; no pairs.
fn at(model: &Model, y: Vec<f64>) -> State {
    let dofs = model.dofs();
    let contacts = model.contacts.len();
    let mut state = State {
        y,
        v: model.initial_velocity.clone(),
        a: (0..dofs).map(|dof| wave(dof, 0.5)).collect(),
        f_internal: vec![0.0; dofs],
        f_external: vec![0.0; dofs],
        f_contact: vec![0.0; dofs],
        contact_forces: vec![[0.0; 3]; contacts],
        impulses: vec![[0.0; 3]; contacts],
        pairs: vec![Vec::new(); contacts],
        ..State::default()
    };
    let at = Configuration::at(&state.y);
    model.internal_force(&at, &mut state.f_internal, &mut Materials::default()).unwrap();
    state
}

/// The same with the nodes of the first body, along the last axis, at `height` of their initial
/// one, and closed pairs where the gap is below `near`.
fn touching(model: &Model, near: f64, height: impl Fn(usize, f64) -> f64) -> State {
    let d = model.dimension;
    let kinematics = &model.contacts[0].kinematics;
    let mut y = model.initial_position.clone();
    let own: Vec<usize> = model.parts[0].nodes().map(|node| d * node + d - 1).collect();
    own.iter().for_each(|&dof| y[dof] = height(dof, y[dof]));
    // Seen from further away, every node has the facet that faces it.
    let mut apart = y.clone();
    own.iter().for_each(|&dof| apart[dof] += 0.1 * model.scale);
    let mut pairing = Pairing::default();
    kinematics.search(&apart, &y, &mut pairing, &mut Vec::new());
    for (p, pair) in pairing.pairs.iter_mut().enumerate() {
        let mut rows = Rows::new(d);
        kinematics.measure(pair, &y, &mut rows).unwrap();
        if rows.row(0).gap < near {
            (pair.active, pair.lambda) = (true, -2.0 - wave(p, 0.2));
        }
    }
    let mut state = at(model, y);
    state.pairs = vec![pairing.pairs];
    let gaps = measure_all(model, &mut state).unwrap();
    press(model, &mut state, &gaps);
    state
}

/// The right half of a disc that strikes a block.
fn strike() -> Model {
    let disc = generate::half_disc(Element::T10, 0.5, [0.0, 0.5], 0.25).unwrap();
    let block = generate::rectangle(Element::T10, [0.0, -0.5], [1.0, 0.0], [4, 2]).unwrap();
    let parts = parts([disc, block], Law::NeoHookean { lambda: 200.0, mu: 15.0 }, 0.25);
    let bottom = nodes(&parts[1], "bottom").into_iter().flat_map(|node| [2 * node, 2 * node + 1]);
    let symmetry =
        [nodes(&parts[0], "axis"), nodes(&parts[1], "left")].concat().into_iter().map(|node| 2 * node);
    let fixed: Vec<usize> = bottom.chain(symmetry).collect();
    let strike = contact(&parts, (0, "arc"), (1, "top"));
    let mut model = model(parts, &fixed, Motions::default(), Loads::default(), vec![strike]);
    model.parts[0].nodes().for_each(|node| model.initial_velocity[2 * node + 1] = -3.0);
    model
}

/// The disc with a flat: the slope of its heights grows from 0.3.
fn flattened(model: &Model) -> State {
    touching(model, 0.1, |_, y| y - 0.14 * (y / 0.2).tanh())
}

/// With active, sliding contact; and the matrix is symmetric.
#[test]
fn the_whole_tangent_with_contact_is_the_derivative_of_the_residual() {
    let averaged = Scheme::hht(0.2).unwrap().with_forces(ForceRule::AverageState);
    for scheme in [Scheme::chung_hulbert(0.6).unwrap(), averaged] {
        let model = strike();
        let state = flattened(&model);
        let equations = equations(&model, &state, &scheme, DT, DT);
        let mut tangent = Tangent::new(&equations, 1e-3);
        assert!(tangent.rows.len() > 3);
        let u = tangent.direction(0.1);
        let w = tangent.direction(0.7);
        let ku = tangent.product(&u);
        let kw = tangent.product(&w);
        assert!((dot(&ku, &w) - dot(&kw, &u)).abs() < 1e-12 * dot(&ku, &ku).sqrt() * dot(&w, &w).sqrt());
        for (i, (numeric, k)) in tangent.derivative(&u, 2.5e-5).iter().zip(&ku).enumerate() {
            assert!((numeric - k).abs() < 1e-7 * largest(&ku), "{scheme:?} {i}: {numeric} {k}");
        }
    }
}

/// With a contact force along a discrete gradient, whose matrix is not symmetric.
#[test]
fn the_whole_tangent_with_a_conserving_contact_is_the_derivative_of_the_residual() {
    let mut model = strike();
    model.contacts[0].interface = Box::new(ConservingUnilateral);
    let state = flattened(&model);
    let equations = equations(&model, &state, &EnergyMomentum, DT, DT);
    let mut tangent = Tangent::new(&equations, 1e-3);
    assert!(tangent.rows.len() > 3);
    let u = tangent.direction(0.1);
    let ku = tangent.product(&u);
    for (i, (numeric, k)) in tangent.derivative(&u, 2.5e-5).iter().zip(&ku).enumerate() {
        assert!((numeric - k).abs() < 1e-6 * largest(&ku), "{i}: {numeric} {k}");
    }
}

/// With nodes that stick and others that slip, of which some closed in this step; the cone follows
/// the pressure, and the matrix is not symmetric.
#[test]
fn the_whole_tangent_with_friction_is_the_derivative_of_the_residual() {
    for scheme in [Scheme::chung_hulbert(0.6).unwrap(), Scheme::hht(0.2).unwrap()] {
        let mut model = strike();
        model.contacts[0].friction = Some(Friction::coulomb(0.4, 64));
        let mut state = flattened(&model);
        let holds = [
            FrictionState::Stick,
            FrictionState::Slip([1.0, 0.0]),
            FrictionState::Slip([-1.0, 0.0]),
            FrictionState::Stick,
        ];
        let closed = state.pairs[0].iter_mut().filter(|pair| pair.active);
        for (pair, friction_state) in closed.zip(holds.iter().cycle()) {
            (pair.tangential.friction_state, pair.tangential.traction) =
                (*friction_state, [0.1 * pair.lambda, 0.0]);
        }
        let at = Iterate::at_start(&state);
        // These two were open, and would fly through the other side.
        state.v.iter_mut().skip(1).step_by(2).for_each(|v| *v -= 0.5);
        state.y.iter_mut().skip(1).step_by(2).take(state.v.len() / 8).for_each(|y| *y += 1e-5);
        let closed = state.pairs[0].iter_mut().filter(|pair| pair.active);
        closed.take(2).for_each(|pair| pair.active = false);
        let equations = equations(&model, &state, &scheme, DT, DT);
        let mut tangent = Tangent::from(&equations, at, 1e-3);
        let sticks = tangent.rows.list.iter().filter_map(|row| row.slip).count();
        let rows = tangent.rows.len();
        assert!(sticks >= 2 && rows - sticks > sticks, "{sticks} {rows}");
        let u = tangent.direction(0.1);
        let ku = tangent.product(&u);
        for (i, (numeric, k)) in tangent.derivative(&u, 2.5e-5).iter().zip(&ku).enumerate() {
            assert!((numeric - k).abs() < 1e-6 * largest(&ku), "{i}: {numeric} {k}");
        }
    }
}

/// A block of tetrahedra that strikes another one obliquely, with curved facets.
fn strike_in_space() -> Model {
    let element = Element::Tet10;
    let upper = generate::cuboid(element, [0.2, 0.15, 0.005], [0.9, 0.8, 0.505], [2, 1, 1]).unwrap();
    let lower = generate::cuboid(element, [0.0, 0.0, -0.5], [1.2, 1.0, 0.0], [2, 2, 1]).unwrap();
    let parts = parts([upper, lower], Law::NeoHookean { lambda: 200.0, mu: 15.0 }, 0.25);
    let fixed: Vec<usize> = nodes(&parts[1], "bottom")
        .into_iter()
        .flat_map(|node| [3 * node, 3 * node + 1, 3 * node + 2])
        .collect();
    let strike = contact(&parts, (0, "bottom"), (1, "top"));
    let mut model = model(parts, &fixed, Motions::default(), Loads::default(), vec![strike]);
    for node in model.parts[0].nodes() {
        model.initial_velocity[3 * node..3 * node + 3].copy_from_slice(&[0.7, -0.4, -3.0]);
    }
    model
}

/// With nodes that stick and others that slip in any direction, also one that differs from that of
/// their slip: the direction is an unknown. The rate changes the coefficient.
#[test]
fn the_whole_tangent_with_friction_in_space_is_the_derivative_of_the_residual() {
    let mut conserving = strike_in_space();
    conserving.contacts[0].interface = Box::new(ConservingUnilateral);
    let chung_hulbert = Scheme::chung_hulbert(0.6).unwrap();
    let cases: [(Model, Box<dyn Kernel>); 3] = [
        (strike_in_space(), Box::new(chung_hulbert)),
        (strike_in_space(), Box::new(Scheme::hht(0.2).unwrap())),
        (conserving, Box::new(EnergyMomentum)),
    ];
    for (mut model, scheme) in cases {
        let mut friction = Friction::coulomb(0.4, 64);
        (friction.slip, friction.decay) = (Some(0.2), 0.3);
        model.contacts[0].friction = Some(friction);
        let state = touching(&model, 0.01, |dof, z| z - 0.004 + 1e-3 * wave(dof, 0.6));
        let equations = equations(&model, &state, scheme.as_ref(), DT, DT);
        let mut at = Iterate::at_start(&state);
        for pair in at.pairings[0].pairs.iter_mut().filter(|pair| pair.active) {
            pair.tangential.tangents = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]];
            (pair.tangential.friction_state, pair.tangential.traction) =
                (FrictionState::Stick, [0.1 * pair.lambda, 0.03 * pair.lambda]);
        }
        let mut tangent = Tangent::from(&equations, at, 1e-3);
        let Tangent { at, spare, timings, .. } = &mut tangent;
        let now = equations.evaluate(at.clone(), spare, timings).unwrap();
        let mut at = now.at.clone();
        for (p, pair) in
            at.pairings[0].pairs.iter_mut().enumerate().filter(|(p, pair)| pair.active && p % 3 > 0)
        {
            let [x, y] = now.slip_of((0, p));
            let (sin, cos) = 0.4_f64.sin_cos();
            pair.tangential.friction_state = FrictionState::of([cos * x - sin * y, sin * x + cos * y], 0.0);
        }
        let mut tangent = Tangent::from(&equations, at, 1e-3);
        let slips = tangent.rows.list.iter().filter_map(|row| row.slip);
        let sticks = slips.clone().filter(|along| along.contains(&1.0)).count();
        let rows = tangent.rows.len();
        assert!(
            sticks > 2 && slips.count() > sticks + 1 && tangent.rows.list.iter().any(|row| row.yields > 0.0)
        );
        assert!(rows > 12, "{rows}");
        let u = tangent.direction(0.1);
        let ku = tangent.product(&u);
        for (i, (numeric, k)) in tangent.derivative(&u, 2.5e-5).iter().zip(&ku).enumerate() {
            assert!((numeric - k).abs() < 1e-6 * largest(&ku), "{i}: {numeric} {k} of {}", largest(&ku));
        }
    }
}

/// On springs, of which some stick and others slip: the direction of a slip is that of its spring.
#[test]
fn the_whole_tangent_with_springs_in_space_is_the_derivative_of_the_residual() {
    let mut model = strike_in_space();
    let nodes = model.contacts[0].kinematics.secondary().len();
    model.contacts[0].interface = Box::new(Penalty);
    model.contacts[0].springs = Some(Springs {
        factors: [200.0, 60.0],
        diagonal: OfRows { of_rows: vec![1.0; nodes], ..OfRows::default() },
    });
    let mut friction = Friction::coulomb(0.3, 64);
    (friction.slip, friction.decay) = (Some(0.2), 0.3);
    model.contacts[0].friction = Some(friction);
    let scheme = Scheme::chung_hulbert(0.6).unwrap();
    let mut state = touching(&model, 0.0, |dof, z| z - 0.015 + 1e-3 * wave(dof, 0.6));
    // Of those closed at the start, whose springs end the step well inside or outside the cone.
    let closed = state.pairs[0].iter_mut().filter(|pair| pair.active);
    for (k, pair) in closed.enumerate() {
        let cone = if k % 2 == 0 { 0.05 } else { 0.6 } * pair.lambda;
        pair.tangential.before = [0.8 * cone, -0.6 * cone];
        pair.tangential.friction_state =
            if k % 2 == 0 { FrictionState::Stick } else { FrictionState::of(pair.tangential.before, 0.0) };
    }
    let equations = equations(&model, &state, &scheme, DT, DT);
    let mut tangent = Tangent::from(&equations, Iterate::at_start(&state), 1e-4);
    let holds = tangent.at.pairings[0]
        .pairs
        .iter()
        .filter(|pair| pair.active)
        .map(|pair| pair.tangential.friction_state);
    let sticks = holds.clone().filter(|friction_state| *friction_state == FrictionState::Stick).count();
    assert!(sticks > 1 && holds.count() > sticks + 1, "{sticks}");
    let u = tangent.direction(0.1);
    let u: Vec<f64> = u.iter().take(model.free.len()).copied().chain(vec![0.0; tangent.rows.len()]).collect();
    let ku = tangent.product(&u);
    let free = model.free.len();
    for (i, (numeric, k)) in tangent.derivative(&u, 2.5e-6).iter().zip(&ku).take(free).enumerate() {
        assert!((numeric - k).abs() < 1e-6 * largest(&ku[..free]), "{i}: {numeric} {k} of {}", largest(&ku));
    }
}

/// A block fixed at the left and moved at the right, with a pressure on another side.
fn pressed(on: &str, pressure: &str) -> Model {
    let block = generate::rectangle(Element::T6, [0.0, 0.0], [1.0, 1.0], [3, 2]).unwrap();
    let parts = parts([block], Law::NeoHookean { lambda: 20.0, mu: 10.0 }, 1.0);
    let read = |text: &str| Formula::parse(text, &["X", "Y", "t"]).unwrap();
    let fixed: Vec<usize> =
        nodes(&parts[0], "left").into_iter().flat_map(|node| [2 * node, 2 * node + 1]).collect();
    let mut right = nodes(&parts[0], "right");
    right.sort_unstable();
    let place = |node: usize| parts[0].body.mesh().nodes[node].to_vec();
    let moved = right.iter().flat_map(|&node| [0, 1].map(|axis| (2 * node + axis, axis, place(node))));
    let along = |text| Motion::Displacement { label: "the right side".to_owned(), formula: read(text) };
    let motions = ["0.1*t", "t^2"].map(along).to_vec();
    let motions = Motions::new(motions, moved);
    let mut loads = Loads::default();
    let side = loaded(&parts[0], on);
    loads.add_pressure(Load { on: side, value: vec![read(pressure)], label: on.to_owned(), amplitude: None });
    model(parts, &fixed, motions, loads, Vec::new())
}

/// Follower pressure with free ends and a moving side: the matrix is symmetric only if the ends are
/// constrained and the pressure is uniform.
#[test]
fn the_tangent_under_pressure_is_the_derivative_of_the_residual() {
    let scheme = Scheme::chung_hulbert(0.5).unwrap();
    for (on, pressure, symmetric) in
        [("top", "3", true), ("top", "3*(1 + X^2)", false), ("bottom", "-2", true)]
    {
        let model = pressed(on, pressure);
        let state = at(&model, model.initial_position.clone());
        // Without inertia and with soft springs the pressure dominates the tangent.
        let equations = equations(&model, &state, &scheme, 1e3, 0.1);
        let mut tangent = Tangent::new(&equations, 1e-2);
        let u = tangent.direction(0.1);
        let w = tangent.direction(0.7);
        let ku = tangent.product(&u);
        let kw = tangent.product(&w);
        for (i, (numeric, k)) in tangent.derivative(&u, 1e-4).iter().zip(&ku).enumerate() {
            assert!((numeric - k).abs() < 1e-7 * largest(&ku), "{on} {pressure} {i}: {numeric} {k}");
        }
        let apart = (dot(&ku, &w) - dot(&kw, &u)).abs() / (dot(&ku, &ku) * dot(&w, &w)).sqrt();
        assert_eq!(apart < 1e-12, symmetric, "{on} {pressure}: {apart:e}");
    }
}

/// Also for a discrete gradient, whose tangent is not symmetric.
#[test]
fn the_product_of_a_discrete_gradient_is_the_derivative_of_its_force() {
    let model = pressed("top", "3");
    let at = |size: f64, seed: f64| -> Vec<f64> {
        model.initial_position.iter().enumerate().map(|(i, y)| y + size * wave(i, seed)).collect()
    };
    let before = at(0.02, 0.3);
    let y = at(0.03, 0.9);
    let u = (0..model.dofs()).map(|i| wave(i, 0.1)).collect::<Vec<_>>();
    let mut product = vec![0.0; model.dofs()];
    let at = Configuration { before: Some(&before), ..Configuration::at(&y) };
    model.internal_product(&at, &u, &mut product).unwrap();
    let force = |e: f64| {
        let moved: Vec<f64> = y.iter().zip(&u).map(|(y, u)| y + e * u).collect();
        let mut force = vec![0.0; model.dofs()];
        let at = Configuration { before: Some(&before), ..Configuration::at(&moved) };
        model.internal_force(&at, &mut force, &mut Materials::default()).unwrap();
        force
    };
    let h = 1e-5;
    for (i, ((plus, minus), k)) in force(h).iter().zip(&force(-h)).zip(&product).enumerate() {
        assert!(((plus - minus) / (2.0 * h) - k).abs() < 1e-6 * largest(&product), "{i}");
    }
}

/// Two unmatched tied blocks, held at the left, under a pressure that follows the right sides,
/// whose nodes the tie has too, and the tied side itself.
fn tied_blocks() -> Model {
    let lower = generate::rectangle(Element::T6, [0.0, 0.0], [1.0, 0.5], [2, 1]).unwrap();
    let upper = generate::rectangle(Element::T6, [0.0, 0.5], [1.0, 1.0], [3, 2]).unwrap();
    let parts = parts([lower, upper], Law::NeoHookean { lambda: 20.0, mu: 10.0 }, 1.0);
    let held = [nodes(&parts[0], "left"), nodes(&parts[1], "left")].concat();
    let fixed: Vec<usize> = held.into_iter().flat_map(|node| [2 * node, 2 * node + 1]).collect();
    let mut loads = Loads::default();
    for (part, side) in [(0, "right"), (1, "right"), (1, "bottom")] {
        let value = vec![Formula::parse("3*(1 + X^2)", &["X", "Y", "t"]).unwrap()];
        let on = loaded(&parts[part], side);
        loads.add_pressure(Load { on, value, label: side.to_owned(), amplitude: None });
    }
    tied(model(parts, &fixed, Motions::default(), loads, Vec::new()), (1, "bottom"), (0, "top"))
}

/// With ties, under pressure on tied facets: of the α family and of a discrete gradient.
#[test]
fn the_whole_tangent_with_a_tie_is_the_derivative_of_the_residual() {
    let model = tied_blocks();
    let alpha = Scheme::chung_hulbert(0.5).unwrap();
    for scheme in [&alpha as &dyn Kernel, &EnergyMomentum] {
        let state = at(&model, model.initial_position.clone());
        for dt in [0.01, 1e3] {
            let equations = equations(&model, &state, scheme, dt, 0.1);
            let mut tangent = Tangent::new(&equations, 1e-2);
            let u = tangent.direction(0.1);
            let ku = tangent.product(&u);
            for (i, (numeric, k)) in tangent.derivative(&u, 1e-4).iter().zip(&ku).enumerate() {
                assert!((numeric - k).abs() < 1e-7 * largest(&ku), "{dt} {i}: {numeric} {k}");
            }
        }
    }
}

/// The assembled matrices over the unknowns are TᵀKT, TᵀMT and the symmetric part of TᵀK_ext T.
#[test]
fn assembled_matrices_are_those_of_the_unknowns() {
    let model = tied_blocks();
    let mut matrices = Matrices::new(&model);
    let y: Vec<f64> =
        model.initial_position.iter().enumerate().map(|(i, y)| y + 0.02 * wave(i, 0.3)).collect();
    let mut at = y.clone();
    model.points.carry(&mut at);
    matrices.assemble(&model, &Configuration::at(&at)).unwrap();
    matrices.assemble_loads(&model, 0.0, &at).unwrap();
    let [u, w] = [0.1, 0.7].map(|seed| {
        let values: Vec<f64> = (0..model.free.len()).map(|i| wave(i, seed)).collect();
        let mut all = vec![0.0; model.dofs()];
        model.free.iter().zip(&values).for_each(|(dof, x)| all[*dof] = *x);
        model.points.carry(&mut all);
        (values, all)
    });
    let of_unknowns = |values: &[f64]| {
        let mut product = vec![0.0; model.free.len()];
        matrices.pattern.multiply_add(values, &u.0, &mut product);
        dot(&product, &w.0)
    };
    let mut stiff = vec![0.0; model.dofs()];
    model.internal_product(&Configuration::at(&at), &u.1, &mut stiff).unwrap();
    let mut heavy = vec![0.0; model.dofs()];
    model.mass.multiply_into(&u.1, &mut heavy);
    let loads = |u: &[f64], w: &[f64]| {
        let force = |e: f64| {
            let moved: Vec<f64> = at.iter().zip(u).map(|(y, u)| y + e * u).collect();
            let mut force = vec![0.0; model.dofs()];
            model.loads_into(0.0, &moved, &mut LoadsAt::default(), &mut force).unwrap();
            dot(&force, w)
        };
        (force(1.0) - force(-1.0)) / 2.0
    };
    let follower = 0.5 * (loads(&u.1, &w.1) + loads(&w.1, &u.1));
    for (name, values, expected) in [
        ("stiffness", &matrices.stiffness, dot(&stiff, &w.1)),
        ("mass", &matrices.mass, dot(&heavy, &w.1)),
        ("loads", &matrices.follower, follower),
    ] {
        let found = of_unknowns(values);
        assert!((found - expected).abs() < 1e-11 * expected.abs(), "{name}: {found} {expected}");
    }
}

/// Both solvers find M⁻¹f of the unknowns, M over all nodes pulled back: T(TᵀMT)⁻¹Tᵀf.
#[test]
fn solves_with_the_mass_carry_the_points() {
    let model = tied_blocks();
    let forces: Vec<f64> = (0..model.dofs()).map(|i| wave(i, 0.4)).collect();
    let rows = Constraints::none(2);
    let solvers: [Box<dyn Preconditioner>; 2] =
        [Box::new(Direct::new(&model)), Box::new(Iterative::new(&model))];
    for mut solver in solvers {
        solver.form_mass(&model, &rows).unwrap();
        let mut x = vec![0.0; model.dofs()];
        solver.solve(&model, [&forces, &[]], &mut x, &mut Vec::new()).unwrap();
        let mut carried = x.clone();
        model.points.carry(&mut carried);
        assert_eq!(x, carried);
        let mut left = vec![0.0; model.dofs()];
        model.mass.multiply_into(&x, &mut left);
        left.iter_mut().zip(&forces).for_each(|(left, force)| *left -= force);
        model.points.gather(&mut left);
        let missing = model.free.iter().map(|dof| left[*dof].abs()).fold(0.0, f64::max);
        assert!(missing < 1e-12, "{missing:e}");
    }
}

/// A tied node strikes: its row acts on what carries it, and solves with the frozen tangent satisfy
/// the rows.
#[test]
fn the_whole_tangent_of_a_tied_node_in_contact_is_the_derivative_of_the_residual() {
    let left = generate::rectangle(Element::T6, [0.1, 0.005], [0.5, 0.505], [2, 2]).unwrap();
    let block = generate::rectangle(Element::T6, [0.0, -0.5], [1.0, 0.0], [4, 2]).unwrap();
    let right = generate::rectangle(Element::T6, [0.5, 0.005], [0.9, 0.505], [2, 3]).unwrap();
    let parts = parts([left, block, right], Law::NeoHookean { lambda: 200.0, mu: 15.0 }, 0.25);
    let bottom = nodes(&parts[1], "bottom").into_iter().flat_map(|node| [2 * node, 2 * node + 1]);
    let fixed: Vec<usize> = bottom.collect();
    // The nodes of the left block that strike include the lowest one of the tie.
    let strike = contact(&parts, (0, "bottom"), (1, "top"));
    let model = model(parts, &fixed, Motions::default(), Loads::default(), vec![strike]);
    let model = tied(model, (0, "right"), (2, "left"));
    let mut state = touching(&model, 0.1, |_, y| y);
    model.points.carry(&mut state.a);
    let scheme = Scheme::chung_hulbert(0.6).unwrap();
    let equations = equations(&model, &state, &scheme, DT, DT);
    let mut tangent = Tangent::new(&equations, 1e-3);
    let is_tied = |row: &carom_contact::Row| row.nodes.iter().any(|node| model.points.of(*node).is_some());
    assert!(tangent.rows.rows.iter().any(|row| is_tied(&row)));
    let u = tangent.direction(0.1);
    let ku = tangent.product(&u);
    for (i, (numeric, k)) in tangent.derivative(&u, 2.5e-5).iter().zip(&ku).enumerate() {
        assert!((numeric - k).abs() < 1e-7 * largest(&ku), "{i}: {numeric} {k}");
    }
}

/// Two free unmatched blocks that spin and vibrate: a step of the energy–momentum scheme keeps
/// energy, momentum and angular momentum.
#[test]
fn a_step_of_tied_blocks_keeps_energy_and_momenta() {
    let lower = generate::rectangle(Element::T6, [0.0, 0.0], [1.0, 0.5], [2, 1]).unwrap();
    let upper = generate::rectangle(Element::T6, [0.0, 0.5], [1.0, 1.0], [3, 2]).unwrap();
    let parts = parts([lower, upper], Law::NeoHookean { lambda: 20.0, mu: 10.0 }, 1.0);
    let mut model =
        tied(model(parts, &[], Motions::default(), Loads::default(), Vec::new()), (1, "bottom"), (0, "top"));
    for node in 0..model.dofs() / 2 {
        let [x, y] = [model.reference[2 * node], model.reference[2 * node + 1]];
        model.initial_position[2 * node] = 1.1 * x;
        model.initial_velocity[2 * node] = 0.3 - 2.0 * y;
        model.initial_velocity[2 * node + 1] = 2.2 * x - 0.5;
    }
    let settings = Settings {
        tolerance: 1e-14,
        max_iterations: 20,
        linear: Linear::Direct,
        tangent: FactorRule::Full,
        mixing: 0,
    };
    let stepper = Implicit::new(Box::new(EnergyMomentum), settings);
    let mut work = Workspace::new(&model, Linear::Direct);
    let mut state = start(&model, Inertia::Constrained, None, &mut work.system).unwrap();
    let sums = |state: &State| {
        let mut p = vec![0.0; model.dofs()];
        model.mass.multiply_into(&state.v, &mut p);
        let nodes = state.y.chunks_exact(2).zip(p.chunks_exact(2));
        let momenta =
            nodes.fold([0.0; 3], |s, (y, p)| [s[0] + p[0], s[1] + p[1], s[2] + y[0] * p[1] - y[1] * p[0]]);
        [momenta[0], momenta[1], momenta[2], state.ledger.total()]
    };
    let before = sums(&state);
    let strain = state.ledger.strain;
    for step in 1..=10 {
        state = stepper.step(&model, &state, 0.01, 0.01 * f64::from(step), &mut work).unwrap().into_parts().0;
        for (now, before) in sums(&state).iter().zip(&before) {
            assert!((now - before).abs() < 1e-12, "{step}: {:e}", now - before);
        }
    }
    assert!((state.ledger.strain - strain).abs() > 0.1 * strain);
}
