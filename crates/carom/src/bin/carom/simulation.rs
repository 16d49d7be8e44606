//! The interface to the library: options, progress and outcome of a simulation.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use carom::case::{Case, Document};
use carom::recording::{self, RunError};
use carom_record::Warning;
use serde::Serialize;

use crate::exit::Failure;
use crate::summary::short;

/// How to run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Options {
    /// How it is computed.
    pub(crate) run: recording::Options,
    /// Whether figures and page are made at the end.
    pub(crate) report: bool,
    /// Whether a timing profile is printed.
    pub(crate) profile: bool,
}

/// A finished or interrupted run.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Outcome {
    pub(crate) directory: PathBuf,
    /// Whether it was stopped by Ctrl-C before the end.
    pub(crate) interrupted: bool,
    pub(crate) steps: usize,
    pub(crate) time: f64,
    pub(crate) time_unit: String,
    pub(crate) wall: f64,
    pub(crate) extremes: Vec<Extreme>,
    pub(crate) expectations: Vec<Expectation>,
    /// Wall seconds by phase, with `--profile`.
    pub(crate) profile: Vec<(String, f64)>,
    /// The page, if it was made.
    pub(crate) report: Option<PathBuf>,
    /// Remarks for the summary.
    pub(crate) remarks: Vec<String>,
}

/// Smallest and largest value of a probe's column.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Extreme {
    pub(crate) column: String,
    pub(crate) unit: String,
    pub(crate) min: f64,
    pub(crate) min_time: f64,
    pub(crate) max: f64,
    pub(crate) max_time: f64,
}

/// Outcome of an `[[expect]]`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Expectation {
    pub(crate) what: String,
    /// `-0.7827 ± 0.004`.
    pub(crate) wanted: String,
    pub(crate) got: Option<f64>,
    /// Why there is no value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) why: Option<String>,
    pub(crate) met: bool,
    /// The expected value, or the bound.
    #[serde(skip)]
    pub(crate) value: Option<f64>,
}

/// Facts about the model of a case, for `carom check`.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Facts {
    pub(crate) bodies: Vec<BodyFacts>,
    /// Steps in which a pressure wave crosses the smallest body; none in statics.
    pub(crate) transit_steps: Option<f64>,
    /// 2/ω_max, for explicit schemes.
    pub(crate) stable_step: Option<f64>,
    /// Doubts about the case.
    #[serde(skip)]
    pub(crate) warnings: Vec<Warning>,
}

/// A body's mesh.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct BodyFacts {
    pub(crate) name: String,
    pub(crate) nodes: usize,
    pub(crate) cells: usize,
    /// Sides, with their numbers of nodes.
    pub(crate) sides: Vec<(String, usize)>,
    /// Free degrees of freedom.
    pub(crate) dofs: usize,
    /// Smallest scaled Jacobian; none for bars.
    pub(crate) scaled_jacobian: Option<f64>,
}

/// Runs a case in a new directory.
pub(crate) fn run(
    case: &Case,
    document: &Document,
    out: &Path,
    options: Options,
    progress: &mut (dyn FnMut(&recording::Progress) + Send),
    stop: &AtomicBool,
) -> Result<Outcome, Failure> {
    let folder = Path::new(document.name()).parent().unwrap_or(Path::new(""));
    let folder = std::path::absolute(Path::new(".").join(folder)).ok();
    let source = carom_record::Source { text: document.text().to_owned(), sets: document.sets(), folder };
    let done = recording::run(case, source, out, options.run, progress, stop);
    let done = done.map_err(|error| match error {
        RunError::Case(problems) => Failure::Case(document.diagnose_all(&problems)),
        error => error.into(),
    });
    conclude(done?, options)
}

/// Resumes a run that was stopped; a finished run is returned unchanged.
pub(crate) fn resume(
    directory: &Path,
    options: Options,
    progress: &mut (dyn FnMut(&recording::Progress) + Send),
    stop: &AtomicBool,
) -> Result<Outcome, Failure> {
    let done = recording::resume(directory, options.run, progress, stop);
    conclude(done?, options)
}

/// Starts a case as `run` does, which finds everything that stops a run before its first step.
pub(crate) fn facts(case: &Case, document: &Document) -> Result<Facts, Failure> {
    let started = carom::Setup::new(case).start();
    let simulation = started.map_err(|problems| Failure::Case(document.diagnose_all(&problems)))?;
    let model = simulation.model();
    let d = model.dimension;
    let explicit = case.time.scheme.is_explicit();
    let stable_step =
        explicit.then(|| carom::stability::stable_step(model)).flatten().map(|stable| stable.power);
    let mut transit = f64::INFINITY;
    let mut bodies = Vec::new();
    for (part, spec) in model.parts.iter().zip(&case.bodies) {
        let mesh = part.body.mesh();
        if let Some(m) = case.material(spec).filter(|m| m.density > 0.0) {
            let speed = m.wave_speed(case.plane);
            let least = |i: usize| {
                let at = mesh.nodes.iter().map(|x| x[i]);
                at.clone().fold(f64::NEG_INFINITY, f64::max) - at.fold(f64::INFINITY, f64::min)
            };
            let width = (0..d).map(least).fold(f64::INFINITY, f64::min);
            transit = transit.min(width / speed / case.time.step);
        }
        let free = part.nodes().flat_map(|n| n * d..(n + 1) * d).filter(|&dof| !model.fixed[dof]).count();
        bodies.push(BodyFacts {
            name: part.name.clone(),
            nodes: mesh.nodes.len(),
            cells: mesh.cell_count(),
            sides: mesh.sides.keys().filter_map(|s| Some((s.clone(), mesh.side_nodes(s)?.len()))).collect(),
            dofs: free,
            scaled_jacobian: mesh.scaled_jacobian(),
        });
    }
    let transit_steps = (transit.is_finite() && !case.time.scheme.is_static()).then_some(transit);
    Ok(Facts { bodies, transit_steps, stable_step, warnings: carom::warnings(case, model) })
}

/// The report, the extremes of the probes and the expectations of a run that ended.
fn conclude(done: recording::Outcome, options: Options) -> Result<Outcome, Failure> {
    let page = page(&done, options)?;
    if let recording::End::Stopped(_) = &done.end {
        let (tried, help) = help_after(&done.directory)?;
        return Err(Failure::Stopped {
            reason: done.reason.unwrap_or_default(),
            tried,
            help,
            page: page.is_some(),
            directory: done.directory,
        });
    }
    let run = carom_record::Run::open(&done.directory)?;
    let expectations = run.manifest.expectations.iter();
    Ok(Outcome {
        directory: done.directory,
        interrupted: done.end == recording::End::Interrupted,
        steps: done.steps as usize,
        time: done.time,
        time_unit: run
            .manifest
            .columns
            .iter()
            .find(|c| c.name == "time")
            .map_or_else(String::new, |c| c.unit.clone()),
        wall: done.wall,
        extremes: extremes(&run),
        expectations: expectations
            .map(|e| Expectation {
                what: e.what.clone(),
                wanted: e.expected.clone(),
                got: e.got,
                why: e.why.clone(),
                met: e.pass,
                value: e.value,
            })
            .collect(),
        profile: if options.profile { profile(&run.manifest) } else { Vec::new() },
        report: page,
        remarks: done.remarks,
    })
}

/// Wall seconds by phase in the order of a step, then their total and the processor time.
fn profile(manifest: &carom_record::Manifest) -> Vec<(String, f64)> {
    let phases = manifest.phases().into_iter().map(|(name, _, seconds)| (name.to_owned(), seconds));
    let sums = [("total", "total"), ("processor", "cpu")]
        .into_iter()
        .filter_map(|(word, name)| Some((word.to_owned(), *manifest.timings.get(name)?)));
    phases.chain(sums).collect()
}

/// Makes the page of a run if it is requested and anything was computed since it was last made.
fn page(done: &recording::Outcome, options: Options) -> Result<Option<PathBuf>, Failure> {
    let made = done.directory.join("report.html");
    let current = done.wall == 0.0 && made.exists();
    if options.report && !current {
        Ok(Some(carom_report::report(&done.directory)?.page))
    } else {
        Ok(current.then_some(made))
    }
}

/// What was tried after a stop without success, and what to try: what was tried with success, or
/// else the first advice.
fn help_after(directory: &Path) -> Result<(String, String), Failure> {
    let manifest = carom_record::Manifest::read(directory)?;
    let Some(stop) = carom_record::Stop::read(directory, &manifest)? else {
        return Ok((String::new(), String::new()));
    };
    let option = |advice: &carom_record::Advice| {
        advice.sets.iter().map(|set| format!("--set '{set}'")).collect::<Vec<_>>().join(" ")
    };
    let passed = |advice: &&carom_record::Advice| advice.trial.as_ref().is_some_and(|trial| trial.passed);
    let mut lines: Vec<String> = stop
        .advice
        .iter()
        .filter(passed)
        .map(|advice| format!("{} gets past t = {} (tried)", option(advice), short(stop.time)))
        .collect();
    let mut failed = String::new();
    if lines.is_empty() {
        let time = short(stop.time);
        failed = match stop.advice.iter().filter(|advice| advice.trial.is_some()).count() {
            0 => String::new(),
            1 => format!("the only change tried does not get five steps past t = {time}"),
            tried => format!("none of the {tried} changes tried gets five steps past t = {time}"),
        };
        let untried = stop.advice.iter().filter(|advice| advice.trial.is_none());
        lines.extend(untried.take(3).map(|advice| match option(advice) {
            sets if sets.is_empty() => advice.what.clone(),
            sets => format!("{sets}: {}", advice.what),
        }));
    }
    Ok((failed, lines.join("\n")))
}

/// Smallest and largest value of every probe's column.
fn extremes(run: &carom_record::Run) -> Vec<Extreme> {
    let probes = run.manifest.case["probes"].as_array().cloned().unwrap_or_default();
    let names: Vec<String> =
        probes.iter().filter_map(|p| Some(format!("{}.", p["name"].as_str()?))).collect();
    let of_probe = |name: &str| names.iter().any(|n| name.starts_with(n.as_str()));
    let columns = run.manifest.columns.iter().filter(|c| of_probe(&c.name));
    columns
        .filter_map(|column| {
            let values = run.column(&column.name)?;
            // Rows in which a cell is inverted have no stress: they are NaN.
            let rows = (0..values.len()).filter(|&row| !values[row].is_nan());
            let low = rows.clone().min_by(|&a, &b| values[a].total_cmp(&values[b]))?;
            let high = rows.min_by(|&a, &b| values[b].total_cmp(&values[a]))?;
            Some(Extreme {
                column: column.name.clone(),
                unit: column.unit.clone(),
                min: values[low],
                min_time: run.times()[low],
                max: values[high],
                max_time: run.times()[high],
            })
        })
        .collect()
}
