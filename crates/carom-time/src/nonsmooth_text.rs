//! What `carom explain` knows of schemes with a contact law of their own.
use std::f64::consts::TAU;
use std::fmt::{Display, Formatter, Result};

use serde::Serialize;

use crate::explain::Accuracy;
use crate::names::short;
use crate::nonsmooth::{Impulse, Nonsmooth, nonsmooth};

/// All of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NonsmoothExplanation {
    /// As in a case file.
    pub kind: &'static str,
    /// Parameters by key.
    pub parameters: Vec<(&'static str, f64)>,
    /// One sentence.
    pub summary: &'static str,
    /// Where it was published.
    pub reference: &'static str,
    /// Order on smooth motion.
    pub order: u8,
    /// Largest ωΔt at which no mode grows; none: any.
    pub stable_omega_dt: Option<f64>,
    /// Spectral radius at infinity; none where the scheme is not stable there.
    pub rho_inf: Option<f64>,
    /// At 5, 10, 20, 50 and 100 steps per period.
    pub accuracy: Vec<Accuracy>,
    /// What contact does.
    pub contact: Vec<&'static str>,
    /// What is conserved, and what is not.
    pub conserves: Vec<&'static str>,
}

/// Explains a scheme with a contact law of its own.
///
/// ```
/// let told = carom_time::explain_nonsmooth(&carom_time::Nonsmooth::CentralDifference);
/// assert_eq!((told.order, told.stable_omega_dt), (2, Some(2.0)));
/// ```
pub fn explain_nonsmooth(scheme: &Nonsmooth) -> NonsmoothExplanation {
    let info = scheme.info();
    let values = match scheme {
        Nonsmooth::Impulse(Impulse::MoreauJean { theta }) => vec![*theta],
        Nonsmooth::Impulse(Impulse::GeneralizedAlpha(alpha)) => vec![alpha.spectral_radius_at_infinity()],
        _ => vec![],
    };
    NonsmoothExplanation {
        kind: info.name,
        parameters: info.keys.iter().copied().zip(values).collect(),
        summary: info.summary,
        reference: info.reference,
        order: scheme.order(),
        stable_omega_dt: scheme.stable_omega_dt(),
        rho_inf: scheme.rho_inf(),
        accuracy: [5, 10, 20, 50, 100].iter().filter_map(|&steps| accuracy(scheme, steps)).collect(),
        contact: contact(scheme),
        conserves: conserves(scheme),
    }
}

fn accuracy(scheme: &Nonsmooth, steps_per_period: u32) -> Option<Accuracy> {
    let omega_dt = TAU / f64::from(steps_per_period);
    let (modulus, angle) = scheme.oscillation(omega_dt)?;
    let damping = 0.0 - modulus.ln() / angle;
    Some(Accuracy {
        steps_per_period,
        spectral_radius: scheme.spectral_radius(omega_dt),
        damping_ratio: Some(damping),
        period_error: Some(omega_dt / angle - 1.0),
    })
}

fn contact(scheme: &Nonsmooth) -> Vec<&'static str> {
    match scheme {
        Nonsmooth::CentralDifference => vec![
            "the force at a step's start keeps the positions at its end out (forward increment): no penetration but for hand-overs of facets",
            "needs mass = \"lumped\" on every body; the stable step is computed, a longer one refused",
        ],
        Nonsmooth::PaoliSchatzman => vec![
            "restitution e of the contact, 0: the same as central-difference; positions penetrate by Δt·speed where e > 0",
            "with e = 1 and finite elements energy alternates from step to step during contact and high modes are excited",
            "needs mass = \"lumped\" on every body; the stable step is computed, a longer one refused",
        ],
        Nonsmooth::Impulse(_) => vec![
            "an impulse P per step where the gap is predicted closed: 0 ≤ G v_{n+1} + e G v_n ⊥ P ≥ 0; recorded as the force P/Δt",
            "velocities, not positions, are held: penetration of the order of Δt·speed stays",
        ],
    }
}

fn conserves(scheme: &Nonsmooth) -> Vec<&'static str> {
    let energy = match scheme {
        Nonsmooth::CentralDifference | Nonsmooth::PaoliSchatzman => {
            "energy: no mode of linear motion is damped below the stable step; each impact of a node takes its share"
        }
        Nonsmooth::Impulse(Impulse::MoreauJean { theta }) if *theta == 0.5 => {
            "energy: no mode of linear motion is damped; an impact with e = 0 takes what the node had"
        }
        Nonsmooth::Impulse(_) => "energy: dissipates, high frequencies most; see the damping above",
    };
    vec!["momentum: exactly", energy]
}

impl Display for NonsmoothExplanation {
    fn fmt(&self, f: &mut Formatter) -> Result {
        write!(f, "{{ kind = \"{}\"", self.kind)?;
        self.parameters.iter().try_for_each(|(key, value)| write!(f, ", {key} = {}", short(*value)))?;
        writeln!(f, " }}   {}\n  {}", self.reference, self.summary)?;
        write!(f, "\norder {}   ", self.order)?;
        match (self.stable_omega_dt, self.rho_inf) {
            (Some(limit), _) => writeln!(f, "stable for ωΔt ≤ {limit} (linear motion)")?,
            (None, rho) => writeln!(f, "ρ∞ = {:.4}   stable at any Δt (linear motion)", rho.unwrap_or(1.0))?,
        }
        writeln!(f, "\n  {:>6} {:>10} {:>12} {:>10}", "T/Δt", "ρ", "damping ξ", "PE %")?;
        for row in &self.accuracy {
            let (xi, pe) = (row.damping_ratio.unwrap_or(0.0), 100.0 * row.period_error.unwrap_or(0.0));
            writeln!(f, "  {:>6} {:>10.6} {xi:>12.4} {pe:>10.4}", row.steps_per_period, row.spectral_radius)?;
        }
        for (title, lines) in [("contact", &self.contact), ("conserves", &self.conserves)] {
            writeln!(f, "\n{title}")?;
            lines.iter().try_for_each(|line| writeln!(f, "  {line}"))?;
        }
        Ok(())
    }
}

/// Members shown of each kind.
const SHOWN: &[(&str, &[(&str, f64)])] = &[
    ("central-difference", &[]),
    ("paoli-schatzman", &[]),
    ("moreau-jean", &[("theta", 0.5)]),
    ("moreau-jean", &[("theta", 1.0)]),
    ("nonsmooth-generalized-alpha", &[("rho_inf", 0.1)]),
    ("nonsmooth-generalized-alpha", &[("rho_inf", 0.8)]),
];

/// Typical members of every kind with a contact law of its own.
///
/// ```
/// let all = carom_time::explain_all_nonsmooth();
/// assert!(carom_time::NONSMOOTH_KINDS.iter().all(|kind| all.iter().any(|told| told.kind == kind.name)));
/// ```
pub fn explain_all_nonsmooth() -> Vec<NonsmoothExplanation> {
    let made = |&(kind, parameters): &(&str, &[(&str, f64)])| {
        let given = parameters.iter().map(|(key, value)| ((*key).to_owned(), *value)).collect();
        Some(explain_nonsmooth(&nonsmooth(kind, &given)?.ok()?))
    };
    SHOWN.iter().filter_map(made).collect()
}
