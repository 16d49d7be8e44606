//! The commands, each in a file of its own.

pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod explain;
pub(crate) mod export;
mod flags;
pub(crate) mod man;
pub(crate) mod mesh;
pub(crate) mod new;
mod progress;
pub(crate) mod reduce;
pub(crate) mod report;
pub(crate) mod resume;
pub(crate) mod run;
pub(crate) mod schema;
pub(crate) mod study;
mod study_parts;
pub(crate) mod verify;

use std::io::IsTerminal;
use std::num::NonZero;
use std::path::Path;
use std::sync::mpsc;
use std::time::Duration;

use carom::case::{Case, Document, read};
use carom_record::Machine;
use carom_study::Plan;

use crate::console;
use crate::exit::Failure;

/// Name of standard input in place of a case file.
pub(crate) const STDIN: &str = "-";
/// Time without the end of an input after which a command says that it waits.
const PATIENCE: Duration = Duration::from_secs(2);

/// Reads a case with its overrides, from a file or from standard input.
fn case(path: &Path, sets: &[String]) -> Result<(Case, Document), Failure> {
    let document = document(path, sets)?;
    Ok((resolved(&document)?, document))
}

fn resolved(document: &Document) -> Result<Case, Failure> {
    Ok(read(document).map_err(|problems| document.diagnose_all(&problems))?)
}

/// A study that has been read; the paths of its cases start at its folder, or at the working
/// directory if it comes from standard input.
fn plan(document: &Document, path: &Path) -> Result<Plan, Failure> {
    Ok(Plan::of(document, path.parent().unwrap_or(Path::new("")))?)
}

/// Reads a case or a study once: a pipe cannot be read again.
fn document(path: &Path, sets: &[String]) -> Result<Document, Failure> {
    let _waiting = Waiting::for_input(path);
    Ok(if path == Path::new(STDIN) {
        Document::read_from("<stdin>", std::io::stdin().lock(), sets)?
    } else {
        Document::open(path, sets)?
    })
}

/// Says what a command waits for if an input has not ended after a while. Dropped when it has.
struct Waiting {
    _ended: Option<mpsc::Sender<()>>,
}

impl Waiting {
    fn for_input(path: &Path) -> Self {
        let from_stdin = path == Path::new(STDIN);
        if console::is_silent() || !(from_stdin || is_pipe(path)) {
            return Self { _ended: None };
        }
        if from_stdin && std::io::stdin().is_terminal() {
            console::say("reading a case from standard input; end it with Ctrl-D");
            return Self { _ended: None };
        }
        let source = if from_stdin { "standard input".to_owned() } else { path.display().to_string() };
        let (sender, receiver) = mpsc::channel::<()>();
        std::thread::spawn(move || {
            if receiver.recv_timeout(PATIENCE) == Err(mpsc::RecvTimeoutError::Timeout) {
                console::say(format!("waiting for a case on {source}; stop with Ctrl-C"));
            }
        });
        Self { _ended: Some(sender) }
    }
}

/// Whether a path is a named pipe, whose writer may be slow or missing.
fn is_pipe(path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        std::fs::metadata(path).is_ok_and(|facts| facts.file_type().is_fifo())
    }
    #[cfg(not(unix))]
    {
        let _ = path;
        false
    }
}

/// The requested number of threads or concurrent runs, or one per core. Numbers that can only cost
/// time and memory are refused: more than four per core, and more than 64.
fn parallel(option: &str, requested: Option<NonZero<usize>>) -> Result<usize, Failure> {
    let machine = Machine::current();
    let cores = machine.cpus;
    let most = machine.most_concurrent();
    let count = requested.map_or(cores, NonZero::get);
    if count > most {
        let what = format!(
            "{option} {count} is too many: more than the {cores} cores of this machine cost time and memory, \
             and at most {most} are accepted"
        );
        return Err(Failure::argument(what, format!("omit {option} for one per core")));
    }
    Ok(count)
}
