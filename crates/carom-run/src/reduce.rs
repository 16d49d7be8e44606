//! A smaller case that stops as a run did: it continues from a checkpoint a few steps before the
//! stop, without the bodies and contacts that the stop does not need. Every reduction is run.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use carom_case::{
    Case, ContactSpec, Excerpt, FileMesh, LoadKind, LoadSpec, MeshSpec, PrimarySpec, Problems, SurfaceSpec,
};
use carom_mechanics::{GridReport, Simulation, State};
use carom_record::{Manifest, RecordError, Stop, StopPlace, checkpoints};

use crate::recording::explain;
use crate::saved_state;
use crate::setup::Setup;

/// Longest way from the start of the reduced case to the stop, in steps, if there is a choice.
const FAR: u64 = 60;
/// Steps beyond the stop.
const BEYOND: u64 = 2;
/// Why nothing is removed.
pub const NEEDED: &str = "no body and no contact could be left out";
/// Name of the state beside the case.
const STATE: &str = "state.bin";

/// A reduced case.
#[derive(Clone, Debug)]
pub struct Reduced {
    /// The case file.
    pub case: PathBuf,
    /// Grid step from which it continues, and time.
    pub step: u64,
    /// Time.
    pub time: f64,
    /// Steps to the stop.
    pub steps: u64,
    /// Bodies and contacts that were removed.
    pub removed: Vec<String>,
    /// Bodies and contacts that remain.
    pub remaining: Vec<String>,
    /// The reason with which the reduced case stops; none if it does not stop in the same way.
    pub reason: Option<String>,
}

/// Why a run cannot be reduced.
#[derive(Debug, thiserror::Error)]
pub enum ReduceError {
    /// The record cannot be read, or a file cannot be written.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The model of the run cannot be built any more.
    #[error("the run cannot be continued from its checkpoint: {0}")]
    Case(Problems),
    /// The run cannot be reduced.
    #[error("{what}")]
    Unusable {
        /// Why.
        what: String,
        /// A remedy.
        help: &'static str,
    },
}

fn unusable(what: impl Into<String>, help: &'static str) -> ReduceError {
    ReduceError::Unusable { what: what.into(), help }
}

/// A candidate: a case with a state.
struct Candidate {
    case: Case,
    state: State,
}

/// Reduces a run that stopped into a directory that must not exist.
///
/// # Errors
/// If the run did not stop, was made by another version, or a file cannot be written.
pub fn reduce(directory: &Path, out: &Path) -> Result<Reduced, ReduceError> {
    const AGAIN: &str = "run its case again with this version";
    let manifest = Manifest::read(directory)?;
    let place = directory.display();
    let Some(stop) = Stop::read(directory, &manifest)? else {
        let what =
            format!("{place} has no stopped.json: the run has not stopped, or an earlier version made it");
        return Err(unusable(what, "reduce a run that ended with exit code 3"));
    };
    let case = Case::from_json(manifest.case.clone())
        .map_err(|e| unusable(format!("the case in {place} does not fit this version: {e}"), AGAIN))?;
    if case.manufactured.is_some() {
        let what = "a case with [manufactured] cannot continue from a state";
        return Err(unusable(what, "reduce it by hand"));
    }
    let mut states = Vec::new();
    for (_, payload) in checkpoints(directory)? {
        let (state, _): (State, _) = postcard::take_from_bytes(&payload)
            .map_err(|_| unusable(format!("the checkpoint of {place} is of another version"), AGAIN))?;
        states.push(state);
    }
    // The last state is one step before the stop: there is little to see on the way.
    states.sort_by_key(|state| (stop.step.saturating_sub(state.step) > FAR, state.step));
    let mut best = None;
    for state in states {
        let candidate = Candidate { case: trimmed(&case, stop.step), state };
        // What is wrong with the whole case, a missing mesh for example, is an error.
        let simulation = Setup::new(&candidate.case).resume(candidate.state.clone());
        if stops(simulation.map_err(ReduceError::Case)?, &candidate.case, &stop).is_some() {
            best = Some(candidate);
            break;
        }
    }
    let Some(mut best) = best else {
        let what = "the run does not stop again in the same way from any of its checkpoints";
        return Err(unusable(what, "run its case again; if that stops, report it as a defect of Carom"));
    };
    let mut removed = Vec::new();
    for what in removable(&best.case, stop.place.as_ref()) {
        let words = what.words(&best.case);
        let Some(smaller) = without(&best, &what).filter(|_| !words.is_empty()) else { continue };
        if reproduces(&smaller, &stop).is_some() {
            removed.push(words);
            best = smaller;
        }
    }
    write(&best, &manifest, &stop, &case, &removed, out)
}

/// The case up to just after the stop, without what is only watched.
fn trimmed(case: &Case, step: u64) -> Case {
    let mut case = case.clone();
    let steps = (step + BEYOND).min(case.time.steps() as u64) - u64::from(case.time.phase > 0.0);
    case.time.end = shortest(steps as f64 * case.time.step);
    case.probes.clear();
    case.expects.clear();
    case.exact.clear();
    case.initial = None;
    case
}

/// A product without the digits of its round-off, as it would be written: 39 × 5e-5 is 0.00195.
pub fn shortest(product: f64) -> f64 {
    format!("{product:.11e}").parse().unwrap_or(product)
}

/// The reason with which a candidate stops, if it is that of the stop, at the same place.
fn reproduces(candidate: &Candidate, stop: &Stop) -> Option<String> {
    let simulation = Setup::new(&candidate.case).resume(candidate.state.clone()).ok()?;
    stops(simulation, &candidate.case, stop)
}

fn stops(mut simulation: Simulation, case: &Case, stop: &Stop) -> Option<String> {
    while !simulation.finished() {
        let mut report = GridReport::default();
        if let Err(stopped) = simulation.advance(&mut report) {
            let (found, _) = explain(case, &simulation, &stopped, &report);
            let same = found.kind == stop.kind
                && found.step == stop.step
                && same_place(found.place.as_ref(), stop.place.as_ref());
            return same.then_some(found.reason);
        }
    }
    None
}

/// Whether two places are the same node or cell of the same body. Numbers of nodes depend on the
/// other bodies; reference positions do not.
fn same_place(a: Option<&StopPlace>, b: Option<&StopPlace>) -> bool {
    let key = |place: &StopPlace| {
        let node = place.node.as_ref().map(|node| (node.body.clone(), node.reference.clone()));
        (node, place.contact.clone(), place.cell)
    };
    a.map(key) == b.map(key)
}

/// Something that may be removed.
enum Removable {
    Body(String),
    /// The contacts of a table, by its number.
    Contacts(usize),
}

impl Removable {
    /// Empty if it went with a body.
    fn words(&self, case: &Case) -> String {
        match self {
            Self::Body(name) => format!("body \"{name}\""),
            Self::Contacts(entry) => {
                let contacts = case.contacts.iter().filter(|contact| contact.entry == *entry);
                contacts.map(|c| format!("contact \"{}\"", c.name)).collect::<Vec<_>>().join(", ")
            }
        }
    }
}

/// Bodies and contacts away from the place; bodies first, which take their contacts with them.
fn removable(case: &Case, place: Option<&StopPlace>) -> Vec<Removable> {
    let contact = place.and_then(|place| place.contact.as_deref());
    let mut needed: BTreeSet<&str> = BTreeSet::new();
    if let Some(place) = place {
        needed.extend(place.body.as_deref());
        needed.extend(place.node.iter().chain(&place.facet_nodes).map(|node| node.body.as_str()));
    }
    needed.extend(
        case.contacts.iter().filter(|c| Some(c.name.as_str()) == contact).flat_map(ContactSpec::bodies),
    );
    let bodies = case.bodies.iter().filter(|body| !needed.contains(body.name.as_str()));
    // Without a contact that has a table of its own, `between` would stand for it, too.
    let between = case.contacts.iter().any(|c| c.between);
    let needed = |c: &&ContactSpec| {
        Some(c.name.as_str()) == contact || between && !c.between && c.primary.side().is_some()
    };
    let kept: BTreeSet<usize> = case.contacts.iter().filter(needed).map(|c| c.entry).collect();
    let entries: BTreeSet<usize> = case.contacts.iter().map(|c| c.entry).collect();
    bodies
        .map(|body| Removable::Body(body.name.clone()))
        .chain(entries.difference(&kept).map(|&entry| Removable::Contacts(entry)))
        .collect()
}

/// A candidate without a body or a contact; none if that is not possible.
fn without(candidate: &Candidate, what: &Removable) -> Option<Candidate> {
    let Candidate { case: old, state } = candidate;
    let mut case = old.clone();
    match what {
        Removable::Body(name) => {
            let touches = |side: &str| side.split('.').next() == Some(name);
            case.bodies.retain(|body| body.name != *name);
            case.contacts.retain(|contact| contact.bodies().all(|body| body != name));
            case.ties.retain(|tie| !tie.bodies().contains(&name.as_str()));
            for support in &mut case.supports {
                support.on.retain(|side| !touches(side));
            }
            case.supports.retain(|support| !support.on.is_empty());
            for load in &mut case.loads {
                if let LoadKind::Traction { on, .. } | LoadKind::Pressure { on, .. } = &mut load.kind {
                    on.retain(|side| !touches(side));
                }
            }
            case.loads.retain(|load| match &load.kind {
                LoadKind::BodyForce { body, .. } => body != name,
                _ => !load.sides().is_empty(),
            });
        }
        Removable::Contacts(entry) => case.contacts.retain(|contact| contact.entry != *entry),
    }
    let kept = |c: &ContactSpec| case.contacts.iter().any(|k| k.name == c.name);
    // Contacts that share a side number facets and nodes together.
    let shares = |a: &ContactSpec| {
        case.contacts.iter().any(|b| {
            a.secondary == b.secondary || (a.primary.side().is_some() && a.primary.side() == b.primary.side())
        })
    };
    if case.bodies.is_empty() || old.contacts.iter().any(|c| !kept(c) && shares(c)) {
        return None;
    }
    let large = Setup::new(old).build().ok()?;
    let small = Setup::new(&case).build().ok()?;
    let mut dofs = Vec::new();
    for part in &small.parts {
        let from = large.parts.iter().find(|p| p.name == part.name)?;
        dofs.extend(from.nodes().start * large.dimension..from.nodes().end * large.dimension);
    }
    let contacts: Vec<usize> =
        small.contacts.iter().filter_map(|c| large.contacts.iter().position(|k| k.name == c.name)).collect();
    let state = state.restricted(&large, &small, &dofs, &contacts).ok()?;
    Some(Candidate { case, state })
}

/// Writes case and state, and runs what was written.
fn write(
    best: &Candidate,
    manifest: &Manifest,
    stop: &Stop,
    whole: &Case,
    removed: &[String],
    out: &Path,
) -> Result<Reduced, ReduceError> {
    let failed = |action: &'static str, path: &Path| {
        let path = path.to_path_buf();
        move |source| RecordError::Io { action, path, source }
    };
    fs::create_dir_all(out).map_err(failed("create", out))?;
    let put = |name: &str, bytes: &[u8]| {
        let path = out.join(name);
        fs::write(&path, bytes).map_err(failed("write", &path))
    };
    let encoded = saved_state::encoded(&best.state)
        .map_err(|why| unusable(format!("the state cannot be encoded: {why}"), "report this as a defect"))?;
    put(STATE, &encoded)?;
    let mut meshes = BTreeMap::new();
    for body in &best.case.bodies {
        if let MeshSpec::File(FileMesh { file, .. }) = body.mesh.source() {
            let name = format!("{}.msh", body.name);
            let to = out.join(&name);
            fs::copy(file, &to).map_err(failed("copy", file))?;
            meshes.insert(body.name.clone(), name);
        }
    }
    let mut surfaces = BTreeMap::new();
    for contact in &best.case.contacts {
        if let PrimarySpec::Surface(SurfaceSpec { file, .. }) = &contact.primary {
            let kind = file.extension().and_then(OsStr::to_str).unwrap_or("stl");
            let name = format!("contact-{}.surface.{kind}", contact.entry);
            fs::copy(file, out.join(&name)).map_err(failed("copy", file))?;
            surfaces.insert(contact.entry, name);
        }
    }
    let body_of = |side: &str| side.split('.').next().unwrap_or_default().to_owned();
    let remains = |body: &str| best.case.bodies.iter().any(|b| b.name == body);
    let acts = |load: &LoadSpec| match &load.kind {
        LoadKind::BodyForce { body, .. } => remains(body),
        _ => load.sides().iter().any(|side| remains(&body_of(side))),
    };
    let mut tables = Vec::new();
    for (k, load) in whole.loads.iter().enumerate() {
        let Some(table) = load.table.as_ref().filter(|_| acts(load)) else {
            tables.push(String::new());
            continue;
        };
        let name = format!("table-{k}.csv");
        let rows = table.times.iter().zip(&table.values).map(|(t, value)| format!("{t:?},{value:?}\n"));
        put(&name, ("t,value\n".to_owned() + &rows.collect::<String>()).as_bytes())?;
        tables.push(name);
    }
    let without = if removed.is_empty() {
        format!("# Nothing was removed: {NEEDED}.\n")
    } else {
        format!("# Without {}.\n", removed.join(", "))
    };
    let comment = format!(
        "# Reduced by `carom reduce` from a run that stopped:\n# {}.\n# It continues at t = {:?}, step {}.\n{without}",
        stop.reason, best.state.time, best.state.step
    );
    let excerpt = Excerpt {
        bodies: best.case.bodies.iter().map(|body| body.name.clone()).collect(),
        contacts: tables_of(&best.case),
        end: best.case.time.end,
        state: STATE.into(),
        meshes,
        surfaces,
        tables,
        comment,
    };
    let text = excerpt
        .of(&manifest.source.text, &manifest.source.sets)
        .map_err(|e| unusable(e.to_string(), "report this as a defect"))?;
    put("case.toml", text.as_bytes())?;
    let path = out.join("case.toml");
    Ok(Reduced {
        step: best.state.step,
        time: best.state.time,
        steps: stop.step - best.state.step,
        removed: removed.to_vec(),
        remaining: excerpt
            .bodies
            .iter()
            .map(|b| format!("body \"{b}\""))
            .chain(best.case.contacts.iter().map(|c| format!("contact \"{}\"", c.name)))
            .collect(),
        reason: written(&path, stop),
        case: path,
    })
}

/// The tables of contacts, with a name where one contact remains of those that `between` stood for.
fn tables_of(case: &Case) -> BTreeMap<usize, Option<String>> {
    let mut tables = BTreeMap::new();
    for contact in &case.contacts {
        let alone = contact.between.then(|| contact.name.clone());
        tables.entry(contact.entry).and_modify(|name| *name = None).or_insert(alone);
    }
    tables
}

/// The reason with which the written case stops, if it stops in the same way.
fn written(path: &Path, stop: &Stop) -> Option<String> {
    let document = carom_case::Document::open(path, &[]).ok()?;
    let case = carom_case::read(&document).ok()?;
    stops(Setup::new(&case).start().ok()?, &case, stop)
}
