//! `report.html`: one page that needs nothing but itself, on screen and on paper.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use carom_record::{FieldFormat, Run, Status, metrics};

use crate::figures::Figure;
use crate::labels::number;
use crate::text::{escape, html};
use crate::work::work;

/// Log events shown; all are counted.
const EVENTS: usize = 50;

/// The page.
pub(crate) fn page(run: &Run, figures: &[Figure], animation: Option<&str>, notes: &[String]) -> String {
    let title = run.manifest.case.get("title").and_then(|t| t.as_str()).unwrap_or("Carom run");
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>{title}</title>\n<style>\n{}</style>\n</head>\n<body>\n<h1>{title}</h1>\n",
        include_str!("page.css"),
        title = escape(title)
    );
    header(&mut out, run);
    for warning in &run.manifest.warnings {
        let _ = writeln!(out, "<p><b class=\"miss\">Warning:</b> {}.</p>", escape(warning));
    }
    for note in notes {
        let _ = writeln!(out, "<p class=\"small\">{}</p>", escape(note));
    }
    let case = figures.iter().take_while(|f| f.name == "setup").count();
    show(&mut out, &figures[..case], 1);
    out.push_str(animation.unwrap_or_default());
    results(&mut out, run);
    expectations(&mut out, run);
    out.push_str("<h2>Figures</h2>\n");
    show(&mut out, &figures[case..], case + 1);
    events(&mut out, run);
    work(&mut out, &run.manifest);
    reproduce(&mut out, run);
    out.push_str("</body>\n</html>\n");
    out
}

/// Figures with captions, numbered from `first`.
fn show(out: &mut String, figures: &[Figure], first: usize) {
    for (i, figure) in figures.iter().enumerate() {
        let (caption, name) = (html(&figure.caption), figure.name);
        let link = format!("<a href=\"figures/{name}.svg\">figures/{name}.svg</a>");
        let _ = writeln!(
            out,
            "<figure>\n{}<figcaption><b>Figure {}.</b> {caption} <span class=\"small\">({link})</span></figcaption>\n</figure>",
            figure.svg,
            first + i
        );
    }
}

fn header(out: &mut String, run: &Run) {
    let m = &run.manifest;
    let (class, word) = match m.status {
        Status::Running => ("running", "running, or killed: resumable"),
        Status::Finished => ("finished", "finished"),
        Status::Stopped => ("stopped", "stopped: resumable"),
        Status::Failed => ("failed", "failed"),
    };
    let reason = m.reason.as_ref().map(|r| format!(" {}", escape(r))).unwrap_or_default();
    let _ = writeln!(out, "<p><span class=\"status {class}\">{word}</span>{reason}</p>\n<table>");
    let (rows, last) = (run.times().len(), run.times().last().copied().unwrap_or(0.0));
    let wall: f64 = m.timings.get("total").copied().unwrap_or_else(|| m.timings.values().sum());
    let mut row = |name: &str, value: String| {
        let _ = writeln!(out, "<tr><th>{name}</th><td>{value}</td></tr>");
    };
    let names: Vec<&str> = m
        .case
        .get("bodies")
        .and_then(|b| b.as_array())
        .into_iter()
        .flatten()
        .filter_map(|b| b.get("name")?.as_str())
        .collect();
    if !names.is_empty() {
        row("Bodies", escape(&names.join(", ")));
    }
    row("Carom", escape(&m.version));
    row("Input hash", format!("<code class=\"hash\">{}</code>", escape(&m.input_hash)));
    row("Recorded", format!("{rows} rows to t = {} {}", number(last), html(run.history.unit("time"))));
    if let Some(scheme) = m.case.pointer("/time/scheme").and_then(|s| s.as_object()) {
        let part = |(k, v): (&String, &serde_json::Value)| match v.as_str() {
            Some(text) if k == "kind" => text.to_string(),
            Some(text) => format!("{k} {text}"),
            None => format!("{k} = {v}"),
        };
        let step =
            m.case.pointer("/time/step").and_then(serde_json::Value::as_f64).map_or(String::new(), number);
        row(
            "Time integration",
            escape(&format!("{}; Δt = {step}", scheme.iter().map(part).collect::<Vec<_>>().join(", "))),
        );
    }
    let machine = &m.machine;
    row(
        "Machine",
        escape(&format!("{} cores, {} {}; threads: {}", machine.cpus, machine.os, machine.arch, m.threads)),
    );
    row("Wall time", format!("{} s", number(wall)));
    row("Started", escape(&m.started));
    out.push_str("</table>\n<p class=\"small\">From manifest.json: version, input_hash, case, machine, threads, timings.total, started. The hash is BLAKE3 of the case file and the options given with it. Rows and times: history.csv.</p>\n");
}

fn results(out: &mut String, run: &Run) {
    out.push_str("<h2>Key results</h2>\n<table>\n<thead><tr><th>Metric</th><th>Value</th><th>Unit</th><th>Definition</th></tr></thead>\n");
    for metric in metrics::all(&run.history) {
        if let Some(value) = metric.value {
            let _ = writeln!(
                out,
                "<tr><td><code>{}</code></td><td class=\"n\">{}</td><td>{}</td><td>{}</td></tr>",
                metric.name,
                number(value),
                html(&metric.unit),
                escape(metric.definition)
            );
        }
    }
    out.push_str("</table>\n");
    if let Some(body) = metrics::striker(&run.history) {
        let _ = writeln!(
            out,
            "<p class=\"small\">Striker: {}. All values are computed from history.csv alone: times from <code>time</code> and <code>active</code>, forces from \
             <code>contact_force_…</code>, impulses from <code>contact_impulse_…</code>, energies from <code>dissipation</code>, \
             <code>kinetic</code> and <code>strain</code>, motion from <code>center_…</code> and <code>velocity_…</code> of the striker.</p>",
            escape(body)
        );
    }
}

fn expectations(out: &mut String, run: &Run) {
    if run.manifest.expectations.is_empty() {
        return;
    }
    out.push_str("<h2>Expectations</h2>\n<table>\n<thead><tr><th>What</th><th>Expected</th><th>Got</th><th></th><th>Source</th></tr></thead>\n");
    for e in &run.manifest.expectations {
        let (class, word) = if e.pass { ("pass", "holds") } else { ("miss", "missed") };
        let _ = writeln!(
            out,
            "<tr><td><code>{}</code></td><td>{}</td><td class=\"n\">{}</td><td class=\"{class}\">{word}</td><td>{}</td></tr>",
            escape(&e.what),
            escape(&e.expected).replace('-', "−"),
            e.got.map_or("–".into(), number),
            escape(e.source.as_deref().unwrap_or_default())
        );
    }
    out.push_str("</table>\n");
}

fn events(out: &mut String, run: &Run) {
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for event in &run.log {
        *kinds.entry(&event.kind).or_default() += 1;
    }
    out.push_str("<h2>Events</h2>\n<p class=\"small\">log.jsonl, one event per line.</p>\n");
    if kinds.is_empty() {
        out.push_str("<p>None.</p>\n");
        return;
    }
    let counts: Vec<String> = kinds.iter().map(|(kind, n)| format!("{n} × {}", escape(kind))).collect();
    let shown = run.log.len().min(EVENTS);
    let _ = writeln!(
        out,
        "<p>{}.</p>\n<details><summary>The first {shown} of {}</summary>\n<table>",
        counts.join(", "),
        run.log.len()
    );
    out.push_str("<thead><tr><th>Step</th><th>Time</th><th>Kind</th><th>What happened</th></tr></thead>\n");
    for e in &run.log[..shown] {
        let (time, kind, message) = (number(e.time), escape(&e.kind), escape(&e.message));
        let _ = writeln!(
            out,
            "<tr><td class=\"n\">{}</td><td class=\"n\">{time}</td><td>{kind}</td><td>{message}</td></tr>",
            e.step
        );
    }
    out.push_str("</table></details>\n");
}

fn reproduce(out: &mut String, run: &Run) {
    let source = &run.manifest.source;
    // A quote inside single quotes of a shell ends them, is escaped, and begins them anew.
    let sets: String =
        source.sets.iter().map(|s| [" --set '", &s.replace('\'', r"'\''"), "'"].concat()).collect();
    let _ = writeln!(
        out,
        "<h2>To reproduce</h2>\n<p>Save the case as <code>case.toml</code>, then with Carom {}:</p>\n<pre>carom run case.toml{}</pre>\n\
         <details><summary>The case file</summary>\n<pre>{}</pre></details>",
        escape(&run.manifest.version),
        escape(&sets),
        escape(&source.text)
    );
    out.push_str("<p>Beside this page: ");
    let mut files = vec!["manifest.json", "history.csv", "contact.csv", "log.jsonl"];
    if !run.fields.is_empty() {
        files.push(if run.field_format == FieldFormat::Vtu { "fields.pvd" } else { "fields.vtkhdf" });
    }
    let links: Vec<String> = files.iter().map(|f| format!("<a href=\"{f}\">{f}</a>")).collect();
    let _ = writeln!(out, "{}.</p>", links.join(", "));
}
