//! `carom explain`: properties of time integrators.

use std::fmt::Display;

use carom::case::read_scheme;
use serde::Serialize;

use crate::exit::{Exit, Failure};
use crate::out;

/// Print order, spectral radius, damping and period error of a time integrator, and its parameters
/// in every convention of the literature
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom explain
  carom explain chung-hulbert rho_inf=0.1
  carom explain newmark beta=0.25 gamma=0.5
  carom explain hht alpha=0.05 forces=average-state
  carom explain moreau-jean theta=0.5")]
pub(crate) struct Arguments {
    /// Kind of scheme, as in a case file; without it, all kinds are listed
    scheme: Option<String>,
    /// Parameters of the scheme
    #[arg(value_name = "KEY=VALUE")]
    parameters: Vec<String>,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let Some(kind) = &arguments.scheme else {
        return print(&carom_time::explain_all(), arguments.json);
    };
    let spec = read_scheme(kind, &arguments.parameters)?;
    if spec.is_static() {
        return Err(Failure::argument(
            "the scheme `static` is not a time integrator: every step is a static equilibrium, with t as the load parameter",
            "run `carom explain` without arguments to list the time integrators",
        ));
    }
    let scheme = spec.integrator().map_err(|e| Failure::argument(e.to_string(), ""))?;
    print(&scheme.explain(), arguments.json)
}

fn print<T: Display + Serialize>(explained: &T, json: bool) -> Result<Exit, Failure> {
    if json {
        out::event(explained)?;
    } else {
        out::line(&explained.to_string())?;
    }
    Ok(Exit::Done)
}
