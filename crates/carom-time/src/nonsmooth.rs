//! Schemes that bring their own treatment of contact: explicit ones, and those whose unknown at an impact is an impulse.
//!
//! ```text
//! central-difference   M(y_{n+1} − 2y_n + y_{n−1}) = Δt² (f_n + Gᵀλ_n),  g(y_{n+1}) ≥ 0        Carpenter, Taylor, Katona 1991
//! paoli-schatzman      the same with g((y_{n+1} + e y_{n−1})/(1 + e)) ≥ 0                      Paoli, Schatzman 2002
//! moreau-jean          M(v_{n+1} − v_n) = Δt f(y_n + θd) + GᵀP,  d = Δt(θ v_{n+1} + (1−θ) v_n)  Moreau, Jean 1999
//! nonsmooth-generalized-alpha   a step of eq. (13)–(15) without contact, and a jump w of velocity, M w = GᵀP:
//!                      v_{n+1} += w,  y_{n+1} += Δt w/2                                        Chen, Acary, Virlez, Brüls 2013
//! ```
//!
//! The last two hold 0 ≤ G v_{n+1} + e G v_n ⊥ P ≥ 0 where the gap is predicted to be closed. Both are a [`Stage`] with the unknown d = y_{n+1} − y_n and an
//! impulse beside it: eliminating w and a_{n+1} leaves P in the balance and in the maps with the three shares of [`ImpulseShares`].

use std::collections::BTreeMap;

use serde::Serialize;

use crate::error::SchemeError;
use crate::scheme::Scheme;
use crate::stage::{Internal, Kernel, Memory, Stage, Weights};

/// A scheme with a contact law of its own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Nonsmooth {
    /// Explicit, positions kept out of contact.
    CentralDifference,
    /// Explicit, a mean of positions kept out of contact.
    PaoliSchatzman,
    /// Implicit, with impulses.
    Impulse(Impulse),
}

/// A scheme whose contact is an impulse.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Impulse {
    /// The θ-method.
    MoreauJean {
        /// ½ ≤ θ ≤ 1.
        theta: f64,
    },
    /// A step of the α family between impacts.
    GeneralizedAlpha(Scheme),
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

/// A kind by name.
#[derive(Clone, Copy, Debug)]
pub struct NonsmoothInfo {
    /// As written in a case file.
    pub name: &'static str,
    /// Its parameters, all required.
    pub keys: &'static [&'static str],
    /// One sentence.
    pub summary: &'static str,
    /// Where it was published.
    pub reference: &'static str,
    build: fn(&[f64]) -> Result<Nonsmooth, SchemeError>,
}

/// All kinds with a contact law of their own.
pub const NONSMOOTH_KINDS: &[NonsmoothInfo] = &[
    NonsmoothInfo {
        name: "central-difference",
        keys: &[],
        summary: "explicit, with a lumped mass; the contact force of a step keeps the positions at its end out of contact",
        reference: "Carpenter, Taylor, Katona 1991",
        build: |_| Ok(Nonsmooth::CentralDifference),
    },
    NonsmoothInfo {
        name: "paoli-schatzman",
        keys: &[],
        summary: "explicit, with a lumped mass; what contact keeps out is (y_{n+1} + e y_{n−1})/(1 + e), e the contact's restitution",
        reference: "Paoli, Schatzman 2002",
        build: |_| Ok(Nonsmooth::PaoliSchatzman),
    },
    NonsmoothInfo {
        name: "moreau-jean",
        keys: &["theta"],
        summary: "the θ-method with impulses: contact holds velocities, with Newton's restitution",
        reference: "Moreau 1999; Jean 1999",
        build: |p| {
            if (0.5..=1.0).contains(&p[0]) {
                return Ok(Nonsmooth::Impulse(Impulse::MoreauJean { theta: p[0] }));
            }
            let hint = "below ½ every mode grows; ½ is of order 2, 1 damps most".to_owned();
            Err(SchemeError::OutOfRange { key: "theta", value: p[0], range: "[0.5, 1]", hint })
        },
    },
    NonsmoothInfo {
        name: "nonsmooth-generalized-alpha",
        keys: &["rho_inf"],
        summary: "Chung and Hulbert's scheme between impacts, impulses and Newton's restitution at them",
        reference: "Chen, Acary, Virlez, Brüls 2013",
        build: |p| Ok(Nonsmooth::Impulse(Impulse::GeneralizedAlpha(Scheme::chung_hulbert(p[0])?))),
    },
];

/// A scheme with a contact law of its own by the name and parameters of a case file; `None` where the name is none of these.
///
/// ```
/// let parameters = [("theta".to_owned(), 0.4)].into();
/// assert!(carom_time::nonsmooth("moreau-jean", &parameters).is_some_and(|made| made.is_err()));
/// assert!(carom_time::nonsmooth("hu", &parameters).is_none());
/// ```
pub fn nonsmooth(kind: &str, parameters: &BTreeMap<String, f64>) -> Option<Result<Nonsmooth, SchemeError>> {
    let info = NONSMOOTH_KINDS.iter().find(|info| info.name == kind)?;
    let expected = || if info.keys.is_empty() { "no parameter".to_owned() } else { info.keys.join(" + ") };
    let (kind, known) = (info.name, info.keys.to_vec());
    if let Some(key) = parameters.keys().find(|key| !info.keys.contains(&key.as_str())) {
        return Some(Err(SchemeError::Superfluous { kind, key: key.clone(), expected: expected(), known }));
    }
    let mut values = Vec::new();
    for key in info.keys {
        match parameters.get(*key) {
            Some(value) => values.push(*value),
            None => return Some(Err(SchemeError::Missing { kind, key, expected: expected(), known })),
        }
    }
    Some((info.build)(&values))
}

impl Nonsmooth {
    /// As in a case file.
    pub fn info(&self) -> &'static NonsmoothInfo {
        &NONSMOOTH_KINDS[match self {
            Self::CentralDifference => 0,
            Self::PaoliSchatzman => 1,
            Self::Impulse(Impulse::MoreauJean { .. }) => 2,
            Self::Impulse(Impulse::GeneralizedAlpha(_)) => 3,
        }]
    }

    /// Order of convergence on smooth motion.
    pub fn order(&self) -> u8 {
        match self {
            Self::CentralDifference | Self::PaoliSchatzman => 2,
            Self::Impulse(Impulse::MoreauJean { theta }) => 1 + u8::from((theta - 0.5).abs() < 1e-12),
            Self::Impulse(Impulse::GeneralizedAlpha(scheme)) => scheme.order(),
        }
    }

    /// Largest Ω = ωΔt at which no mode grows; none: any.
    pub fn stable_omega_dt(&self) -> Option<f64> {
        matches!(self, Self::CentralDifference | Self::PaoliSchatzman).then_some(2.0)
    }

    /// Spectral radius on linear motion as Ω → ∞; none where the scheme is not stable there.
    pub fn rho_inf(&self) -> Option<f64> {
        match self {
            Self::CentralDifference | Self::PaoliSchatzman => None,
            Self::Impulse(Impulse::MoreauJean { theta }) => Some((1.0 - theta) / theta),
            Self::Impulse(Impulse::GeneralizedAlpha(scheme)) => Some(scheme.spectral_radius_at_infinity()),
        }
    }

    /// Spectral radius of the whole map of smooth motion at Ω: that of the step of the α family for `nonsmooth-generalized-alpha`, whose third root belongs to
    /// the carried acceleration; the pair's own for the others, which carry none. Central differences beyond Ω = 2: the larger root of z² + (Ω² − 2)z + 1.
    pub fn spectral_radius(&self, omega_dt: f64) -> f64 {
        match self {
            Self::Impulse(Impulse::GeneralizedAlpha(scheme)) => scheme.spectral_radius(omega_dt),
            _ => self.oscillation(omega_dt).map_or_else(
                || {
                    let half = 0.5 * omega_dt * omega_dt - 1.0;
                    half + (half * half - 1.0).max(0.0).sqrt()
                },
                |pair| pair.0,
            ),
        }
    }

    /// Modulus and angle of the oscillating pair at Ω. θ-method: z = (1 + i(1−θ)Ω)/(1 − iθΩ); central differences: |z| = 1, sin(arg z/2) = Ω/2, Ω < 2.
    pub fn oscillation(&self, omega_dt: f64) -> Option<(f64, f64)> {
        match self {
            Self::CentralDifference | Self::PaoliSchatzman => {
                (omega_dt < 2.0).then(|| (1.0, 2.0 * (0.5 * omega_dt).asin()))
            }
            Self::Impulse(Impulse::MoreauJean { theta }) => {
                let (new, old) = (theta * omega_dt, (1.0 - theta) * omega_dt);
                Some((old.hypot(1.0) / new.hypot(1.0), old.atan() + new.atan()))
            }
            Self::Impulse(Impulse::GeneralizedAlpha(scheme)) => {
                scheme.principal(omega_dt).map(|pair| (pair.modulus, omega_dt / (1.0 + pair.period_error)))
            }
        }
    }
}

impl Impulse {
    /// Fills the stage of a step of size `dt` and returns where the impulse enters it. Contact has no weight of its own: it is the impulse.
    pub fn stage_into(&self, dt: f64, memory: &Memory, stage: &mut Stage) -> ImpulseShares {
        match self {
            Self::MoreauJean { theta } => {
                let (_, v, _) = memory.states[0];
                let new = 1.0 / (theta * dt);
                stage.end = 1.0;
                (stage.velocity.slope, stage.acceleration.slope) = (new, new / dt);
                stage.velocity.at_start.clear();
                stage.velocity.at_start.extend(v.iter().map(|v| (1.0 - 1.0 / theta) * v));
                stage.acceleration.at_start.clear();
                stage.acceleration.at_start.extend(v.iter().map(|v| -new * v));
                stage.weights = Weights { mass: 1.0, internal: 1.0, external: 1.0, contact: 0.0 };
                stage.before = Weights::default();
                stage.average = 1.0 - theta;
                (stage.internal, stage.mean) = (Internal::Gradient, [0.0, 0.0, 1.0]);
                ImpulseShares { force: 1.0 / dt, ..ImpulseShares::default() }
            }
            Self::GeneralizedAlpha(scheme) => {
                scheme.stage_into(0, dt, memory, stage);
                (stage.weights.contact, stage.before.contact) = (0.0, 0.0);
                // d holds Δt w/2 of the jump: what the maps make of it is taken back.
                let acceleration = 0.5 / (scheme.beta * dt);
                ImpulseShares {
                    force: stage.weights.mass * acceleration,
                    velocity: 1.0 - 0.5 * scheme.gamma / scheme.beta,
                    acceleration,
                }
            }
        }
    }

    /// Whether the gap that decides is that at the end of the step solved without contact; otherwise that at y_n + Δt v_n/2.
    pub fn predicts_by_solving(&self) -> bool {
        matches!(self, Self::GeneralizedAlpha(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One mass on a spring through the stage, a step at a time: the angle and modulus of its motion are those claimed.
    #[test]
    fn stages_move_an_oscillator_as_the_analysis_says() {
        let omega_dt: f64 = 0.4;
        let schemes = [0.5, 0.7, 1.0].map(|theta| Impulse::MoreauJean { theta });
        let alpha = [0.1, 0.8].map(|r| Impulse::GeneralizedAlpha(Scheme::chung_hulbert(r).unwrap()));
        for scheme in schemes.into_iter().chain(alpha) {
            let (mut y, mut v, mut a) = (1.0, 0.0, -omega_dt * omega_dt);
            let mut stage = Stage::default();
            let mut seen = Vec::new();
            for _ in 0..200 {
                scheme.stage_into(1.0, &Memory { states: &[(&[y], &[v], &[a])], before: None }, &mut stage);
                let q = omega_dt * omega_dt;
                let (w, b) = (stage.weights, stage.before);
                // Linear in d: mass·a(d) + internal·q (y + (1 − average) d) + known = 0.
                let known =
                    b.mass * a + b.internal * q * y + w.mass * stage.acceleration.at_start[0] + w.internal * q * y;
                let d = -known / (w.mass * stage.acceleration.slope + w.internal * q * (1.0 - stage.average));
                v = stage.velocity.slope * d + stage.velocity.at_start[0];
                a = stage.acceleration.slope * d + stage.acceleration.at_start[0];
                y += d;
                seen.push(y);
            }
            // Late enough for the spurious root to be gone: y_{n+1} = 2 Re z y_n − |z|² y_{n−1}.
            let [p, q, r, s] = [seen[60], seen[61], seen[62], seen[63]];
            let determinant = q * q - p * r;
            let (trace, square) = ((q * r - p * s) / determinant, (r * r - q * s) / determinant);
            let (modulus, angle) = Nonsmooth::Impulse(scheme).oscillation(omega_dt).unwrap();
            assert!((square.sqrt() - modulus).abs() < 1e-8, "{scheme:?}: |z| {} {modulus}", square.sqrt());
            assert!((trace - 2.0 * modulus * angle.cos()).abs() < 1e-8, "{scheme:?}: trace {trace}");
        }
    }

    /// Without contact the nonsmooth scheme is Chung and Hulbert's, third root included; central differences grow beyond Ω = 2: z = −(7 + 3√5)/2 at Ω = 3.
    #[test]
    fn the_radius_is_that_of_the_whole_map() {
        for rho in [0.0, 0.1, 0.8] {
            let alpha = Scheme::chung_hulbert(rho).unwrap();
            let own = Nonsmooth::Impulse(Impulse::GeneralizedAlpha(alpha));
            for omega_dt in [0.01, 1.0, 10.0, 1e3] {
                // The numeric map's triple root at infinity is known to a third of the digits.
                let (got, want) = (own.spectral_radius(omega_dt), crate::map::spectral_radius(&alpha, omega_dt));
                assert!((got - want).abs() < 1e-3, "{rho} {omega_dt}: {got} {want}");
            }
        }
        let explicit = Nonsmooth::CentralDifference;
        assert!((explicit.spectral_radius(3.0) - 0.5 * (7.0 + 45f64.sqrt())).abs() < 1e-12);
        assert_eq!(explicit.spectral_radius(1.9), 1.0);
    }

    /// A free mass stopped by an impulse: momentum is M v, the position follows half of the jump.
    #[test]
    fn an_impulse_changes_the_velocity_by_itself_over_the_mass() {
        let (dt, mass, v, p) = (0.1, 2.0, -3.0, 6.0);
        for scheme in
            [Impulse::MoreauJean { theta: 0.6 }, Impulse::GeneralizedAlpha(Scheme::chung_hulbert(0.3).unwrap())]
        {
            let mut stage = Stage::default();
            let shares = scheme.stage_into(dt, &Memory { states: &[(&[0.0], &[v], &[0.0])], before: None }, &mut stage);
            let w = stage.weights.mass * mass;
            let d = (shares.force * p - w * stage.acceleration.at_start[0]) / (w * stage.acceleration.slope);
            let end = stage.velocity.slope * d + stage.velocity.at_start[0] + shares.velocity * p / mass;
            let a = stage.acceleration.slope * d + stage.acceleration.at_start[0] - shares.acceleration * p / mass;
            assert!((end - (v + p / mass)).abs() < 1e-13, "{scheme:?}: {end}");
            match scheme {
                Impulse::MoreauJean { theta } => assert!((d - dt * (v + theta * p / mass)).abs() < 1e-14),
                Impulse::GeneralizedAlpha(_) => {
                    assert!((d - dt * (v + 0.5 * p / mass)).abs() < 1e-14 && a.abs() < 1e-12);
                }
            }
        }
    }
}
