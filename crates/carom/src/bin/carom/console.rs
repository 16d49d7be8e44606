//! Output other than results, controlled by the options of all commands: verbosity, colours, and
//! the progress bar on standard error.

use std::fmt::Display;
use std::io::{self, Write};
use std::sync::OnceLock;

use anstream::ColorChoice;
use carom_record::Warning;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Redraws a second.
const RATE: u8 = 10;

static VERBOSITY: OnceLock<Verbosity> = OnceLock::new();
static JSON: OnceLock<bool> = OnceLock::new();

/// Options of every command.
#[derive(clap::Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct Options {
    /// Print more: rejected steps, contacts that begin or end, every row of a table
    #[arg(short, long, global = true, conflicts_with = "quiet")]
    verbose: bool,
    /// Print errors only
    #[arg(short, long, global = true)]
    quiet: bool,
    /// When to use colours; `auto` honours NO_COLOR and CLICOLOR_FORCE
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    color: When,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum When {
    Auto,
    Always,
    Never,
}

/// How much is printed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verbosity {
    Quiet,
    Normal,
    Verbose,
}

impl Options {
    /// Makes these the options of the process; `json`: whether standard output is JSON.
    pub(crate) fn apply(&self, json: bool) {
        let _ = JSON.set(json);
        let verbosity = match (self.quiet, self.verbose) {
            (true, _) => Verbosity::Quiet,
            (_, true) => Verbosity::Verbose,
            _ => Verbosity::Normal,
        };
        let _ = VERBOSITY.set(verbosity);
        let choice = match self.color {
            When::Auto => ColorChoice::Auto,
            When::Always => ColorChoice::Always,
            When::Never => ColorChoice::Never,
        };
        choice.write_global();
    }
}

pub(crate) fn is_quiet() -> bool {
    VERBOSITY.get() == Some(&Verbosity::Quiet)
}

/// Whether standard output is JSON.
pub(crate) fn is_json() -> bool {
    JSON.get() == Some(&true)
}

/// Whether text for people is unwanted.
pub(crate) fn is_silent() -> bool {
    is_quiet() || is_json()
}

pub(crate) fn is_verbose() -> bool {
    VERBOSITY.get() == Some(&Verbosity::Verbose)
}

/// Whether standard error takes colours.
pub(crate) fn in_colour() -> bool {
    anstream::AutoStream::choice(&io::stderr()) != ColorChoice::Never
}

/// Writes a line to standard error. A closed standard error must not stop a run.
pub(crate) fn say(line: impl Display) {
    let _ = writeln!(anstream::stderr().lock(), "{line}");
}

/// A warning in three lines: what was found, why it matters, what to try. `place` precedes it.
pub(crate) fn warning(head: &str, place: &str, warning: &Warning) -> String {
    let Warning { id, place: own, what, why, advice } = warning;
    let indent = " ".repeat(head.len());
    format!("{head}{place}{own}: {what} ({id})\n{indent}why: {why}\n{indent}try: {advice}")
}

/// A progress bar; hidden with `--quiet`, and if standard error is not a terminal.
pub(crate) fn bar(steps: u64) -> ProgressBar {
    let target =
        if is_quiet() { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr_with_hz(RATE) };
    let style = ProgressStyle::with_template("{percent:>4} % {bar:16} {wide_msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::with_draw_target(Some(steps.max(1)), target).with_style(style.progress_chars("━╸ "))
}
