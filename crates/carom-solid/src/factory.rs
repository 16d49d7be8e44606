//! Builds a body, whose shape and law are compile-time types, from a mesh and a law known at run
//! time.

use crate::body::Body;
use crate::material::{Law, LinearElastic, Material, NeoHookean, PlaneStress, SaintVenantKirchhoff};
use crate::mesh::{Element, Mesh};
use crate::shape::{Line2, Line3, Line4, Shape, Tri3, Tri6, Tri10};
use crate::solid::{Solid, SolidError};

/// Body of a mesh of any dimension; plane strain in the plane. `thickness` is the area of the
/// cross-section in dimension 1.
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
/// If a number is out of range, a cell is degenerate, or the element has another dimension than the
/// mesh.
pub fn body(mesh: Mesh, law: Law, density: f64, thickness: f64) -> Result<Box<dyn Body>, SolidError> {
    match law {
        Law::NeoHookean { lambda, mu } => any(mesh, NeoHookean { lambda, mu }, density, thickness),
        Law::SaintVenantKirchhoff { lambda, mu } => {
            any(mesh, SaintVenantKirchhoff { lambda, mu }, density, thickness)
        }
        Law::LinearElastic { lambda, mu } => any(mesh, LinearElastic { lambda, mu }, density, thickness),
    }
}

/// Body in plane stress. `thickness` is that of the undeformed sheet.
///
/// # Errors
/// As [`body`], and for a mesh that is not plane.
pub fn plane_stress_body(
    mesh: Mesh,
    law: Law,
    density: f64,
    thickness: f64,
) -> Result<Box<dyn Body>, SolidError> {
    match law {
        Law::NeoHookean { lambda, mu } => {
            plane(mesh, PlaneStress(NeoHookean { lambda, mu }), density, thickness)
        }
        Law::SaintVenantKirchhoff { lambda, mu } => {
            plane(mesh, PlaneStress(SaintVenantKirchhoff { lambda, mu }), density, thickness)
        }
        Law::LinearElastic { lambda, mu } => {
            plane(mesh, PlaneStress(LinearElastic { lambda, mu }), density, thickness)
        }
    }
}

/// Body of a law defined in every dimension.
fn any<L>(mesh: Mesh, law: L, density: f64, thickness: f64) -> Result<Box<dyn Body>, SolidError>
where
    L: Material<1> + Material<2> + Material<3>,
{
    match mesh.element {
        Element::L2 => solid::<1, 2, Line2, L>(mesh, law, density, thickness),
        Element::L3 => solid::<1, 3, Line3, L>(mesh, law, density, thickness),
        Element::L4 => solid::<1, 4, Line4, L>(mesh, law, density, thickness),
        Element::T3 | Element::T6 | Element::T10 => plane(mesh, law, density, thickness),
        #[cfg(test)]
        Element::Tet4 => solid::<3, 4, crate::shape::Tet4, L>(mesh, law, density, thickness),
    }
}

/// Body of a law defined in the plane.
fn plane<L: Material<2>>(
    mesh: Mesh,
    law: L,
    density: f64,
    thickness: f64,
) -> Result<Box<dyn Body>, SolidError> {
    match mesh.element {
        Element::T3 => solid::<2, 3, Tri3, L>(mesh, law, density, thickness),
        Element::T6 => solid::<2, 6, Tri6, L>(mesh, law, density, thickness),
        Element::T10 => solid::<2, 10, Tri10, L>(mesh, law, density, thickness),
        element => Err(SolidError::Dimension { element, dimension: 2 }),
    }
}

fn solid<const D: usize, const N: usize, S: Shape<D, N>, L: Material<D>>(
    mesh: Mesh,
    law: L,
    density: f64,
    thickness: f64,
) -> Result<Box<dyn Body>, SolidError> {
    Ok(Box::new(Solid::<D, N, S, L>::new(mesh, law, density, thickness)?))
}
