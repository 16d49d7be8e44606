//! `report.html`: the report of a run as a single self-contained page, for screen and print.

use std::collections::BTreeMap;

use carom_record::{Run, Status, Warning};
use maud::{Markup, Render, html};
use serde_json::Value;

use crate::animation::Animation;
use crate::document::{document, figure, file, joined};
use crate::expectations::expectations;
use crate::figure::Figure;
use crate::labels::{capitalised, instant_label, is_static, number};
use crate::recorded::Recorded;
use crate::results::results;
use crate::scientific::powers;
use crate::setup::table;
use crate::stopped;
use crate::text::{Label, Prose, typeset};
use crate::timing::{three, timing};
use crate::values::{names, unit};

/// Number of log events listed; all of them are counted.
const EVENTS: usize = 50;

const HEADER: &str = "Data: `manifest.json` (version, input_hash, case, machine, threads, timings.total, \
    started) and `history.csv` (rows and times). The input hash is the BLAKE3 hash of the case file and of \
    the options given with it.";

/// The page.
pub(crate) fn page(run: &Run, figures: &[Figure], animation: Option<&Animation>, notes: &[String]) -> String {
    let title = run.manifest.case.get("title").and_then(Value::as_str).unwrap_or("Carom run");
    let named = |name: &'static str| figures.iter().enumerate().filter(move |(_, f)| f.name == name);
    let place = named("stopped").next().map(figure);
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
            b.miss { "Warning" } " (" code { (id) } "), " (typeset(place)) ": " (Label(&powers(&typeset(what)))) "; " (typeset(why)) ". Try "
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
        Status::Failed if run.stop.is_some() => ("failed", "stopped by an error".to_owned()),
        Status::Failed => ("failed", "failed".to_owned()),
    };
    html! {
        p {
            span.status.(class) { (word) }
            @if let Some(reason) = m.reason.as_ref().filter(|_| run.stop.is_none()) { " " (Label(&powers(&typeset(reason)))) }
        }
    }
}

fn header(run: &Run) -> Markup {
    let (m, machine) = (&run.manifest, &run.manifest.machine);
    let (rows, last) = (run.times().len(), run.times().last().copied().unwrap_or(0.0));
    let wall: f64 = m.timings.get("total").copied().unwrap_or_else(|| m.timings.values().sum());
    let bodies = names(&m.case, "bodies");
    html! {
        table {
            @if let Some(name) = run.directory.file_name() { (row("Run", name.to_string_lossy())) }
            @if run.fields.is_empty() {
                // Nothing is drawn of the model.
                @let recorded = Recorded::new(run.clone()).ok();
                @if let Some(recorded) = recorded { (row("Model", table(&recorded.case, None))) }
            } @else if !bodies.is_empty() { (row("Bodies", bodies.join(", "))) }
            @if !m.source.sets.is_empty() {
                (row("Changed options", html! {
                    @for (i, set) in m.source.sets.iter().enumerate() { @if i > 0 { br; } code.set { (set) } }
                }))
            }
            (row("Carom version", &m.version))
            (row("Input hash", html! { code.hash { (m.input_hash) } }))
            (row("Record", html! {
                (rows) @if rows == 1 { " row" } @else { " rows" } ", up to " (Label(&instant_label(run, last)))
            }))
            @if let Some(time) = integration(&m.case, run.history.unit("time")) {
                (row(if is_static(run) { "Analysis" } else { "Time integration" }, Label(&time)))
            }
            (row("Machine", html! {
                (machine.cpus) " cores, " (capitalised(&machine.os)) " " (machine.arch) "; threads: " (m.threads)
            }))
            (row("Wall time", html! { (three(wall)) " s" }))
            (row("Started", m.started.replace('T', " ").replace('Z', " UTC")))
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
        Some(text) if k == "kind" => scheme_name(text).to_owned(),
        Some(text) => format!("{k}: {}", text.replace('-', " ")),
        None => format!("{} = {}", symbol_of(k), v.as_f64().map_or_else(|| v.to_string(), number)),
    };
    let scheme = case.pointer("/time/scheme")?.as_object()?;
    let is_static = scheme.get("kind").is_some_and(|kind| kind == "static");
    // Averaged internal forces are the rule, and without inertia there is nothing to average.
    let told = |(k, v): &(&String, &Value)| *k != "forces" || !(is_static || *v == "average-forces");
    let scheme: Vec<String> = scheme.iter().filter(told).map(part).collect();
    let step = case.pointer("/time/step").and_then(Value::as_f64).map_or(String::new(), number);
    let step = if is_static { format!("load step = {step}") } else { format!("Δt = {step} {unit}") };
    Some(format!("{}; {step}", scheme.join(", ")).replace(" = ", "\u{a0}=\u{a0}"))
}

/// The name of a scheme in the literature.
fn scheme_name(kind: &str) -> &str {
    match kind {
        "backward-euler" => "backward Euler",
        "bathe" => "Bathe",
        "central-difference" => "central differences",
        "chung-hulbert" => "Chung–Hulbert (generalized-α)",
        "energy-momentum" => "energy–momentum",
        "generalized-alpha" => "generalized-α",
        "hht" => "Hilber–Hughes–Taylor (HHT-α)",
        "hu" => "Hu",
        "moreau-jean" => "Moreau–Jean",
        "newmark" => "Newmark",
        "nonsmooth-generalized-alpha" => "nonsmooth generalized-α",
        "paoli-schatzman" => "Paoli–Schatzman",
        "wbz" => "Wood–Bossak–Zienkiewicz (WBZ-α)",
        kind => kind,
    }
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
                summary {
                    @if listed < all { "The first " (listed) " of " (all) " events" }
                    @else if all == 1 { "1 event" } @else { (all) " events" }
                }
                table {
                    thead { tr { th.n { "Step" } th.n { "Time (" (Label(run.history.unit("time"))) ")" } th { "Kind" } th { "Message" } } }
                    @for e in &run.log[..listed] {
                        tr {
                            td.n { (e.step) } td.n { (number(e.time)) } td { (e.kind) }
                            td { (Label(&powers(&typeset(&e.message)))) }
                        }
                    }
                }
            }
        }
        @if all > 0 {
            p.small {
                (Label(&units_in_messages(run))) (Prose("Data: `log.jsonl`, one event per line."))
            }
        }
    }
}

/// The units of numbers in messages, which state none.
fn units_in_messages(run: &Run) -> String {
    // Warnings do.
    let messages = || run.log.iter().filter(|e| e.kind != "warning").map(|e| &*e.message);
    let has_numbers =
        messages().any(|text| text.contains(" = ") || text.contains(|c: char| c.is_ascii_digit()));
    let length = unit(&run.manifest.case, "length");
    if !has_numbers || length.is_empty() {
        return String::new();
    }
    let time =
        if is_static(run) { String::new() } else { format!("times in {}, ", run.history.unit("time")) };
    let model =
        if messages().any(|text| text.contains(" L (")) { "; L is the length of the model" } else { "" };
    format!("In messages: {time}lengths in {length}, energies in {}{model}. ", run.history.unit("total"))
}

fn reproduce(run: &Run) -> Markup {
    let source = &run.manifest.source;
    // Inside single quotes a shell has no escape: the quote is closed, written and opened again.
    let sets: Vec<String> = source.sets.iter().map(|s| s.replace('\'', r"'\''")).collect();
    let fields = (!run.fields.is_empty()).then_some("fields.pvd");
    let files = ["manifest.json", "history.csv", "contact.csv", "log.jsonl"].into_iter().chain(fields);
    html! {
        h2 { "How to reproduce" }
        p { (Prose("Save the case file below as `case.toml` and run Carom ")) (run.manifest.version) ":" }
        pre { "carom run case.toml" @for set in &sets { " " span.option { "--set" } " '" (set) "'" } }
        details { summary { "Case file" } pre { (source.text) } }
        p { "Files beside this page: " (joined(files.map(file), ", ")) "." }
    }
}
