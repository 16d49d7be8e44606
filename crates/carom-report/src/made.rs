//! How a run was made: version, scheme, machine, times of the phases, events, and how to reproduce
//! it.

use std::collections::BTreeMap;

use carom_record::Manifest;
use carom_time::ForceRule;
use maud::{Markup, Render, html};

use crate::document::{file, joined};
use crate::labels::{capitalised, instant_label, number};
use crate::recorded::Recorded;
use crate::scientific::powers;
use crate::setup::table;
use crate::text::{Label, typeset};

/// Number of log events listed; all of them are counted.
const EVENTS: usize = 50;

/// The section of the page.
pub(crate) fn made(run: &Recorded) -> Markup {
    html! {
        (facts(run))
        (reproduce(run))
        (timing(run))
        (events(run))
    }
}

fn facts(run: &Recorded) -> Markup {
    let m = &run.manifest;
    let machine = &m.machine;
    let rows = run.times().len();
    let last = run.times().last().copied().unwrap_or(0.0);
    let wall: f64 = m.timings.get("total").copied().unwrap_or_else(|| m.timings.values().sum());
    html! {
        table {
            @if run.fields.is_empty() {
                // Nothing is drawn of the model.
                (row("Model", table(&run.case, None)))
            }
            (row(if run.is_static() { "Analysis" } else { "Time integration" }, Label(&integration(run))))
            (row("Record", html! { (rows) " rows, up to " (Label(&instant_label(run, last))) }))
            (row("Wall time", html! {
                (three(wall)) " s, " (m.threads) @if m.threads == 1 { " thread" } @else { " threads" } " of "
                (machine.cpus) " cores, " (capitalised(&machine.os)) " " (machine.arch)
            }))
            (row("Started", moment(&m.started)))
            (row("Carom", &m.version))
            (row("Input hash", html! { code.hash { (m.input_hash) } }))
        }
    }
}

/// A time stamp as it is read: `2026-01-02 03:04:05 UTC`.
pub(crate) fn moment(stamp: &str) -> String {
    stamp.replace('T', " ").replace('Z', " UTC")
}

fn row(name: &str, value: impl Render) -> Markup {
    html! { tr { th { (name) } td { (value) } } }
}

fn events(run: &Recorded) -> Markup {
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for event in &run.log {
        *kinds.entry(&event.kind).or_default() += 1;
    }
    let counts: Vec<String> = kinds.iter().map(|(kind, n)| format!("{n} × {kind}")).collect();
    html! {
        @if !run.log.is_empty() {
            details {
                summary { "Events: " (counts.join(", ")) }
                table {
                    thead { tr { th.n { "Step" } th.n { "Time (" (Label(run.history.unit("time"))) ")" } th { "Kind" } th { "Message" } } }
                    @for e in run.log.iter().take(EVENTS) {
                        tr {
                            td.n { (e.step) } td.n { (number(e.time)) } td { (e.kind) }
                            td { (Label(&powers(&typeset(&e.message)))) }
                        }
                    }
                }
                @if run.log.len() > EVENTS { p.small { "The first " (EVENTS) " of " (run.log.len()) "; all: " (file("log.jsonl")) "." } }
            }
        }
    }
}

fn reproduce(run: &Recorded) -> Markup {
    let source = &run.manifest.source;
    let fields = (!run.fields.is_empty()).then_some("fields.pvd");
    let files = ["manifest.json", "history.csv", "contact.csv", "log.jsonl"].into_iter().chain(fields);
    html! {
        p { "To run it again with Carom " (run.manifest.version) ", save the case file as " code { "case.toml" } ":" }
        pre { (command(&source.sets)) }
        details { summary { "Case file" } pre { (source.text) } }
        p { "Files: " (joined(files.map(file), ", ")) "." }
    }
}

/// The command that runs `case.toml` with options.
pub(crate) fn command(sets: &[String]) -> Markup {
    // Inside single quotes a shell has no escape: the quote is closed, written and opened again.
    let sets: Vec<String> = sets.iter().map(|set| set.replace('\'', r"'\''")).collect();
    html! { "carom run case.toml" @for set in &sets { " " span.option { "--set" } " '" (set) "'" } }
}

/// The scheme with its parameters, and the time step.
fn integration(run: &Recorded) -> String {
    let time = &run.case.time;
    let scheme = &time.scheme;
    let mut parts = vec![scheme_name(&scheme.kind).to_owned()];
    parts.extend(
        scheme.parameters.iter().map(|(key, value)| format!("{} = {}", symbol_of(key), number(*value))),
    );
    if !run.is_static() && scheme.forces != ForceRule::AverageForces {
        parts.push("forces of averaged positions".to_owned());
    }
    let step = number(time.step);
    let step = if run.is_static() {
        format!("load step = {step}")
    } else {
        format!("Δt = {step} {}", run.time_unit())
    };
    format!("{}; {step}", parts.join(", ")).replace(" = ", "\u{a0}=\u{a0}")
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

/// Three significant digits; all digits of the integer part of a larger number.
pub(crate) fn three(x: f64) -> String {
    let unit = if x == 0.0 { 1.0 } else { 10.0_f64.powi(x.abs().log10().floor().min(2.0) as i32 - 2) };
    number((x / unit).round() * unit)
}

/// A counter in words.
fn counter(name: &str, is_explicit: bool) -> String {
    match name {
        "newton" if is_explicit => "iterations of the contact forces".to_owned(),
        "newton" => "Newton iterations".to_owned(),
        "rejected" => "rejected attempts".to_owned(),
        "activations" => "activations of contact nodes".to_owned(),
        "releases" => "releases of contact nodes".to_owned(),
        name => name.replace('_', " "),
    }
}

/// Width of a bar of 100 %, in rem.
const WIDTH: f64 = 8.0;

/// Wall time by phase, in total and per step, and the counters.
fn timing(run: &Recorded) -> Markup {
    let m: &Manifest = &run.manifest;
    let steps = m.counters.get("steps").copied().unwrap_or(0);
    let is_explicit = run.is_explicit();
    let each = |whole: f64| if steps > 0 { three(whole / steps as f64) } else { "–".into() };
    html! {
        details {
        summary { "Timing and counters" }
        @if let Some(&total) = m.timings.get("total") {
            table.timing {
                thead {
                    tr {
                        th { "Phase" } th.n { "Total (s)" } th.n { "Per step (ms)" } th.n { "Share" } th {}
                        th { "Description" }
                    }
                }
                @let all = ("total", "wall time of the run without its set-up", total);
                @for (name, what, seconds) in m.phases().into_iter().chain([all]).filter(|phase| phase.2 > 0.0) {
                    @let share = seconds / total.max(f64::MIN_POSITIVE);
                    tr {
                        td { (name) } td.n { (three(seconds)) } td.n { (each(1e3 * seconds)) }
                        td.n { @if share < 0.005 { "< 1 %" } @else { (format_args!("{:.0} %", 100.0 * share)) } }
                        td.share { span style=(format_args!("width:{:.2}rem", WIDTH * share)) {} }
                        td { (what) }
                    }
                }
            }
        }
        @if let Some(&cpu) = m.timings.get("cpu") {
            p {
                "Processor time of the first thread in the time steps: " (three(cpu)) "\u{a0}s (" (each(1e3 * cpu))
                "\u{a0}ms per step)."
            }
        }
        table {
            thead { tr { th { "Counter" } th.n { "Total" } th.n { "Per step" } } }
            @for (name, &count) in m.counters.iter().filter(|(_, count)| **count > 0) {
                tr {
                    td { (counter(name, is_explicit)) } td.n { (count) }
                    td.n { @if name != "steps" { (each(count as f64)) } }
                }
            }
        }
        }
    }
}
