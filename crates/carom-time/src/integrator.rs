//! What a name in the catalogue stands for: a member of the α family, whose analysis is closed, or any other list of stages, whose analysis is numeric.
use crate::explain::{Explanation, explain, explain_kernel};
use crate::names::Name;
use crate::scheme::Scheme;
use crate::stage::Kernel;

/// An integrator of the catalogue.
#[derive(Debug)]
pub enum Integrator {
    /// A member of the α family.
    Alpha(Scheme),
    /// Another implicit kernel, and the name it was asked for by.
    Stages(Box<dyn Kernel>, Name),
}

impl Integrator {
    /// The list of stages.
    pub fn kernel(&self) -> &dyn Kernel {
        match self {
            Self::Alpha(scheme) => scheme,
            Self::Stages(kernel, _) => &**kernel,
        }
    }

    /// The list of stages, to keep.
    pub fn into_kernel(self) -> Box<dyn Kernel> {
        match self {
            Self::Alpha(scheme) => Box::new(scheme),
            Self::Stages(kernel, _) => kernel,
        }
    }

    /// Its four parameters, where it is of the α family.
    pub fn alpha(&self) -> Option<Scheme> {
        match self {
            Self::Alpha(scheme) => Some(*scheme),
            Self::Stages(..) => None,
        }
    }

    /// All that is known of it.
    pub fn explain(&self) -> Explanation {
        match self {
            Self::Alpha(scheme) => explain(scheme),
            Self::Stages(kernel, name) => explain_kernel(&**kernel, name),
        }
    }
}
