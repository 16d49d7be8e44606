//! `verify.html`: what was verified, family by family, in one page that needs nothing but itself;
//! and the same as Markdown.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use carom_record::verification::{Row, SetUp, Verification};

use crate::labels::number;
use crate::publish::ReportError;
use crate::text::escape;

/// What the page of a run does not need.
const CSS: &str = "body { max-width: 1200px; } th.n { text-align: right; } td.q { overflow-wrap: anywhere; max-width: 26rem; } td.arm { max-width: 15rem; font-size: .85rem; } \
td.source { max-width: 18rem; font-size: .85rem; color: #555; } .summary td { padding-right: 2rem; } tr.set-up td { background: #f6f6f6; padding-top: .5rem; } \
@media print { table { font-size: 8pt; } a { color: inherit; text-decoration: none; } thead { display: table-header-group; } }\n";

/// Writes `verify.html` into the directory of a verification, from `verify.json` alone.
///
/// # Errors
/// What cannot be read or written.
pub fn verify(directory: &Path) -> Result<PathBuf, ReportError> {
    let verification = Verification::read(directory)?;
    write(directory.join("verify.html"), &page(&verification, directory))
}

/// Writes one Markdown table per family, `FAMILY.md`.
///
/// # Errors
/// What cannot be read or written.
pub fn verify_markdown(directory: &Path, out: &Path) -> Result<Vec<PathBuf>, ReportError> {
    let verification = Verification::read(directory)?;
    std::fs::create_dir_all(out).map_err(|source| ReportError::Write { path: out.to_owned(), source })?;
    let one = |family: &&str| write(out.join(format!("{family}.md")), &markdown(&verification, family));
    verification.families().iter().map(one).collect()
}

fn write(path: PathBuf, text: &str) -> Result<PathBuf, ReportError> {
    match std::fs::write(&path, text) {
        Ok(()) => Ok(path),
        Err(source) => Err(ReportError::Write { path, source }),
    }
}

fn page(v: &Verification, directory: &Path) -> String {
    let rows = v.rows().count();
    let (missed, stopped) = (v.missed(), v.stopped());
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>Carom {version}, verified</title>\n<style>\n{}{CSS}</style>\n</head>\n<body>\n<h1>Carom {version}, verified</h1>\n",
        include_str!("page.css"),
        version = escape(&v.version)
    );
    let (class, word) = match (missed, stopped) {
        (0, 0) => ("finished", "every expectation is met".to_owned()),
        (_, 0) => ("failed", format!("{missed} of {rows} expectations missed")),
        _ => {
            ("failed", format!("{missed} of {rows} expectations missed, {stopped} runs stopped unexpectedly"))
        }
    };
    let _ = writeln!(out, "<p><span class=\"status {class}\">{word}</span></p>\n<table class=\"summary\">");
    let line = |name: &str, value: String| format!("<tr><th>{name}</th><td>{}</td></tr>\n", escape(&value));
    out += &line("Set-ups", format!("{} (a study with all its arms counts once)", v.set_ups.len()));
    out += &line("with dynamic contact", v.with_contact().to_string());
    out += &line("Simulations", v.set_ups.iter().map(|s| s.runs).sum::<usize>().to_string());
    out += &line("Expected values", rows.to_string());
    out += &line("missed", missed.to_string());
    out += &line("Runs that stopped unexpectedly", stopped.to_string());
    out += &line("Wall time", format!("{} s, {} runs at a time", number(v.wall), v.jobs));
    out += &line("Machine", format!("{} cores, {}, {}", v.machine.cpus, v.machine.os, v.machine.arch));
    out += &line("Date", v.started.clone());
    let selection = if v.fast { "without what is marked slow (--fast)" } else { "all" };
    out += &line("Selection", selection.to_owned());
    out.push_str("</table>\n<h2>Families</h2>\n<table>\n<thead><tr><th>Family</th><th class=\"n\">Set-ups</th><th class=\"n\">with contact</th>\
                  <th class=\"n\">Values</th><th class=\"n\">Missed</th><th class=\"n\">Seconds</th></tr></thead>\n");
    for family in v.families() {
        let mine: Vec<&SetUp> = v.set_ups.iter().filter(|s| s.family == family).collect();
        let rows: Vec<&Row> = mine.iter().flat_map(|s| &s.rows).collect();
        let missed = rows.iter().filter(|r| !r.verdict.pass).count();
        let _ = writeln!(
            out,
            "<tr><td><a href=\"#{name}\">{name}</a></td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>\
             <td class=\"n {}\">{missed}</td><td class=\"n\">{}</td></tr>",
            mine.len(),
            mine.iter().filter(|s| s.contact).count(),
            rows.len(),
            if missed == 0 { "pass" } else { "miss" },
            number(mine.iter().map(|s| s.wall).sum()),
            name = escape(family)
        );
    }
    out.push_str("</table>\n");
    for family in v.families() {
        let _ = writeln!(
            out,
            "<h2 id=\"{name}\">{name}</h2>\n<table>\n<thead><tr><th>Arm</th><th>Quantity</th><th>Expected</th><th class=\"n\">Got</th>\
             <th class=\"n\">Error</th><th class=\"n\">Tolerance</th><th></th><th>Source</th></tr></thead>",
            name = escape(family)
        );
        for set_up in v.set_ups.iter().filter(|s| s.family == family) {
            head(&mut out, set_up, directory);
            set_up.rows.iter().for_each(|row| self::row(&mut out, row));
        }
        out.push_str("</table>\n");
    }
    foot(&mut out, v);
    out
}

fn head(out: &mut String, set_up: &SetUp, directory: &Path) {
    let pages = ["report.html", "study.html", "manifest.json", "study.json"];
    let page = pages.into_iter().find(|page| directory.join(&set_up.directory).join(page).is_file());
    let runs = if set_up.runs == 1 { String::new() } else { format!(", {} runs", set_up.runs) };
    let contact = if set_up.contact { ", contact" } else { "" };
    let _ = writeln!(
        out,
        "<tr class=\"set-up\"><td colspan=\"8\"><b>{}</b> <span class=\"small\"><a href=\"{}/{}\">{}</a>{runs}{contact}, {} s, \
         <code class=\"hash\" title=\"{}\">{}</code></span>{}</td></tr>",
        escape(&set_up.title),
        escape(&set_up.directory),
        page.unwrap_or_default(),
        escape(&set_up.directory),
        number(set_up.wall),
        escape(&set_up.input_hash),
        escape(&set_up.input_hash.chars().take(10).collect::<String>()),
        set_up.stopped.iter().fold(String::new(), |all, why| all + &format!("<br>stopped: {}", escape(why)))
    );
}

fn row(out: &mut String, row: &Row) {
    let verdict = &row.verdict;
    let (class, word) = if verdict.pass { ("pass", "met") } else { ("miss", "missed") };
    let why = verdict
        .why
        .as_ref()
        .map_or_else(String::new, |why| format!("<br><span class=\"small\">{}</span>", escape(why)));
    let shown = |x: Option<f64>| x.map_or("–".into(), number);
    let _ = writeln!(
        out,
        "<tr><td class=\"arm\">{}</td><td class=\"q\"><a href=\"{}/\"><code>{}</code></a>{why}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>\
         <td class=\"n\">{}</td><td class=\"{class}\">{word}</td><td class=\"source\">{}</td></tr>",
        escape(row.arm.as_deref().unwrap_or_default()),
        escape(&row.directory),
        escape(&verdict.what),
        escape(&verdict.expected),
        shown(verdict.got),
        shown(row.error()),
        shown(verdict.tolerance),
        escape(verdict.source.as_deref().unwrap_or_default())
    );
}

fn foot(out: &mut String, v: &Verification) {
    let command = if v.fast { "carom verify --fast" } else { "carom verify" };
    let _ = writeln!(
        out,
        "<h2>To reproduce</h2>\n<p>With Carom {version}, in a folder with the cases:</p>\n<pre>{command}</pre>\n<p class=\"small\">Error: got − \
         expected; for a bound, how far beyond it. Expected values are written in the case files, with their sources. Every value is computed \
         from the run directory its row links to; the hash after a title is BLAKE3 of the files and options that were run. All digits are in \
         <a href=\"verify.csv\">verify.csv</a>. Results do not depend on the number of runs at a time; wall times do.</p>\n<p class=\"small\">To \
         cite: Carom {version}, verification of {date} ({n} set-ups, {rows} expected values, {missed} missed).</p>\n</body>\n</html>",
        version = escape(&v.version),
        date = escape(v.started.split('T').next().unwrap_or_default()),
        n = v.set_ups.len(),
        rows = v.rows().count(),
        missed = v.missed()
    );
}

fn markdown(v: &Verification, family: &str) -> String {
    let cell = |text: &str| text.replace('|', "\\|").replace('\n', " ");
    let mut out = String::from(
        "| case | quantity | expected | got | error | source | |\n| --- | --- | --- | ---: | ---: | --- | --- |\n",
    );
    for (set_up, row) in v.rows().filter(|(s, _)| s.family == family) {
        let verdict = &row.verdict;
        let shown = |x: Option<f64>| x.map_or("–".into(), number);
        let _ = writeln!(
            out,
            "| {} | `{}` | {} | {} | {} | {} | {} |",
            cell(&set_up.name),
            cell(&row.quantity()),
            cell(&verdict.expected),
            shown(verdict.got),
            shown(row.error()),
            cell(verdict.source.as_deref().unwrap_or_default()),
            if verdict.pass { "met" } else { "**missed**" }
        );
    }
    out
}
