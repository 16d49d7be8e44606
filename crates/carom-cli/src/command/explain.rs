//! `carom explain`: what a time integrator does, before anything is computed.

use carom::case::read_scheme;

use crate::exit::{Exit, Failure};
use crate::out;

/// Order, ρ∞, damping, period error of a time integrator, and its parameters in every convention
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom explain chung-hulbert rho_inf=0.1
  carom explain newmark beta=0.25 gamma=0.5
  carom explain hht alpha=0.05 forces=average-state")]
pub(crate) struct Arguments {
    /// Kind, as in a case file
    scheme: String,
    /// Its parameters
    #[arg(value_name = "KEY=VALUE")]
    parameters: Vec<String>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let spec = read_scheme(&arguments.scheme, &arguments.parameters)?;
    let scheme = carom_time::scheme(&spec.kind, &spec.parameters, spec.forces)
        .map_err(|e| Failure::Argument { what: e.to_string(), help: String::new() })?;
    out::line(&format!("{scheme:#?}"))?;
    Ok(Exit::Done)
}
