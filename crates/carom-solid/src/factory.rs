//! Builds a body, whose shape is a compile-time type, from a mesh and a law known at run time.

use crate::body::Body;
use crate::element_shape::of_shape;
use crate::material::{
    Hencky, J2, Law, LinearElastic, Material, Mean, NeoHookean, PlaneStress, Pointwise, SaintVenantKirchhoff,
    Thickness,
};
use crate::mesh::{Element, Mesh};
use crate::shape::{Hex8, Quad4, Shape};
use crate::solid::{Medium, Solid, SolidError};

/// A law that bodies of every shape can be made of: each [`Material`] that is known in every
/// dimension, your own included.
pub trait Constitutive: Send + Sync {
    /// The law in dimension 1: no strain across.
    fn along_line(&self) -> LawAtPoints<1>;

    /// The law in plane strain.
    fn in_plane_strain(&self) -> LawAtPoints<2>;

    /// The law in plane stress.
    fn in_plane_stress(&self) -> LawAtPoints<2>;

    /// The law in space.
    fn in_space(&self) -> LawAtPoints<3>;
}

/// A law compiled for the quadrature points of bodies of one dimension.
pub struct LawAtPoints<const D: usize>(Box<dyn Pointwise<D>>);

/// A law of which bodies with mean dilatation can be made.
pub trait VolumeAveraged {
    /// Parts of the law in plane strain.
    fn averaged_in_plane(&self) -> AveragedAtPoints<2>;

    /// Parts of the law in space.
    fn averaged_in_space(&self) -> AveragedAtPoints<3>;
}

/// A law without, and with, its resistance to changes of volume.
pub struct AveragedAtPoints<const D: usize> {
    rest: Box<dyn Pointwise<D>>,
    mean: Mean<D>,
}

impl VolumeAveraged for Law {
    fn averaged_in_plane(&self) -> AveragedAtPoints<2> {
        let (rest, mean) = self.averaged();
        AveragedAtPoints { rest: rest.pointwise(), mean }
    }

    fn averaged_in_space(&self) -> AveragedAtPoints<3> {
        let (rest, mean) = self.averaged();
        AveragedAtPoints { rest: rest.pointwise(), mean }
    }
}

impl VolumeAveraged for J2 {
    fn averaged_in_plane(&self) -> AveragedAtPoints<2> {
        let (rest, mean) = self.averaged();
        AveragedAtPoints { rest: Box::new(rest), mean }
    }

    fn averaged_in_space(&self) -> AveragedAtPoints<3> {
        let (rest, mean) = self.averaged();
        AveragedAtPoints { rest: Box::new(rest), mean }
    }
}

impl<L: VolumeAveraged + ?Sized> VolumeAveraged for &L {
    fn averaged_in_plane(&self) -> AveragedAtPoints<2> {
        (**self).averaged_in_plane()
    }

    fn averaged_in_space(&self) -> AveragedAtPoints<3> {
        (**self).averaged_in_space()
    }
}

/// Material of the cells of a region of a body.
#[derive(Clone, Copy, Debug)]
pub struct RegionMaterial<L> {
    /// Constitutive law.
    pub law: L,
    /// Density ρ₀ ≥ 0.
    pub density: f64,
}

/// Plane state of a two-dimensional body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaneState {
    /// No strain out of the plane.
    Strain,
    /// No stress out of the plane.
    Stress,
}

impl<L: Material<1> + Material<2> + Thickness + Clone + 'static> Constitutive for L {
    fn along_line(&self) -> LawAtPoints<1> {
        LawAtPoints(Box::new(self.clone()))
    }

    fn in_plane_strain(&self) -> LawAtPoints<2> {
        LawAtPoints(Box::new(self.clone()))
    }

    fn in_plane_stress(&self) -> LawAtPoints<2> {
        LawAtPoints(Box::new(PlaneStress(self.clone())))
    }

    fn in_space(&self) -> LawAtPoints<3> {
        LawAtPoints(Box::new(self.clone()))
    }
}

impl Law {
    /// The law as a type that makes bodies.
    ///
    /// ```
    /// use carom_solid::{Element, Law, generate};
    /// let mesh = generate::rectangle(Element::T6, [0.0, 0.0], [2.0, 1.0], [4, 2])?;
    /// let rubber = carom_solid::body(mesh, Law::NeoHookean { lambda: 200.0, mu: 15.0 }, 0.25, 1.0)?;
    /// assert_eq!(rubber.mesh().cell_count(), 16);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn constitutive(self) -> Box<dyn Constitutive> {
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

impl J2 {
    /// The law as a type that makes bodies. Compiled here, not where it is used: kernels need the
    /// optimisation of this crate.
    pub fn constitutive(self) -> Box<dyn Constitutive> {
        Box::new(self)
    }
}

/// Body of a mesh of any dimension, of one material; plane strain in the plane.
///
/// # Errors
/// As [`body_of_regions`].
pub fn body(mesh: Mesh, law: Law, density: f64, thickness: f64) -> Result<Box<dyn Body>, SolidError> {
    let law = &*law.constitutive();
    body_of_regions(mesh, &[RegionMaterial { law, density }], PlaneState::Strain, thickness)
}

/// Body of one material in plane stress.
///
/// # Errors
/// As [`body_of_regions`].
pub fn plane_stress_body(
    mesh: Mesh,
    law: Law,
    density: f64,
    thickness: f64,
) -> Result<Box<dyn Body>, SolidError> {
    let law = &*law.constitutive();
    body_of_regions(mesh, &[RegionMaterial { law, density }], PlaneState::Stress, thickness)
}

/// Body of a mesh of any dimension, with the materials of its regions. `thickness` is that of the
/// undeformed sheet in the plane and the area of the cross-section in dimension 1; it is not used
/// in space.
///
/// # Errors
/// If a number is out of range, a cell is degenerate, a region has no material, the element has
/// another dimension than the mesh, or a body in plane stress is not plane.
pub fn body_of_regions(
    mesh: Mesh,
    materials: &[RegionMaterial<&dyn Constitutive>],
    plane: PlaneState,
    thickness: f64,
) -> Result<Box<dyn Body>, SolidError> {
    let element = mesh.element;
    match (element.dimension(), plane) {
        (1, PlaneState::Strain) => {
            let media = media(materials, |law| law.along_line());
            let other = SolidError::Dimension { element, dimension: 1 };
            of_shape!(1, element, solid(mesh, media, thickness), Err(other))
        }
        (3, PlaneState::Strain) => {
            let media = media(materials, |law| law.in_space());
            let other = SolidError::Dimension { element, dimension: 3 };
            // Solids in space have no thickness.
            of_shape!(3, element, solid(mesh, media, 1.0), Err(other))
        }
        _ => {
            let media = media(materials, |law| match plane {
                PlaneState::Strain => law.in_plane_strain(),
                PlaneState::Stress => law.in_plane_stress(),
            });
            let other = SolidError::Dimension { element, dimension: 2 };
            of_shape!(2, element, solid(mesh, media, thickness), Err(other))
        }
    }
}

/// Body whose volumetric energy depends on one measure of the change of volume of each cell
/// (`solid/mean.rs`): quadrilaterals and hexahedra of degree 1, in plane strain or in space.
///
/// # Errors
/// As [`body_of_regions`]; for another element, of which F is constant in a cell or the pressure
/// would be too coarse.
pub fn mean_dilatation_body<L: VolumeAveraged>(
    mesh: Mesh,
    materials: &[RegionMaterial<L>],
    thickness: f64,
) -> Result<Box<dyn Body>, SolidError> {
    match mesh.element {
        Element::Q4 => {
            let media = averaged(materials, VolumeAveraged::averaged_in_plane);
            solid::<2, 4, Quad4>(mesh, media, thickness)
        }
        Element::Hex8 => {
            let media = averaged(materials, VolumeAveraged::averaged_in_space);
            solid::<3, 8, Hex8>(mesh, media, 1.0)
        }
        element => Err(SolidError::NoMeanDilatation { element }),
    }
}

fn media<const D: usize>(
    materials: &[RegionMaterial<&dyn Constitutive>],
    at_points: impl Fn(&dyn Constitutive) -> LawAtPoints<D>,
) -> Vec<Medium<D>> {
    let medium = |of: &RegionMaterial<&dyn Constitutive>| Medium {
        law: at_points(of.law).0,
        mean: None,
        density: of.density,
    };
    materials.iter().map(medium).collect()
}

fn averaged<const D: usize, L>(
    materials: &[RegionMaterial<L>],
    at_points: impl Fn(&L) -> AveragedAtPoints<D>,
) -> Vec<Medium<D>> {
    let medium = |of: &RegionMaterial<L>| {
        let AveragedAtPoints { rest, mean } = at_points(&of.law);
        Medium { law: rest, mean: Some(mean), density: of.density }
    };
    materials.iter().map(medium).collect()
}

fn solid<const D: usize, const N: usize, S: Shape<D, N>>(
    mesh: Mesh,
    media: Vec<Medium<D>>,
    thickness: f64,
) -> Result<Box<dyn Body>, SolidError> {
    Ok(Box::new(Solid::<D, N, S>::new(mesh, media, thickness)?))
}
