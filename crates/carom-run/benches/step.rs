//! The components of a step, on the jobs of `cases/perf/` in mid-contact: cells, detection, gaps,
//! assembly and factor, solve, whole steps.
//!
//!     cargo bench -p carom-run                    times
//!     bench/instructions.py carom-run         instructions

use std::collections::BTreeSet;
use std::hint::black_box;
use std::sync::Arc;

use carom_algebra::{Condensed, Elimination, Pattern, Precision};
use carom_contact::{Pair, Pairing, Rows};
use carom_mechanics::Materials;
use carom_run::case::{Case, Document, read};
use carom_run::{GridReport, Simulation, State};
use carom_solid::Configuration;
use divan::{Bencher, counter::ItemsCount};

fn main() {
    divan::main();
}

const SMALL: &str = include_str!("../../../cases/perf/disc-2k.toml");
const LARGE: &str = include_str!("../../../cases/perf/disc-19k.toml");
const BAR: &str = include_str!("../../../cases/perf/bar.toml");

/// A job of the discs, displayed by its dofs.
#[derive(Clone, Copy)]
enum Job {
    Small,
    Large,
}

impl std::fmt::Display for Job {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Small => "2k",
            Self::Large => "19k",
        })
    }
}

const JOBS: [Job; 2] = [Job::Small, Job::Large];

fn case_of(text: &str) -> Case {
    read(&Document::parse("case.toml", text, &[]).expect("the case is in the repository")).expect("valid")
}

fn at_start(job: Job) -> Simulation {
    let text = match job {
        Job::Small => SMALL,
        Job::Large => LARGE,
    };
    carom_run::Setup::new(&case_of(text)).start().expect("valid")
}

fn restored(mut simulation: Simulation, state: State) -> Simulation {
    simulation.restore(state).expect("a state of the same model");
    simulation
}

/// The job with about a dozen nodes (2k) or forty (19k) in contact.
fn in_contact(job: Job) -> Simulation {
    let mut sim = at_start(job);
    while sim.state().step < 60 {
        sim.advance(&mut GridReport::default()).expect("the job runs");
    }
    sim
}

#[divan::bench(args = JOBS)]
fn forces_of_all_cells(bencher: Bencher, job: Job) {
    let sim = in_contact(job);
    let mut force = vec![0.0; sim.model().dofs()];
    let cells: usize = sim.model().parts.iter().map(|p| p.body.mesh().cell_count()).sum();
    let bencher = bencher.counter(ItemsCount::new(cells));
    bencher.bench_local(|| {
        sim.model()
            .internal_force(
                &Configuration::at(black_box(&sim.state().y)),
                &mut force,
                &mut Materials::default(),
            )
            .is_ok()
    });
}

#[divan::bench(args = JOBS)]
fn tangents_of_all_cells(bencher: Bencher, job: Job) {
    let sim = in_contact(job);
    let (mut force, mut tangent) = ([0.0; 20], [0.0; 400]);
    let cells: usize = sim.model().parts.iter().map(|p| p.body.mesh().cell_count()).sum();
    let bencher = bencher.counter(ItemsCount::new(cells));
    bencher.bench_local(|| {
        for part in &sim.model().parts {
            let y = part.of(&sim.state().y);
            for cell in 0..part.body.mesh().cell_count() {
                black_box(part.body.cell_tangent(cell, y, &mut force, &mut tangent).is_ok());
            }
        }
    });
}

#[divan::bench(args = JOBS)]
fn assembly(bencher: Bencher, job: Job) {
    let mut sim = in_contact(job);
    bencher.bench_local(|| sim.assemble().is_ok());
}

#[divan::bench(args = JOBS)]
fn mass_times_vector(bencher: Bencher, job: Job) {
    let sim = in_contact(job);
    let mut out = vec![0.0; sim.model().dofs()];
    bencher.bench_local(|| sim.model().mass.multiply_into(black_box(&sim.state().v), &mut out));
}

#[divan::bench(args = JOBS)]
fn detection(bencher: Bencher, job: Job) {
    let sim = in_contact(job);
    let y = &sim.state().y;
    bencher.bench_local(|| {
        let mut pairing = Pairing::new(sim.state().pairs[0].clone());
        sim.model().contacts[0].kinematics.search(y, black_box(y), &mut pairing, &mut Vec::new())
    });
}

#[divan::bench(args = JOBS)]
fn gaps(bencher: Bencher, job: Job) {
    let sim = in_contact(job);
    let y = &sim.state().y;
    let kinematics = &sim.model().contacts[0].kinematics;
    let mut rows = Rows::new(2);
    assert!(kinematics.measure(&mut sim.state().pairs[0][0].clone(), y, &mut rows).is_ok());
    let mut curvature = vec![0.0; rows.row(0).gradient.len().pow(2)];
    bencher.counter(ItemsCount::new(sim.state().pairs[0].len())).bench_local(|| {
        rows.clear();
        for mut pair in sim.state().pairs[0].iter().copied() {
            black_box(kinematics.measure(&mut pair, black_box(y), &mut rows).is_ok());
            kinematics.curvature_into(&pair, black_box(y), &mut curvature);
        }
    });
}

/// The consistent mass on the pattern of the tangent, positive definite; the nodes on which pairs
/// act are eliminated last.
fn mass_matrix(sim: &Simulation) -> (Pattern, Vec<f64>, Vec<usize>, Vec<usize>) {
    let mass = &sim.model().mass;
    let entries = (0..mass.nodes()).flat_map(|a| mass.row(a).map(move |(b, value)| (a, b, value)));
    let entries: Vec<_> = entries
        .flat_map(|(a, b, v)| {
            [(0, 0), (0, 1), (1, 0), (1, 1)]
                .map(|(i, j)| (2 * a + i, 2 * b + j, if i == j { v } else { 0.0 }))
        })
        .filter(|(i, j, _)| i >= j)
        .collect();
    let pattern = Pattern::from_entries(sim.model().dofs(), entries.iter().map(|&(i, j, _)| (i, j)));
    let mut values = vec![0.0; pattern.len()];
    for (i, j, value) in entries {
        values[pattern.slot(i, j).expect("just made")] += value;
    }
    let groups = (0..sim.model().dofs()).map(|dof| dof / 2).collect();
    let kinematics = &sim.model().contacts[0].kinematics;
    let nodes_of =
        |pair: &Pair| [&[kinematics.secondary()[pair.node]], kinematics.facet_nodes(pair)].concat();
    let contact_nodes: BTreeSet<usize> = sim.state().pairs[0].iter().flat_map(nodes_of).collect();
    let last = contact_nodes.iter().flat_map(|n| [2 * n, 2 * n + 1]).collect();
    (pattern, values, groups, last)
}

#[divan::bench(args = JOBS)]
fn ordering_and_analysis(bencher: Bencher, job: Job) {
    let (pattern, _, groups, last) = mass_matrix(&in_contact(job));
    bencher.bench_local(|| Elimination::new(black_box(&pattern), &groups, &last).is_ok());
}

/// As in a run of the job.
fn precision(job: Job) -> Precision {
    match job {
        Job::Small => Precision::Double,
        Job::Large => Precision::Single,
    }
}

#[divan::bench(args = JOBS)]
fn factor(bencher: Bencher, job: Job) {
    let (pattern, values, groups, last) = mass_matrix(&in_contact(job));
    let elimination = Arc::new(Elimination::new(&pattern, &groups, &last).expect("memory"));
    let mut condensed = Condensed::new(&elimination, precision(job));
    bencher.bench_local(|| condensed.factor(|k| values[k]).is_ok());
}

#[divan::bench(args = JOBS)]
fn solve(bencher: Bencher, job: Job) {
    let (pattern, values, groups, last) = mass_matrix(&in_contact(job));
    let elimination = Arc::new(Elimination::new(&pattern, &groups, &last).expect("memory"));
    let mut condensed = Condensed::new(&elimination, precision(job));
    condensed.factor(|k| values[k]).expect("positive definite");
    let (right, mut x, mut out) = (vec![1.0; pattern.size()], Vec::new(), vec![0.0; pattern.size()]);
    bencher.bench_local(|| {
        condensed.eliminate_into(black_box(&right), &mut x);
        condensed.substitute_into(&mut x, &mut out);
    });
}

#[divan::bench(args = JOBS, sample_count = 5, sample_size = 1)]
fn ten_steps(bencher: Bencher, job: Job) {
    let state = in_contact(job).into_state();
    bencher.with_inputs(|| restored(at_start(job), state.clone())).bench_local_values(|mut sim| {
        for _ in 0..10 {
            black_box(sim.advance(&mut GridReport::default()).is_ok());
        }
    });
}

#[divan::bench(sample_count = 10, sample_size = 1)]
fn thousand_steps_of_a_bar(bencher: Bencher) {
    let case = case_of(BAR);
    bencher.with_inputs(|| carom_run::Setup::new(&case).start().expect("valid")).bench_local_values(
        |mut sim| {
            for _ in 0..1000 {
                black_box(sim.advance(&mut GridReport::default()).is_ok());
            }
        },
    );
}
