//! The available laws, chosen at run time.

use super::{
    Hencky, Isochoric, LinearElastic, MooneyRivlin, NeoHookean, Pointwise, SaintVenantKirchhoff, Yeoh,
};

/// An elastic law with its constants.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Law {
    NeoHookean { lambda: f64, mu: f64 },
    SaintVenantKirchhoff { lambda: f64, mu: f64 },
    LinearElastic { lambda: f64, mu: f64 },
    Hencky { lambda: f64, mu: f64 },
    MooneyRivlin(Isochoric<MooneyRivlin>),
    Yeoh(Isochoric<Yeoh>),
}

impl Law {
    /// The law at the points of a body of one dimension.
    pub(crate) fn pointwise<const D: usize>(self) -> Box<dyn Pointwise<D>> {
        match self {
            Self::NeoHookean { lambda, mu } => Box::new(NeoHookean { lambda, mu }),
            Self::SaintVenantKirchhoff { lambda, mu } => Box::new(SaintVenantKirchhoff { lambda, mu }),
            Self::LinearElastic { lambda, mu } => Box::new(LinearElastic { lambda, mu }),
            Self::Hencky { lambda, mu } => Box::new(Hencky { lambda, mu }),
            Self::MooneyRivlin(law) => Box::new(law),
            Self::Yeoh(law) => Box::new(law),
        }
    }
}
