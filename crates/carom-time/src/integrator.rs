//! The integrator behind a name of the catalogue: a member of the α family, with closed-form
//! analysis; another list of stages, with numeric analysis; or a scheme with its own contact law.

use crate::name::Name;
use crate::nonsmooth::Nonsmooth;
use crate::scheme::Scheme;
use crate::stage::Kernel;

/// An integrator of the catalogue.
#[derive(Debug)]
pub enum Integrator {
    /// A member of the α family, and the name by which it was requested.
    Alpha(Scheme, Name),
    /// Another implicit kernel, and its name.
    Stages(Box<dyn Kernel>, Name),
    /// Explicit or with impulses, and its name.
    Nonsmooth(Nonsmooth, Name),
}

impl Integrator {
    /// The list of stages; none if contact is not a force in their balance.
    pub fn kernel(&self) -> Option<&dyn Kernel> {
        match self {
            Self::Alpha(scheme, _) => Some(scheme),
            Self::Stages(kernel, _) => Some(&**kernel),
            Self::Nonsmooth(..) => None,
        }
    }

    /// The list of stages, by value.
    pub fn into_kernel(self) -> Option<Box<dyn Kernel>> {
        match self {
            Self::Alpha(scheme, _) => Some(Box::new(scheme)),
            Self::Stages(kernel, _) => Some(kernel),
            Self::Nonsmooth(..) => None,
        }
    }

    /// Its four parameters, if it is of the α family.
    pub fn alpha(&self) -> Option<Scheme> {
        match self {
            Self::Alpha(scheme, _) => Some(*scheme),
            _ => None,
        }
    }
}
