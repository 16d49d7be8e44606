//! `carom explain`: properties of time integrators, and the meaning of keys, columns, metrics and
//! warnings.

use std::fmt::Display;

use carom::WARNINGS;
use carom::case::{ExplainedColumn, ExplainedKey, every_column, explained_columns, read_scheme};
use carom::record::metrics::{self, Explanation};
use serde::Serialize;

use crate::exit::{Exit, Failure};
use crate::out;

/// Print order, spectral radius, damping and period error of a time integrator, and its parameters
/// in every convention of the literature; or meaning, values and default of a key of case and study
/// files, that of a column of history.csv and contact.csv, the definition of a metric, or the
/// reason of a warning
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
  carom explain energy_lost
  carom explain contact_force_y
  carom explain ball.center_x
  carom explain flat-cell
  carom explain rho_inf")]
pub(crate) struct Arguments {
    /// Kind of scheme, as in a case file, a key with or without its table, a word that is a value
    /// of keys, a column, a metric, or the name of a warning; without it, all kinds of schemes are
    /// listed
    #[arg(value_name = "SCHEME, KEY, COLUMN, METRIC or WARNING")]
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
        let explained = Explained::of(what);
        if explained.is_empty() {
            let metrics = metrics::explained().map(|metric| metric.name);
            let columns = every_column();
            let columns = columns.iter().flat_map(|column| &column.names).map(String::as_str);
            let warnings = WARNINGS.iter().map(|entry| entry.id);
            let words: Vec<&str> = kinds.into_iter().chain(metrics).chain(warnings).chain(columns).collect();
            return Err(Failure::argument(
                format!("there is no scheme, key, column, metric or warning `{what}`"),
                carom_study::similar_key(what, &words),
            ));
        }
        return print(&explained, arguments.json);
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

/// Keys, columns, a metric and a warning with the same name.
#[derive(Serialize)]
struct Explained {
    keys: Vec<ExplainedKey>,
    columns: Vec<ExplainedColumn>,
    metric: Option<Explanation>,
    warning: Option<Warning>,
}

/// The reason of a warning.
#[derive(Serialize)]
struct Warning {
    id: &'static str,
    why: &'static str,
    advice: &'static str,
}

impl Explained {
    fn of(word: &str) -> Self {
        // A metric of a column or of measured data has a second name.
        let is_named = |metric: &Explanation| word.split(':').any(|part| part == metric.name);
        let warning = WARNINGS.iter().find(|entry| entry.id == word);
        Self {
            keys: carom_study::explained(word),
            columns: explained_columns(word),
            metric: metrics::explained().find(is_named),
            warning: warning.map(|entry| Warning { id: entry.id, why: entry.why, advice: entry.advice }),
        }
    }

    fn is_empty(&self) -> bool {
        self.keys.is_empty() && self.columns.is_empty() && self.metric.is_none() && self.warning.is_none()
    }
}

impl Display for Explained {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut parts: Vec<String> = self.keys.iter().map(ToString::to_string).collect();
        parts.extend(self.columns.iter().map(ToString::to_string));
        if let Some(Explanation { name, meaning, formula, unit }) = &self.metric {
            parts.push(format!("{name}   metric\n  {meaning}\n\nformula\n  {formula}\n\nunit\n  {unit}"));
        }
        if let Some(Warning { id, why, advice }) = &self.warning {
            parts.push(format!("{id}   warning\n  {why}\n\nremedy\n  {advice}"));
        }
        f.write_str(parts.join("\n\n").trim_end())
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
