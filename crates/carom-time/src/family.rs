//! The catalogue: schemes by the names a case file uses. One line in [`KINDS`] is a new name for the reader, the schema, the help and `explain`.
use std::collections::BTreeMap;

use crate::backward_euler::BackwardEuler;
use crate::bathe::Bathe;
use crate::bdf2::Bdf2;
use crate::energy_momentum::EnergyMomentum;
use crate::error::SchemeError;
use crate::integrator::Integrator;
use crate::names::Name;
use crate::scheme::{ForceRule, Scheme};
use crate::stage::Kernel;

/// What a kind makes of the number of the key set and the values in its order.
#[derive(Clone, Copy, Debug)]
enum Build {
    Alpha(fn(usize, &[f64]) -> Result<Scheme, SchemeError>),
    Stages(fn(&[f64]) -> Result<Box<dyn Kernel>, SchemeError>),
}

/// A published scheme by name.
#[derive(Clone, Copy, Debug)]
pub struct KindInfo {
    /// As written in a case file.
    pub name: &'static str,
    /// Sets of parameter keys, of which exactly one is to be given in full.
    pub keys: &'static [&'static [&'static str]],
    /// One sentence.
    pub summary: &'static str,
    /// Where it was published.
    pub reference: &'static str,
    build: Build,
}

/// All kinds.
pub const KINDS: &[KindInfo] = &[
    KindInfo {
        name: "newmark",
        keys: &[&["beta", "gamma"], &["rho_inf"]],
        summary: "Newmark's rule by β and γ (¼, ½: trapezoidal), or its damped form by ρ∞, first order below 1",
        reference: "Newmark 1959",
        build: Build::Alpha(|set, p| if set == 0 { Scheme::newmark(p[0], p[1]) } else { Scheme::newmark_damped(p[0]) }),
    },
    KindInfo {
        name: "hu",
        keys: &[&[]],
        summary: "γ = 3/2, β = 1: ρ∞ = 0, first order, strongly dissipative",
        reference: "Hu 1997",
        build: Build::Alpha(|_, _| Ok(Scheme::hu())),
    },
    KindInfo {
        name: "hht",
        keys: &[&["alpha"]],
        summary: "averages the forces, 0 ≤ alpha = α_f ≤ 1/3 (the opposite of the original α): second order, ½ ≤ ρ∞ ≤ 1",
        reference: "Hilber, Hughes, Taylor 1977",
        build: Build::Alpha(|_, p| Scheme::hht(p[0])),
    },
    KindInfo {
        name: "wbz",
        keys: &[&["rho_inf"]],
        summary: "averages the inertia forces: second order, any ρ∞",
        reference: "Wood, Bossak, Zienkiewicz 1980",
        build: Build::Alpha(|_, p| Scheme::wbz(p[0])),
    },
    KindInfo {
        name: "chung-hulbert",
        keys: &[&["rho_inf"]],
        summary: "averages both with the least damping of low frequencies for its ρ∞: second order",
        reference: "Chung, Hulbert 1993",
        build: Build::Alpha(|_, p| Scheme::chung_hulbert(p[0])),
    },
    KindInfo {
        name: "generalized-alpha",
        keys: &[&["alpha_m", "alpha_f", "beta", "gamma"]],
        summary: "four raw parameters, index s + 1 − α: an α is the share of the old term",
        reference: "Chung, Hulbert 1993",
        build: Build::Alpha(|_, p| Scheme::generalized_alpha(p[0], p[1], p[2], p[3])),
    },
    KindInfo {
        name: "backward-euler",
        keys: &[&[]],
        summary: "everything at the end of the step: first order, ρ∞ = 0",
        reference: "Hairer, Wanner 1996",
        build: Build::Stages(|_| Ok(Box::new(BackwardEuler))),
    },
    KindInfo {
        name: "bdf2",
        keys: &[&[]],
        summary: "two-step backward differentiation: second order, ρ∞ = 0",
        reference: "Gear 1971",
        build: Build::Stages(|_| Ok(Box::new(Bdf2))),
    },
    KindInfo {
        name: "tr-bdf2",
        keys: &[&[]],
        summary: "trapezoidal rule, then backward differentiation, in one step: second order, ρ∞ = 0, two solves",
        reference: "Bank and others 1985",
        build: Build::Stages(|_| Ok(Box::new(Bathe::new(0.0)?))),
    },
    KindInfo {
        name: "bathe",
        keys: &[&["rho_inf"]],
        summary: "the composite rule for any ρ∞: second order, two solves",
        reference: "Noh, Bathe 2019",
        build: Build::Stages(|p| Ok(Box::new(Bathe::new(p[0])?))),
    },
    KindInfo {
        name: "energy-momentum",
        keys: &[&[]],
        summary: "midpoint rule with a discrete gradient: second order, ρ∞ = 1, energy and momenta of free motion exactly",
        reference: "Simo, Tarnow 1992; Gonzalez 2000",
        build: Build::Stages(|_| Ok(Box::new(EnergyMomentum))),
    },
];

impl KindInfo {
    /// Every key of any set, without repetition.
    pub fn all_keys(&self) -> Vec<&'static str> {
        let mut keys: Vec<_> = self.keys.concat();
        keys.dedup();
        keys
    }

    /// The key sets in words: "beta + gamma, or rho_inf".
    pub fn expected(&self) -> String {
        let sets: Vec<_> = self
            .keys
            .iter()
            .map(|set| if set.is_empty() { "no parameter".to_owned() } else { set.join(" + ") })
            .collect();
        sets.join(", or ")
    }

    fn build(&self, parameters: &BTreeMap<String, f64>, forces: ForceRule) -> Result<Integrator, SchemeError> {
        let given = |key: &&&str| parameters.contains_key(**key);
        let superfluous = |key: &str| SchemeError::Superfluous {
            kind: self.name,
            key: key.to_owned(),
            expected: self.expected(),
            known: self.all_keys(),
        };
        // The set that explains most of what was given; the first one if nothing was.
        let mut best = (0, &[][..], 0);
        for (number, set) in self.keys.iter().enumerate() {
            let hits = set.iter().filter(given).count();
            if number == 0 || hits > best.2 {
                best = (number, *set, hits);
            }
        }
        let (number, set, _) = best;
        if let Some(key) = parameters.keys().find(|key| !set.contains(&key.as_str())) {
            return Err(superfluous(key));
        }
        let value = |key: &&'static str| {
            parameters.get(*key).copied().ok_or_else(|| SchemeError::Missing {
                kind: self.name,
                key,
                expected: self.expected(),
                known: self.all_keys(),
            })
        };
        let values: Vec<f64> = set.iter().map(value).collect::<Result<_, _>>()?;
        Ok(match self.build {
            Build::Alpha(build) => Integrator::Alpha(build(number, &values)?.with_forces(forces)),
            Build::Stages(build) => {
                let parameters = set.iter().copied().zip(values.iter().copied()).collect();
                Integrator::Stages(build(&values)?, Name { kind: self.name, parameters })
            }
        })
    }
}

/// A scheme by the name and parameters of a case file. `forces` is for the α family.
///
/// ```
/// use carom_time::{ForceRule, Scheme, scheme};
/// let parameters = [("rho_inf".to_owned(), 0.1)].into();
/// let made = scheme("chung-hulbert", &parameters, ForceRule::AverageForces)?;
/// assert_eq!(made.alpha(), Some(Scheme::chung_hulbert(0.1)?));
/// # Ok::<(), carom_time::SchemeError>(())
/// ```
pub fn scheme(kind: &str, parameters: &BTreeMap<String, f64>, forces: ForceRule) -> Result<Integrator, SchemeError> {
    let Some(info) = KINDS.iter().find(|info| info.name == kind) else {
        let known = KINDS.iter().map(|info| info.name).collect();
        return Err(SchemeError::UnknownKind { kind: kind.to_owned(), known });
    };
    info.build(parameters, forces)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn build(kind: &str, parameters: &[(&str, f64)]) -> Result<Integrator, SchemeError> {
        let parameters = parameters.iter().map(|(key, value)| ((*key).to_owned(), *value)).collect();
        scheme(kind, &parameters, ForceRule::AverageForces)
    }

    /// theory.md §3.1, from the papers named there.
    #[test]
    fn parameters_are_the_published_ones() {
        let table: &[(&str, &[(&str, f64)], [f64; 4])] = &[
            ("newmark", &[("beta", 0.25), ("gamma", 0.5)], [0.0, 0.0, 0.25, 0.5]),
            ("newmark", &[("rho_inf", 1.0)], [0.0, 0.0, 0.25, 0.5]),
            ("newmark", &[("rho_inf", 0.6)], [0.0, 0.0, 0.390625, 0.75]),
            ("newmark", &[("rho_inf", 0.0)], [0.0, 0.0, 1.0, 1.5]),
            ("hu", &[], [0.0, 0.0, 1.0, 1.5]),
            ("hht", &[("alpha", 0.05)], [0.0, 0.05, 0.275625, 0.55]),
            ("hht", &[("alpha", 1.0 / 3.0)], [0.0, 1.0 / 3.0, 4.0 / 9.0, 5.0 / 6.0]),
            ("wbz", &[("rho_inf", 0.6)], [-0.25, 0.0, 0.390625, 0.75]),
            ("wbz", &[("rho_inf", 0.0)], [-1.0, 0.0, 1.0, 1.5]),
            ("chung-hulbert", &[("rho_inf", 1.0)], [0.5, 0.5, 0.25, 0.5]),
            ("chung-hulbert", &[("rho_inf", 0.6)], [0.125, 0.375, 0.390625, 0.75]),
            ("chung-hulbert", &[("rho_inf", 0.1)], [-0.8 / 1.1, 0.1 / 1.1, 1.0 / 1.21, 1.45 / 1.1]),
            ("chung-hulbert", &[("rho_inf", 0.0)], [-1.0, 0.0, 1.0, 1.5]),
        ];
        for (kind, parameters, expected) in table {
            let s = build(kind, parameters).unwrap().alpha().unwrap();
            for (got, want) in [s.alpha_m, s.alpha_f, s.beta, s.gamma].iter().zip(expected) {
                assert!((got - want).abs() < 1e-15, "{kind} {parameters:?}: {s:?}");
            }
        }
    }

    #[test]
    fn errors_name_the_key_and_what_is_valid() {
        let error = build("chung-hulber", &[]).unwrap_err();
        assert_eq!((error.key(), error.known().len()), ("kind", KINDS.len()));
        let error = build("wbz", &[]).unwrap_err();
        assert!(matches!(error, SchemeError::Missing { key: "rho_inf", .. }));
        let error = build("newmark", &[("beta", 0.25)]).unwrap_err();
        assert!(matches!(error, SchemeError::Missing { key: "gamma", .. }));
        assert_eq!(error.to_string(), "scheme `newmark` needs `gamma`; it takes beta + gamma, or rho_inf");
        let error = build("newmark", &[("beta", 0.25), ("gamma", 0.5), ("rho_inf", 1.0)]).unwrap_err();
        assert!(matches!(&error, SchemeError::Superfluous { key, .. } if key == "rho_inf"));
        let error = build("hu", &[("rho_inf", 0.0)]).unwrap_err();
        assert_eq!(error.to_string(), "scheme `hu` does not take `rho_inf`; it takes no parameter");
        for value in [1.2, -0.1, f64::NAN, f64::INFINITY] {
            let error = build("chung-hulbert", &[("rho_inf", value)]).unwrap_err();
            assert!(matches!(error, SchemeError::OutOfRange { key: "rho_inf", range: "[0, 1]", .. }), "{error}");
        }
        assert_eq!(build("newmark", &[("beta", 0.0), ("gamma", 0.5)]).unwrap_err().key(), "beta");
        let error = build("hht", &[("alpha", -0.05)]).unwrap_err().to_string();
        assert!(error.contains("write alpha = 0.05"), "{error}");
        assert!(build("hht", &[("alpha", f64::NAN)]).is_err() && build("hht", &[("alpha", 0.4)]).is_ok());
    }
}
