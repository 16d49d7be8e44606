//! Why a simulation stopped before its end, in words.

use carom_formula::instant;

use crate::rejected::Rejected;

/// Why a simulation stopped before its end; the state of the last grid time is preserved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Stopped {
    /// No step from here is accepted, however small.
    #[error(
        "the step at t = {} [time] {} rejected: {rejected}", at(*time, *dt * f64::from(*halvings).exp2()), tried(*halvings, *dt)
    )]
    NoStep {
        /// Time of the last accepted state.
        time: f64,
        /// Smallest step tried.
        dt: f64,
        /// Bisections of the grid's step.
        halvings: u32,
        /// The reason for its rejection.
        rejected: Rejected,
    },
    /// The caller ended it within a grid step.
    #[error("interrupted in the step that begins at t = {} [time]", at(*time, *dt))]
    Interrupted {
        /// Time of the last grid time.
        time: f64,
        /// The grid step.
        dt: f64,
    },
    /// The scheme created energy.
    #[error(
        "energy was created at t = {} [time]: {created:.4e} [energy], which is {} % of the energy scale, {scale:.4e} [energy]; the limit is {} %", at(*time, *dt), percent(created / scale), percent(*share)
    )]
    EnergyGuard {
        /// Time.
        time: f64,
        /// The grid step.
        dt: f64,
        /// Rise of total − external work above its running minimum.
        created: f64,
        /// Allowed fraction.
        share: f64,
        /// Largest kinetic + strain energy so far, or Σ |ΔW| of the external work.
        scale: f64,
    },
}

impl Stopped {
    /// Whether another method might take the step.
    pub(crate) fn is_of_the_method(&self, end: f64) -> bool {
        match self {
            Self::NoStep { rejected, .. } => !rejected.is_final(end),
            Self::EnergyGuard { .. } => true,
            Self::Interrupted { .. } => false,
        }
    }
}

/// A time with the digits of the grid step.
fn at(time: f64, step: f64) -> String {
    instant(time, step, 6)
}

fn tried(halvings: u32, dt: f64) -> String {
    match halvings {
        0 => format!("of Δt = {dt:.3e} [time] is"),
        _ => format!("was bisected {halvings} times, to Δt = {dt:.3e} [time], and is still"),
    }
}

/// A fraction in per cent, to three significant digits.
fn percent(fraction: f64) -> f64 {
    let percent = 100.0 * fraction;
    format!("{percent:.2e}").parse().unwrap_or(percent)
}
