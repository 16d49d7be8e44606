//! Initial overlap of the bodies of a contact: kept, or closed before the start.
//!
//! `overlap = "keep-gap"` adds its initial depth to the gap of each node, to the end of the run,
//! and `overlap = "touch"` also subtracts its initial distance.
//!
//! `overlap = "relax"` finds the equilibrium in which the gaps are closed: an interference fit. The
//! depths that the nodes keep are reduced in stages to zero, or to the deviation of straight cells
//! from the curved sides that they stand for, and each stage is solved by steps of the proximal
//! point method in the metric of the mass matrix,
//!
//! ```text
//! y_k+1 = argmin U(y) + |y − y_k|²_M / 2τ²   with   g(y) + (1 − s) depth ≥ 0,
//! ```
//!
//! which are steps of backward Euler from rest. With τ much longer than the longest period of the
//! bodies a step is nearly static; bodies that supports leave free keep their centre of mass, and
//! need no other regularisation. They find the same minimum for every τ, which grows where the
//! energy settles slowly: where bodies that nothing holds turn relative to each other. Loads and
//! gravity do not act. The run starts from the positions found, with the velocities of the case,
//! and the energy that the bodies then store is in its first row.

use std::collections::{BTreeMap, BTreeSet};

use carom_case::{
    BodySpec, Case, ContactLaw, FormulaSpec, FrictionSpec, Law, MassKind, ObstacleMotion, Overlap,
    Persistency, Problem, SchemeSpec,
};
use carom_contact::{Pairing, Rows};
use carom_mechanics::model::Model;
use carom_mechanics::{Grid, Implicit, InitialState, Linear, Settings, Simulation, Stepper, Tangent, depths};
use carom_solid::longest_edge;
use carom_time::ForceRule;

use crate::build::side::owner;
use crate::build::{Materials, build, overlaps};
use crate::quantity::quantity;

/// Distance of sides that touch all over, over the length of a facet, beyond which a gap is one.
const TOUCHING: f64 = 0.25;

/// Stages in which the depths are reduced.
const STAGES: u32 = 8;
/// First τ as a multiple of the time in which a wave crosses the largest body.
const LONG: f64 = 100.0;
/// Relative change of the strain energy in a step with which the equilibrium is reached. Positions
/// would not do: bodies that may turn freely turn a little in every step, since the energy hardly
/// depends on how facets of different lengths lie on each other.
const SETTLED: f64 = 1e-10;
/// Most steps with one τ.
const MOST: u32 = 20;
/// Growth of τ where they were not enough, and number of its values. With the last one, inertia is
/// about 1e-10 of the stiffness of a body, well above round-off.
const LONGER: f64 = 10.0;
const ROUNDS: u32 = 4;
/// Gap, relative to L, at which a pair is closed.
const CLOSED: f64 = 1e-9;
/// Stretch of a body of small strain by its rotation, over the overlap, that is allowed.
const SWELLS: f64 = 0.01;

/// Deviation of straight cells from their curve, over the overlap, up to which an overlap is known:
/// the deviation is known to half a percent.
const CHORDS: f64 = 20.0;

/// A node of a contact inside the body of the other side.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct OverlapNode {
    /// Contact.
    pub contact: String,
    /// Global number.
    pub node: usize,
    /// The body of the node.
    pub body: String,
    /// Initial position.
    pub at: Vec<f64>,
    /// Depth below the other side.
    pub depth: f64,
    /// Treatment of the overlap by the case.
    pub overlap: Overlap,
}

/// The nodes that overlap at the start, by contact, the deepest first.
pub fn overlapping(case: &Case, model: &Model) -> Vec<OverlapNode> {
    let y = &model.initial_position;
    let d = model.dimension;
    let mut nodes = Vec::new();
    // Behind a side, but outside its body, nothing overlaps.
    let overlap: BTreeSet<usize> =
        carom_mechanics::inside(model, y, CLOSED * model.scale).iter().map(|place| place.contact).collect();
    for (k, depths) in depths(model, y).iter().enumerate() {
        let keeps = matches!(case.contacts[k].overlap, Overlap::KeepGap | Overlap::Touch);
        let is_treated = keeps || case.contacts[k].overlap == Overlap::Relax;
        if !is_treated && !overlap.contains(&k) {
            continue;
        }
        let contact = &model.contacts[k];
        let first = nodes.len();
        for (place, &node) in contact.kinematics.secondary().iter().enumerate() {
            let kept = if keeps { contact.kinematics.kept(place) } else { 0.0 };
            let depth = depths[place] + kept;
            if depth > CLOSED * model.scale {
                let body = owner(&model.parts, node);
                nodes.push(OverlapNode {
                    contact: contact.name.clone(),
                    node,
                    body: body.map_or_else(String::new, |part| part.name.clone()),
                    at: y[node * d..(node + 1) * d].to_vec(),
                    depth,
                    overlap: case.contacts[k].overlap,
                });
            }
        }
        nodes[first..].sort_by(|a, b| b.depth.total_cmp(&a.depth));
    }
    nodes
}

/// Gives the contacts of a model the initial depths that they keep: the overlap of the bodies, or
/// the deviation of straight cells from the curved sides whose overlap is closed.
pub(crate) fn keep(case: &Case, model: &mut Model) {
    for (contact, spec) in model.contacts.iter_mut().zip(&case.contacts) {
        if spec.overlap == Overlap::Relax {
            let heights = contact.kinematics.roundings(&model.initial_position);
            let is_round = heights.iter().any(|height| height.abs() > CLOSED * model.scale);
            if is_round {
                contact.kinematics.keep(&heights.iter().map(|height| -height).collect::<Vec<_>>());
            }
        }
    }
    add(case, model, |overlap| f64::from(u8::from(overlap == Overlap::KeepGap)));
    for (contact, spec) in model.contacts.iter_mut().zip(&case.contacts) {
        if spec.overlap == Overlap::Touch {
            let near = TOUCHING * longest(&contact.facets[0].1, &model.initial_position, model.dimension);
            let kinematics = &mut contact.kinematics;
            let depth = |node| {
                let distance = kinematics.signed_distance(node, &model.initial_position);
                -distance.filter(|distance| distance.abs() <= near).unwrap_or(0.0)
            };
            let depths: Vec<f64> = (0..kinematics.secondary().len()).map(depth).collect();
            kinematics.keep(&depths);
        }
    }
}

/// Longest edge of the facets.
pub(crate) fn longest(facets: &[Vec<usize>], y: &[f64], d: usize) -> f64 {
    facets.iter().map(|facet| longest_edge(facet, y, d)).fold(0.0, f64::max)
}

/// Adds to the depths that the contacts keep a share of their initial overlap.
fn add(case: &Case, model: &mut Model, share: impl Fn(Overlap) -> f64) {
    if case.contacts.iter().all(|contact| share(contact.overlap) == 0.0) {
        return;
    }
    let initial = depths(model, &model.initial_position);
    for ((contact, spec), depths) in model.contacts.iter_mut().zip(&case.contacts).zip(&initial) {
        let share = share(spec.overlap);
        if share > 0.0 {
            let kinematics = &mut contact.kinematics;
            let kept = |(node, depth): (usize, &f64)| kinematics.kept(node) + share * depth;
            let kept: Vec<f64> = depths.iter().enumerate().map(kept).collect();
            kinematics.keep(&kept);
        }
    }
}

/// The start of a case whose contacts relax their overlap, for its own model; none if there is
/// nothing to relax.
///
/// # Errors
/// If there is no equilibrium, under the key of the contact.
pub(crate) fn relaxed(
    case: &Case,
    model: &Model,
    materials: &Materials,
    threads: usize,
) -> Result<Option<InitialState>, Vec<Problem>> {
    let Some(first) = case.contacts.iter().position(|contact| contact.overlap == Overlap::Relax) else {
        return Ok(None);
    };
    let fails = |why: String| {
        let what = format!("the overlap of contact \"{}\" cannot be relaxed", case.contacts[first].name);
        let help = "move a body so that the overlap is smaller than a cell, or use a finer mesh there";
        vec![Problem::new(format!("contact[{first}].overlap"), what, case.in_units(&why), help)]
    };
    if let Some(problem) = hidden(case, model) {
        return Err(vec![problem]);
    }
    let quasi = quasi_static(case);
    let at = |share: f64| -> Result<Model, Vec<Problem>> {
        let mut model = build(&quasi, materials)?;
        keep(&quasi, &mut model);
        add(&quasi, &mut model, |overlap| if overlap == Overlap::Relax { share } else { 0.0 });
        Ok(model)
    };
    let start = at(1.0)?;
    let inside = overlaps(&quasi, &start, |_| true);
    if let Some(problem) = inside.first() {
        return Err(fails(format!("{}; {}", problem.what, problem.why)));
    }
    let speeds = case.materials.iter().map(|material| material.wave_speed(case.plane));
    let slowest = speeds.filter(|speed| speed.is_finite()).fold(f64::INFINITY, f64::min);
    if !slowest.is_finite() {
        return Err(fails("no body has a mass".to_owned()));
    }
    let rest = vec![0.0; start.dofs()];
    let mut before = InitialState {
        y: start.initial_position.clone(),
        v: rest,
        pairs: closed(&start),
        slid: BTreeMap::new(),
        memory: Vec::new(),
    };
    let mut proximal = Proximal {
        step: LONG * start.scale / slowest,
        tolerance: case.newton.tolerance,
        floor: floor(case, &start),
        threads,
    };
    for stage in 1..STAGES {
        let model = at(1.0 - f64::from(stage) / f64::from(STAGES))?;
        before = proximal.steps(model, before, 1).map_err(&fails)?.end;
    }
    for round in 1..=ROUNDS {
        let found = proximal.steps(at(0.0)?, before, MOST).map_err(&fails)?;
        before = found.end;
        let Some([old, strain]) = found.changes else { break };
        if round == ROUNDS {
            let steps = ROUNDS * MOST;
            return Err(fails(format!(
                "the strain energy still changes from {old:.6e} [energy] to {strain:.6e} [energy] after {steps} steps"
            )));
        }
        proximal.step *= LONGER;
    }
    if let Some(why) = swells(case, model, &before.y) {
        let what = format!("the overlap of contact \"{}\" cannot be relaxed", case.contacts[first].name);
        let help = "use law = \"saint-venant-kirchhoff\" with the same constants, or a support that prevents the rotation";
        return Err(vec![Problem::new(format!("contact[{first}].overlap"), what, why, help)]);
    }
    // The carriers of moving obstacles come last.
    let mut y = model.initial_position.clone();
    let from = &before.y;
    y[..from.len()].copy_from_slice(from);
    Ok(Some(InitialState {
        y,
        v: model.initial_velocity.clone(),
        pairs: before.pairs,
        slid: BTreeMap::new(),
        memory: before.memory,
    }))
}

/// Why an overlap is not known: it is much smaller than the deviation of straight cells from the
/// curved side that they stand for.
fn hidden(case: &Case, model: &Model) -> Option<Problem> {
    let all = depths(model, &model.initial_position);
    let relaxes = |k: &usize| case.contacts[*k].overlap == Overlap::Relax;
    (0..all.len()).filter(relaxes).find_map(|k| {
        let kinematics = &model.contacts[k].kinematics;
        let deepest = all[k].iter().copied().fold(0.0, f64::max);
        let chord = (0..all[k].len()).map(|node| kinematics.kept(node).abs()).fold(0.0, f64::max);
        let is_hidden = deepest > CLOSED * model.scale && chord > CHORDS * deepest;
        is_hidden.then(|| {
            let [chord, deepest] = [chord, deepest].map(|length| quantity(length, &case.units.length));
            Problem::new(
                format!("contact[{k}].overlap"),
                format!("the overlap of contact \"{}\" cannot be relaxed", case.contacts[k].name),
                format!("straight cells deviate by {chord} from the curved side that they stand for, and the bodies overlap by {deepest}, which that hides"),
                "use curved cells there, as T6, Hex27 or Tet10, or shorter ones: the deviation is h²/8R",
            )
        })
    })
}

/// The energy of round-off: of displacements of 1e-10 L in the stiffest material.
pub(crate) fn floor(case: &Case, model: &Model) -> f64 {
    let stiffest = case.materials.iter().map(|m| m.lambda + 2.0 * m.mu).fold(0.0, f64::max);
    1e-20 * stiffest * model.scale.powi(model.dimension as i32)
}

/// Why the equilibrium is none, if a body has turned whose strain is that of small displacements:
/// turned by ω, it is longer by √(1 + ω²) across the axis at no energy, and an overlap vanishes
/// without pressure.
fn swells(case: &Case, model: &Model, y: &[f64]) -> Option<String> {
    let deepest = depths(model, &model.initial_position).concat().into_iter().fold(0.0, f64::max);
    let is_small = |spec: &&BodySpec| case.materials_of(spec).iter().any(|m| m.law == Law::LinearElastic);
    case.bodies.iter().filter(is_small).find_map(|spec| {
        let part = model.parts.iter().find(|part| part.name == spec.name)?;
        let turn = rotation(model.dimension, part.of(&model.reference), part.of(y));
        let stretch = ((1.0 + turn * turn).sqrt() - 1.0) * part.body.mesh().diameter();
        (stretch > SWELLS * deepest).then(|| {
            format!(
                "body \"{}\" turns by {turn:.2e} rad, and linear elasticity, whose strain is that of small displacements, stretches a body that turns at no energy: here by {}, with an overlap of {}",
                spec.name,
                quantity(stretch, &case.units.length),
                quantity(deepest, &case.units.length)
            )
        })
    })
}

/// Angle by which points have turned on average about their centre, Σ x × u / Σ |x|²; in space the
/// length of its vector.
fn rotation(d: usize, reference: &[f64], y: &[f64]) -> f64 {
    let count = (reference.len() / d) as f64;
    let mean = |values: &[f64], i: usize| values.iter().skip(i).step_by(d).sum::<f64>() / count;
    let from = |values: &[f64]| -> Vec<f64> {
        let centre: Vec<f64> = (0..d).map(|i| mean(values, i)).collect();
        values.iter().enumerate().map(|(k, value)| value - centre[k % d]).collect()
    };
    let x = from(reference);
    let now = from(y);
    let mut sum = 0.0;
    for (i, j) in [(0, 1), (1, 2), (2, 0)].into_iter().filter(|(i, j)| *i.max(j) < d) {
        let mut moment = 0.0;
        let mut square = 0.0;
        for (x, now) in x.chunks_exact(d).zip(now.chunks_exact(d)) {
            moment += x[i] * (now[j] - x[j]) - x[j] * (now[i] - x[i]);
            square += x[i] * x[i] + x[j] * x[j];
        }
        sum += (moment / square).powi(2);
    }
    sum.sqrt()
}

/// Steps of the proximal point method.
struct Proximal {
    /// τ.
    step: f64,
    /// Tolerance of Newton's method.
    tolerance: f64,
    /// Energy that counts as none.
    floor: f64,
    threads: usize,
}

/// The positions that proximal steps have reached.
struct Reached {
    end: InitialState,
    /// The last two strain energies, if they still change.
    changes: Option<[f64; 2]>,
}

impl Proximal {
    /// Steps from rest until the strain energy has settled, at most so many.
    fn steps(&self, model: Model, before: InitialState, most: u32) -> Result<Reached, String> {
        let rest = before.v.clone();
        let grid = Grid { dt: self.step, steps: u64::from(most), phase: 0.0, guard: None, floor: 0.0 };
        let stepper = stepper(self.tolerance, &model)?;
        let mut simulation = Simulation::new(model, stepper, grid, true, Some(before), self.threads)
            .map_err(|rejected| rejected.to_string())?;
        loop {
            let old = simulation.state().ledger.strain;
            simulation.step().map_err(|stopped| stopped.to_string())?;
            let mut state = simulation.state().clone();
            let strain = state.ledger.strain;
            let changes = (strain - old).abs() > SETTLED * strain.abs() + self.floor;
            if !changes || simulation.finished() {
                let memory = state.materials.past(0.0).memory.to_vec();
                let slid = BTreeMap::new();
                let end = InitialState { y: state.y, v: rest, pairs: state.pairs, slid, memory };
                return Ok(Reached { end, changes: changes.then_some([old, strain]) });
            }
            (state.v, state.a) = (rest.clone(), rest.clone());
            simulation.restore(state).map_err(|other| other.to_string())?;
        }
    }
}

fn stepper(tolerance: f64, model: &Model) -> Result<Box<dyn Stepper>, String> {
    // As in load steps: a tangent from before metal yields is a thousand times stiffer.
    let tangent = if model.remembers() { Tangent::Full } else { Tangent::Frozen };
    let settings = Settings { tolerance, max_iterations: 60, tangent, linear: Linear::Direct, mixing: 0 };
    let kernel = scheme().kernel().ok_or("backward Euler has no stages")?;
    Ok(Box::new(Implicit::new(kernel, settings)))
}

fn scheme() -> SchemeSpec {
    SchemeSpec {
        kind: "backward-euler".into(),
        parameters: std::collections::BTreeMap::new(),
        forces: ForceRule::default(),
    }
}

/// The case without loads and motion.
fn quasi_static(case: &Case) -> Case {
    let mut quasi = case.clone();
    quasi.time.scheme = scheme();
    quasi.loads.clear();
    quasi.probes.clear();
    for body in &mut quasi.bodies {
        body.gravity.fill(FormulaSpec::Number(0.0));
        body.velocity = vec![FormulaSpec::Number(0.0); case.dimension];
        body.mass = MassKind::Consistent;
    }
    for support in &mut quasi.supports {
        // A motion begins where its nodes are.
        support.fix.extend(support.moves.drain(..).map(|(axis, _)| axis));
    }
    for contact in &mut quasi.contacts {
        contact.motion = ObstacleMotion::Fixed;
        contact.law = Some(ContactLaw::Position);
        contact.persistency = Persistency::None;
        contact.restitution = 0.0;
        // Overlaps are closed before anything rubs.
        contact.friction = FrictionSpec::default();
    }
    quasi
}

/// Pairs of the nodes that overlap, whose gap is closed while they keep their whole depth.
fn closed(model: &Model) -> Vec<Vec<carom_contact::Pair>> {
    let y = &model.initial_position;
    let mut rows = Rows::new(model.dimension);
    let mut all = Vec::new();
    for contact in &model.contacts {
        let mut pairing = Pairing::default();
        contact.kinematics.search(y, y, &mut pairing, &mut Vec::new());
        for pair in &mut pairing.pairs {
            rows.clear();
            let strict =
                contact.kinematics.kept(pair.node) != 0.0 && contact.kinematics.allowed(pair.node) == 0.0;
            let found = contact.kinematics.measure(pair, y, &mut rows).is_ok();
            pair.active = strict && found && rows.row(0).gap.abs() <= CLOSED * model.scale;
        }
        all.push(pairing.pairs);
    }
    all
}
