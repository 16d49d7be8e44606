//! From a scheme's name in the case to the kernel that steps.

use carom_time::{Kernel, Scheme, SchemeError};

use crate::case::{Problem, SchemeSpec};

impl SchemeSpec {
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
