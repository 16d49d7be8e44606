//! Theory of the schemes of a study, for its page: `theory.csv` has spectral radius, damping ratio
//! and period error of every method for the test oscillator; `frequencies.csv` has the natural
//! frequencies of the model and those of contact springs. Both are written when the study starts.

use std::collections::BTreeSet;
use std::path::Path;

use carom_record::{RecordError, table};
use carom_run::Setup;
use carom_run::case::{Case, Enforcement, SchemeSpec};
use carom_run::frequencies::{Frequencies, frequencies, spring};
use carom_time::Integrator;

use crate::Plan;
use crate::file::FINE_NAME;

/// Points per decade of ωΔt, from 0.01 to 1000.
const POINTS: i32 = 24;

/// Spectral radius of the amplification matrix, and damping ratio ξ and period error of its
/// principal pair at Ω; none if the pair does not oscillate.
fn at(scheme: &SchemeSpec, omega_dt: f64) -> [Option<f64>; 3] {
    let Ok(integrator) = scheme.integrator() else { return [None; 3] };
    if let Integrator::Nonsmooth(scheme, _) = &integrator {
        let pair = scheme.oscillation(omega_dt);
        return [
            Some(scheme.spectral_radius(omega_dt)),
            pair.map(|(modulus, angle)| -modulus.ln() / angle),
            pair.map(|(_, angle)| omega_dt / angle - 1.0),
        ];
    }
    let Some(kernel) = integrator.kernel() else { return [None; 3] };
    let pair = carom_time::map::principal(kernel, omega_dt);
    let radius = carom_time::map::spectral_radius(kernel, omega_dt);
    [Some(radius), pair.map(|p| p.damping_ratio), pair.map(|p| p.period_error)]
}

/// Writes both files next to `study.json`.
///
/// # Errors
/// Input/output or system error.
pub(crate) fn write(plan: &Plan, directory: &Path) -> Result<(), RecordError> {
    let mut lines = Vec::new();
    let mut seen: Vec<&SchemeSpec> = Vec::new();
    let arms = || plan.manifest.arms.iter().zip(&plan.arms);
    for (arm, planned) in arms().filter(|(arm, _)| !arm.role.fine) {
        let scheme = &planned.case.time.scheme;
        if seen.contains(&scheme) || scheme.is_static() {
            continue;
        }
        seen.push(scheme);
        for i in -2 * POINTS..=3 * POINTS {
            let omega_dt = 10f64.powf(f64::from(i) / f64::from(POINTS));
            let [radius, damping, period] = at(scheme, omega_dt);
            // Above Ω ≈ 6 a period is not resolved, so it has no error.
            let period = period.filter(|_| omega_dt <= std::f64::consts::TAU);
            let finite = [radius, damping, period].map(|x| x.filter(|x| x.is_finite()));
            lines.push((arm.method(), omega_dt, finite));
        }
    }
    let header = ["method", "omega_dt", "spectral_radius", "damping_ratio", "period_error"];
    table::write(&directory.join("theory.csv"), &header, lines.iter())?;
    let Some(found) = plan.arms.first().and_then(|arm| of_case(&arm.case)) else { return Ok(()) };
    // Arms that differ only in the step have the same springs, and most arms have none.
    let mut seen = BTreeSet::new();
    let stiff = arms().filter(|(arm, planned)| {
        let name = if arm.role.fine { FINE_NAME } else { arm.method() };
        planned.case.contacts.iter().any(|c| c.enforcement == Enforcement::Penalty) && seen.insert(name)
    });
    let mut springs: Vec<f64> = stiff.filter_map(|(_, planned)| spring_of(&planned.case)).collect();
    springs.sort_by(f64::total_cmp);
    springs.dedup();
    let lowest = found.lowest.iter().enumerate().map(|(k, omega)| ((k + 1).to_string(), *omega));
    let highest = found.highest.map(|omega| ("highest".to_owned(), omega));
    let springs = springs.into_iter().map(|omega| ("spring".to_owned(), omega));
    let lines = lowest.chain(highest).chain(springs);
    table::write(&directory.join("frequencies.csv"), &["mode", "omega"], lines)
}

fn of_case(case: &Case) -> Option<Frequencies> {
    let start = Setup::new(case).start().ok()?;
    frequencies(start.model(), &start.state().configuration())
}

fn spring_of(case: &Case) -> Option<f64> {
    spring(Setup::new(case).start().ok()?.model())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published values at Ω = 2π/10: ξ = 0.297 and a period error of 12 % for Hu's scheme, ξ =
    /// 0.036 for that of Chung and Hulbert with ρ∞ = 0.1; the trapezoidal rule has no damping.
    #[test]
    fn published_dampings() {
        let damping = |kind: &str, parameters: &[(&str, f64)]| {
            let parameters = parameters.iter().map(|(k, v)| ((*k).to_owned(), *v)).collect();
            let scheme = SchemeSpec {
                kind: kind.to_owned(),
                parameters,
                forces: carom_time::ForceRule::AverageForces,
            };
            at(&scheme, std::f64::consts::TAU / 10.0)
        };
        let [_, xi, period] = damping("hu", &[]);
        assert!((xi.unwrap() - 0.297).abs() < 5e-4 && (period.unwrap() - 0.12).abs() < 5e-3);
        assert!((damping("chung-hulbert", &[("rho_inf", 0.1)])[1].unwrap() - 0.036).abs() < 5e-4);
        assert!(damping("newmark", &[("beta", 0.25), ("gamma", 0.5)])[1].unwrap().abs() < 1e-12);
        assert!((damping("moreau-jean", &[("theta", 0.5)])[0].unwrap() - 1.0).abs() < 1e-12);
    }
}
