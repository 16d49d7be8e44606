//! Initial states other than the reference configuration: of a manufactured motion, or `[initial]
//! from`, positions, velocities and contact at the end of another run of the same meshes.
//!
//! The meshes are rebuilt from the resolved case of that run and compared node by node: names alone
//! would not detect a changed mesh.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use carom_case::{Case, InitialSpec, Problem, Units, Velocities};
use carom_mechanics::model::{Manufactured, Model, Tie, past_of};
use carom_mechanics::{Grid, InitialState, State, inside};
use carom_record::{Manifest, Status, last_checkpoint};
use carom_solid::Mesh;

use crate::build;
use crate::initial_obstacles::Continued;
use crate::initial_pairs::{self, Found};
use crate::saved_state;

/// The initial state of a manufactured motion.
///
/// # Errors
/// If a formula has no value at t = 0.
pub(crate) fn given(motion: &Manufactured, model: &Model) -> Result<InitialState, Vec<Problem>> {
    let mut y = Vec::new();
    let mut v = Vec::new();
    for place in model.reference.chunks_exact(model.dimension) {
        let [position, velocity] = motion.motion(place, 0.0).map_err(|error| {
            let help = "change the formula so that it has a finite value in the whole body";
            vec![Problem::new(
                "manufactured.y",
                "the motion has no finite value at t = 0",
                error.to_string(),
                help,
            )]
        })?;
        y.extend(position);
        v.extend(velocity);
    }
    Ok(InitialState {
        y,
        v,
        pairs: vec![Vec::new(); model.contacts.len()],
        slid: BTreeMap::new(),
        memory: Vec::new(),
    })
}

/// Reads the end of the run from which a case starts.
///
/// # Errors
/// If there is no such run, it is not finished, or its bodies are not those of the case; all under
/// `initial.from`.
pub(crate) fn before(spec: &InitialSpec, case: &Case, model: &Model) -> Result<InitialState, Vec<Problem>> {
    let directory = spec.from.display();
    let wrong = |what: String, why: String, help: &str| vec![Problem::new("initial.from", what, why, help)];
    let unreadable = |why: String| {
        let help = "give the directory of a finished run, relative to the folder of the case";
        wrong(format!("the final state of the run {directory} cannot be used"), why, help)
    };
    let manifest = Manifest::read(&spec.from).map_err(|e| unreadable(e.to_string()))?;
    if manifest.status != Status::Finished {
        let (why, help) = match manifest.status {
            Status::Failed => ("it stopped before its end", "give it an earlier `time.end`, before it stops"),
            _ => ("it was interrupted, or is running", "let it finish with `carom resume`"),
        };
        return Err(wrong(format!("the run {directory} is not finished"), why.to_owned(), help));
    }
    let payload = last_checkpoint(&spec.from).map_err(|e| unreadable(e.to_string()))?;
    let version = |e: String| unreadable(format!("it was written by Carom {}: {e}", manifest.version));
    let old = Case::from_json(manifest.case.clone()).map_err(|e| version(e.to_string()))?;
    let state: State = postcard::from_bytes(&payload).map_err(|e| version(e.to_string()))?;
    let steps = old.time.steps();
    if state.step as usize != steps {
        let why = format!("its last intact checkpoint is that of step {} of {steps}", state.step);
        return Err(wrong(format!("the run {directory} is damaged"), why, "run its case again"));
    }
    let d = model.dimension;
    if old.dimension != d {
        let why = format!("it has dimension {}, the case {d}", old.dimension);
        return Err(wrong(
            "the runs do not have the same dimension".into(),
            why,
            "start from a run of the same bodies",
        ));
    }
    if case.units.declared && old.units.declared && case.units != old.units {
        let named = |units: &Units| format!("{}, {}, {}", units.length, units.time, units.mass);
        let why = format!(
            "it has {}, the case {}; numbers are not converted",
            named(&old.units),
            named(&case.units)
        );
        return Err(wrong("the runs do not have the same units".into(), why, "give both the same [units]"));
    }

    let mut before = InitialState {
        y: model.reference.clone(),
        v: vec![0.0; model.dofs()],
        pairs: Vec::new(),
        slid: BTreeMap::new(),
        memory: remembered(&old, &state, model)?,
    };
    let mut meshes = Vec::new();
    let mut first = 0;
    let made = build::tied_meshes(&old).map_err(|problems| {
        let why =
            problems.first().map_or_else(String::new, |problem| format!("{}: {}", problem.what, problem.why));
        unreadable(why)
    })?;
    for (body, mesh) in old.bodies.iter().zip(made) {
        let nodes = mesh.nodes.len();
        meshes.push((&body.name, first, mesh));
        first += nodes;
    }
    // The nodes of moving obstacles come after the bodies.
    let carriers: usize = old.contacts.iter().map(|contact| contact.motion.nodes(d)).sum();
    if state.y.len() != (first + carriers) * d {
        return Err(unreadable(format!("its state has {} nodes, its meshes {first}", state.y.len() / d)));
    }
    for part in model.parts.iter().filter(|part| !part.is_rigid()) {
        let mesh = part.body.mesh();
        let Some((_, first, old)) = meshes.iter().find(|(name, ..)| **name == part.name) else {
            let names: Vec<_> = meshes.iter().map(|(name, ..)| name.as_str()).collect();
            let why = format!("its bodies are: {}", names.join(", "));
            return Err(wrong(
                format!("the run {directory} has no body \"{}\"", part.name),
                why,
                "start from a run of the same bodies",
            ));
        };
        if !same_nodes(old, mesh, !case.ties.is_empty())
            || old.cells != mesh.cells
            || old.element != mesh.element
        {
            let count = |m: &carom_solid::Mesh| {
                format!("{} nodes, {} cells {:?}", m.nodes.len(), m.cell_count(), m.element)
            };
            let why = format!(
                "there it has {}, here {}; nodes and cells must be the same to the last digit",
                count(old),
                count(mesh)
            );
            return Err(wrong(
                format!("body \"{}\" has another mesh in {directory}", part.name),
                why,
                "give both cases the same `mesh` and `element`",
            ));
        }
        let to = part.first_node * d;
        let from = first * d;
        let length = mesh.nodes.len() * d;
        before.y[to..to + length].copy_from_slice(&state.y[from..from + length]);
        if spec.velocities == Velocities::Keep {
            before.v[to..to + length].copy_from_slice(&state.v[from..from + length]);
        }
    }
    for (dof, fixed) in model.fixed.iter().enumerate() {
        if *fixed {
            before.v[dof] = 0.0;
        }
    }
    carry(model, &mut before, &directory.to_string())?;
    let free =
        Continued { case, model, old: &old, state: &state, first }.go_on(spec.velocities, &mut before)?;
    let known = OnceCell::new();
    let depths = || &**known.get_or_init(|| depths_of(&old, &state));
    let Found { pairs, slid, left } =
        initial_pairs::found(case, model, &before.y, &old, &state, &free, depths);
    if let Some(problem) = initial_pairs::overlap(case, model, &before.y, &left) {
        return Err(vec![problem]);
    }
    (before.pairs, before.slid) = (pairs, slid);
    Ok(before)
}

/// How deep the bodies of each contact of a run are at its end; empty if it cannot be built again,
/// with laws of the user's own.
fn depths_of(old: &Case, state: &State) -> Vec<f64> {
    let Ok(whole) = build::build(old, &build::Materials::default()) else { return Vec::new() };
    let mut depths = vec![0.0; whole.contacts.len()];
    for place in inside(&whole, &state.y, 0.0) {
        depths[place.contact] = place.depth;
    }
    depths
}

/// Memory of the materials of a model, as the run left it: for each body, of its materials there.
///
/// # Errors
/// The material of a body remembers other things there.
fn remembered(old: &Case, state: &State, model: &Model) -> Result<Vec<f64>, Vec<Problem>> {
    let memory = state.materials.past(0.0).memory;
    if memory.is_empty() {
        return Ok(Vec::new());
    }
    let whole = build::build(old, &build::Materials::default())?;
    let mut own = Vec::new();
    for part in &model.parts {
        let there = whole.parts.iter().position(|other| other.name == part.name);
        let past = there.map_or(&[][..], |k| past_of(&whole.parts, k, memory).memory);
        // A body of an elastic material has no past.
        if past.is_empty() || past.len() == part.memory() {
            own.extend_from_slice(past);
            own.resize(own.len() + part.memory() - past.len(), 0.0);
            continue;
        }
        let what =
            format!("the material of body \"{}\" remembers something else in the other run", part.name);
        let why = format!("there its points remember {} numbers, here {}", past.len(), part.memory());
        let help = "give the body a material of the same law, in the same plane state";
        return Err(vec![Problem::new("initial.from", what, why, help)]);
    }
    Ok(own)
}

/// Difference of positions, over L, and of velocities, over the largest, that is round-off.
const NEAR: f64 = 1e-9;

/// Whether meshes have the same nodes; `tied`: but for the round-off of nodes that a tie moves.
fn same_nodes(old: &Mesh, mesh: &Mesh, tied: bool) -> bool {
    let apart = |(a, b): (&f64, &f64)| (a - b).abs() > NEAR * mesh.diameter();
    let is_near =
        || old.nodes.len() == mesh.nodes.len() && !old.nodes.flat().iter().zip(mesh.nodes.flat()).any(apart);
    old.nodes == mesh.nodes || tied && is_near()
}

/// Gives tied nodes the exact motion of what carries them.
///
/// # Errors
/// The sides of a tie are apart, or move apart, at the end of the run.
fn carry(model: &Model, before: &mut InitialState, directory: &str) -> Result<(), Vec<Problem>> {
    let fastest = before.v.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let help = "let the other run have the same tie; where only velocities differ, `velocities = \"zero\"` starts at rest";
    for (values, unit, verb) in [(&mut before.y, model.scale, "are"), (&mut before.v, fastest, "move")] {
        let given = values.clone();
        model.points.carry(values);
        let apart = |(a, b): (&f64, &f64)| (a - b).abs() > NEAR * unit;
        if let Some(dof) = values.iter().zip(&given).position(apart) {
            let node = dof / model.dimension;
            let has = |tie: &&Tie| tie.tied.iter().any(|nodes| nodes.contains(&node));
            let tie = model.ties.iter().find(has).map_or("", |tie| tie.name.as_str());
            let what = format!("the sides of tie `{tie}` {verb} apart at the end of the run {directory}");
            let why = format!(
                "at a tied node, {} on the secondary side and {} on the primary one",
                given[dof], values[dof]
            );
            return Err(vec![Problem::new("initial.from", what, why, help)]);
        }
    }
    Ok(())
}

/// The state from which a case continues, if its `[initial]` names a file and not a run.
///
/// # Errors
/// The file is not a state.
pub(crate) fn saved(initial: Option<&InitialSpec>) -> Result<Option<State>, Vec<Problem>> {
    let Some(InitialSpec { from, velocities }) = initial.filter(|initial| initial.from.is_file()) else {
        return Ok(None);
    };
    let problem = |key: &str, what: String, why: String, help: &str| {
        Err(vec![Problem::new(format!("initial.{key}"), what, why, help)])
    };
    if *velocities == Velocities::Zero {
        let what = "the velocities of a saved state cannot be set to zero".to_owned();
        let why = "the case continues from it with everything that the next step depends on".to_owned();
        return problem(
            "velocities",
            what,
            why,
            "leave `velocities` out, or start from the directory of a run",
        );
    }
    match saved_state::read(from) {
        Ok(state) => Ok(Some(state)),
        Err(why) => problem(
            "from",
            format!("the state {} cannot be used", from.display()),
            why,
            "give a state.bin that `carom reduce` wrote, or the directory of a finished run",
        ),
    }
}

/// Whether a case continues from a saved state: then its step and phase are those of the state.
pub(crate) fn continues(case: &Case) -> bool {
    case.initial.as_ref().is_some_and(|initial| initial.from.is_file())
}

/// Checks that a case has the clock of the run which the state continues.
///
/// # Errors
/// The step, phase or end of the case is another one.
pub(crate) fn on_the_grid(state: &State, grid: &Grid) -> Result<(), Vec<Problem>> {
    let step = state.step;
    let time = state.time;
    let refused = |key: &str, what: String, why: String, help: String| {
        Err(vec![Problem::new(format!("time.{key}"), what, why, help)])
    };
    if step >= grid.steps {
        let what = format!("the run ends before the state from which it continues, that of t = {time:?}");
        let why = format!("the state is that of step {step}, and the run has {} steps", grid.steps);
        return refused("end", what, why, "give a later end".to_owned());
    }
    let here = grid.time(step);
    if (here - time).abs() > 1e-9 * grid.dt {
        let what = "the step is not that of the run which the state continues".to_owned();
        let why =
            format!("the state is that of step {step} at t = {time:?}; here step {step} is at {here:?}");
        let help = "give the step and phase of that run; to change them, start from t = 0, or from the \
                    directory of a finished run";
        return refused("step", what, why, help.to_owned());
    }
    Ok(())
}
