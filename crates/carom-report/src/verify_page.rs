//! `verify.html`: what was verified, family by family, in one page that needs nothing but itself;
//! and the same as Markdown.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use carom_record::verification::{Row, SetUp, Verification};
use maud::{Markup, html};

use crate::document::{document, file, or_dash};
use crate::labels::number;
use crate::publish::ReportError;

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
    let title = format!("Carom {}, verified", v.version);
    let body = html! {
        (summary(v))
        h2 { "Families" }
        table {
            thead {
                tr {
                    th { "Family" }
                    @for head in ["Set-ups", "with contact", "Values", "Missed", "Seconds"] { th.n { (head) } }
                }
            }
            @for name in v.families() { (family(v, name)) }
        }
        @for name in v.families() {
            h2 id=(name) { (name) }
            table {
                thead {
                    tr {
                        th { "Arm" } th { "Quantity" } th { "Expected" }
                        @for head in ["Got", "Error", "Tolerance"] { th.n { (head) } }
                        th {} th { "Source" }
                    }
                }
                @for set_up in v.set_ups.iter().filter(|s| s.family == name) {
                    (head(set_up, directory))
                    @for one in &set_up.rows { (row(one)) }
                }
            }
        }
        (foot(v))
    };
    document(&title, include_str!("verify.css"), &body)
}

fn summary(v: &Verification) -> Markup {
    let (rows, missed, stopped) = (v.rows().count(), v.missed(), v.stopped());
    let (class, word) = match (missed, stopped) {
        (0, 0) => ("finished", "every expectation is met".to_owned()),
        (_, 0) => ("failed", format!("{missed} of {rows} expectations missed")),
        _ => {
            ("failed", format!("{missed} of {rows} expectations missed, {stopped} runs stopped unexpectedly"))
        }
    };
    let lines = [
        ("Set-ups", format!("{} (a study with all its arms counts once)", v.set_ups.len())),
        ("with dynamic contact", v.with_contact().to_string()),
        ("Simulations", v.set_ups.iter().map(|s| s.runs).sum::<usize>().to_string()),
        ("Expected values", rows.to_string()),
        ("missed", missed.to_string()),
        ("Runs that stopped unexpectedly", stopped.to_string()),
        ("Wall time", format!("{} s, {} runs at a time", number(v.wall), v.jobs)),
        ("Machine", format!("{} cores, {}, {}", v.machine.cpus, v.machine.os, v.machine.arch)),
        ("Date", v.started.clone()),
        ("Selection", if v.fast { "without what is marked slow (--fast)" } else { "all" }.to_owned()),
    ];
    html! {
        p { span.status.(class) { (word) } }
        table.summary { @for (name, value) in lines { tr { th { (name) } td { (value) } } } }
    }
}

/// A family's row in the table of all.
fn family(v: &Verification, name: &str) -> Markup {
    let mine: Vec<&SetUp> = v.set_ups.iter().filter(|s| s.family == name).collect();
    let rows: Vec<&Row> = mine.iter().flat_map(|s| &s.rows).collect();
    let missed = rows.iter().filter(|r| !r.verdict.pass).count();
    html! {
        tr {
            td { a href={ "#" (name) } { (name) } }
            td.n { (mine.len()) }
            td.n { (mine.iter().filter(|s| s.contact).count()) }
            td.n { (rows.len()) }
            td.n.(if missed == 0 { "pass" } else { "miss" }) { (missed) }
            td.n { (number(mine.iter().map(|s| s.wall).sum())) }
        }
    }
}

fn head(set_up: &SetUp, directory: &Path) -> Markup {
    let pages = ["report.html", "study.html", "manifest.json", "study.json"];
    let page = pages.into_iter().find(|page| directory.join(&set_up.directory).join(page).is_file());
    html! {
        tr.set-up {
            td colspan="8" {
                b { (set_up.title) } " "
                span.small {
                    a href={ (set_up.directory) "/" (page.unwrap_or_default()) } { (set_up.directory) }
                    @if set_up.runs != 1 { ", " (set_up.runs) " runs" }
                    @if set_up.contact { ", contact" }
                    ", " (number(set_up.wall)) " s, "
                    code.hash title=(set_up.input_hash) { (set_up.input_hash.chars().take(10).collect::<String>()) }
                }
                @for why in &set_up.stopped { br; "stopped: " (why) }
            }
        }
    }
}

fn row(row: &Row) -> Markup {
    let verdict = &row.verdict;
    html! {
        tr {
            td.arm { @if let Some(arm) = &row.arm { (arm) } }
            td.q {
                a href={ (row.directory) "/" } { code { (verdict.what) } }
                @if let Some(why) = &verdict.why { br; span.small { (why) } }
            }
            td { (verdict.expected) }
            td.n { (or_dash(verdict.got, number)) }
            td.n { (or_dash(row.error(), number)) }
            td.n { (or_dash(verdict.tolerance, number)) }
            @if verdict.pass { td.pass { "met" } } @else { td.miss { "missed" } }
            td.source { @if let Some(source) = &verdict.source { (source) } }
        }
    }
}

fn foot(v: &Verification) -> Markup {
    html! {
        h2 { "To reproduce" }
        p { "With Carom " (v.version) ", in a folder with the cases:" }
        pre { "carom verify" @if v.fast { " --fast" } }
        p.small {
            "Error: got − expected; for a bound, how far beyond it. Expected values are written in the case files, \
             with their sources. Every value is computed from the run directory its row links to; the hash after a \
             title is BLAKE3 of the files and options that were run. All digits are in " (file("verify.csv")) ". \
             Results do not depend on the number of runs at a time; wall times do."
        }
        p.small {
            "To cite: Carom " (v.version) ", verification of " (v.started.split('T').next().unwrap_or_default()) " ("
            (v.set_ups.len()) " set-ups, " (v.rows().count()) " expected values, " (v.missed()) " missed)."
        }
    }
}

fn markdown(v: &Verification, family: &str) -> String {
    let cell = |text: &str| text.replace('|', "\\|").replace('\n', " ");
    let mut out = String::from(
        "| case | quantity | expected | got | error | source | |\n| --- | --- | --- | ---: | ---: | --- | --- |\n",
    );
    for (set_up, row) in v.rows().filter(|(s, _)| s.family == family) {
        let verdict = &row.verdict;
        let _ = writeln!(
            out,
            "| {} | `{}` | {} | {} | {} | {} | {} |",
            cell(&set_up.name),
            cell(&row.quantity()),
            cell(&verdict.expected),
            or_dash(verdict.got, number),
            or_dash(row.error(), number),
            cell(verdict.source.as_deref().unwrap_or_default()),
            if verdict.pass { "met" } else { "**missed**" }
        );
    }
    out
}
