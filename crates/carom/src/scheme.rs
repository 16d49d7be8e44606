//! From a scheme's name in the case to what steps: a kernel of implicit stages, or a scheme with a contact law of its own.

use carom_time::{Integrator, Kernel, Nonsmooth, STATIC, SchemeError};

use crate::case::{Case, ContactLaw, Problem, SchemeSpec};
use crate::model::Model;
use crate::stepper::{Explicit, Implicit, Impulsive, Stepper};

impl SchemeSpec {
    /// Whether it is equilibrium without inertia, with t as the load parameter.
    pub fn is_static(&self) -> bool {
        self.kind == STATIC
    }

    /// The scheme by its name and parameters.
    ///
    /// # Errors
    /// Unknown kinds, missing, superfluous or inadmissible parameters.
    pub fn integrator(&self) -> Result<Integrator, SchemeError> {
        carom_time::scheme(&self.kind, &self.parameters, self.forces)
    }

    /// The scheme with a contact law of its own; `None` where the kind is none of these.
    pub fn nonsmooth(&self) -> Option<Nonsmooth> {
        match self.integrator() {
            Ok(Integrator::Nonsmooth(scheme, _)) => Some(scheme),
            _ => None,
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
        matches!(self.nonsmooth(), Some(Nonsmooth::Explicit(_)))
    }

    /// The scheme as a list of implicit stages; `None` where it cannot be used or contact is not a force in their balance.
    pub fn kernel(&self) -> Option<Box<dyn Kernel>> {
        self.integrator().ok()?.into_kernel()
    }
}

/// The stepper of a case.
///
/// # Errors
/// As [`SchemeSpec::integrator`], located at `time.scheme`.
pub(crate) fn stepper<const D: usize>(case: &Case, model: &Model<D>) -> Result<Box<dyn Stepper<D>>, Vec<Problem>> {
    let newton = || case.newton.clone();
    let integrator = case.time.scheme.integrator().map_err(|error| {
        let path = format!("time.scheme.{}", error.key());
        vec![Problem::new(path, "the scheme cannot be used", error.to_string(), "carom explain lists schemes")]
    })?;
    Ok(match integrator {
        Integrator::Alpha(scheme, _) => Box::new(Implicit::new(Box::new(scheme), newton())),
        Integrator::Stages(kernel, _) => Box::new(Implicit::new(kernel, newton())),
        Integrator::Nonsmooth(Nonsmooth::Impulse(scheme), _) => Box::new(Impulsive::new(scheme, newton())),
        Integrator::Nonsmooth(Nonsmooth::Explicit(_), _) => Box::new(Explicit::new(model)),
    })
}
