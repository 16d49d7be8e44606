//! `carom study plan`, `arm` and `collect`: a study in separate processes.

use std::path::{Path, PathBuf};

use carom_record::Status;
use carom_record::study::{Row, StudyManifest};
use serde_json::json;

use crate::exit::{Exit, Failure};
use crate::live::{Live, stop_on_signal};
use crate::{console, directory, out, study_summary};

use super::progress::Runs;

/// Steps of a study that is computed by separate processes, also on several machines
#[derive(clap::Subcommand)]
pub(super) enum StudyCommand {
    /// Write the directory of a study without computing any run
    #[command(after_help = "\
Then compute every run, in any order and on any machine that shares the directory:
  sbatch DIR/slurm.sh                           with --slurm
  seq N | parallel carom study arm DIR          with GNU parallel, for N runs
and write the tables and the page with:
  carom study collect DIR
A study at matched cost needs trial runs to choose the time steps: --settle makes them.")]
    Plan {
        /// The study file, or - for standard input
        study: PathBuf,
        /// Directory of the study; must not exist yet
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// Also write DIR/slurm.sh, a job array for Slurm
        #[arg(long)]
        slurm: bool,
        /// Choose the steps of equal cost now, by trial runs one after the other
        #[arg(long)]
        settle: bool,
    },
    /// Compute or continue one run (arm) of a planned study; a finished run is left unchanged
    Arm {
        /// Directory of the study
        directory: PathBuf,
        /// Number of the run, from 1
        number: usize,
    },
    /// Write the tables and the page of what has been computed, and list what is missing
    ///
    /// When all runs of a study with a goal have ended, one of them is computed twice more, once
    /// with two threads and once interrupted and resumed, to check that the results are bitwise
    /// identical.
    Collect {
        /// Directory of the study
        directory: PathBuf,
        /// Do not write the figures or the report page
        #[arg(long)]
        no_report: bool,
    },
}

impl StudyCommand {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        match self {
            Self::Plan { study, out, slurm, settle } => plan(study, out, *slurm, *settle),
            Self::Arm { directory, number } => arm(directory, *number),
            Self::Collect { directory, no_report } => collect(directory, !no_report),
        }
    }
}

fn plan(study: &Path, directory: &Path, slurm: bool, settle: bool) -> Result<Exit, Failure> {
    let plan = super::plan(&super::document(study, &[])?, study)?;
    let directory = directory::given(directory, "name another directory")?;
    let is_matched = plan.manifest.arms.iter().any(|arm| plan.manifest.by_cost(arm));
    if settle && is_matched {
        let stop = stop_on_signal()?;
        let mut runs = Runs::of_study(&plan.manifest);
        let settled = carom_study::plan_settled(&plan, &directory, &mut |e| runs.event(e), &stop);
        drop(runs);
        if !settled? {
            let place = directory.display();
            console::say(format_args!(
                "interrupted before the steps were found; remove {place} and plan the study again, or \
                 compute all of it on this machine with: carom resume {place}"
            ));
            return Ok(Exit::Interrupted);
        }
    } else {
        carom_study::plan(&plan, &directory)?;
    }
    let count = plan.manifest.runs().count();
    if slurm {
        let path = directory.join("slurm.sh");
        let failed = |e| Failure::cannot("write", &path, &e);
        let whole = std::path::absolute(&*directory).map_err(failed)?;
        std::fs::write(&path, script(&plan.manifest.title, &whole, count)).map_err(failed)?;
    }
    let place = directory.display();
    out::summary(&format!("{count} runs in {place}; each is computed by:"))?;
    out::summary(&format!("  carom study arm {place} N        with N from 1 to {count}"))?;
    if slurm {
        out::summary(&format!("  sbatch {place}/slurm.sh          computes all"))?;
    }
    Ok(Exit::Done)
}

/// A job array. A run that was killed continues when its task is started again.
fn script(title: &str, directory: &Path, count: usize) -> String {
    let place = directory.display().to_string().replace('\'', "'\\''");
    let title = title.replace(|c: char| !c.is_alphanumeric(), "-");
    format!(
        "#!/bin/sh\n\
         #SBATCH --job-name={title}\n\
         #SBATCH --array=1-{count}\n\
         #SBATCH --cpus-per-task=1\n\
         #SBATCH --requeue\n\
         # Afterwards: carom study collect '{place}'\n\
         exec carom study arm '{place}' \"$SLURM_ARRAY_TASK_ID\"\n"
    )
}

fn arm(directory: &Path, number: usize) -> Result<Exit, Failure> {
    let manifest = StudyManifest::read(directory)?;
    let arm = manifest.runs().nth(number.saturating_sub(1));
    let (name, place) = arm.map(|arm| (arm.name.clone(), arm.directory.clone())).unwrap_or_default();
    let stop = stop_on_signal()?;
    let mut live = Live::new(&directory.join(place));
    let ended = carom_study::arm(directory, number, &mut |p| live.show(p), &stop);
    drop(live);
    let ended = ended?;
    let reason = ended.reason.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
    out::summary(&format!("{name}: {}{reason}", json!(ended.status).as_str().unwrap_or_default()))?;
    // A failed arm is a row of the table.
    Ok(if ended.status == Status::Stopped { Exit::Interrupted } else { Exit::Done })
}

fn collect(directory: &Path, page: bool) -> Result<Exit, Failure> {
    let stop = stop_on_signal()?;
    let outcome = carom_study::collect(directory, &stop)?;
    study_summary::print(&outcome, directory, page)?;
    let rows = || outcome.study.rows.iter().chain(&outcome.study.members).enumerate();
    let listed = |of: fn(&Row) -> bool| {
        let found = rows().filter(|(_, row)| of(row)).map(|(i, row)| format!("{} ({})", i + 1, row.name));
        found.collect::<Vec<_>>().join(", ")
    };
    let missing = listed(|row| !row.has_ended() && !row.is_damaged());
    let damaged = listed(Row::is_damaged);
    if !damaged.is_empty() {
        console::say(format_args!("damaged: {damaged}"));
    }
    if !missing.is_empty() {
        console::say(format_args!("missing: {missing}"));
        console::say(format_args!("compute them with: carom study arm {} N", directory.display()));
    }
    Ok(if rows().all(|(_, row)| row.has_ended()) { Exit::Done } else { Exit::Missed })
}
