//! The output of `carom explain` for schemes with their own contact law.
use std::f64::consts::TAU;
use std::fmt::{Display, Formatter, Result};

use serde::Serialize;

use crate::catalogue::info;
use crate::explain::{Accuracy, with_consistent_mass};
use crate::layout::{accuracy_table, write_wrapped};
use crate::name::{Name, short};
use crate::nonsmooth::Nonsmooth;

/// Everything known of such a scheme.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NonsmoothExplanation {
    /// Name in a case file.
    pub kind: &'static str,
    /// Parameters by key.
    pub parameters: Vec<(&'static str, f64)>,
    /// One sentence.
    pub summary: &'static str,
    /// Publication.
    pub reference: &'static str,
    /// Order on smooth motion.
    pub order: u8,
    /// Largest ωΔt for which no mode grows; none: unlimited.
    pub stable_omega_dt: Option<f64>,
    /// Spectral radius at infinity; none if the scheme is unstable there.
    pub rho_inf: Option<f64>,
    /// At 5, 10, 20, 50 and 100 steps per period.
    pub accuracy: Vec<Accuracy>,
    /// Treatment of contact.
    pub contact: &'static [&'static str],
    /// What is conserved and what is not.
    pub conserves: Vec<&'static str>,
}

/// Explains a scheme with its own contact law, by the name that was requested.
pub(crate) fn explain_nonsmooth(scheme: &Nonsmooth, name: &Name) -> NonsmoothExplanation {
    let accuracy: Vec<_> = [5, 10, 20, 50, 100].iter().filter_map(|&steps| accuracy(scheme, steps)).collect();
    let lossless = accuracy.iter().all(|row| row.damping_ratio.is_some_and(|xi| xi.abs() < 1e-9));
    let (contact, energy) = match scheme {
        Nonsmooth::Explicit(scheme) => (
            scheme.contact,
            "energy: below the stability limit no mode of linear motion is damped; with e = 0 each impact of a node dissipates some energy",
        ),
        Nonsmooth::Impulse(_) if lossless => (
            IMPULSES,
            "energy: no mode of linear motion is damped; an impact with e = 0 dissipates the kinetic energy of the node's normal velocity",
        ),
        Nonsmooth::Impulse(_) => {
            (IMPULSES, "energy: dissipated, most strongly at high frequencies (damping ratio above)")
        }
    };
    NonsmoothExplanation {
        kind: name.kind,
        parameters: name.parameters.iter().map(|(key, value)| (*key, *value)).collect(),
        summary: scheme.summary(),
        reference: info(name.kind).map_or("", |info| info.reference),
        order: scheme.order(),
        stable_omega_dt: scheme.stable_omega_dt(),
        rho_inf: scheme.rho_inf(),
        accuracy,
        contact,
        conserves: vec!["momentum: conserved exactly", energy],
    }
}

const IMPULSES: &[&str] = &[
    "where the gap is predicted to be closed, an impulse P acts in the step: 0 ≤ G v_{n+1} + e G v_n ⊥ P ≥ 0, with the gap rate G v and the coefficient of restitution e; it is recorded as the force P/Δt",
    "velocities are constrained, not positions: a penetration of the order of Δt·speed remains",
];

fn accuracy(scheme: &Nonsmooth, steps_per_period: u32) -> Option<Accuracy> {
    let omega_dt = TAU / f64::from(steps_per_period);
    let (modulus, angle) = scheme.oscillation(omega_dt)?;
    let damping = 0.0 - modulus.ln() / angle;
    Some(Accuracy {
        steps_per_period,
        spectral_radius: scheme.spectral_radius(omega_dt),
        damping_ratio: Some(damping),
        period_error: Some(omega_dt / angle - 1.0),
        dispersion: wave(scheme, omega_dt).map(|angle| angle / omega_dt - 1.0),
    })
}

/// Angle per step of a wave in a bar of linear elements whose exact angle is `omega_dt`, at c Δt =
/// h. Explicit schemes have lumped masses, others consistent ones.
fn wave(scheme: &Nonsmooth, omega_dt: f64) -> Option<f64> {
    let semi_discrete = match scheme {
        Nonsmooth::Explicit(_) => 2.0 * (omega_dt / 2.0).sin(),
        Nonsmooth::Impulse(_) => with_consistent_mass(omega_dt),
    };
    Some(scheme.oscillation(semi_discrete)?.1)
}

impl Display for NonsmoothExplanation {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "{{ kind = \"{}\"", self.kind)?;
        self.parameters.iter().try_for_each(|(key, value)| write!(f, ", {key} = {}", short(*value)))?;
        writeln!(f, " }}   {}", self.reference)?;
        write_wrapped(f, self.summary)?;
        write!(f, "\norder {}   ", self.order)?;
        match (self.stable_omega_dt, self.rho_inf) {
            (Some(limit), _) => writeln!(f, "stable for ωΔt ≤ {limit} in linear motion")?,
            (None, rho) => {
                writeln!(f, "ρ∞ = {:.4}   unconditionally stable in linear motion", rho.unwrap_or(1.0))?;
            }
        }
        accuracy_table(f, &self.accuracy)?;
        for (title, lines) in [("contact", self.contact), ("conservation", &self.conserves)] {
            writeln!(f, "\n{title}")?;
            lines.iter().try_for_each(|line| write_wrapped(f, line))?;
        }
        Ok(())
    }
}
