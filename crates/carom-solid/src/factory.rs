//! Builds a body, whose shape is a compile-time type, from a mesh and a law known at run time.

use crate::body::Body;
use crate::element_shape::of_shape;
use crate::material::{
    Law, LinearElastic, Material, NeoHookean, PlaneStress, Pointwise, SaintVenantKirchhoff, Thickness,
};
use crate::mesh::{Element, Mesh};
use crate::shape::{Hex8, Quad4, Shape};
use crate::solid::{Solid, SolidError};

/// A law that bodies of every shape can be made of: each [`Material`] that is known in every
/// dimension, your own included.
pub trait Constitutive: Send + Sync {
    /// Body of a mesh of any dimension; plane strain in the plane. `thickness` is the area of the
    /// cross-section in dimension 1; it is not used in space.
    ///
    /// # Errors
    /// If a number is out of range, a cell is degenerate, or the element has another dimension than
    /// the mesh.
    fn body(&self, mesh: Mesh, density: f64, thickness: f64) -> Result<Box<dyn Body>, SolidError>;

    /// Body in plane stress. `thickness` is that of the undeformed sheet.
    ///
    /// # Errors
    /// As [`Constitutive::body`], and for a mesh that is not plane.
    fn plane_stress_body(
        &self,
        mesh: Mesh,
        density: f64,
        thickness: f64,
    ) -> Result<Box<dyn Body>, SolidError>;
}

impl<L: Material<1> + Material<2> + Thickness + Clone> Constitutive for L {
    fn body(&self, mesh: Mesh, density: f64, thickness: f64) -> Result<Box<dyn Body>, SolidError> {
        let element = mesh.element;
        match element.dimension() {
            1 => {
                let other = SolidError::Dimension { element, dimension: 1 };
                of_shape!(1, element, solid(mesh, Box::new(self.clone()), density, thickness), Err(other))
            }
            2 => plane(mesh, Box::new(self.clone()), density, thickness),
            // Solids in space have no thickness.
            _ => {
                let other = SolidError::Dimension { element, dimension: 3 };
                of_shape!(3, element, solid(mesh, Box::new(self.clone()), density, 1.0), Err(other))
            }
        }
    }

    fn plane_stress_body(
        &self,
        mesh: Mesh,
        density: f64,
        thickness: f64,
    ) -> Result<Box<dyn Body>, SolidError> {
        plane(mesh, Box::new(PlaneStress(self.clone())), density, thickness)
    }
}

impl Law {
    /// The law as a type that makes bodies.
    ///
    /// ```
    /// use carom_solid::{Element, Law, generate};
    /// let mesh = generate::rectangle(Element::T6, [0.0, 0.0], [2.0, 1.0], [4, 2])?;
    /// let rubber = Law::NeoHookean { lambda: 200.0, mu: 15.0 }.constitutive();
    /// assert_eq!(rubber.body(mesh, 0.25, 1.0)?.mesh().cell_count(), 16);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn constitutive(self) -> Box<dyn Constitutive> {
        match self {
            Self::NeoHookean { lambda, mu } => Box::new(NeoHookean { lambda, mu }),
            Self::SaintVenantKirchhoff { lambda, mu } => Box::new(SaintVenantKirchhoff { lambda, mu }),
            Self::LinearElastic { lambda, mu } => Box::new(LinearElastic { lambda, mu }),
        }
    }
}

/// [`Constitutive::body`] of a law.
///
/// # Errors
/// As there.
pub fn body(mesh: Mesh, law: Law, density: f64, thickness: f64) -> Result<Box<dyn Body>, SolidError> {
    law.constitutive().body(mesh, density, thickness)
}

/// [`Constitutive::plane_stress_body`] of a law.
///
/// # Errors
/// As there.
pub fn plane_stress_body(
    mesh: Mesh,
    law: Law,
    density: f64,
    thickness: f64,
) -> Result<Box<dyn Body>, SolidError> {
    law.constitutive().plane_stress_body(mesh, density, thickness)
}

/// Body whose volumetric energy depends on one measure of the change of volume of each cell
/// (`solid/mean.rs`): quadrilaterals and hexahedra of degree 1, in plane strain or in space.
///
/// # Errors
/// As [`Constitutive::body`]; for another element, of which F is constant in a cell or the pressure
/// would be too coarse.
pub fn mean_dilatation_body(
    mesh: Mesh,
    law: Law,
    density: f64,
    thickness: f64,
) -> Result<Box<dyn Body>, SolidError> {
    match mesh.element {
        Element::Q4 => Ok(Box::new(Solid::<2, 4, Quad4>::averaged(mesh, law, density, thickness)?)),
        Element::Hex8 => Ok(Box::new(Solid::<3, 8, Hex8>::averaged(mesh, law, density, 1.0)?)),
        element => Err(SolidError::NoMeanDilatation { element }),
    }
}

fn plane(
    mesh: Mesh,
    law: Box<dyn Pointwise<2>>,
    density: f64,
    thickness: f64,
) -> Result<Box<dyn Body>, SolidError> {
    let element = mesh.element;
    let other = SolidError::Dimension { element, dimension: 2 };
    of_shape!(2, element, solid(mesh, law, density, thickness), Err(other))
}

fn solid<const D: usize, const N: usize, S: Shape<D, N>>(
    mesh: Mesh,
    law: Box<dyn Pointwise<D>>,
    density: f64,
    thickness: f64,
) -> Result<Box<dyn Body>, SolidError> {
    Ok(Box::new(Solid::<D, N, S>::new(mesh, law, density, thickness)?))
}
