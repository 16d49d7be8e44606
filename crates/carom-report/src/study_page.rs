//! `study.html`: arms, claims, metrics and overlays, in one page that needs nothing but itself.

use std::fmt::Write as _;

use carom_record::Status;
use carom_record::study::{Study, Verdict};

use crate::collected::Origins;
use crate::digits::five;
use crate::plot::{Plot, style};
use crate::text::{escape, html};
use crate::{convergence, design, integrity, verdict};

/// Arms in one table of metrics; more make more tables.
const ACROSS: usize = 8;

/// Values of a key that are told one by one.
const FEW: usize = 4;

/// More arms than these are folded away.
const MANY: usize = 12;

/// What the page of a run does not need.
const CSS: &str = "td.method { min-width: 10rem; } .verdict { border: 2px solid #0072b2; border-radius: 6px; padding: .2rem 1.1rem .6rem; margin: 1rem 0; background: #f4f9fd; } \
.verdict.none { border-color: #8a5a00; background: #fdf8ee; } .verdict dt { font-weight: 600; margin-top: .5rem; } .verdict dd { margin-left: 1.2rem; } span.miss { color: #a32b00; font-weight: 600; } td.undecided { color: #8a5a00; font-weight: 600; } th.n { text-align: right; } \
table.metrics td, table.metrics th { padding-right: .7rem; } table.ranking { font-size: .78rem; } table.ranking td, table.ranking th { padding-right: .45rem; } .ranking td.method { min-width: 7rem; } .ranking code { font-size: inherit; } svg.line { vertical-align: middle; } \
@media print { body { -webkit-print-color-adjust: exact; print-color-adjust: exact; } .metrics { font-size: 8.5pt; } }\n";

/// The page.
pub(crate) fn page(study: &Study, picture: Option<&str>, plots: &[Plot], origins: &Origins) -> String {
    let m = &study.manifest;
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>{title}</title>\n<style>\n{}{CSS}</style>\n</head>\n<body>\n<h1>{title}</h1>\n",
        include_str!("page.css"),
        title = escape(&m.title)
    );
    let (class, word) = match m.status {
        Status::Finished => ("finished", "finished"),
        Status::Running => ("running", "running, or killed: resumable"),
        Status::Stopped | Status::Failed => ("stopped", "stopped: resumable"),
    };
    let _ = writeln!(out, "<p><span class=\"status {class}\">{word}</span></p>");
    verdict::show(&mut out, study);
    setup(&mut out, study, picture);
    arms(&mut out, study);
    verdict::rankings(&mut out, study);
    claims(&mut out, &study.verdicts);
    expectations(&mut out, study);
    out.push_str("<h2>Figures</h2>\n");
    for (i, plot) in plots.iter().enumerate() {
        let (caption, name) = (html(&plot.caption), escape(&plot.name));
        let link =
            ["svg", "csv", "py"].map(|e| format!("<a href=\"figures/{name}.{e}\">figures/{name}.{e}</a>"));
        let _ = writeln!(
            out,
            "<figure>\n{}<figcaption><b>Figure {}.</b> {caption} <span class=\"small\">({})</span></figcaption>\n</figure>",
            plot.svg(),
            i + 1,
            link.join(", ")
        );
    }
    metrics(&mut out, study);
    convergence::show(&mut out, study);
    verdict::phases(&mut out, study);
    integrity::show(&mut out, study, origins);
    reproduce(&mut out, study);
    out.push_str("</body>\n</html>\n");
    out
}

/// The case drawn, what is made of what, and what the arms vary.
fn setup(out: &mut String, study: &Study, picture: Option<&str>) {
    out.push_str("<h2>Setup</h2>\n");
    if let Some(svg) = picture {
        let _ = writeln!(
            out,
            "<figure>\n{svg}<figcaption>The case <code>{}</code> as its first arm has it <span class=\"small\">(<a \
             href=\"figures/setup.svg\">figures/setup.svg</a>)</span></figcaption>\n</figure>",
            escape(&study.manifest.source.case_path)
        );
    }
    let mut varied: Vec<(&str, Vec<&str>)> = Vec::new();
    let sets = study.manifest.arms.iter().filter(|a| !a.role.fine).flat_map(|a| &a.sets);
    for (key, value) in sets.filter_map(|set| set.split_once('=')) {
        let (key, value) = (key.trim(), value.trim());
        match varied.iter_mut().find(|(k, _)| *k == key) {
            Some((_, values)) if values.contains(&value) => {}
            Some((_, values)) => values.push(value),
            None => varied.push((key, vec![value])),
        }
    }
    let told = |(key, values): &(&str, Vec<&str>)| {
        let values = match values.len() {
            n if n > FEW => format!("{n} values"),
            _ => values.iter().map(|v| format!("<code>{}</code>", escape(v))).collect::<Vec<_>>().join(", "),
        };
        format!("<li><code>{}</code>: {values}</li>", escape(key))
    };
    if !varied.is_empty() {
        let _ = writeln!(
            out,
            "<p>Varied, where an arm does not leave it as the case has it:</p>\n<ul>{}</ul>",
            varied.iter().map(told).collect::<String>()
        );
    }
    design::show(out, study);
}

fn arms(out: &mut String, study: &Study) {
    // A long list stands in the way of what was found.
    let open = if study.rows.len() > MANY { "" } else { " open" };
    let _ = writeln!(
        out,
        "<h2>Arms</h2>\n<details{open}><summary>{} arms, and what each sets</summary>",
        study.rows.len()
    );
    out.push_str("<table>\n<thead><tr><th></th><th></th><th>Arm</th><th>Sets</th><th class=\"n\">Steps</th><th></th></tr></thead>\n");
    for (i, (row, arm)) in study.rows.iter().zip(&study.manifest.arms).enumerate() {
        let (color, dashes, _) = style(i);
        let (class, word) = match row.status {
            Some(Status::Finished) => ("pass", "finished"),
            Some(Status::Failed) => ("miss", "failed"),
            Some(Status::Running | Status::Stopped) => ("undecided", "not finished"),
            None => ("undecided", "not begun"),
        };
        let reason = row.reason.as_ref().map(|r| format!("<br><span class=\"small\">{}</span>", escape(r)));
        let reference =
            if study.manifest.reference.as_ref() == Some(&row.name) { " (reference)" } else { "" };
        let _ = writeln!(
            out,
            "<tr><td class=\"n\">{}</td><td><svg class=\"line\" width=\"44\" height=\"10\"><path d=\"M1 5h42\" stroke=\"{color}\" \
             stroke-width=\"2\" stroke-dasharray=\"{dashes}\"/></svg></td><td><a href=\"{}/report.html\">{}</a>{reference}</td>\
             <td>{}</td><td class=\"n\">{}</td><td class=\"{class}\">{word}{}</td></tr>",
            i + 1,
            escape(&arm.directory),
            escape(&row.name),
            arm.case_path
                .iter()
                .map(|path| format!("case <code>{}</code>", escape(path)))
                .chain(arm.sets.iter().map(|s| format!("<code>{}</code>", escape(s))))
                .collect::<Vec<_>>()
                .join("<br>"),
            arm.steps,
            reason.unwrap_or_default()
        );
    }
    out.push_str("</table></details>\n");
}

fn claims(out: &mut String, verdicts: &[Verdict]) {
    if verdicts.is_empty() {
        return;
    }
    out.push_str("<h2>Claims</h2>\n<table>\n<thead><tr><th>Claim</th><th class=\"n\">Left</th><th class=\"n\">Right</th><th></th></tr></thead>\n");
    for v in verdicts {
        let class = match v.holds {
            Some(true) => "pass",
            Some(false) => "miss",
            None => "undecided",
        };
        let _ = writeln!(
            out,
            "<tr><td>{}<br><code>{}</code></td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"{class}\">{}</td></tr>",
            escape(&v.claim.text),
            escape(&v.claim.compare),
            v.left.map_or("–".into(), five),
            v.right.map_or("–".into(), five),
            v.word()
        );
    }
    out.push_str("</table>\n");
}

fn expectations(out: &mut String, study: &Study) {
    let arms = study.rows.iter().flat_map(|row| row.expectations.iter().map(move |e| (row.name.as_str(), e)));
    let all: Vec<_> = arms.chain(study.expectations.iter().map(|e| ("", e))).collect();
    if all.is_empty() {
        return;
    }
    out.push_str("<h2>Expectations</h2>\n");
    let met = all.iter().filter(|(_, e)| e.pass).count();
    let _ = writeln!(out, "<p>{met} of {} met.</p>", all.len());
    let across = side_by_side(out, study);
    let _ = writeln!(
        out,
        "<details{}><summary>One by one, with their sources</summary>",
        if across { "" } else { " open" }
    );
    out.push_str("<table>\n<thead><tr><th>What</th><th>Arm</th><th>Expected</th><th class=\"n\">Got</th><th></th><th>Source</th></tr></thead>\n");
    for (arm, e) in all {
        let (class, word) = if e.pass { ("pass", "met") } else { ("miss", "missed") };
        let why = e
            .why
            .as_ref()
            .map_or_else(String::new, |w| format!("<br><span class=\"small\">{}</span>", escape(w)));
        let _ = writeln!(
            out,
            "<tr><td><code>{}</code>{why}</td><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"{class}\">{word}</td><td>{}</td></tr>",
            escape(&e.what),
            escape(arm),
            escape(&e.expected),
            e.got.map_or("–".into(), five),
            escape(e.source.as_deref().unwrap_or_default())
        );
    }
    out.push_str("</table></details>\n");
}

/// Most columns that stand side by side.
const COLUMNS: usize = 8;

/// What is expected of several arms, a row per arm and a column per question: what it got over what
/// was expected. Whether there is such a table.
fn side_by_side(out: &mut String, study: &Study) -> bool {
    let mut questions: Vec<&str> = Vec::new();
    for e in study.rows.iter().flat_map(|row| &row.expectations) {
        if !questions.contains(&e.what.as_str()) {
            questions.push(&e.what);
        }
    }
    let arms: Vec<_> = study.rows.iter().filter(|row| !row.expectations.is_empty()).collect();
    if arms.len() < 3 || questions.is_empty() || questions.len() > COLUMNS {
        return false;
    }
    let heads: Vec<String> =
        questions.iter().map(|q| format!("<th class=\"n\"><code>{}</code></th>", escape(q))).collect();
    let heads = heads.concat();
    let _ = writeln!(out, "<table class=\"metrics\"><thead><tr><th>Arm</th>{heads}</tr></thead>");
    for row in arms {
        let cell = |question: &&str| {
            let mine: Vec<_> = row.expectations.iter().filter(|e| e.what == **question).collect();
            let Some(first) = mine.first() else { return "<td></td>".to_owned() };
            let class = if mine.iter().all(|e| e.pass) { "pass" } else { "miss" };
            let expected = mine.iter().map(|e| escape(&e.expected)).collect::<Vec<_>>().join(", ");
            let got = first.got.map_or("–".into(), five);
            format!(
                "<td class=\"n\"><span class=\"{class}\">{got}</span><br><span class=\"small\">{expected}</span></td>"
            )
        };
        let cells: String = questions.iter().map(cell).collect();
        let _ = writeln!(out, "<tr><td>{}</td>{cells}</tr>", escape(&row.name));
    }
    out.push_str("</table>\n");
    true
}

fn metrics(out: &mut String, study: &Study) {
    out.push_str("<h2>Metrics</h2>\n");
    let all = study.metrics();
    let shown: Vec<_> =
        all.iter().filter(|m| study.rows.iter().any(|r| r.value(&m.name).is_some())).collect();
    for first in (0..study.rows.len()).step_by(ACROSS) {
        let rows = &study.rows[first..study.rows.len().min(first + ACROSS)];
        let heads = (0..rows.len())
            .fold(String::new(), |row, i| row + &format!("<th class=\"n\">{}</th>", first + i + 1));
        let _ = writeln!(
            out,
            "<table class=\"metrics\">\n<thead><tr><th>Metric</th><th>Unit</th>{heads}</tr></thead>"
        );
        for metric in &shown {
            let cells = rows.iter().map(|r| r.value(&metric.name).map_or("–".into(), five));
            let cells = cells.fold(String::new(), |row, c| row + &format!("<td class=\"n\">{c}</td>"));
            let _ = writeln!(
                out,
                "<tr><td><code>{}</code></td><td>{}</td>{cells}</tr>",
                escape(&metric.name),
                html(&metric.unit)
            );
        }
        out.push_str("</table>\n");
    }
    out.push_str("<p class=\"small\">Columns are the numbers of the arms. Every value is computed from the arm's own directory alone; the same \
                  numbers with all digits are in <a href=\"study.csv\">study.csv</a> and <a href=\"study_tidy.csv\">study_tidy.csv</a>.</p>\n\
                  <details><summary>Definitions</summary>\n<table>\n");
    for metric in &shown {
        let _ = writeln!(
            out,
            "<tr><td><code>{}</code></td><td>{}</td></tr>",
            escape(&metric.name),
            escape(metric.definition)
        );
    }
    out.push_str("</table></details>\n");
}

/// An entry for a bibliography that names the program and the input.
fn bibtex(study: &Study) -> String {
    let m = &study.manifest;
    let (year, hash) = (m.created.get(..4).unwrap_or_default(), m.input_hash.get(..16).unwrap_or_default());
    format!(
        "@software{{carom,\n  title   = {{Carom: impact and contact by the positional finite element method}},\n  version = {{{}}},\n  year    = {{{year}}},\n  \
         note    = {{study \"{}\", input {hash}}}\n}}",
        m.version, m.title
    )
}

/// Files of a study directory, where it has them.
const FILES: [&str; 9] = [
    "study.json",
    "study.csv",
    "study_tidy.csv",
    "ranking.csv",
    "reference.csv",
    "claims.csv",
    "theory.csv",
    "frequencies.csv",
    "checks.json",
];

fn reproduce(out: &mut String, study: &Study) {
    let m = &study.manifest;
    let case = escape(&m.source.case_path);
    let _ = writeln!(
        out,
        "<h2>To reproduce</h2>\n<p>Save the study as <code>study.toml</code> and the case as <code>{case}</code> beside it, then with Carom \
         {}:</p>\n<pre>carom study study.toml</pre>\n<p class=\"small\">Input hash <code class=\"hash\">{}</code>; made {} on {} cores, {} {}. \
         Results do not depend on the number of jobs; wall times do.</p>\n\
         <details><summary>The study file</summary>\n<pre>{}</pre></details>\n<details><summary>The case file</summary>\n<pre>{}</pre></details>",
        escape(&m.version),
        escape(&m.input_hash),
        escape(&m.created),
        m.machine.cpus,
        escape(&m.machine.os),
        escape(&m.machine.arch),
        escape(&m.source.study),
        escape(&m.source.case)
    );
    let there = FILES.iter().filter(|name| study.directory.join(name).is_file());
    let files = there.fold(String::new(), |list, name| list + &format!(" · <a href=\"{name}\">{name}</a>"));
    let _ = writeln!(
        out,
        "<p>The folder of this page is the record of the study, and enough to make the page again with <code>carom report</code>: put it into an archive whole. In it: \
         <code>arms/</code>{files}</p>"
    );
    let _ = writeln!(out, "<h2>To cite</h2>\n<pre>{}</pre>", escape(&bibtex(study)));
    for (path, text) in &m.source.others {
        let (path, text) = (escape(path), escape(text));
        let _ =
            writeln!(out, "<details><summary>The case file {path}</summary>\n<pre>{text}</pre></details>");
    }
}
