//! The available laws, chosen at run time.

/// A law with Lamé's constants.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Law {
    NeoHookean { lambda: f64, mu: f64 },
    SaintVenantKirchhoff { lambda: f64, mu: f64 },
    LinearElastic { lambda: f64, mu: f64 },
}
