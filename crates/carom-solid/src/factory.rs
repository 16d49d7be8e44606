//! From a mesh and a law, known when a case has been read, to a body whose shape and law were known when Carom was compiled.

use crate::body::Body;
use crate::material::{Law, LinearElastic, Material, NeoHookean, PlaneStress, SaintVenantKirchhoff};
use crate::mesh::{Element, Mesh};
use crate::shape::{Line2, Line3, Line4, Shape, Tri3, Tri6, Tri10};
use crate::solid::{Solid, SolidError};

/// Body of a mesh: `Mesh<1>` and `Mesh<2>` can be made one. `thickness` is the area of the cross-section in dimension 1.
///
/// ```
/// use carom_solid::{Element, Law, body, generate};
/// let mesh = generate::rectangle(Element::T6, [0.0, 0.0], [2.0, 1.0], [4, 2])?;
/// let prism = body(mesh, Law::NeoHookean { lambda: 200.0, mu: 15.0 }, 0.25, 1.0)?;
/// assert_eq!(prism.mesh().cell_count(), 16);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If a number is out of its range, a cell is degenerate, or the element has another dimension than the space.
pub fn body<const D: usize>(
    mesh: Mesh<D>,
    law: Law,
    density: f64,
    thickness: f64,
) -> Result<Box<dyn Body<D>>, SolidError>
where
    Mesh<D>: Cells<D>,
{
    match law {
        Law::NeoHookean { lambda, mu } => mesh.with(NeoHookean { lambda, mu }, density, thickness),
        Law::SaintVenantKirchhoff { lambda, mu } => mesh.with(SaintVenantKirchhoff { lambda, mu }, density, thickness),
        Law::LinearElastic { lambda, mu } => mesh.with(LinearElastic { lambda, mu }, density, thickness),
    }
}

/// Body in plane stress; [`body`] makes one in plane strain. `thickness` is that of the undeformed sheet.
///
/// # Errors
/// As [`body`].
pub fn plane_stress_body(
    mesh: Mesh<2>,
    law: Law,
    density: f64,
    thickness: f64,
) -> Result<Box<dyn Body<2>>, SolidError> {
    match law {
        Law::NeoHookean { lambda, mu } => mesh.with(PlaneStress(NeoHookean { lambda, mu }), density, thickness),
        Law::SaintVenantKirchhoff { lambda, mu } => {
            mesh.with(PlaneStress(SaintVenantKirchhoff { lambda, mu }), density, thickness)
        }
        Law::LinearElastic { lambda, mu } => mesh.with(PlaneStress(LinearElastic { lambda, mu }), density, thickness),
    }
}

/// A mesh in a space whose elements have shape functions.
pub trait Cells<const D: usize> {
    /// Body of the mesh with a law.
    fn with<L: Material<D>>(self, law: L, density: f64, thickness: f64) -> Result<Box<dyn Body<D>>, SolidError>;
}

impl Cells<1> for Mesh<1> {
    fn with<L: Material<1>>(self, law: L, density: f64, thickness: f64) -> Result<Box<dyn Body<1>>, SolidError> {
        match self.element {
            Element::L2 => solid::<1, 2, Line2, L>(self, law, density, thickness),
            Element::L3 => solid::<1, 3, Line3, L>(self, law, density, thickness),
            Element::L4 => solid::<1, 4, Line4, L>(self, law, density, thickness),
            element => Err(SolidError::Dimension { element, dimension: 1 }),
        }
    }
}

impl Cells<2> for Mesh<2> {
    fn with<L: Material<2>>(self, law: L, density: f64, thickness: f64) -> Result<Box<dyn Body<2>>, SolidError> {
        match self.element {
            Element::T3 => solid::<2, 3, Tri3, L>(self, law, density, thickness),
            Element::T6 => solid::<2, 6, Tri6, L>(self, law, density, thickness),
            Element::T10 => solid::<2, 10, Tri10, L>(self, law, density, thickness),
            element => Err(SolidError::Dimension { element, dimension: 2 }),
        }
    }
}

fn solid<const D: usize, const N: usize, S: Shape<D, N>, L: Material<D>>(
    mesh: Mesh<D>,
    law: L,
    density: f64,
    thickness: f64,
) -> Result<Box<dyn Body<D>>, SolidError> {
    Ok(Box::new(Solid::<D, N, S, L>::new(mesh, law, density, thickness)?))
}
