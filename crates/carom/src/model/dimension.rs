//! What differs between a line and a plane when a case becomes a model: shapes, element types and how two sides touch.
//! A new built-in shape or a new contact method is one line here.

use carom_contact::{ContactMethod, NodeToNode, NodeToSegment, Surface};
use carom_solid::generate::{self, Refinement};
use carom_solid::{Body, Law, Mesh, SolidError};

use crate::case::mesh_file;
use crate::case::{BodySpec, ContactSpec, Detection, MeshSpec, Plane, RefineSpec};

/// A space of dimension `D` that cases can be computed in.
pub trait Dimension<const D: usize> {
    /// Mesh of a body where the case puts it, or why there is none.
    fn mesh(spec: &BodySpec) -> Result<Mesh<D>, String> {
        let mut mesh = Self::unplaced(spec)?;
        if let Some(place) = &spec.place {
            place.apply(&mut mesh);
        }
        Ok(mesh)
    }

    /// Mesh of a body as its shape or file has it.
    fn unplaced(spec: &BodySpec) -> Result<Mesh<D>, String>;

    /// Body of a mesh; the plane state is that of dimension 2.
    fn body(
        mesh: Mesh<D>,
        law: Law,
        plane: Plane,
        density: f64,
        thickness: f64,
    ) -> Result<Box<dyn Body<D>>, SolidError>;

    /// Contact of two sides: secondary nodes, primary facets, and in dimension 1 the direction out of the primary.
    fn between(
        spec: &ContactSpec,
        secondary: &[usize],
        primary: &[Vec<usize>],
        outward: f64,
    ) -> Box<dyn ContactMethod<D>>;
}

/// Carries the implementations.
pub struct Space;

impl Dimension<1> for Space {
    fn unplaced(spec: &BodySpec) -> Result<Mesh<1>, String> {
        match spec.mesh {
            MeshSpec::Interval { min, max, cells } => {
                generate::interval(spec.element, min, max, cells).map_err(|e| e.to_string())
            }
            MeshSpec::File { ref file, ref surface, ref hash, .. } => mesh_file::mesh(file, surface, hash),
            _ => Err("this shape needs dimension = 2".into()),
        }
    }

    fn body(mesh: Mesh<1>, law: Law, _: Plane, density: f64, thickness: f64) -> Result<Box<dyn Body<1>>, SolidError> {
        carom_solid::body(mesh, law, density, thickness)
    }

    fn between(
        _: &ContactSpec,
        secondary: &[usize],
        primary: &[Vec<usize>],
        outward: f64,
    ) -> Box<dyn ContactMethod<1>> {
        Box::new(NodeToNode::new(secondary[0], primary[0][0], outward))
    }
}

impl Dimension<2> for Space {
    fn unplaced(spec: &BodySpec) -> Result<Mesh<2>, String> {
        match spec.mesh {
            MeshSpec::File { ref file, ref surface, ref hash, .. } => return mesh_file::mesh(file, surface, hash),
            MeshSpec::Interval { .. } => return Err("shape \"interval\" needs dimension = 1".into()),
            MeshSpec::Rectangle { min, max, cells } => generate::rectangle(spec.element, min, max, cells),
            MeshSpec::Disc { radius, center, size } => generate::disc(spec.element, radius, center, size),
            MeshSpec::HalfDisc { radius, center, size } => generate::half_disc(spec.element, radius, center, size),
            MeshSpec::Ring { inner, outer, center, size } => generate::ring(spec.element, inner, outer, center, size),
            MeshSpec::Polygon { ref points, size, ref refine } => {
                let place = |r: &RefineSpec| Refinement { near: r.near, radius: r.radius, size: r.size };
                generate::polygon(spec.element, points, size, &refine.iter().map(place).collect::<Vec<_>>())
            }
        }
        .map_err(|e| e.to_string())
    }

    fn body(
        mesh: Mesh<2>,
        law: Law,
        plane: Plane,
        density: f64,
        thickness: f64,
    ) -> Result<Box<dyn Body<2>>, SolidError> {
        match plane {
            Plane::Strain => carom_solid::body(mesh, law, density, thickness),
            Plane::Stress => carom_solid::plane_stress_body(mesh, law, density, thickness),
        }
    }

    fn between(spec: &ContactSpec, secondary: &[usize], primary: &[Vec<usize>], _: f64) -> Box<dyn ContactMethod<2>> {
        let detection = match spec.detection {
            Detection::ClosestPoint => carom_contact::Detection::ClosestPoint,
            Detection::Trajectory => carom_contact::Detection::Trajectory,
        };
        Box::new(NodeToSegment::new(secondary.to_vec(), Surface::new(primary), detection))
    }
}
