//! Schemes with their own treatment of contact: explicit ones, and those whose unknown at an impact
//! is an impulse.
//!
//! An impulse scheme imposes 0 ≤ G v_{n+1} + e G v_n ⊥ P ≥ 0 where the gap is predicted to be
//! closed. It is a [`crate::Stage`] with the unknown d = y_{n+1} − y_n, without contact forces,
//! plus an impulse with the three coefficients of [`ImpulseShares`].

use crate::explicit::{self, Explicit};
use crate::map;
use crate::scheme::Scheme;
use crate::stage::Kernel;

/// A scheme with its own contact law.
#[derive(Debug)]
pub enum Nonsmooth {
    /// Explicit, without a system to solve.
    Explicit(Explicit),
    /// Implicit, with impulses.
    Impulse(Box<dyn Impulse>),
}

/// A scheme whose contact is an impulse. Its stage has no weight for contact forces.
pub trait Impulse: Kernel {
    /// One sentence.
    fn summary(&self) -> &'static str;

    /// Where the impulse enters the stage of a step of size `dt`.
    fn shares(&self, dt: f64) -> ImpulseShares;

    /// Whether the contact decision uses the gap at the end of the step solved without contact;
    /// otherwise that at y_n + Δt v_n/2.
    fn predicts_by_solving(&self) -> bool {
        false
    }

    /// Its step between impacts if it is of the α family, with closed-form analysis.
    fn alpha(&self) -> Option<Scheme> {
        None
    }
}

/// Where the impulse P enters a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImpulseShares {
    /// The balance gets −force·GᵀP.
    pub force: f64,
    /// v = velocity(d) + velocity·M⁻¹GᵀP.
    pub velocity: f64,
    /// a = acceleration(d) − acceleration·M⁻¹GᵀP.
    pub acceleration: f64,
}

impl Nonsmooth {
    /// One sentence.
    pub fn summary(&self) -> &'static str {
        match self {
            Self::Explicit(scheme) => scheme.summary,
            Self::Impulse(scheme) => scheme.summary(),
        }
    }

    /// Order of convergence on smooth motion.
    pub fn order(&self) -> u8 {
        match self {
            Self::Explicit(scheme) => scheme.order,
            Self::Impulse(scheme) => {
                scheme.alpha().map_or_else(|| map::order(&**scheme), |alpha| alpha.order())
            }
        }
    }

    /// Largest Ω = ωΔt for which no mode grows; none: unlimited.
    pub fn stable_omega_dt(&self) -> Option<f64> {
        matches!(self, Self::Explicit(_)).then_some(explicit::STABLE)
    }

    /// Spectral radius on linear motion as Ω → ∞; none if the scheme is unstable there.
    pub fn rho_inf(&self) -> Option<f64> {
        match self {
            Self::Explicit(_) => None,
            Self::Impulse(scheme) => Some(scheme.alpha().map_or_else(
                || map::spectral_radius_at_infinity(&**scheme),
                |alpha| alpha.spectral_radius_at_infinity(),
            )),
        }
    }

    /// Spectral radius of the whole map of smooth motion at Ω, including the root of a carried
    /// acceleration.
    pub fn spectral_radius(&self, omega_dt: f64) -> f64 {
        match self {
            Self::Explicit(_) => explicit::spectral_radius(omega_dt),
            Self::Impulse(scheme) => scheme.alpha().map_or_else(
                || map::spectral_radius(&**scheme, omega_dt),
                |alpha| alpha.spectral_radius(omega_dt),
            ),
        }
    }

    /// Modulus and angle of the oscillating pair at Ω.
    pub fn oscillation(&self, omega_dt: f64) -> Option<(f64, f64)> {
        let Self::Impulse(scheme) = self else { return explicit::oscillation(omega_dt) };
        let pair = match scheme.alpha() {
            Some(alpha) => alpha.principal(omega_dt),
            None => map::principal(&**scheme, omega_dt),
        };
        pair.map(|pair| (pair.modulus, omega_dt / (1.0 + pair.period_error)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::Integrator;
    use crate::schemes::KINDS;
    use crate::{Memory, Stage};

    fn impulses() -> impl Iterator<Item = Box<dyn Impulse>> {
        let named = KINDS.iter().flat_map(|kind| kind.members.iter().map(|member| kind.named(member)));
        named.filter_map(|name| match name.integrator().unwrap() {
            Integrator::Nonsmooth(Nonsmooth::Impulse(scheme), _) => Some(scheme),
            _ => None,
        })
    }

    /// Where the analysis is that of the α family, the stage moves an oscillator accordingly,
    /// including the third root.
    #[test]
    fn a_closed_analysis_is_that_of_the_stage() {
        for (scheme, alpha) in impulses().filter_map(|scheme| scheme.alpha().map(|alpha| (scheme, alpha))) {
            for omega_dt in [0.01, 0.4, 1.0, 10.0, 1e3] {
                // The numeric map resolves the triple root at infinity to a third of the digits.
                let (got, want) = (map::spectral_radius(&*scheme, omega_dt), alpha.spectral_radius(omega_dt));
                assert!((got - want).abs() < 1e-3, "{scheme:?} {omega_dt}: {got} {want}");
            }
            let (got, want) = (map::principal(&*scheme, 0.4).unwrap(), alpha.principal(0.4).unwrap());
            assert!((got.modulus - want.modulus).abs() + (got.period_error - want.period_error).abs() < 1e-8);
        }
    }

    /// A free mass stopped by an impulse: momentum is M v for every scheme, and the carried
    /// acceleration is that of the forces or of the whole step.
    #[test]
    fn an_impulse_changes_the_velocity_by_itself_over_the_mass() {
        let (dt, mass, v, p) = (0.1, 2.0, -3.0, 6.0);
        for scheme in impulses() {
            let mut stage = Stage::default();
            let memory = Memory { states: &[(&[0.0], &[v], &[0.0])], before: None };
            scheme.stage_into(0, dt, &memory, &mut stage);
            let shares = scheme.shares(dt);
            let w = stage.weights.mass * mass;
            let d = (shares.force * p - w * stage.acceleration.at_start[0]) / (w * stage.acceleration.slope);
            let end = stage.velocity.slope * d + stage.velocity.at_start[0] + shares.velocity * p / mass;
            let a = stage.acceleration.slope * d + stage.acceleration.at_start[0]
                - shares.acceleration * p / mass;
            assert!((end - (v + p / mass)).abs() < 1e-13, "{scheme:?}: {end}");
            assert!(a.abs() < 1e-12 || (a - p / mass / dt).abs() < 1e-12, "{scheme:?}: {a}");
            // The jump moves the position by a fraction of Δt w.
            let share = (d / dt - v) / (p / mass);
            assert!((0.5 - 1e-13..1.0 + 1e-13).contains(&share), "{scheme:?}: {share}");
            assert!(scheme.alpha().is_none() || (share - 0.5).abs() < 1e-13, "{scheme:?}: {share}");
        }
    }
}
