//! From a scheme's name in the case to the kernel that steps.

use carom_time::{Kernel, STATIC, Scheme, SchemeError, Static};

use crate::case::{Problem, SchemeSpec};

impl SchemeSpec {
    /// Whether it is equilibrium without inertia, with t as the load parameter.
    pub fn is_static(&self) -> bool {
        self.kind == STATIC
    }

    /// The scheme's parameters.
    ///
    /// # Errors
    /// Unknown kinds, missing, superfluous or inadmissible parameters.
    pub fn scheme(&self) -> Result<Scheme, SchemeError> {
        carom_time::scheme(&self.kind, &self.parameters, self.forces)
    }

    /// The scheme as a list of stages.
    ///
    /// # Errors
    /// As [`Self::scheme`], located at `time.scheme`.
    pub fn kernel(&self) -> Result<Box<dyn Kernel>, Vec<Problem>> {
        if self.is_static() {
            return Ok(Box::new(Static));
        }
        match self.scheme() {
            Ok(scheme) => Ok(Box::new(scheme)),
            Err(error) => {
                let path = format!("time.scheme.{}", error.key());
                Err(vec![Problem::new(
                    path,
                    "the scheme cannot be used",
                    error.to_string(),
                    "carom explain lists schemes",
                )])
            }
        }
    }
}
