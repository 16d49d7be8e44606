//! A kind of scheme as stored in the table [`crate::KINDS`]: name, keys, text, constructor, and
//! members with the claims of their papers. Reader, schema, help, `explain` and the tests common to
//! all schemes use the table. The claims are numbers, which the tests verify.
use std::collections::BTreeMap;

use crate::error::SchemeError;
use crate::explicit::Explicit;
use crate::integrator::Integrator;
use crate::name::Name;
use crate::nonsmooth::{Impulse, Nonsmooth};
use crate::parameter::Parameter;
use crate::scheme::{ForceRule, Scheme};
use crate::stage::Kernel;

/// A published scheme by name.
#[derive(Clone, Copy, Debug)]
pub struct KindInfo {
    /// Name in a case file.
    pub name: &'static str,
    /// One sentence.
    pub summary: &'static str,
    /// Publication.
    pub reference: &'static str,
    /// Sets of parameters, exactly one of which must be given in full.
    pub sets: &'static [&'static [Parameter]],
    /// Members shown by `explain` and measured by tests.
    pub members: &'static [Member],
    pub(crate) build: Build,
}

/// One scheme of a kind, with its published properties.
#[derive(Clone, Copy, Debug)]
pub struct Member {
    /// One set of parameters by key.
    pub parameters: &'static [(&'static str, f64)],
    /// Order of convergence on smooth motion.
    pub order: u8,
    /// Spectral radius at infinity; infinite if the scheme is only stable up to a limit of the
    /// step.
    pub rho_inf: f64,
    /// Excess of free fall from any start after n steps, in units of g Δt².
    pub falls: fn(f64) -> f64,
    /// Whether `explain` shows it in its table; otherwise it only serves the tests.
    pub shown: bool,
}

impl Member {
    /// A member with exact free fall.
    pub const fn new(parameters: &'static [(&'static str, f64)], order: u8, rho_inf: f64) -> Self {
        Self { parameters, order, rho_inf, falls: |_| 0.0, shown: true }
    }

    /// One whose free fall is too long by `by(n)` g Δt² after n steps.
    pub const fn falling(self, by: fn(f64) -> f64) -> Self {
        Self { falls: by, ..self }
    }

    /// One for the tests only.
    pub const fn hidden(self) -> Self {
        Self { shown: false, ..self }
    }
}

/// Builds a scheme from the values of a parameter set in its order; the α family also receives the
/// index of the set.
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

    /// Whether it is of the α family, with its two ways to average forces.
    pub fn is_alpha(&self) -> bool {
        matches!(self.build, Build::Alpha(_))
    }

    /// Whether it has its own contact law.
    pub fn is_nonsmooth(&self) -> bool {
        matches!(self.build, Build::Explicit(_) | Build::Impulse(_))
    }

    /// The name by which a member is requested.
    pub fn named(&self, member: &Member) -> Name {
        Name {
            kind: self.name,
            parameters: member.parameters.iter().copied().collect(),
            forces: ForceRule::default(),
        }
    }

    /// The sets of keys in words: "`beta` and `gamma`, or `rho_inf`".
    fn expected(&self) -> String {
        let words = |set: &&[Parameter]| {
            let keys: Vec<_> = set.iter().map(|parameter| format!("`{}`", parameter.key)).collect();
            match keys.split_last() {
                None => "no parameters".to_owned(),
                Some((last, [])) => last.clone(),
                Some((last, others)) => format!("{} and {last}", others.join(", ")),
            }
        };
        self.sets.iter().map(words).collect::<Vec<_>>().join(", or ")
    }

    /// The kind with the example of each parameter, once per set.
    fn examples(&self) -> Vec<String> {
        let example = |set: &&[Parameter]| {
            let kind = format!("kind = \"{}\"", self.name);
            let keys = set.iter().map(|p| format!("{} = {}", p.key, p.example));
            format!("{{ {} }}", std::iter::once(kind).chain(keys).collect::<Vec<_>>().join(", "))
        };
        self.sets.iter().map(example).collect()
    }

    fn keys(&self) -> Vec<&'static str> {
        self.parameters().iter().map(|parameter| parameter.key).collect()
    }

    /// Builds the scheme of these parameters. `forces` is for the α family.
    pub(crate) fn build(
        &self,
        given: &BTreeMap<String, f64>,
        forces: ForceRule,
    ) -> Result<Integrator, SchemeError> {
        // The set with the most given parameters; the first one if there are none.
        let mut best = (0, &[][..], 0);
        for (number, set) in self.sets.iter().enumerate() {
            let hits = set.iter().filter(|parameter| given.contains_key(parameter.key)).count();
            if number == 0 || hits > best.2 {
                best = (number, *set, hits);
            }
        }
        let (number, set, _) = best;
        let (kind, expected, known) = (self.name, || self.expected(), || self.keys());
        let examples = || self.examples();
        if let Some(key) = given.keys().find(|key| !set.iter().any(|parameter| parameter.key == **key)) {
            return Err(SchemeError::Superfluous {
                kind,
                key: key.clone(),
                expected: expected(),
                examples: examples(),
                known: known(),
            });
        }
        let value = |&Parameter { key, .. }: &Parameter| {
            let missing = || SchemeError::Missing {
                kind,
                key,
                expected: expected(),
                examples: examples(),
                known: known(),
            };
            given.get(key).copied().ok_or_else(missing)
        };
        let values: Vec<f64> = set.iter().map(value).collect::<Result<_, _>>()?;
        let parameters = set.iter().map(|parameter| parameter.key).zip(values.iter().copied()).collect();
        let forces = if self.is_alpha() { forces } else { ForceRule::default() };
        let name = Name { kind, parameters, forces };
        Ok(match self.build {
            Build::Alpha(build) => Integrator::Alpha(build(number, &values)?.with_forces(forces), name),
            Build::Stages(build) => Integrator::Stages(build(&values)?, name),
            Build::Explicit(scheme) => Integrator::Nonsmooth(Nonsmooth::Explicit(scheme), name),
            Build::Impulse(build) => Integrator::Nonsmooth(Nonsmooth::Impulse(build(&values)?), name),
        })
    }
}
