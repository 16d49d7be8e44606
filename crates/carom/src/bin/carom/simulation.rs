//! Results of a run, for the summary on the terminal and the last event of `--json`.

use std::path::PathBuf;

use carom::case::{Case, ProbeSpec};
use carom::recording::{self, End};
use carom_record::metrics::{self, Metric};
use carom_record::{Advice, Expectation, Manifest, Run, Sizes, Stop};
use serde::Serialize;

use crate::exit::Failure;

/// Metrics of the summary, where they are defined; all are in `metrics.json`.
const SHOWN: [&str; 8] = [
    "contact_duration",
    "peak_mean_force",
    "restitution",
    "energy_lost",
    "permanent_set",
    "penetration",
    "pressure_max",
    "traction_max",
];
/// Columns of reactions in the summary.
const REACTIONS: usize = 3;

/// Options of the report and the summary of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Options {
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
    #[serde(serialize_with = "named")]
    pub(crate) metrics: Vec<Metric>,
    /// Extremes of the columns of probes, and of the largest reactions.
    pub(crate) extremes: Vec<Extreme>,
    pub(crate) expectations: Vec<Expectation>,
    /// Wall seconds by phase, with `--profile`.
    pub(crate) profile: Vec<(String, f64)>,
    /// The page, if it was made.
    pub(crate) report: Option<PathBuf>,
    /// Remarks for the summary.
    pub(crate) remarks: Vec<String>,
    /// Sizes that values are compared with to tell round-off.
    #[serde(skip)]
    pub(crate) sizes: Option<Sizes>,
}

/// Metrics as an object: names with values.
fn named<S: serde::Serializer>(metrics: &[Metric], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(metrics.iter().map(|metric| (&metric.name, metric.value)))
}

/// Smallest and largest value of a column.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Extreme {
    pub(crate) column: String,
    pub(crate) unit: String,
    pub(crate) min: f64,
    pub(crate) min_time: f64,
    pub(crate) max: f64,
    pub(crate) max_time: f64,
}

impl Extreme {
    /// None if the column has no numbers: rows in which a cell is inverted have no stress.
    fn of(run: &Run, column: &str) -> Option<Self> {
        let values = run.column(column)?;
        let rows = (0..values.len()).filter(|&row| !values[row].is_nan());
        let low = rows.clone().min_by(|&a, &b| values[a].total_cmp(&values[b]))?;
        let high = rows.min_by(|&a, &b| values[b].total_cmp(&values[a]))?;
        Some(Self {
            column: column.to_owned(),
            unit: run.history.unit(column).to_owned(),
            min: values[low],
            min_time: run.times()[low],
            max: values[high],
            max_time: run.times()[high],
        })
    }

    fn size(&self) -> f64 {
        self.max.abs().max(self.min.abs())
    }
}

/// Makes the report of a run that ended, and reads what the summary says about it.
pub(crate) fn conclude(
    done: Result<recording::Outcome, Failure>,
    options: Options,
) -> Result<Outcome, Failure> {
    let done = done?;
    let report = page(&done, options)?;
    if let End::Stopped(_) = &done.end {
        return Err(Failure::Stopped {
            reason: done.reason.unwrap_or_default(),
            help: help_after(&done.directory)?,
            page: report.is_some(),
            directory: done.directory,
        });
    }
    let run = match done.record {
        Some(run) => run,
        None => Run::open(&done.directory)?,
    };
    let interrupted = done.end == End::Interrupted;
    Ok(Outcome {
        interrupted,
        steps: done.steps as usize,
        time: done.time,
        time_unit: run.history.unit("time").to_owned(),
        wall: done.wall,
        metrics: if interrupted { Vec::new() } else { shown(&run) },
        extremes: extremes(&run),
        profile: if options.profile { profile(&run.manifest) } else { Vec::new() },
        report,
        remarks: done.remarks.into_iter().chain(no_rebound(&run)).chain(projected(&run)).collect(),
        sizes: Some(Sizes::of(&run)),
        directory: done.directory,
        expectations: run.manifest.expectations,
    })
}

/// Why a run in contact has no coefficient of restitution.
fn no_rebound(run: &Run) -> Option<String> {
    let has_contact = !run.manifest.facts.is_static && metrics::first_episode(&run.history).is_some();
    let why = metrics::no_rebound(run).filter(|_| has_contact)?;
    Some(format!("no restitution: {why}"))
}

/// A remark on stresses of probes in bodies that yield.
fn projected(run: &Run) -> Option<String> {
    let case = Case::from_json(run.manifest.case.clone()).ok()?;
    let yielding: Vec<&str> = case.yielding().map(|body| case.bodies[body].name.as_str()).collect();
    let is_projected =
        |probe: &&ProbeSpec| yielding.contains(&&*probe.body) && probe.record.iter().any(|of| of.is_stress());
    let names: Vec<&str> = case.probes.iter().filter(is_projected).map(|probe| probe.name.as_str()).collect();
    let words =
        "where bodies yield, they are projected from the quadrature points and may exceed the yield stress";
    (!names.is_empty()).then(|| format!("stresses of {}: {words}", names.join(", ")))
}

fn shown(run: &Run) -> Vec<Metric> {
    let all = metrics::of_run(run);
    let metric = |name: &&str| all.iter().find(|metric| metric.name == **name && metric.value.is_some());
    let has_contact = !run.manifest.facts.contacts.is_empty();
    SHOWN.iter().filter(|name| has_contact || **name != "penetration").filter_map(metric).cloned().collect()
}

/// Wall seconds by phase in the order of a step, then their total and the processor time.
fn profile(manifest: &Manifest) -> Vec<(String, f64)> {
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

/// The first advice after a stop.
fn help_after(directory: &std::path::Path) -> Result<String, Failure> {
    let manifest = Manifest::read(directory)?;
    let advice = Stop::read(directory, &manifest)?.map_or_else(Vec::new, |stop| stop.advice);
    let line = |advice: &Advice| match advice.sets.as_slice() {
        [] => advice.what.clone(),
        sets => {
            let options: Vec<String> = sets.iter().map(|set| format!("--set '{set}'")).collect();
            format!("{}: {}", options.join(" "), advice.what)
        }
    };
    Ok(advice.iter().take(3).map(line).collect::<Vec<_>>().join("\n"))
}

/// Extremes of every column of a probe, and of the columns of the largest reactions.
fn extremes(run: &Run) -> Vec<Extreme> {
    let of_probes = metrics::probe_columns(run).into_iter().filter_map(|column| Extreme::of(run, column));
    let columns = run.manifest.columns.iter().filter(|column| column.name.contains(".reaction_"));
    let mut reactions: Vec<Extreme> = columns.filter_map(|column| Extreme::of(run, &column.name)).collect();
    reactions.sort_by(|a, b| b.size().total_cmp(&a.size()));
    // A component across the others is round-off of the solution.
    let least = 1e-9 * reactions.first().map_or(0.0, Extreme::size);
    reactions.retain(|extreme| extreme.size() > least);
    reactions.truncate(REACTIONS);
    of_probes.chain(reactions).collect()
}
