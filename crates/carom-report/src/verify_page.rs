//! `verify.html`: the results of a verification by family, as a single self-contained page; the
//! same tables in Markdown.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use carom_record::verification::{Row, SetUp, Verification};
use maud::{Markup, html};

use crate::digits::{five, three};
use crate::document::{document, file, labelled, minus, or_dash};
use crate::labels::{capitalised, number};
use crate::made::moment;
use crate::publish::{ReportError, write};
use crate::scientific::powers;
use crate::text::Label;

/// Writes `verify.html` into the directory of a verification, from `verify.json` alone.
///
/// # Errors
/// A file cannot be read or written.
pub fn verify(directory: &Path) -> Result<PathBuf, ReportError> {
    let verification = Verification::read(directory)?;
    write(directory.join("verify.html"), &page(&verification, directory))
}

/// Writes one Markdown table per family, `FAMILY.md`.
///
/// # Errors
/// A file cannot be read or written.
pub fn verify_markdown(directory: &Path, out: &Path) -> Result<Vec<PathBuf>, ReportError> {
    let verification = Verification::read(directory)?;
    std::fs::create_dir_all(out).map_err(|source| ReportError::Write { path: out.to_owned(), source })?;
    let one = |family: &&str| write(out.join(format!("{family}.md")), &markdown(&verification, family));
    verification.families().iter().map(one).collect()
}

fn page(v: &Verification, directory: &Path) -> String {
    let title = format!("Verification of Carom {}", v.version);
    let body = html! {
        (summary(v))
        p.small { (WORDS) }
        @for name in v.families() { (family(v, name, directory)) }
        (foot(v))
    };
    document(&title, include_str!("verify.css"), &body)
}

fn summary(v: &Verification) -> Markup {
    let rows = v.rows().count();
    let missed = v.missed();
    let stopped = v.stopped();
    let sourced = v.rows().filter(|(_, row)| row.verdict.source.is_some()).count();
    let (class, word) = match (missed, stopped) {
        (0, 0) if v.fast => ("finished", format!("all {rows} expected values of the fast selection are met")),
        (0, 0) => ("finished", format!("all {rows} expected values are met")),
        (_, 0) => ("failed", format!("{missed} of {rows} expectations missed")),
        _ => {
            ("failed", format!("{missed} of {rows} expectations missed, {stopped} runs stopped unexpectedly"))
        }
    };
    let runs = v.set_ups.iter().map(|set_up| set_up.runs).sum::<usize>();
    html! {
        p { span.status.(class) { (word) } " " (sourced) " of them with a stated source." }
        p.small {
            (v.set_ups.len()) " set-ups (a study counts as one), " (v.with_contact()) " with dynamic contact; " (runs)
            " simulations in " (three(v.wall)) " s, " (v.jobs) " at once, on " (v.machine.cpus) " cores, " (capitalised(&v.machine.os))
            " " (v.machine.arch) "; " (moment(&v.started)) "."
            @if v.fast { " Without cases marked slow (" code { "--fast" } ")." }
        }
    }
}

/// Explanation of the tables of families.
const WORDS: &str = "Error: result − expected value; for a bound, the amount beyond it. Every value is computed from \
    the run directory that its row links to. After each title: BLAKE3 hash of the files and options of its runs.";

/// The values of a family, open where one is missed.
fn family(v: &Verification, name: &str, directory: &Path) -> Markup {
    let set_ups: Vec<&SetUp> = v.set_ups.iter().filter(|set_up| set_up.family == name).collect();
    let rows = || set_ups.iter().flat_map(|set_up| &set_up.rows);
    let missed = rows().filter(|row| !row.verdict.pass).count();
    let wall = set_ups.iter().map(|set_up| set_up.wall).sum();
    html! {
        details id=(name) open[missed > 0] {
            summary {
                b { (name) } ": " (set_ups.len()) " set-ups, " (rows().count()) " values, "
                span.(if missed == 0 { "pass" } else { "miss" }) { (missed) " missed" } ", " (three(wall)) " s"
            }
            div.scroll {
                table {
                    thead {
                        tr {
                            th { "Arm" } th { "Quantity" } th { "Expected" } th.n { "Result" } th.n { "Error" }
                            th { "Met" } th { "Source" }
                        }
                    }
                    @for set_up in &set_ups {
                        (head(set_up, directory))
                        @for one in &set_up.rows { (row(one)) }
                    }
                }
            }
        }
    }
}

/// The row above the results of a set-up: title, link, time and hash.
fn head(set_up: &SetUp, directory: &Path) -> Markup {
    let pages = ["report.html", "study.html", "manifest.json", "study.json"];
    let page = pages.into_iter().find(|page| directory.join(&set_up.directory).join(page).is_file());
    let hash: String = set_up.input_hash.chars().take(10).collect();
    html! {
        tr.set-up {
            td colspan="7" {
                b { (set_up.title) } " "
                span.small {
                    a href={ (set_up.directory) "/" (page.unwrap_or_default()) } { (set_up.directory) }
                    @if set_up.runs != 1 { ", " (set_up.runs) " runs" }
                    @if set_up.contact { ", contact" }
                    ", " (three(set_up.wall)) " s, "
                    code.hash title=(set_up.input_hash) { (hash) }
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
            td { (Label(&powers(&minus(&verdict.expected)))) }
            td.n { (labelled(verdict.got, five)) } td.n { (labelled(row.error(), three)) }
            @if verdict.pass { td.pass { "yes" } } @else { td.miss { "missed" } }
            td.source { @if let Some(source) = &verdict.source { (source) } }
        }
    }
}

fn foot(v: &Verification) -> Markup {
    html! {
        p.small {
            "To reproduce: " code { "carom verify" @if v.fast { " --fast" } } " of Carom " (v.version)
            " in a directory with the cases. Values with all digits: " (file("verify.csv")) "."
        }
    }
}

fn markdown(v: &Verification, family: &str) -> String {
    let cell = |text: &str| text.replace('|', "\\|").replace('\n', " ");
    let mut out = String::from(
        "| case | quantity | expected | result | error | source | |\n\
         | --- | --- | --- | ---: | ---: | --- | --- |\n",
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
