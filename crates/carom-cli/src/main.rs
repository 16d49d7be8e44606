//! The command line of Carom: one file per command under `command/`.

mod command;
mod directory;
mod exit;
mod live;
mod out;
mod simulation;
mod summary;
mod wrong;

use clap::{Parser, Subcommand};
use command::{check, explain, mesh, new, report, resume, run, schema, study, verify};

/// Impact and contact of deformable solids, and the laboratory of its time integrators.
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

Exit codes: 0 done · 1 an expectation was missed (verify) · 2 the case is wrong · 3 the simulation stopped · 4 the machine refused · 130 stopped by Ctrl-C")]
struct Arguments {
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
    Schema(schema::Arguments),
}

fn main() -> std::process::ExitCode {
    let done = match Arguments::parse().command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Resume(arguments) => resume::run(&arguments),
        Command::Study(arguments) => study::run(&arguments),
        Command::Verify(arguments) => verify::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Mesh(arguments) => mesh::run(&arguments),
        Command::New(arguments) => new::run(&arguments),
        Command::Report(arguments) => report::run(&arguments),
        Command::Schema(arguments) => schema::run(&arguments),
    };
    let exit = done.unwrap_or_else(|failure| wrong::tell(&failure));
    std::process::ExitCode::from(exit as u8)
}
