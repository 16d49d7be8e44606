//! Time integration: the interval, the step, the scheme, and Newton's method.

use std::collections::BTreeMap;

use carom_time::{ForceRule, SchemeError};
use serde::{Deserialize, Serialize};

use crate::keys::Kind::{self, Count, Number, NumberOrFalse, Variant};
use crate::keys::{Keys, POSITIVE, Range, View, schemes};
use crate::suggest;

const FRACTION: Range = Range { low: Some((0.0, true)), high: Some((1.0, false)) };

/// Time interval, time step and time integrator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Keys)]
#[keys(name = "[time]", later = ["adaptive"])]
pub struct TimeSpec {
    /// End time, a multiple of the time step.
    #[key(Number(POSITIVE), unit = "time", example = "0.75")]
    pub end: f64,
    /// Time step.
    #[key(Number(POSITIVE), unit = "time", example = "1.875e-3", later = "a table { initial, min, max, … }")]
    pub step: f64,
    /// Fraction of a step by which all instants are shifted to earlier times: the first step is
    /// shorter by it, and the last one has this length. With another phase, contact begins at
    /// another instant within a step.
    #[key(Number(FRACTION), default = "0.0")]
    #[serde(default)]
    pub phase: f64,
    /// Time integrator.
    #[key(
        Variant(schemes),
        example = "{ kind = \"chung-hulbert\", rho_inf = 0.1 }",
        with = of_time
    )]
    pub scheme: SchemeSpec,
    /// The run stops if scheme and contact create more than this fraction of the energy scale so
    /// far: the columns `energy_created` and `energy_scale`; false: it never stops for this reason.
    #[key(NumberOrFalse(POSITIVE), default = "0.02", paper = "false", with = energy_guard)]
    pub energy_guard: Option<f64>,
    /// What takes a grid step at which the run would stop, because no substep is accepted or the
    /// energy guard stops it. Its steps are counted in the column `fallbacks`. For implicit
    /// schemes, multipliers without friction and restitution, and bodies with mass.
    #[key(default = "\"none\"")]
    #[serde(default)]
    pub fallback: Fallback,
}

fn energy_guard(v: &View) -> Option<f64> {
    v.value("energy_guard")?.number()
}

/// The step that replaces a grid step at which the run would stop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum Fallback {
    /// Nothing.
    #[default]
    None,
    /// Backward Euler with contact implicit in velocity, which dissipates energy in this step.
    Velocity,
}

/// A time integrator by its published name: `{ kind = "chung-hulbert", rho_inf = 0.1 }`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SchemeSpec {
    /// Published name of the scheme, the key `kind`.
    pub kind: String,
    /// Parameters of the scheme by key, as given.
    #[serde(flatten)]
    pub parameters: BTreeMap<String, f64>,
    /// Whether forces are averaged over the step, or evaluated at the averaged state.
    pub forces: ForceRule,
}

/// The scheme of `[time]`.
fn of_time(time: &View) -> Option<SchemeSpec> {
    scheme(&time.at("scheme")?)
}

/// The scheme of a table with `kind` and parameters.
pub(crate) fn scheme(v: &View) -> Option<SchemeSpec> {
    let kind = v.word()?;
    let numbers = v.keys.iter().filter(|k| matches!(k.kind, Kind::Number(_)));
    let parameters = numbers.filter_map(|k| Some((k.name.to_owned(), v.get(k.name)?))).collect();
    let has_rule = v.keys.iter().any(|k| k.name == "forces");
    let forces = if has_rule { v.get("forces")? } else { ForceRule::default() };
    let spec = SchemeSpec { kind: kind.to_owned(), parameters, forces };
    if let Err(error) = spec.integrator()
        && !v.has_problem(|problem| problem.path.starts_with(&v.path))
    {
        let help = match &error {
            SchemeError::OutOfRange { hint, .. } => hint.clone(),
            SchemeError::Missing { examples, .. } | SchemeError::Superfluous { examples, .. } => {
                let written: Vec<_> = examples.iter().map(|example| format!("`{example}`")).collect();
                format!("write for example {}", written.join(" or "))
            }
            SchemeError::UnknownKind { .. } => suggest::help(kind, error.known().iter().copied()),
        };
        let why = schemes().table(kind).map_or(schemes().doc, |t| t.doc);
        v.wrong::<()>(error.key(), error.to_string(), why, help);
    }
    Some(spec)
}

/// Settings of Newton's method.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, Keys)]
#[keys(name = "[newton]")]
pub struct NewtonSpec {
    /// Convergence tolerance on ‖Δy‖∞/L and ‖r‖/Σ‖f‖.
    #[key(Number(Range { low: Some((0.0, false)), high: Some((1.0, false)) }), default = "1e-9")]
    pub tolerance: f64,
    /// Largest number of Newton iterations before a step is rejected. Each may take several linear
    /// solves, which the column `newton` counts.
    #[key(Count(1), default = "40")]
    pub max_iterations: usize,
    /// Linear solver for systems with the tangent.
    #[key(default = "\"auto\"")]
    #[serde(default)]
    pub linear: LinearRule,
    /// When the tangent is factorised.
    #[key(default = "\"frozen\"")]
    #[serde(default)]
    pub tangent: TangentRule,
    /// Number of earlier corrections with the same factorisation that accelerate the next one (the
    /// restart length of the Krylov method); 0 disables mixing.
    #[key(default = "4")]
    #[serde(default)]
    pub mixing: usize,
}

/// Solver of the linear systems.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum LinearRule {
    /// Iterative for dynamics in space with 5 000 unknowns or more and without friction; otherwise
    /// direct.
    #[default]
    Auto,
    /// Factorisation.
    Direct,
    /// Conjugate gradients, preconditioned by the diagonal blocks of the nodes; only the rows of
    /// closed contacts are factorised.
    Iterative,
}

/// When the tangent is assembled and factorised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Keys)]
#[serde(rename_all = "kebab-case")]
pub enum TangentRule {
    /// The factorisation is reused as a preconditioner over iterations and steps as long as this
    /// reduces the cost; with 10 000 unknowns or more it is in single precision where this
    /// suffices.
    #[default]
    Frozen,
    /// As frozen, always in double precision.
    FrozenDouble,
    /// In every iteration.
    Full,
}
