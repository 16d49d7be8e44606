//! From a scheme's name in the case to the kernel that steps.

use carom_time::{Integrator, Kernel, STATIC, SchemeError, Static};

use crate::case::{Problem, SchemeSpec};

impl SchemeSpec {
    /// Whether it is equilibrium without inertia, with t as the load parameter.
    pub fn is_static(&self) -> bool {
        self.kind == STATIC
    }

    /// The scheme by its name and parameters; the static one is none of them.
    ///
    /// # Errors
    /// Unknown kinds, missing, superfluous or inadmissible parameters.
    pub fn integrator(&self) -> Result<Integrator, SchemeError> {
        carom_time::scheme(&self.kind, &self.parameters, self.forces)
    }

    /// Whether it is of the α family, where a contact force may be averaged over the step.
    pub fn is_alpha(&self) -> bool {
        self.integrator().is_ok_and(|integrator| integrator.alpha().is_some())
    }

    /// The scheme as a list of stages.
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
