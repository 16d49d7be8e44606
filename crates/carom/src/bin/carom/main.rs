//! The command line of Carom: one file per command under `command/`.

mod command;
mod console;
mod diagnostics;
mod directory;
mod exit;
mod live;
mod out;
mod shared;
mod simulation;
mod study_summary;
mod summary;
mod table;
mod text;

use clap::{Parser, Subcommand};
use command::{
    check, completions, explain, export, man, mesh, new, reduce, report, resume, run, schema, study, verify,
};

/// Simulate impact and contact of deformable solids, and compare time integrators.
#[derive(Parser)]
#[command(name = "carom", version, propagate_version = true, max_term_width = 100)]
#[command(after_help = "\
Examples:
  carom new drop
  carom run cases/impact/impact.toml
  carom check cases/impact/impact.toml --set time.step=1e-3
  carom study cases/paper/paper.toml
  carom verify --fast
  carom explain chung-hulbert rho_inf=0.1

Exit codes:
  0    success
  1    an expectation was missed (verify, or --strict); study collect: runs are missing or damaged
  2    the case or an argument is invalid; reduce: the reduced case does not stop in the same way
  3    the simulation stopped; its last valid state is saved
  4    input/output or system error
  130  interrupted by Ctrl-C; continue with carom resume")]
struct Arguments {
    #[command(flatten)]
    console: console::Options,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Run(run::Arguments),
    Resume(resume::Arguments),
    Study(study::Arguments),
    Verify(verify::Arguments),
    Check(check::Arguments),
    Explain(explain::Arguments),
    Mesh(mesh::Arguments),
    New(new::Arguments),
    Report(report::Arguments),
    Export(export::Arguments),
    Reduce(reduce::Arguments),
    Schema(schema::Arguments),
    Completions(completions::Arguments),
    Man(man::Arguments),
}

impl Command {
    /// Whether standard output is JSON.
    fn json(&self) -> bool {
        match self {
            Self::Run(arguments) => arguments.flags.json,
            Self::Resume(arguments) => arguments.flags.json,
            Self::Study(arguments) => arguments.json,
            Self::Verify(arguments) => arguments.json,
            Self::Check(arguments) => arguments.json,
            Self::Explain(arguments) => arguments.json,
            _ => false,
        }
    }
}

fn main() -> std::process::ExitCode {
    let Arguments { console, command } = Arguments::parse();
    console.apply(command.json());
    let done = match &command {
        Command::Run(arguments) => run::run(arguments),
        Command::Resume(arguments) => resume::run(arguments),
        Command::Study(arguments) => study::run(arguments),
        Command::Verify(arguments) => verify::run(arguments),
        Command::Check(arguments) => check::run(arguments),
        Command::Explain(arguments) => explain::run(arguments),
        Command::Mesh(arguments) => mesh::run(arguments),
        Command::New(arguments) => new::run(arguments),
        Command::Report(arguments) => report::run(arguments),
        Command::Export(arguments) => export::run(arguments),
        Command::Reduce(arguments) => reduce::run(arguments),
        Command::Schema(arguments) => schema::run(arguments),
        Command::Completions(arguments) => completions::run(arguments),
        Command::Man(arguments) => man::run(arguments),
    };
    let exit = done.unwrap_or_else(|failure| diagnostics::print(&failure));
    std::process::ExitCode::from(exit as u8)
}
