//! `carom verify`: runs every case with expectations and compares the results with them.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::num::NonZero;
use std::path::{Path, PathBuf};

use carom_record::RecordError;
use carom_record::verification::{Row, SetUp, Verification};
use carom_study::{Kind, Named, Suite, VerifyOptions};
use include_dir::{Dir, include_dir};
use serde_json::json;

use super::progress::Runs;
use crate::exit::{Exit, Failure};
use crate::live::stop_on_signal;
use crate::study_summary::report as study_report;
use crate::text::{duration, missed, several, short_or_dash};
use crate::{console, directory, out, table};

/// The cases as they were when the program was built.
static CASES: Dir = include_dir!("$CAROM_CASES");

/// Run all cases and studies that state expected results, and report which expectations are met
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom verify
  carom verify cases/bar --report
  carom verify --fast --csv
  carom verify --verbose | less -S

Exit codes: 0 all expectations met · 1 an expectation was missed · 2 a case is invalid · 3 a run stopped unexpectedly")]
#[allow(clippy::struct_excessive_bools)] // flags of the command line
pub(crate) struct Arguments {
    /// Cases, studies, or folders of them [default: the folder cases/ if it exists, otherwise
    /// the fast built-in cases]
    paths: Vec<PathBuf>,
    /// Skip expectations marked slow, and cases that have no others
    #[arg(long)]
    fast: bool,
    /// Stop at the first case or study that misses an expectation; short ones are run first
    #[arg(long, conflicts_with = "report")]
    fail_fast: bool,
    /// Number of concurrent runs; results are bitwise identical for any number;
    /// at most 64, or four per core if that is more [default: one per core]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZero<usize>>,
    /// Directory of the verification; must not exist yet [default: runs/verify, runs/verify-2, …]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the table as CSV
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Write fields, figures and a page for every run
    #[arg(long)]
    report: bool,
    /// Write one Markdown table per folder of cases into this directory
    #[arg(long, value_name = "DIR")]
    markdown: Option<PathBuf>,
    /// Print one JSON object per event on standard output, and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let jobs = super::parallel("--jobs", arguments.jobs)?;
    let directory = directory::of_run(Path::new("verify"), arguments.out.as_deref())?;
    let (paths, fast) = match arguments.paths.as_slice() {
        [] if Path::new("cases").is_dir() => (vec![PathBuf::from("cases")], arguments.fast),
        [] => {
            let cases = directory.join("cases");
            std::fs::create_dir_all(&cases)?;
            CASES.extract(&cases)?;
            (vec![cases], true)
        }
        paths => (paths.to_vec(), arguments.fast),
    };
    let suite = Suite::read(&paths, fast)?;
    if suite.items.is_empty() {
        let slow = fast && !Suite::read(&paths, false)?.items.is_empty();
        let (what, help) = if slow {
            ("all expectations found are slow, and --fast leaves them out", "leave out --fast")
        } else {
            (
                "no expectations found",
                "give a case or a study that has an [[expect]], or a folder that contains one",
            )
        };
        return Err(Failure::argument(what, help));
    }
    std::fs::create_dir_all(&*directory)?;
    let options = VerifyOptions { jobs, whole: arguments.report, fail_fast: arguments.fail_fast };
    let stop = stop_on_signal()?;
    let runs = RefCell::new(Runs::new("run"));
    let mut begin = |named: &[Named]| {
        named.iter().for_each(|run| runs.borrow_mut().add(&run.name, run.steps));
        // A closed standard output must not stop the suite.
        let _ = out::event(&json!({ "event": "start", "runs": runs.borrow().names }));
    };
    let done = suite.verify(&directory, options, &mut begin, &mut |e| runs.borrow_mut().event(e), &stop);
    drop(runs);
    let Some(verification) = done? else {
        out::event(&json!({ "event": "interrupted", "directory": &*directory }))?;
        if !arguments.csv {
            out::summary("interrupted by Ctrl-C: no expectation was evaluated")?;
        }
        return Ok(Exit::Interrupted);
    };
    if arguments.report {
        pages(&suite, &verification, &directory)?;
    }
    let page = carom_report::verify(&directory)?;
    if let Some(folder) = &arguments.markdown {
        carom_report::verify_markdown(&directory, folder)?;
    }
    print(&verification, arguments.csv, &page)?;
    let unjudged = suite.items.len() - verification.set_ups.len();
    if unjudged > 0 && !arguments.csv {
        out::summary(&format!(
            "stopped at the first miss: {unjudged} of {} set-ups were not evaluated",
            suite.items.len()
        ))?;
    }
    Ok(match (verification.stopped(), verification.missed()) {
        (0, 0) => Exit::Done,
        (0, _) => Exit::Missed,
        _ => Exit::Stopped,
    })
}

/// Figures and pages of every run.
fn pages(suite: &Suite, verification: &Verification, directory: &Path) -> Result<(), Failure> {
    for (item, set_up) in suite.items.iter().zip(&verification.set_ups) {
        let place = directory.join(&set_up.directory);
        match item.kind {
            Kind::Case(..) => drop(carom_report::report(&place)?),
            Kind::Study(_) => drop(study_report(&place)?),
        }
    }
    Ok(())
}

fn print(v: &Verification, csv: bool, page: &Path) -> Result<(), Failure> {
    for (set_up, row) in v.rows() {
        out::event(
            &json!({ "event": "row", "family": set_up.family, "case": set_up.name, "row": row, "error": row.error() }),
        )?;
    }
    out::event(&json!({
        "event": "done", "set_ups": v.set_ups.len(), "with_contact": v.with_contact(), "rows": v.rows().count(),
        "missed": v.missed(), "stopped": v.stopped(), "wall": v.wall, "report": page
    }))?;
    if csv {
        let table = page.with_file_name("verify.csv");
        let text = std::fs::read_to_string(&table).map_err(RecordError::io("read", &table))?;
        return Ok(out::line(&text)?);
    }
    out::summary(&summary(v, console::is_verbose()))?;
    Ok(out::summary(&page.display().to_string())?)
}

/// Missed expectations (with `all`, every row) as a table; runs that stopped; one line per family;
/// the total.
fn summary(v: &Verification, all: bool) -> String {
    let rows: Vec<_> = v.rows().filter(|(_, row)| all || !row.verdict.pass).collect();
    let mut lines = if rows.is_empty() { Vec::new() } else { table(&rows) };
    for set_up in &v.set_ups {
        lines.extend(
            set_up.stopped.iter().map(|why| format!("{}/{} stopped: {why}", set_up.family, set_up.name)),
        );
    }
    lines.extend(table::lines(&families(v), &[1, 2, 3]).into_iter().map(|line| format!("  {line}")));
    lines.push(format!(
        "{}, {} with dynamic contact; {}, {} missed; {}",
        several(v.set_ups.len(), "set-up"),
        v.with_contact(),
        several(v.rows().count(), "expected value"),
        v.missed(),
        duration(v.wall)
    ));
    lines.join("\n")
}

/// Set-ups, values and misses of each family.
fn families(v: &Verification) -> Vec<Vec<String>> {
    let mut families: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    for set_up in &v.set_ups {
        families.entry(&set_up.family).or_default()[0] += 1;
    }
    for (set_up, row) in v.rows() {
        let counts = families.entry(&set_up.family).or_default();
        counts[1] += 1;
        counts[2] += usize::from(!row.verdict.pass);
    }
    let row = |(family, [set_ups, values, missed]): (&str, [usize; 3])| {
        vec![
            family.to_owned(),
            several(set_ups, "set-up"),
            several(values, "value"),
            format!("{missed} missed"),
        ]
    };
    families.into_iter().map(row).collect()
}

fn table(rows: &[(&SetUp, &Row)]) -> Vec<String> {
    const HEADS: [&str; 8] = ["case", "quantity", "expected", "got", "error", "tolerance", "", "source"];
    let line = |(set_up, row): &(&SetUp, &Row)| {
        vec![
            format!("{}/{}", set_up.family, set_up.name),
            row.quantity(),
            row.verdict.expected.clone(),
            match row.verdict.got {
                Some(got) if !row.verdict.pass => missed(got, row.verdict.value),
                got => short_or_dash(got),
            },
            short_or_dash(row.error()),
            short_or_dash(row.verdict.tolerance),
            if row.verdict.pass { "met" } else { "MISSED" }.to_owned(),
            row.verdict.why.clone().or_else(|| row.verdict.source.clone()).unwrap_or_default(),
        ]
    };
    let mut cells = vec![HEADS.map(str::to_owned).to_vec()];
    cells.extend(rows.iter().map(line));
    table::lines(&cells, &[3, 4, 5])
}
