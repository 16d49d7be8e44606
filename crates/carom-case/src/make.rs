//! The mesh of a body: generated from its shape or read from its file, then placed. A new built-in
//! shape is one line here.

use carom_solid::generate::{self, Refinement};
use carom_solid::{Element, Mesh};

use crate::no_mesh::NoMesh;
use crate::spec::PLANES;
use crate::{BodySpec, MeshSpec, RefineSpec};

impl BodySpec {
    /// Makes the mesh of the body in a case of this dimension.
    ///
    /// # Errors
    /// Why it cannot be made.
    pub fn make_mesh(&self, dimension: usize) -> Result<Mesh, NoMesh> {
        let mut mesh = match self.mesh {
            MeshSpec::File(ref file) => file.mesh(dimension)?,
            MeshSpec::Interval { .. } if dimension != 1 => {
                return Err(NoMesh::Dimension(1));
            }
            MeshSpec::Interval { min, max, cells } => generate::interval(self.element, min, max, cells)?,
            MeshSpec::Box { min, max, cells, .. } if dimension == 3 => {
                generate::cuboid(self.element, min, max, cells)?
            }
            MeshSpec::Ball { radius, center, size, symmetry } if dimension == 3 => {
                generate::ball(self.element, radius, center, size, symmetry)?
            }
            MeshSpec::Cylinder { radius, height, center, axis, size, symmetry } if dimension == 3 => {
                let cylinder =
                    |frame| generate::cylinder(self.element, radius, height, &frame, size, symmetry);
                generate::Frame::along(axis, center).and_then(cylinder)?
            }
            MeshSpec::Tube { inner, outer, height, center, axis, size, symmetry } if dimension == 3 => {
                let tube =
                    |frame| generate::tube(self.element, [inner, outer], height, &frame, size, symmetry);
                generate::Frame::along(axis, center).and_then(tube)?
            }
            MeshSpec::Extrusion { ref of, height, layers, symmetry } if dimension == 3 => {
                let element = generate::plane_of(self.element).ok_or(NoMesh::Extrusion(self.element))?;
                let low = if symmetry[2] { 0.5 * height } else { 0.0 };
                let mut mesh = generate::extrusion(&plane_mesh(of, element)?, height - low, layers)?;
                mesh.nodes.iter_mut().for_each(|x| x[2] += low);
                mesh
            }
            MeshSpec::Box { .. }
            | MeshSpec::Ball { .. }
            | MeshSpec::Cylinder { .. }
            | MeshSpec::Tube { .. }
            | MeshSpec::Extrusion { .. } => return Err(NoMesh::Dimension(3)),
            _ if dimension != 2 => return Err(NoMesh::Dimension(2)),
            ref shape => plane_mesh(shape, self.element)?,
        };
        for (side, plane) in self.mesh.cut_sides().into_iter().zip(PLANES) {
            if let Some(facets) = side.and_then(|side| mesh.sides.remove(&side)) {
                mesh.sides.insert(plane.to_owned(), facets);
            }
        }
        if let Some(place) = &self.place {
            place.apply(&mut mesh);
        }
        Ok(mesh)
    }
}

/// The mesh of a shape of the plane, or of a file.
fn plane_mesh(shape: &MeshSpec, element: Element) -> Result<Mesh, NoMesh> {
    Ok(match *shape {
        MeshSpec::File(ref file) => return file.mesh(2),
        MeshSpec::Rectangle { min, max, cells, .. } => generate::rectangle(element, min, max, cells),
        MeshSpec::Disc { radius, center, size } => generate::disc(element, radius, center, size),
        MeshSpec::HalfDisc { radius, center, size } => generate::half_disc(element, radius, center, size),
        MeshSpec::Ring { inner, outer, center, size } => generate::ring(element, inner, outer, center, size),
        MeshSpec::Polygon { ref points, size, ref refine } => {
            let place = |r: &RefineSpec| Refinement { near: r.near, radius: r.radius, size: r.size };
            generate::polygon(element, points, size, &refine.iter().map(place).collect::<Vec<_>>())
        }
        _ => return Err(NoMesh::NotPlane),
    }?)
}
