//! What a name in the catalogue stands for: a member of the α family, whose analysis is closed, any other list of stages, whose analysis is numeric, or a scheme
//! with a contact law of its own.
use std::fmt::{Display, Formatter, Result};

use serde::Serialize;

use crate::explain::{Explanation, explain_alpha, explain_kernel};
use crate::names::Name;
use crate::nonsmooth::Nonsmooth;
use crate::nonsmooth_text::{NonsmoothExplanation, explain_nonsmooth};
use crate::scheme::Scheme;
use crate::stage::Kernel;

/// An integrator of the catalogue.
#[derive(Debug)]
pub enum Integrator {
    /// A member of the α family, and the name it was asked for by.
    Alpha(Scheme, Name),
    /// Another implicit kernel, and its name.
    Stages(Box<dyn Kernel>, Name),
    /// Explicit or with impulses, and its name.
    Nonsmooth(Nonsmooth, Name),
}

/// All that is known of an integrator.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Explained {
    /// A list of implicit stages.
    Stages(Box<Explanation>),
    /// A scheme with a contact law of its own.
    Nonsmooth(NonsmoothExplanation),
}

impl Display for Explained {
    fn fmt(&self, f: &mut Formatter) -> Result {
        match self {
            Self::Stages(told) => told.fmt(f),
            Self::Nonsmooth(told) => told.fmt(f),
        }
    }
}

impl Integrator {
    /// The list of stages; none where contact is not a force in their balance.
    pub fn kernel(&self) -> Option<&dyn Kernel> {
        match self {
            Self::Alpha(scheme, _) => Some(scheme),
            Self::Stages(kernel, _) => Some(&**kernel),
            Self::Nonsmooth(..) => None,
        }
    }

    /// The list of stages, to keep.
    pub fn into_kernel(self) -> Option<Box<dyn Kernel>> {
        match self {
            Self::Alpha(scheme, _) => Some(Box::new(scheme)),
            Self::Stages(kernel, _) => Some(kernel),
            Self::Nonsmooth(..) => None,
        }
    }

    /// Its four parameters, where it is of the α family.
    pub fn alpha(&self) -> Option<Scheme> {
        match self {
            Self::Alpha(scheme, _) => Some(*scheme),
            _ => None,
        }
    }

    /// All that is known of it.
    ///
    /// ```
    /// use carom_time::{Explained, ForceRule, scheme};
    /// let made = scheme("central-difference", &[].into(), ForceRule::default())?;
    /// assert!(matches!(made.explain(), Explained::Nonsmooth(told) if told.order == 2 && told.stable_omega_dt == Some(2.0)));
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
