//! `carom explain`: properties of time integrators, and the meaning of keys.

use std::fmt::Display;

use carom::case::{ExplainedKey, read_scheme};
use serde::Serialize;

use crate::exit::{Exit, Failure};
use crate::out;

/// Print order, spectral radius, damping and period error of a time integrator, and its parameters
/// in every convention of the literature; or meaning, values and default of a key of case and study
/// files
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom explain
  carom explain chung-hulbert rho_inf=0.1
  carom explain newmark beta=0.25 gamma=0.5
  carom explain hht alpha=0.05 forces=average-state
  carom explain moreau-jean theta=0.5
  carom explain newton.tolerance
  carom explain contact.enforcement
  carom explain hencky
  carom explain rho_inf")]
pub(crate) struct Arguments {
    /// Kind of scheme, as in a case file, a key with or without its table, or a word that is a
    /// value of keys; without it, all kinds of schemes are listed
    #[arg(value_name = "SCHEME or KEY")]
    what: Option<String>,
    /// Parameters of the scheme
    #[arg(value_name = "KEY=VALUE")]
    parameters: Vec<String>,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let Some(what) = &arguments.what else {
        return print(&carom_time::explain_all(), arguments.json);
    };
    let kinds: Vec<&str> = carom_time::KINDS.iter().map(|kind| kind.name).collect();
    if arguments.parameters.is_empty() && !kinds.contains(&what.as_str()) {
        let keys = carom_study::explained(what);
        if keys.is_empty() {
            return Err(Failure::argument(
                format!("there is no scheme and no key `{what}`"),
                carom_study::similar_key(what, &kinds),
            ));
        }
        return print(&Explained { keys }, arguments.json);
    }
    let spec = read_scheme(what, &arguments.parameters)?;
    if spec.is_static() {
        return Err(Failure::argument(
            "the scheme `static` is not a time integrator: every step is a static equilibrium, with t as the load parameter",
            "run `carom explain` without arguments to list the time integrators",
        ));
    }
    let scheme = spec.integrator().map_err(|e| Failure::argument(e.to_string(), ""))?;
    print(&scheme.explain(), arguments.json)
}

/// The keys that a word may be.
#[derive(Serialize)]
struct Explained {
    keys: Vec<ExplainedKey>,
}

impl Display for Explained {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let keys: Vec<String> = self.keys.iter().map(ToString::to_string).collect();
        f.write_str(keys.join("\n\n").trim_end())
    }
}

fn print<T: Display + Serialize>(explained: &T, json: bool) -> Result<Exit, Failure> {
    if json {
        out::event(explained)?;
    } else {
        out::line(&explained.to_string())?;
    }
    Ok(Exit::Done)
}
