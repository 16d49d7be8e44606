//! From a scheme's name in the case to what steps: a kernel of implicit stages, or a scheme with a contact law of its own.

use carom_time::{Kernel, Nonsmooth, Scheme, SchemeError};

use crate::case::{Case, ContactLaw, Problem, SchemeSpec};
use crate::model::Model;
use crate::stepper::{Explicit, Implicit, Impulsive, Stepper};

/// A time integrator with its parameters.
pub enum Integrator {
    /// A list of implicit stages.
    Implicit(Box<dyn Kernel>),
    /// A scheme that treats contact itself.
    Nonsmooth(Nonsmooth),
}

impl SchemeSpec {
    /// The scheme's parameters, of the α family.
    ///
    /// # Errors
    /// Unknown kinds, missing, superfluous or inadmissible parameters.
    pub fn scheme(&self) -> Result<Scheme, SchemeError> {
        carom_time::scheme(&self.kind, &self.parameters, self.forces)
    }

    /// The scheme with a contact law of its own; `None` where the kind is none of these.
    pub fn nonsmooth(&self) -> Option<Nonsmooth> {
        carom_time::nonsmooth(&self.kind, &self.parameters)?.ok()
    }

    /// What steps.
    ///
    /// # Errors
    /// As [`Self::scheme`].
    pub fn integrator(&self) -> Result<Integrator, SchemeError> {
        match carom_time::nonsmooth(&self.kind, &self.parameters) {
            Some(made) => made.map(Integrator::Nonsmooth),
            None => Ok(Integrator::Implicit(Box::new(self.scheme()?))),
        }
    }

    /// What contact holds under this scheme.
    pub fn contact_law(&self) -> ContactLaw {
        match self.nonsmooth() {
            Some(Nonsmooth::Impulse(_)) => ContactLaw::Velocity,
            _ => ContactLaw::Position,
        }
    }

    /// Whether no system is solved, so that the mass must be diagonal and the step short.
    pub fn is_explicit(&self) -> bool {
        matches!(self.nonsmooth(), Some(Nonsmooth::CentralDifference | Nonsmooth::PaoliSchatzman))
    }
}

/// The stepper of a case.
///
/// # Errors
/// As [`SchemeSpec::scheme`], located at `time.scheme`.
pub(crate) fn stepper<const D: usize>(case: &Case, model: &Model<D>) -> Result<Box<dyn Stepper<D>>, Vec<Problem>> {
    let integrator = case.time.scheme.integrator().map_err(|error| {
        let path = format!("time.scheme.{}", error.key());
        vec![Problem::new(path, "the scheme cannot be used", error.to_string(), "carom explain lists schemes")]
    })?;
    Ok(match integrator {
        Integrator::Implicit(kernel) => Box::new(Implicit::new(kernel, case.newton.clone())),
        Integrator::Nonsmooth(Nonsmooth::Impulse(scheme)) => Box::new(Impulsive::new(scheme, case.newton.clone())),
        Integrator::Nonsmooth(_) => Box::new(Explicit::new(model)),
    })
}
