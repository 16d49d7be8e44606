//! From a scheme's name in the case to what steps: a kernel of implicit stages, or a scheme with a contact law of its own.

use carom_time::{Integrator, Kernel, Nonsmooth, STATIC, SchemeError, Static};

use crate::case::{Case, ContactLaw, Problem, SchemeSpec};
use crate::model::Model;
use crate::stepper::{Explicit, Implicit, Impulsive, Stepper};

impl SchemeSpec {
    /// Whether it is equilibrium without inertia, with t as the load parameter.
    pub fn is_static(&self) -> bool {
        self.kind == STATIC
    }

    /// The scheme by its name and parameters, where it is a list of implicit stages with inertia.
    ///
    /// # Errors
    /// Unknown kinds, missing, superfluous or inadmissible parameters.
    pub fn integrator(&self) -> Result<Integrator, SchemeError> {
        carom_time::scheme(&self.kind, &self.parameters, self.forces)
    }

    /// The scheme with a contact law of its own; `None` where the kind is none of these.
    pub fn nonsmooth(&self) -> Option<Nonsmooth> {
        carom_time::nonsmooth(&self.kind, &self.parameters)?.ok()
    }

    /// Whether it can be used.
    ///
    /// # Errors
    /// As [`Self::integrator`].
    pub fn checked(&self) -> Result<(), SchemeError> {
        match carom_time::nonsmooth(&self.kind, &self.parameters) {
            Some(made) => made.map(|_| ()),
            None if self.is_static() => Ok(()),
            None => self.integrator().map(|_| ()),
        }
    }

    /// Whether it is of the α family, where a contact force may be averaged over the step.
    pub fn is_alpha(&self) -> bool {
        self.integrator().is_ok_and(|integrator| integrator.alpha().is_some())
    }

    /// What contact holds under this scheme unless the case says otherwise.
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

    /// The scheme as a list of implicit stages.
    ///
    /// # Errors
    /// As [`Self::integrator`], located at `time.scheme`.
    pub fn kernel(&self) -> Result<Box<dyn Kernel>, Vec<Problem>> {
        if self.is_static() {
            return Ok(Box::new(Static));
        }
        self.integrator().map(Integrator::into_kernel).map_err(|error| {
            let path = format!("time.scheme.{}", error.key());
            vec![Problem::new(path, "the scheme cannot be used", error.to_string(), "carom explain lists schemes")]
        })
    }
}

/// The stepper of a case.
///
/// # Errors
/// As [`SchemeSpec::kernel`].
pub(crate) fn stepper<const D: usize>(case: &Case, model: &Model<D>) -> Result<Box<dyn Stepper<D>>, Vec<Problem>> {
    Ok(match case.time.scheme.nonsmooth() {
        None => Box::new(Implicit::new(case.time.scheme.kernel()?, case.newton.clone())),
        Some(Nonsmooth::Impulse(scheme)) => Box::new(Impulsive::new(scheme, case.newton.clone())),
        Some(_) => Box::new(Explicit::new(model)),
    })
}
