//! `carom check`: reads and resolves a case or a study, starts it and reports errors with their
//! place; it takes no step, and writes nothing but a picture of bodies that overlap at the start.

use std::path::{Path, PathBuf};

use carom::Simulation;
use carom::case::{
    Case, ContactSpec, Document, Enforcement, FileMesh, FormulaSpec, LoadKind, LoadSpec, MaterialSpec,
    MeshSpec, ObstacleMotion, PlaceSpec, PrimarySpec, SchemeSpec, SupportSpec, SurfaceSpec, gibibytes,
};
use carom::stability::{SAFETY, stable_step};
use carom_record::Warning;
use carom_study::Plan;
use carom_time::Explained;
use serde::Serialize;

use crate::exit::{Exit, Failure};
use crate::shared::{of_arms, warnings};
use crate::text::{several, short};
use crate::{console, out};

/// Nodes listed without `--verbose`.
const LISTED: usize = 10;
const AXES: [&str; 3] = ["x", "y", "z"];

/// Report the errors of a case or study without running it, and draw bodies that overlap (SVG)
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  carom check impact.toml --set time.scheme.rho_inf=0.5\n  carom check laboratory.toml"
)]
pub(crate) struct Arguments {
    /// The case file or the study file; - for standard input
    case: PathBuf,
    /// Replace a value of the case, as in `carom run`; not for a study
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// Print the resolved case with all defaults, or its errors, as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let document = super::document(&arguments.case, &[])?;
    if document.is_study() {
        return study(arguments, &document);
    }
    let document = Document::parse(document.name(), document.text(), &arguments.sets)?;
    let case = super::resolved(&document)?;
    let overlap = Overlap::of(&case, &arguments.case)?;
    if !overlap.nodes.is_empty() {
        out::summary(&overlap.lines())?;
    }
    // Started as `run` does, which finds everything that stops a run before its first step.
    let started = carom::Setup::new(&case).start();
    let simulation = started.map_err(|problems| Failure::Case(document.diagnose_all(&problems)))?;
    let facts = Facts::of(&case, &simulation);
    let warnings = carom::warnings(&case, simulation.model());
    out::event(&serde_json::json!({
        "event": "check", "case": case, "model": facts, "memory": case.memory(), "warnings": warnings,
        "overlap": overlap.nodes
    }))?;
    out::summary(&table(&case, &facts, &warnings))?;
    Ok(Exit::Done)
}

/// Facts about the model of a case.
#[derive(Serialize)]
struct Facts {
    bodies: Vec<BodyFacts>,
    /// Number of tied nodes, by tie.
    tied: Vec<usize>,
    /// Steps in which a pressure wave crosses the smallest body; none in statics.
    transit_steps: Option<f64>,
    /// 2/ω_max, for explicit schemes.
    stable_step: Option<f64>,
}

/// A body's mesh.
#[derive(Serialize)]
struct BodyFacts {
    name: String,
    nodes: usize,
    cells: usize,
    /// Sides, with their numbers of nodes.
    sides: Vec<(String, usize)>,
    /// Free degrees of freedom.
    dofs: usize,
    /// Smallest scaled Jacobian; none for bars.
    scaled_jacobian: Option<f64>,
}

impl Facts {
    fn of(case: &Case, start: &Simulation) -> Self {
        let model = start.model();
        let d = model.dimension;
        let body = |part: &carom::model::BodyInstance| {
            let mesh = part.body.mesh();
            let sides = mesh.sides.keys().filter_map(|s| Some((s.clone(), mesh.side_nodes(s)?.len())));
            BodyFacts {
                name: part.name.clone(),
                nodes: mesh.nodes.len(),
                cells: mesh.cell_count(),
                sides: sides.collect(),
                dofs: part.nodes().flat_map(|n| n * d..(n + 1) * d).filter(|&dof| !model.fixed[dof]).count(),
                scaled_jacobian: mesh.scaled_jacobian(),
            }
        };
        let stable = case
            .time
            .scheme
            .is_explicit()
            .then(|| stable_step(model, &start.state().configuration()))
            .flatten();
        Self {
            bodies: model.parts.iter().take(case.bodies.len()).map(body).collect(),
            tied: model.ties.iter().map(|tie| tie.tied.iter().map(Vec::len).sum()).collect(),
            transit_steps: carom::crossing(case, model).map(|time| time / case.time.step),
            stable_step: stable.map(|stable| stable.power),
        }
    }
}

/// The overlap of the bodies at the start.
struct Overlap {
    nodes: Vec<carom::OverlapNode>,
    picture: Option<PathBuf>,
}

impl Overlap {
    /// Finds it, and draws it beside the other files of the working directory. A case whose model
    /// cannot be built has none; what is wrong with it is told later.
    fn of(case: &Case, path: &Path) -> Result<Self, Failure> {
        let placed = case.initial.is_some() || case.manufactured.is_some();
        let Some(model) = carom::Setup::new(case).build().ok().filter(|_| !placed) else {
            return Ok(Self { nodes: Vec::new(), picture: None });
        };
        let nodes = carom::overlapping(case, &model);
        let depths: Vec<(usize, f64)> = nodes.iter().map(|node| (node.node, node.depth)).collect();
        let mut picture = None;
        let fields = carom::recording::initial_fields(case, &model);
        if let Some(svg) = carom_report::overlap(case, &fields, &depths) {
            let stem = if path == Path::new(super::STDIN) { Path::new("stdin") } else { path };
            let stem = stem.file_stem().unwrap_or_default().to_string_lossy();
            let file = PathBuf::from(format!("{stem}-overlap.svg"));
            let failed = |e| Failure::cannot("write", &file, &e);
            std::fs::write(&file, svg).map_err(failed)?;
            picture = Some(file);
        }
        Ok(Self { nodes, picture })
    }

    fn lines(&self) -> String {
        let shown = if console::is_verbose() { usize::MAX } else { LISTED };
        let mut lines = vec!["overlap at the start".to_owned()];
        for node in self.nodes.iter().take(shown) {
            let at: Vec<String> = node.at.iter().map(|x| short(*x)).collect();
            lines.push(format!(
                "  contact  {:12} node {} of {} at [{}] penetrates by {}",
                node.contact,
                node.node,
                node.body,
                at.join(", "),
                short(node.depth)
            ));
        }
        if self.nodes.len() > shown {
            lines.push(format!("           and {} more (--verbose lists them)", self.nodes.len() - shown));
        }
        lines.extend(self.picture.iter().map(|file| format!("  picture  {}", file.display())));
        lines.join("\n")
    }
}

/// The arms of a study, every one resolved.
fn study(arguments: &Arguments, document: &Document) -> Result<Exit, Failure> {
    if !arguments.sets.is_empty() {
        return Err(Failure::argument(
            "--set cannot be used with a study",
            "write changes of all arms in the `set` of the study, and changes of one arm in the `set` of its [[arm]]",
        ));
    }
    let plan = super::plan(document, &arguments.case)?;
    let Plan { manifest, arms } = &plan;
    let jobs = super::parallel("--jobs", None)?;
    plan.fits_memory(jobs)?;
    let found = plan.warnings();
    out::event(
        &serde_json::json!({ "event": "check", "study": manifest, "warnings": warnings(&found, manifest) }),
    )?;
    let mut lines =
        vec![format!("{} ({} runs of {})", manifest.title, arms.len(), manifest.source.case_path)];
    for (arm, planned) in manifest.arms.iter().zip(arms) {
        let time = &planned.case.time;
        let role = if manifest.reference.as_ref() == Some(&arm.name) { ", the reference" } else { "" };
        lines.push(format!(
            "  arm      {}: {}, {} steps of {}{role}",
            arm.name,
            scheme_text(&time.scheme),
            time.steps(),
            short(time.step)
        ));
    }
    if let Some(ensemble) = &manifest.ensemble {
        let runs = arms.len() + manifest.members.len();
        lines.push(format!("  ensemble {}: {runs} runs in all", ensemble.words()));
    }
    let [one, several] = plan.memory(jobs).map(gibibytes);
    lines.push(format!("  memory   about {one} for the largest run, {several} for {jobs} at once"));
    lines.extend(found.iter().map(|(w, arms)| console::warning("  warning  ", &of_arms(arms, manifest), w)));
    out::summary(&lines.join("\n"))?;
    Ok(Exit::Done)
}

fn table(case: &Case, facts: &Facts, warnings: &[Warning]) -> String {
    let mut lines = vec![format!("{} (dimension {})", case.title, case.dimension)];
    lines.extend(bodies(case, facts));
    for support in &case.supports {
        lines.push(named("support", support.name.as_deref(), &support_text(support)));
    }
    for load in &case.loads {
        lines.push(named("load", load.name.as_deref(), &load_text(load)));
    }
    for contact in &case.contacts {
        lines.push(named("contact", Some(&contact.name), &contact_text(case, contact)));
    }
    for (tie, tied) in case.ties.iter().zip(&facts.tied) {
        let nodes = several(*tied, "node");
        let what = format!("{} to {}: {nodes}, {}", tie.secondary, tie.primary, word(&tie.method));
        lines.push(named("tie", Some(&tie.name), &what));
    }
    for probe in &case.probes {
        lines.push(named("probe", Some(&probe.name), &format!("at {:?} in {}", probe.at, probe.body)));
    }
    lines.push(format!("  scheme   {}", scheme_text(&case.time.scheme)));
    lines.extend(times(case, facts));
    lines.push(format!("  memory   about {} for a run", gibibytes(case.memory().total())));
    lines.extend(warnings.iter().map(|warning| console::warning("  warning  ", "", warning)));
    lines.join("\n")
}

/// A line about a named thing of the case.
fn named(kind: &str, name: Option<&str>, text: &str) -> String {
    format!("  {kind:9}{:12} {text}", name.unwrap_or_default())
}

/// A line that continues the one before it.
fn more(text: &str) -> String {
    format!("{:11}{text}", "")
}

fn bodies(case: &Case, facts: &Facts) -> Vec<String> {
    let mut lines = Vec::new();
    for (body, facts) in case.bodies.iter().zip(&facts.bodies) {
        let materials =
            case.materials_of(body).into_iter().map(material_text).collect::<Vec<_>>().join(" and ");
        let what = format!("{:?} of {materials}: {}", body.element, counted(facts));
        lines.push(named("body", Some(&body.name), &what));
        // In the plane every built-in cell is well shaped.
        if let Some(quality) = facts.scaled_jacobian.filter(|_| case.dimension == 3) {
            lines.push(more(&format!("smallest scaled Jacobian {quality:.2}")));
        }
        if let MeshSpec::File(FileMesh { file, repairs, .. }) = body.mesh.source() {
            lines.push(more(&format!("from {}", file.display())));
            lines.extend(repairs.iter().map(|repair| more(&format!("note: {repair}"))));
        }
        if let Some(PlaceSpec { rotate, axis, about, shift }) = &body.place {
            let axis = if axis.is_empty() { String::new() } else { format!(" around {axis:?}") };
            lines.push(more(&format!("rotated by {rotate}°{axis} about {about:?}, translated by {shift:?}")));
        }
    }
    lines
}

fn material_text(material: &MaterialSpec) -> String {
    let yields = if material.plastic.is_some() { " (yields)" } else { "" };
    format!("{}{yields}", material.name)
}

fn support_text(support: &SupportSpec) -> String {
    let axes = support.fix.iter().map(|axis| AXES[*axis]);
    let fixed = axes.chain(support.normal.then_some("their normals")).collect::<Vec<_>>().join(", ");
    let fixed = (!fixed.is_empty()).then(|| format!("fixed in {fixed}"));
    let moved = support.moves.iter().map(|(axis, u)| format!("moved along {} by {u}", AXES[*axis]));
    let how = fixed.into_iter().chain(moved).collect::<Vec<_>>().join(", ");
    format!("{} {how}", support.on.join(", "))
}

/// Sides, motion, method and friction.
fn contact_text(case: &Case, contact: &ContactSpec) -> String {
    let primary = primary_text(case, &contact.primary);
    let motion = match &contact.motion {
        ObstacleMotion::Fixed => "",
        ObstacleMotion::Prescribed { .. } => " that moves",
        ObstacleMotion::Free { .. } => " that is free",
    };
    let enforcement = contact.enforcement != Enforcement::Multiplier;
    let friction = &contact.friction;
    let mut how = vec![word(&contact.method)];
    how.extend(enforcement.then(|| word(&contact.enforcement)));
    how.extend(friction.mu.as_ref().filter(|_| friction.exists()).map(|mu| format!("mu = {mu}")));
    how.extend(friction.shear.map(|shear| format!("shear = {}", short(shear))));
    format!("{} against {primary}{motion}: {}", contact.secondary, how.join(", "))
}

/// The word of a choice in a case file.
fn word(choice: &impl Serialize) -> String {
    let json = serde_json::to_value(choice).unwrap_or_default();
    json.as_str().unwrap_or_default().to_owned()
}

fn primary_text(case: &Case, primary: &PrimarySpec) -> String {
    match primary {
        PrimarySpec::Side(side) => side.clone(),
        PrimarySpec::Plane { .. } => "a rigid plane".to_owned(),
        PrimarySpec::Circle { .. } if case.dimension == 3 => "a rigid sphere".to_owned(),
        PrimarySpec::Circle { .. } => "a rigid circle".to_owned(),
        PrimarySpec::Cylinder { .. } => "a rigid cylinder".to_owned(),
        PrimarySpec::Polyline { .. } => "a rigid polyline".to_owned(),
        PrimarySpec::Surface(surface) => surface_text(surface),
    }
}

fn times(case: &Case, facts: &Facts) -> Vec<String> {
    let [step, end] = [case.time.step, case.time.end].map(short);
    let mut lines =
        vec![format!("  time     {}, Δt = {step}, to t = {end}", several(case.time.steps(), "step"))];
    if let Some(transit) = facts.transit_steps.map(short) {
        lines.push(more(&format!("a pressure wave crosses the smallest body in {transit} steps")));
    }
    if let Some(stable) = facts.stable_step.map(short) {
        lines.push(more(&format!("the longest stable step is {stable}; at most {SAFETY} of it is accepted")));
    }
    lines
}

fn surface_text(surface: &SurfaceSpec) -> String {
    let SurfaceSpec { triangles, rim, inner, .. } = surface;
    let kind = if *rim == 0 { "closed".to_owned() } else { format!("open, with a rim of {rim} edges") };
    let without = match inner {
        0 => String::new(),
        inner => format!("; {inner} triangles between solids that touch were left out"),
    };
    format!("a rigid surface of {triangles} triangles, {kind}{without}")
}

fn scheme_text(scheme: &SchemeSpec) -> String {
    let parameters = scheme.parameters.iter().map(|(key, value)| format!("{key} = {value}"));
    std::iter::once(scheme.kind.clone())
        .chain(parameters)
        .chain(derived(scheme))
        .collect::<Vec<_>>()
        .join(", ")
}

fn load_text(load: &LoadSpec) -> String {
    let list = |value: &[FormulaSpec]| value.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let what = match &load.kind {
        LoadKind::Traction { on, value } => format!("traction [{}] on {}", list(value), on.join(", ")),
        LoadKind::Pressure { on, value } => format!("pressure {value} on {}", on.join(", ")),
        LoadKind::BodyForce { body, material, value } => {
            let cells = material.as_ref().map_or_else(String::new, |material| format!(" of {material}"));
            format!("force per volume [{}] in {body}{cells}", list(value))
        }
    };
    load.table.as_ref().map_or(what.clone(), |table| format!("{what}, times {}", table.file))
}

fn counted(body: &BodyFacts) -> String {
    let sides: Vec<_> = body.sides.iter().map(|(side, n)| format!("{side} {n}")).collect();
    let BodyFacts { nodes, cells, dofs, .. } = body;
    let nodes = several(*nodes, "node");
    let cells = several(*cells, "cell");
    format!("{nodes}, {cells}, {dofs} free dofs; nodes per side: {}", sides.join(", "))
}

/// Properties that follow from the parameters of a scheme.
fn derived(spec: &SchemeSpec) -> Option<String> {
    if spec.is_static() {
        return None;
    }
    Some(match spec.integrator().ok()?.explain() {
        Explained::Stages(scheme) => format!("order {}, ρ∞ = {}", scheme.order, short(scheme.rho_inf)),
        Explained::Nonsmooth(scheme) => match scheme.rho_inf {
            None => format!("order {}, explicit", scheme.order),
            Some(rho) => format!("order {}, ρ∞ = {}, impulses", scheme.order, short(rho)),
        },
    })
}
