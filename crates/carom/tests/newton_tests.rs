//! The whole Newton matrix against differences of the whole residual.

use super::*;
use crate::balance::known_into;
use crate::case::{Document, read};
use crate::evaluation::add_gradient;
use crate::simulation::{GridReport, Simulation};
use carom_time::{Kernel, Memory};

/// The whole Newton matrix, contact active and sliding, against differences of the whole residual along random directions; and its symmetry.
#[test]
fn the_whole_tangent_with_contact_is_the_derivative_of_the_residual() {
    let text = include_str!("../../../cases/impact/impact.toml");
    for scheme in
        [r#"{ kind = "chung-hulbert", rho_inf = 0.6 }"#, r#"{ kind = "hht", alpha = 0.2, forces = "average-state" }"#]
    {
        let sets = ["body.cylinder.mesh.size=0.25", "body.prism.mesh.cells=[4,2]"].map(String::from).to_vec();
        let sets = [sets, vec![format!("time.scheme={scheme}")]].concat();
        let case = read(&Document::parse("impact.toml", text, &sets).unwrap()).unwrap();
        let mut sim = Simulation::<2>::new(&case, 1).unwrap();
        while sim.state.time < 0.42 {
            sim.advance(&mut GridReport::default()).unwrap();
        }
        let (model, state) = (&sim.model, &sim.state);
        let mut work = Workspace::new(model, 1);
        let memory = Memory { states: &[(&state.y, &state.v, &state.a)], before: None };
        case.time.scheme.integrator().unwrap().alpha().unwrap().stage_into(0, sim.dt, &memory, &mut work.stage);
        known_into(model, &work.stage, state, &mut work.forces);
        let wave = |i: usize, seed: f64| ((i as f64 + seed) * 12.9898).sin();
        let increment: Vec<f64> =
            (0..model.dofs()).map(|i| if model.fixed[i] { 0.0 } else { 1e-3 * wave(i, 0.3) }).collect();
        let mut trial =
            Trial { increment: increment.clone(), y: state.y.clone(), pairs: state.pairs.clone(), strain: 0.0 };
        evaluate(model, state, &mut trial, &mut work, true).unwrap();
        let rows = independent_rows(model, &trial.pairs, &work);
        assert!(rows.len() > 3);
        linear_step(model, &mut work, &rows).unwrap();

        let size = model.free.len() + rows.len();
        let direction = |seed: f64| -> Vec<f64> { (0..size).map(|i| wave(i, seed)).collect() };
        let (u, w) = (direction(0.1), direction(0.7));
        let (ku, kw) = (work.system.product(&u), work.system.product(&w));
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        assert!((dot(&ku, &w) - dot(&kw, &u)).abs() < 1e-12 * dot(&ku, &ku).sqrt() * dot(&w, &w).sqrt());

        let base = trial.clone();
        let mut residual = |e: f64| -> Vec<f64> {
            let mut at = base.clone();
            for (place, &dof) in model.free.iter().enumerate() {
                at.increment[dof] = increment[dof] + e * u[place];
            }
            for (r, &(k, p)) in rows.iter().enumerate() {
                at.pairs[k][p].lambda += e * u[model.free.len() + r];
            }
            evaluate(model, state, &mut at, &mut work, false).unwrap();
            let weight = |k: usize| contact_weights(&work.stage, model.contacts[k].force).0;
            let gaps = rows.iter().map(|&(k, p)| weight(k) * work.gaps[k][p].gap);
            model.free.iter().map(|&dof| work.residual[dof]).chain(gaps).collect()
        };
        let mut slope = |h: f64| -> Vec<f64> {
            let (plus, minus) = (residual(h), residual(-h));
            plus.iter().zip(&minus).map(|(p, m)| (p - m) / (2.0 * h)).collect()
        };
        let (fine, coarse) = (slope(2.5e-5), slope(5e-5));
        let size = ku.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for i in 0..ku.len() {
            let numeric = (4.0 * fine[i] - coarse[i]) / 3.0;
            assert!((numeric - ku[i]).abs() < 1e-7 * size, "{scheme} {i}: {numeric} {}", ku[i]);
        }
    }
}

/// Follower pressure with open, free ends and a moving side: the quadratic form of the symmetric matrix is that of the residual's derivative, and where
/// the ends are held and the pressure is uniform the whole matrix is.
#[test]
fn the_tangent_under_pressure_is_the_symmetric_part_of_the_derivative() {
    let text = |on: &str, pressure: &str| {
        format!(
            r#"
dimension = 2
material = [{{ name = "rubber", law = "neo-hookean", density = 1.0, lambda = 20.0, mu = 10.0 }}]
support = [{{ on = ["block.left"], fix = ["x", "y"] }}, {{ on = ["block.right"], move = {{ x = "0.1*t", y = "t^2" }} }}]
load = [{{ on = ["block.{on}"], pressure = "{pressure}" }}]
time = {{ end = 0.1, step = 0.1, scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }} }}
[[body]]
name = "block"
material = "rubber"
element = "T6"
mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [3, 2] }}
"#
        )
    };
    for (on, pressure, symmetric) in [("top", "3", true), ("top", "3*(1 + X^2)", false), ("bottom", "-2", true)] {
        let text = text(on, pressure);
        let case = read(&Document::parse("a.toml", &text, &[]).unwrap()).unwrap();
        let sim = Simulation::<2>::new(&case, 1).unwrap();
        let (model, state) = (&sim.model, &sim.state);
        let mut work = Workspace::new(model, 1);
        let memory = Memory { states: &[(&state.y, &state.v, &state.a)], before: None };
        // Without inertia and with soft springs the pressure is a good part of the tangent.
        case.time.scheme.kernel().unwrap().stage_into(0, 1e3, &memory, &mut work.stage);
        model.loads.at(&model.parts, model.dofs(), 0.1, &mut work.loads).unwrap();
        work.system.loads_tangent(model, &work.loads);
        known_into(model, &work.stage, state, &mut work.forces);
        let wave = |i: usize, seed: f64| ((i as f64 + seed) * 12.9898).sin();
        let increment: Vec<f64> =
            (0..model.dofs()).map(|i| if model.fixed[i] { 0.0 } else { 1e-2 * wave(i, 0.3) }).collect();
        let mut trial = Trial { increment: increment.clone(), y: state.y.clone(), pairs: vec![], strain: 0.0 };
        evaluate(model, state, &mut trial, &mut work, true).unwrap();
        linear_step(model, &mut work, &[]).unwrap();
        let u: Vec<f64> = (0..model.free.len()).map(|i| wave(i, 0.1)).collect();
        let ku = work.system.product(&u);
        let mut residual = |e: f64| -> Vec<f64> {
            let mut at = trial.clone();
            for (place, &dof) in model.free.iter().enumerate() {
                at.increment[dof] = increment[dof] + e * u[place];
            }
            evaluate(model, state, &mut at, &mut work, false).unwrap();
            model.free.iter().map(|&dof| work.residual[dof]).collect()
        };
        let mut slope = |h: f64| -> Vec<f64> {
            let (plus, minus) = (residual(h), residual(-h));
            plus.iter().zip(&minus).map(|(p, m)| (p - m) / (2.0 * h)).collect()
        };
        let (fine, coarse) = (slope(1e-4), slope(2e-4));
        let size = ku.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut form = 0.0;
        let mut largest = 0.0_f64;
        for i in 0..ku.len() {
            let numeric = (4.0 * fine[i] - coarse[i]) / 3.0;
            form += u[i] * (numeric - ku[i]);
            largest = largest.max((numeric - ku[i]).abs());
        }
        assert!(form.abs() < 1e-7 * size, "{on} {pressure}: {form:e}");
        assert_eq!(largest < 1e-7 * size, symmetric, "{on} {pressure}: {largest:e}");
    }
}

/// What the next step takes its share of is the force of the pairs the state has, gaps and normals taken anew.
#[test]
fn the_contact_force_of_every_state_is_that_of_its_pairs() {
    let text = include_str!("../../../cases/impact/whole.toml");
    let case = read(&Document::parse("whole.toml", text, &[]).unwrap()).unwrap();
    let mut sim = Simulation::<2>::new(&case, 1).unwrap();
    let (mut gap, mut touched) = (Linearised::default(), 0);
    while sim.state.time < 0.36 {
        sim.advance(&mut GridReport::default()).unwrap();
        let mut force = vec![0.0; sim.model.dofs()];
        let y = sim.state.y.as_chunks::<2>().0;
        for pair in sim.state.pairs[0].clone().iter_mut().filter(|pair| pair.active) {
            sim.model.contacts[0].method.linearise(pair, y, 0.0, &mut gap).unwrap();
            add_gradient(&gap, pair.lambda, &mut force);
            touched += 1;
        }
        let apart = force.iter().zip(&sim.state.f_contact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-12 * (1.0 + max_abs(&force)), "step {}: {apart:e}", sim.state.step);
    }
    assert!(touched > 100);
}
