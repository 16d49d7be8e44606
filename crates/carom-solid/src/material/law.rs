//! The laws a body can be made of, for a choice at run time.

/// Choice of a law with Lamé's constants.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Law {
    NeoHookean { lambda: f64, mu: f64 },
    SaintVenantKirchhoff { lambda: f64, mu: f64 },
    LinearElastic { lambda: f64, mu: f64 },
}
