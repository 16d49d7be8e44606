//! `report.html`: the report of a run as a single self-contained page, for screen and print.

use std::collections::BTreeMap;

use carom_record::metrics::{self, Metric};
use carom_record::{FieldFormat, Run, Status, Warning};
use maud::{Markup, Render, html};
use serde_json::Value;

use crate::animation::Animation;
use crate::digits;
use crate::document::{document, figure, file, joined, minus, or_dash};
use crate::figure::Figure;
use crate::labels::number;
use crate::noise::has_contact;
use crate::stopped;
use crate::text::{Label, Prose, typeset};
use crate::timing::{three, timing};

/// Number of log events listed; all of them are counted.
const EVENTS: usize = 50;

const HEADER: &str = "Data: `manifest.json` (version, input_hash, case, machine, threads, timings.total, \
    started) and `history.csv` (rows and times). The input hash is the BLAKE3 hash of the case file and of \
    the options given with it.";

const RESULTS: &str = "All values are computed from `history.csv` alone: times from `time` and `active`, \
    forces from `contact_force_…`, impulses from `contact_impulse_…`, energies from `dissipation`, `kinetic` \
    and `strain`, and motion from `center_…` and `velocity_…` of the striker.";

/// The page.
pub(crate) fn page(run: &Run, figures: &[Figure], animation: Option<&Animation>, notes: &[String]) -> String {
    let title = run.manifest.case.get("title").and_then(Value::as_str).unwrap_or("Carom run");
    let figure = |(i, f): (usize, &Figure)| figure(i + 1, f.name, &f.endings(), &f.caption, &f.svg);
    let named = |name: &'static str| figures.iter().enumerate().filter(move |(_, f)| f.name == name);
    let place = named("stopped").next().map(&figure);
    let others = figures.iter().enumerate().filter(|(_, f)| f.name != "setup" && f.name != "stopped");
    let body = html! {
        (status(run))
        (stopped::section(run, place))
        (header(run))
        @for warning in &run.manifest.warnings { (warning_line(warning)) }
        @for note in notes { p.small { (note) } }
        @for f in named("setup") { (figure(f)) }
        @if let Some(animation) = animation { (animation.figure) }
        (results(run))
        (expectations(run))
        h2 { "Figures" }
        @for f in others { (figure(f)) }
        (events(run))
        (timing(&run.manifest))
        (reproduce(run))
        @if let Some(animation) = animation { (animation.scripts) }
    };
    document(title, "", &body)
}

fn warning_line(warning: &Warning) -> Markup {
    let Warning { id, place, what, why, advice } = warning;
    html! {
        p {
            b.miss { "Warning" } " (" code { (id) } "), " (typeset(place)) ": " (typeset(what)) "; " (typeset(why)) ". Try "
            (typeset(advice)) "."
        }
    }
}

/// How the run ended.
fn status(run: &Run) -> Markup {
    let m = &run.manifest;
    let missed = m.expectations.iter().filter(|expectation| !expectation.pass).count();
    let (class, word) = match m.status {
        Status::Running => ("running", "running or interrupted; can be resumed".to_owned()),
        Status::Finished if missed > 0 => {
            ("failed", format!("finished; {missed} of {} expectations missed", m.expectations.len()))
        }
        Status::Finished => ("finished", "finished".to_owned()),
        Status::Stopped => ("stopped", "stopped; can be resumed".to_owned()),
        Status::Failed => ("failed", "failed".to_owned()),
    };
    html! {
        p {
            span.status.(class) { (word) }
            @if let Some(reason) = m.reason.as_ref().filter(|_| run.stop.is_none()) { " " (reason) }
        }
    }
}

fn header(run: &Run) -> Markup {
    let (m, machine) = (&run.manifest, &run.manifest.machine);
    let (rows, last) = (run.times().len(), run.times().last().copied().unwrap_or(0.0));
    let wall: f64 = m.timings.get("total").copied().unwrap_or_else(|| m.timings.values().sum());
    let bodies = m.case.get("bodies").and_then(Value::as_array).into_iter().flatten();
    let bodies: Vec<&str> = bodies.filter_map(|b| b.get("name")?.as_str()).collect();
    html! {
        table {
            @if !bodies.is_empty() { (row("Bodies", bodies.join(", "))) }
            (row("Carom version", &m.version))
            (row("Input hash", html! { code.hash { (m.input_hash) } }))
            (row("Record", html! {
                (rows) " rows, up to t = " (number(last)) " " (Label(run.history.unit("time")))
            }))
            @if let Some(time) = integration(&m.case, run.history.unit("time")) {
                (row("Time integration", Label(&time)))
            }
            (row("Machine", html! {
                (machine.cpus) " cores, " (machine.os) " " (machine.arch) "; threads: " (m.threads)
            }))
            (row("Wall time", html! { (three(wall)) " s" }))
            (row("Started", &m.started))
        }
        p.small { (Prose(HEADER)) }
    }
}

fn row(name: &str, value: impl Render) -> Markup {
    html! { tr { th { (name) } td { (value) } } }
}

/// The scheme with its parameters, and the time step.
fn integration(case: &Value, unit: &str) -> Option<String> {
    let part = |(k, v): (&String, &Value)| match v.as_str() {
        Some(text) if k == "kind" => text.to_string(),
        Some(text) => format!("{k}: {}", text.replace('-', " ")),
        None => format!("{} = {}", symbol_of(k), v.as_f64().map_or_else(|| v.to_string(), number)),
    };
    let scheme = case.pointer("/time/scheme")?.as_object()?;
    let is_static = scheme.get("kind").is_some_and(|kind| kind == "static");
    // Averaged internal forces are the rule, and without inertia there is nothing to average.
    let told = |(k, v): &(&String, &Value)| *k != "forces" || !(is_static || *v == "average-forces");
    let scheme: Vec<String> = scheme.iter().filter(told).map(part).collect();
    let step = case.pointer("/time/step").and_then(Value::as_f64).map_or(String::new(), number);
    let what = if is_static { "load step" } else { "Δt" };
    Some(format!("{}; {what} = {step} {unit}", scheme.join(", ")))
}

/// The symbol of a parameter of a scheme.
fn symbol_of(key: &str) -> &str {
    match key {
        "rho_inf" => "ρ_{∞}",
        "alpha" => "α",
        "alpha_m" => "α_{m}",
        "alpha_f" => "α_{f}",
        "beta" => "β",
        "gamma" => "γ",
        "theta" => "θ",
        key => key,
    }
}

/// Six digits; three of what may be round-off.
fn shown(x: f64) -> String {
    if x.abs() < 1e-9 { digits::three(x) } else { number(x) }
}

fn results(run: &Run) -> Markup {
    let overlays = metrics::overlays(run);
    let measured = overlays.iter().flat_map(|overlay| metrics::of_measured(&run.history, overlay));
    let all = metrics::all(&run.history).into_iter().chain(measured);
    let known: Vec<Metric> = all.filter(|m| m.value.is_some()).collect();
    let groups = metrics::TITLES
        .map(|title| (title, known.iter().filter(|m| metrics::group(&m.name) == title).collect::<Vec<_>>()));
    html! {
        h2 { "Key results" }
        table.results {
            thead { tr { th { "Metric" } th.n { "Value" } th { "Unit" } th { "Definition" } } }
            @for (title, members) in groups.iter().filter(|(_, members)| !members.is_empty()) {
                tr.group { th colspan="4" { (title) } }
                @for metric in members {
                    tr {
                        td { code { (metric.name) } }
                        td.n { (or_dash(metric.value, shown)) }
                        td.unit { @if metric.unit.is_empty() { "–" } @else { (Label(&metric.unit)) } }
                        td { (metric.definition) }
                    }
                }
            }
        }
        @if let Some(body) = metrics::striker(&run.history).filter(|_| has_contact(run)) {
            p.small { "Striker: " (body) ". " (Prose(RESULTS)) }
        }
    }
}

/// The unit of a metric, or of a reduction of one column; empty for other expressions.
fn unit_of_question(run: &Run, what: &str) -> String {
    if let Some(metric) = metrics::all(&run.history).into_iter().find(|m| m.name == what) {
        return metric.unit;
    }
    let Some((form, column)) = what.rsplit_once(' ') else { return run.history.unit(what).to_owned() };
    match form.split(' ').next().unwrap_or_default() {
        _ if form.contains(['[', '/', '*', '+']) => String::new(),
        "time" => run.history.unit("time").to_owned(),
        "min" | "max" | "first" | "last" | "at" | "range" | "drift" | "peak" | "rms" => {
            run.history.unit(column).to_owned()
        }
        _ => String::new(),
    }
}

fn expectations(run: &Run) -> Markup {
    html! {
        @if !run.manifest.expectations.is_empty() {
            h2 { "Expectations" }
            table {
                thead { tr { th { "Quantity" } th { "Expected" } th.n { "Result" } th { "Unit" } th {} th { "Source" } } }
                @for e in &run.manifest.expectations {
                    tr {
                        td { code { (e.what) } } td { (minus(&e.expected)) }
                        td.n { (or_dash(e.got, number)) }
                        td.unit { (Label(&unit_of_question(run, &e.what))) }
                        @if e.pass { td.pass { "met" } } @else { td.miss { "missed" } }
                        td { @if let Some(source) = &e.source { (source) } }
                    }
                }
            }
        }
    }
}

fn events(run: &Run) -> Markup {
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for event in &run.log {
        *kinds.entry(&event.kind).or_default() += 1;
    }
    let counts: Vec<String> = kinds.iter().map(|(kind, n)| format!("{n} × {kind}")).collect();
    let (listed, all) = (run.log.len().min(EVENTS), run.log.len());
    html! {
        h2 { "Events" }
        @if counts.is_empty() {
            p { "None." }
        } @else {
            p { (counts.join(", ")) "." }
            details {
                summary { (listed) " of " (all) " events" }
                table {
                    thead { tr { th.n { "Step" } th.n { "Time (" (Label(run.history.unit("time"))) ")" } th { "Kind" } th { "Message" } } }
                    @for e in &run.log[..listed] {
                        tr { td.n { (e.step) } td.n { (number(e.time)) } td { (e.kind) } td { (e.message) } }
                    }
                }
            }
        }
        p.small { (Prose("Data: `log.jsonl`, one event per line.")) }
    }
}

fn reproduce(run: &Run) -> Markup {
    let source = &run.manifest.source;
    // Inside single quotes a shell has no escape: the quote is closed, written and opened again.
    let sets: String =
        source.sets.iter().map(|s| [" --set '", &s.replace('\'', r"'\''"), "'"].concat()).collect();
    let fields = match run.field_format {
        _ if run.fields.is_empty() => None,
        FieldFormat::Vtu => Some("fields.pvd"),
        FieldFormat::VtkHdf => Some("fields.vtkhdf"),
    };
    let files = ["manifest.json", "history.csv", "contact.csv", "log.jsonl"].into_iter().chain(fields);
    html! {
        h2 { "How to reproduce" }
        p { (Prose("Save the case file below as `case.toml` and run Carom ")) (run.manifest.version) ":" }
        pre { "carom run case.toml" (sets) }
        details { summary { "Case file" } pre { (source.text) } }
        p { "Files beside this page: " (joined(files.map(file), ", ")) "." }
    }
}
