//! The explanation of an integrator of the catalogue, for every family.

use std::fmt::{Display, Formatter, Result};

use serde::Serialize;

use crate::explain::{Explanation, explain_alpha, explain_kernel};
use crate::integrator::Integrator;
use crate::nonsmooth_text::{NonsmoothExplanation, explain_nonsmooth};

/// The explanation of an integrator.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Explained {
    /// A list of implicit stages.
    Stages(Box<Explanation>),
    /// A scheme with its own contact law.
    Nonsmooth(NonsmoothExplanation),
}

impl Display for Explained {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::Stages(explanation) => explanation.fmt(f),
            Self::Nonsmooth(explanation) => explanation.fmt(f),
        }
    }
}

impl Integrator {
    /// Everything known of the integrator.
    ///
    /// ```
    /// use carom_time::{Explained, ForceRule, scheme};
    /// let made = scheme("central-difference", &[].into(), ForceRule::default())?;
    /// assert!(matches!(made.explain(), Explained::Nonsmooth(properties) if properties.order == 2 && properties.stable_omega_dt == Some(2.0)));
    /// # Ok::<(), carom_time::SchemeError>(())
    /// ```
    pub fn explain(&self) -> Explained {
        match self {
            Self::Alpha(scheme, name) => Explained::Stages(Box::new(explain_alpha(scheme, name))),
            Self::Stages(kernel, name) => Explained::Stages(Box::new(explain_kernel(&**kernel, name))),
            Self::Nonsmooth(scheme, name) => Explained::Nonsmooth(explain_nonsmooth(scheme, name)),
        }
    }
}
