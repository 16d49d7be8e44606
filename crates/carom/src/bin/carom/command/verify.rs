//! `carom verify`: runs every case with expectations and compares the results with them.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use carom_record::Status;
use carom_record::verification::{Row, SetUp, Verification};
use carom_study::{Event, Kind, Named, Suite, VerifyOptions};
use include_dir::{Dir, include_dir};
use indicatif::ProgressBar;
use serde_json::json;

use crate::exit::{Exit, Failure};
use crate::live::{duration, stop_on_signal};
use crate::study_summary::report as study_report;
use crate::summary::{missed, short};
use crate::{console, directory, out};

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
    let seen = std::cell::RefCell::new(Seen::new(arguments.json));
    let mut begin = |runs: &[Named]| seen.borrow_mut().begin(runs);
    let done = suite.verify(&directory, options, &mut begin, &mut |e| seen.borrow_mut().event(e), &stop);
    drop(seen);
    let Some(verification) = done? else {
        if arguments.json {
            out::event(&json!({ "event": "interrupted", "directory": &*directory }))?;
        } else if !console::is_quiet() && !arguments.csv {
            out::line("interrupted by Ctrl-C: no expectation was evaluated")?;
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
    print(&verification, arguments, &page)?;
    let unjudged = suite.items.len() - verification.set_ups.len();
    if unjudged > 0 && !arguments.json && !arguments.csv && !console::is_quiet() {
        out::line(&format!(
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

fn print(v: &Verification, arguments: &Arguments, page: &Path) -> Result<(), Failure> {
    if arguments.json {
        for (set_up, row) in v.rows() {
            out::event(
                &json!({ "event": "row", "family": set_up.family, "case": set_up.name, "row": row, "error": row.error() }),
            )?;
        }
        let counts = json!({ "event": "done", "set_ups": v.set_ups.len(), "with_contact": v.with_contact(), "rows": v.rows().count(),
            "missed": v.missed(), "stopped": v.stopped(), "wall": v.wall, "report": page });
        return Ok(out::event(&counts)?);
    }
    if arguments.csv {
        let text = v.csv()?;
        return Ok(out::line(&String::from_utf8_lossy(&text))?);
    }
    if console::is_quiet() {
        return Ok(());
    }
    out::line(&summary(v, console::is_verbose()))?;
    Ok(out::line(&page.display().to_string())?)
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
    let mut families: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    for set_up in &v.set_ups {
        families.entry(&set_up.family).or_default()[0] += 1;
    }
    for (set_up, row) in v.rows() {
        let counts = families.entry(&set_up.family).or_default();
        counts[1] += 1;
        counts[2] += usize::from(!row.verdict.pass);
    }
    for (family, [set_ups, values, missed]) in &families {
        let s = if *set_ups == 1 { " " } else { "s" };
        lines.push(format!("  {family:14}{set_ups:4} set-up{s} {values:6} values {missed:4} missed"));
    }
    lines.push(format!(
        "{} set-up{}, {} with dynamic contact; {} expected values, {} missed; {}",
        v.set_ups.len(),
        if v.set_ups.len() == 1 { "" } else { "s" },
        v.with_contact(),
        v.rows().count(),
        v.missed(),
        duration(v.wall)
    ));
    lines.join("\n")
}

fn table(rows: &[(&SetUp, &Row)]) -> Vec<String> {
    const HEADS: [&str; 8] = ["case", "quantity", "expected", "got", "error", "tolerance", "", "source"];
    let shown = |x: Option<f64>| x.map_or("–".to_owned(), short);
    let line = |(set_up, row): &(&SetUp, &Row)| {
        [
            format!("{}/{}", set_up.family, set_up.name),
            row.quantity(),
            row.verdict.expected.clone(),
            match row.verdict.got {
                Some(got) if !row.verdict.pass => missed(got, row.verdict.value),
                got => shown(got),
            },
            shown(row.error()),
            shown(row.verdict.tolerance),
            if row.verdict.pass { "met" } else { "MISSED" }.to_owned(),
            row.verdict.why.clone().or_else(|| row.verdict.source.clone()).unwrap_or_default(),
        ]
    };
    let mut cells = vec![HEADS.map(str::to_owned)];
    cells.extend(rows.iter().map(line));
    let widths: [usize; 8] =
        std::array::from_fn(|i| cells.iter().map(|row| row[i].chars().count()).max().unwrap_or(0));
    let padded = |row: &[String; 8]| {
        let padded = row.iter().zip(widths).enumerate().map(|(i, (cell, width))| match i {
            3..=5 => format!("{cell:>width$}"),
            7 => cell.clone(),
            _ => format!("{cell:width$}"),
        });
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    cells.iter().map(padded).collect()
}

/// Progress of a suite: a bar on a terminal; with `--verbose`, a line on standard error for every
/// run that ended.
struct Seen {
    runs: Vec<Named>,
    done: Vec<u64>,
    ended: usize,
    json: bool,
    bar: ProgressBar,
    last: Option<Instant>,
}

impl Seen {
    fn new(json: bool) -> Self {
        Self { runs: Vec::new(), done: Vec::new(), ended: 0, json, bar: console::bar(1), last: None }
    }

    fn begin(&mut self, runs: &[Named]) {
        self.runs = runs.to_vec();
        self.done = vec![0; runs.len()];
        self.bar.set_length(runs.iter().map(|r| r.steps).sum::<u64>().max(1));
        if self.json {
            let names: Vec<_> = runs.iter().map(|r| &r.name).collect();
            // A closed standard output must not stop the suite.
            let _ = out::event(&json!({ "event": "start", "runs": names }));
        }
    }

    fn event(&mut self, event: &Event) {
        let line = match event {
            Event::Began(i) => json!({ "event": "began", "run": self.runs[*i].name }),
            Event::Ended(i, ended) => {
                (self.done[*i], self.ended) = (self.runs[*i].steps, self.ended + 1);
                if console::is_verbose() {
                    let how = if ended.status == Status::Finished { "done" } else { "stopped" };
                    let count = format!("{}/{}", self.ended, self.runs.len());
                    let (wall, name) = (duration(ended.wall), &self.runs[*i].name);
                    self.bar.suspend(|| console::say(format_args!("{count:>9}  {how} in {wall}  {name}")));
                }
                json!({ "event": "ended", "run": self.runs[*i].name, "status": ended.status, "reason": ended.reason, "wall": ended.wall })
            }
            Event::Progress(i, p) => {
                self.done[*i] = p.step;
                if self.last.is_some_and(|then| then.elapsed() < Duration::from_millis(200)) {
                    return;
                }
                self.last = Some(Instant::now());
                json!({ "event": "progress", "run": self.runs[*i].name, "step": p.step, "steps": p.steps, "left": p.left })
            }
            Event::AlreadyDone(_) => return,
        };
        if self.json {
            let _ = out::event(&line);
        }
        self.bar.set_position(self.done.iter().sum());
        self.bar.set_message(format!("{} of {} runs", self.ended, self.runs.len()));
    }
}

impl Drop for Seen {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
