//! `report.html`: one page that needs nothing but itself, on screen and on paper.

use std::collections::BTreeMap;

use carom_record::{FieldFormat, Run, Status, metrics};
use maud::{Markup, Render, html};
use serde_json::Value;

use crate::document::{document, figure, file, joined, or_dash};
use crate::figures::Figure;
use crate::labels::number;
use crate::text::Label;
use crate::work::work;

/// Log events shown; all are counted.
const EVENTS: usize = 50;

/// The page.
pub(crate) fn page(run: &Run, figures: &[Figure], animation: Option<&Markup>, notes: &[String]) -> String {
    let title = run.manifest.case.get("title").and_then(Value::as_str).unwrap_or("Carom run");
    let figure = |(i, f): (usize, &Figure)| figure(i + 1, f.name, &["svg"], &f.caption, &f.svg);
    let (case, others): (Vec<_>, Vec<_>) = figures.iter().enumerate().partition(|(_, f)| f.name == "setup");
    let body = html! {
        (header(run))
        @for warning in &run.manifest.warnings { p { b.miss { "Warning:" } " " (warning) "." } }
        @for note in notes { p.small { (note) } }
        @for f in case { (figure(f)) }
        @if let Some(animation) = animation { (animation) }
        (results(run))
        (expectations(run))
        h2 { "Figures" }
        @for f in others { (figure(f)) }
        (events(run))
        (work(&run.manifest))
        (reproduce(run))
    };
    document(title, "", &body)
}

fn header(run: &Run) -> Markup {
    let m = &run.manifest;
    let (class, word) = match m.status {
        Status::Running => ("running", "running, or killed: resumable"),
        Status::Finished => ("finished", "finished"),
        Status::Stopped => ("stopped", "stopped: resumable"),
        Status::Failed => ("failed", "failed"),
    };
    let (rows, last) = (run.times().len(), run.times().last().copied().unwrap_or(0.0));
    let wall: f64 = m.timings.get("total").copied().unwrap_or_else(|| m.timings.values().sum());
    let bodies = m.case.get("bodies").and_then(Value::as_array).into_iter().flatten();
    let bodies: Vec<&str> = bodies.filter_map(|b| b.get("name")?.as_str()).collect();
    let machine = &m.machine;
    html! {
        p {
            span.status.(class) { (word) }
            @if let Some(reason) = &m.reason { " " (reason) }
        }
        table {
            @if !bodies.is_empty() { (row("Bodies", bodies.join(", "))) }
            (row("Carom", &m.version))
            (row("Input hash", html! { code.hash { (m.input_hash) } }))
            (row("Recorded", html! { (rows) " rows to t = " (number(last)) " " (Label(run.history.unit("time"))) }))
            @if let Some(time) = integration(&m.case) { (row("Time integration", time)) }
            (row("Machine", format_args!("{} cores, {} {}; threads: {}", machine.cpus, machine.os, machine.arch, m.threads)))
            (row("Wall time", format_args!("{} s", number(wall))))
            (row("Started", &m.started))
        }
        p.small {
            "From manifest.json: version, input_hash, case, machine, threads, timings.total, started. The hash is BLAKE3 of the case file and the options given with it. Rows and times: history.csv."
        }
    }
}

fn row(name: &str, value: impl Render) -> Markup {
    html! { tr { th { (name) } td { (value) } } }
}

/// The scheme with its parameters, and the step.
fn integration(case: &Value) -> Option<String> {
    let part = |(k, v): (&String, &Value)| match v.as_str() {
        Some(text) if k == "kind" => text.to_string(),
        Some(text) => format!("{k} {text}"),
        None => format!("{k} = {v}"),
    };
    let scheme: Vec<String> = case.pointer("/time/scheme")?.as_object()?.iter().map(part).collect();
    let step = case.pointer("/time/step").and_then(Value::as_f64).map_or(String::new(), number);
    Some(format!("{}; Δt = {step}", scheme.join(", ")))
}

fn results(run: &Run) -> Markup {
    html! {
        h2 { "Key results" }
        table {
            thead { tr { th { "Metric" } th { "Value" } th { "Unit" } th { "Definition" } } }
            @for metric in metrics::all(&run.history) {
                @if let Some(value) = metric.value {
                    tr {
                        td { code { (metric.name) } }
                        td.n { (number(value)) }
                        td { (Label(&metric.unit)) }
                        td { (metric.definition) }
                    }
                }
            }
        }
        @if let Some(body) = metrics::striker(&run.history) {
            p.small {
                "Striker: " (body) ". All values are computed from history.csv alone: times from "
                code { "time" } " and " code { "active" } ", forces from " code { "contact_force_…" }
                ", impulses from " code { "contact_impulse_…" } ", energies from " code { "dissipation" } ", "
                code { "kinetic" } " and " code { "strain" } ", motion from " code { "center_…" } " and "
                code { "velocity_…" } " of the striker."
            }
        }
    }
}

fn expectations(run: &Run) -> Markup {
    html! {
        @if !run.manifest.expectations.is_empty() {
            h2 { "Expectations" }
            table {
                thead { tr { th { "What" } th { "Expected" } th { "Got" } th {} th { "Source" } } }
                @for e in &run.manifest.expectations {
                    tr {
                        td { code { (e.what) } }
                        td { (e.expected.replace('-', "−")) }
                        td.n { (or_dash(e.got, number)) }
                        @if e.pass { td.pass { "holds" } } @else { td.miss { "missed" } }
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
    let shown = run.log.len().min(EVENTS);
    html! {
        h2 { "Events" }
        p.small { "log.jsonl, one event per line." }
        @if counts.is_empty() {
            p { "None." }
        } @else {
            p { (counts.join(", ")) "." }
            details {
                summary { "The first " (shown) " of " (run.log.len()) }
                table {
                    thead { tr { th { "Step" } th { "Time" } th { "Kind" } th { "What happened" } } }
                    @for e in &run.log[..shown] {
                        tr { td.n { (e.step) } td.n { (number(e.time)) } td { (e.kind) } td { (e.message) } }
                    }
                }
            }
        }
    }
}

fn reproduce(run: &Run) -> Markup {
    let source = &run.manifest.source;
    // A quote inside single quotes of a shell ends them, is escaped, and begins them anew.
    let sets: String =
        source.sets.iter().map(|s| [" --set '", &s.replace('\'', r"'\''"), "'"].concat()).collect();
    let fields = match run.field_format {
        _ if run.fields.is_empty() => None,
        FieldFormat::Vtu => Some("fields.pvd"),
        FieldFormat::VtkHdf => Some("fields.vtkhdf"),
    };
    let files = ["manifest.json", "history.csv", "contact.csv", "log.jsonl"].into_iter().chain(fields);
    html! {
        h2 { "To reproduce" }
        p { "Save the case as " code { "case.toml" } ", then with Carom " (run.manifest.version) ":" }
        pre { "carom run case.toml" (sets) }
        details { summary { "The case file" } pre { (source.text) } }
        p { "Beside this page: " (joined(files.map(file), ", ")) "." }
    }
}
