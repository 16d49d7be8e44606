//! A kind of scheme as the table [`KINDS`] holds it: name, keys, text, what builds it, and members with what their papers claim. Reader, schema, help, `explain`
//! and the tests that are the same for every scheme go through the table; the claims are numbers, against which the tests measure.
use std::collections::BTreeMap;
use std::ops::Bound;

use crate::error::SchemeError;
use crate::integrator::Integrator;
use crate::names::Name;
use crate::nonsmooth::{Explicit, Impulse, Nonsmooth};
use crate::scheme::{ForceRule, Scheme};
use crate::schemes::KINDS;
use crate::stage::Kernel;

/// A published scheme by name.
#[derive(Clone, Copy, Debug)]
pub struct KindInfo {
    /// As written in a case file.
    pub name: &'static str,
    /// One sentence.
    pub summary: &'static str,
    /// Where it was published.
    pub reference: &'static str,
    /// Sets of parameters, of which exactly one is to be given in full.
    pub sets: &'static [&'static [Parameter]],
    /// What `explain` shows beside other kinds and what tests measure.
    pub members: &'static [Member],
    pub(crate) build: Build,
}

/// A parameter: a finite number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// As written in a case file.
    pub key: &'static str,
    /// Ends of the values it takes.
    pub range: (Bound<f64>, Bound<f64>),
    /// What it means, a sentence.
    pub meaning: &'static str,
    /// A value, as TOML.
    pub example: &'static str,
}

/// One scheme of a kind, and what is published of it.
#[derive(Clone, Copy, Debug)]
pub struct Member {
    /// One set of parameters by key.
    pub parameters: &'static [(&'static str, f64)],
    /// Order of convergence on smooth motion.
    pub order: u8,
    /// Spectral radius at infinity; infinite where the scheme is stable up to a limit of the step only.
    pub rho_inf: f64,
    /// How much too far it falls from rest or any other start in n steps, in units of g Δt².
    pub falls: fn(f64) -> f64,
    /// Whether it stands in the table of `explain`; otherwise it is there for the tests.
    pub shown: bool,
}

impl Member {
    /// A member that falls exactly.
    pub const fn new(parameters: &'static [(&'static str, f64)], order: u8, rho_inf: f64) -> Self {
        Self { parameters, order, rho_inf, falls: |_| 0.0, shown: true }
    }

    /// One that falls too far by `by(n)` g Δt² in n steps.
    pub const fn falling(self, by: fn(f64) -> f64) -> Self {
        Self { falls: by, ..self }
    }

    /// One for the tests only.
    pub const fn hidden(self) -> Self {
        Self { shown: false, ..self }
    }
}

/// What a kind makes of the values of a set in its order; of the α family, of the number of the set too.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Build {
    Alpha(fn(usize, &[f64]) -> Result<Scheme, SchemeError>),
    Stages(fn(&[f64]) -> Result<Box<dyn Kernel>, SchemeError>),
    Explicit(Explicit),
    Impulse(fn(&[f64]) -> Result<Box<dyn Impulse>, SchemeError>),
}

impl KindInfo {
    /// Every parameter of any set, without repetition.
    pub fn parameters(&self) -> Vec<&'static Parameter> {
        let mut all: Vec<&Parameter> = Vec::new();
        for parameter in self.sets.iter().copied().flatten() {
            if !all.iter().any(|known| known.key == parameter.key) {
                all.push(parameter);
            }
        }
        all
    }

    /// Whether it is of the α family, whose forces may be averaged in two ways.
    pub fn is_alpha(&self) -> bool {
        matches!(self.build, Build::Alpha(_))
    }

    /// Whether it has a contact law of its own.
    pub fn is_nonsmooth(&self) -> bool {
        matches!(self.build, Build::Explicit(_) | Build::Impulse(_))
    }

    /// How a member is asked for.
    pub fn named(&self, member: &Member) -> Name {
        Name { kind: self.name, parameters: member.parameters.iter().copied().collect() }
    }

    /// The sets of keys in words: "beta + gamma, or rho_inf".
    fn expected(&self) -> String {
        let words = |set: &&[Parameter]| match set {
            [] => "no parameter".to_owned(),
            set => set.iter().map(|parameter| parameter.key).collect::<Vec<_>>().join(" + "),
        };
        self.sets.iter().map(words).collect::<Vec<_>>().join(", or ")
    }

    fn keys(&self) -> Vec<&'static str> {
        self.parameters().iter().map(|parameter| parameter.key).collect()
    }

    fn build(&self, given: &BTreeMap<String, f64>, forces: ForceRule) -> Result<Integrator, SchemeError> {
        // The set that explains most of what was given; the first one if nothing was.
        let mut best = (0, &[][..], 0);
        for (number, set) in self.sets.iter().enumerate() {
            let hits = set.iter().filter(|parameter| given.contains_key(parameter.key)).count();
            if number == 0 || hits > best.2 {
                best = (number, *set, hits);
            }
        }
        let (number, set, _) = best;
        let (kind, expected, known) = (self.name, || self.expected(), || self.keys());
        if let Some(key) = given.keys().find(|key| !set.iter().any(|parameter| parameter.key == **key)) {
            return Err(SchemeError::Superfluous { kind, key: key.clone(), expected: expected(), known: known() });
        }
        let value = |&Parameter { key, .. }: &Parameter| {
            let missing = || SchemeError::Missing { kind, key, expected: expected(), known: known() };
            given.get(key).copied().ok_or_else(missing)
        };
        let values: Vec<f64> = set.iter().map(value).collect::<Result<_, _>>()?;
        let parameters = set.iter().map(|parameter| parameter.key).zip(values.iter().copied()).collect();
        let name = Name { kind, parameters };
        Ok(match self.build {
            Build::Alpha(build) => Integrator::Alpha(build(number, &values)?.with_forces(forces), name),
            Build::Stages(build) => Integrator::Stages(build(&values)?, name),
            Build::Explicit(scheme) => Integrator::Nonsmooth(Nonsmooth::Explicit(scheme), name),
            Build::Impulse(build) => Integrator::Nonsmooth(Nonsmooth::Impulse(build(&values)?), name),
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
