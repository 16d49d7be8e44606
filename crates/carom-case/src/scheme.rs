//! A scheme by its name in the case: a kernel of implicit stages, or a scheme with its own contact
//! law.

use carom_time::{Integrator, Kernel, Nonsmooth, STATIC, SchemeError};

use crate::{ContactLaw, SchemeSpec};

/// The scheme of discrete gradients.
const ENERGY_MOMENTUM: &str = "energy-momentum";

impl SchemeSpec {
    /// Whether it is static: equilibrium without inertia, with t as the load parameter.
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

    /// The scheme as one with its own contact law; none if it has no such law.
    pub fn nonsmooth(&self) -> Option<Nonsmooth> {
        match self.integrator() {
            Ok(Integrator::Nonsmooth(scheme, _)) => Some(scheme),
            _ => None,
        }
    }

    /// Whether the scheme is of the generalised-α family, where a contact force may be averaged
    /// over the step.
    pub fn is_alpha(&self) -> bool {
        self.integrator().is_ok_and(|integrator| integrator.alpha().is_some())
    }

    /// Whether the internal forces of the scheme are a discrete gradient that conserves energy;
    /// contact springs then conserve energy too.
    pub fn conserves(&self) -> bool {
        self.kind == ENERGY_MOMENTUM
    }

    /// Default contact law of the scheme: velocities for schemes with impulses, positions for
    /// others.
    pub fn contact_law(&self) -> ContactLaw {
        match self.nonsmooth() {
            Some(Nonsmooth::Impulse(_)) => ContactLaw::Velocity,
            _ => ContactLaw::Position,
        }
    }

    /// Whether no linear system is solved, so that the mass must be diagonal and the step short.
    pub fn is_explicit(&self) -> bool {
        matches!(self.nonsmooth(), Some(Nonsmooth::Explicit(_)))
    }

    /// The scheme as a list of implicit stages; `None` if its parameters are invalid, or if contact
    /// is not a force in the balance of the stages.
    pub fn kernel(&self) -> Option<Box<dyn Kernel>> {
        self.integrator().ok()?.into_kernel()
    }
}
