//! Triangles of a .msh file as a rigid surface: those of a physical surface, or all.

use super::error::{Fault, MshError};
use super::file::{Block, MshFile};
use crate::triangles::{Triangles, TrianglesError};

/// Why a file gave no surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// It has no such cells.
    #[error("{0}")]
    File(MshError),
    /// The triangles are not a surface.
    #[error("{0}")]
    Surface(TrianglesError),
}

/// Gmsh's number of triangles of order 1.
const TRIANGLE: i64 = 2;

impl MshFile {
    /// The triangles of a physical surface, or all of the file, in the order of the file.
    ///
    /// # Errors
    /// An unknown name, cells other than triangles of order 1, triangles that are not a surface.
    pub fn triangles(&self, name: Option<&str>) -> Result<Triangles, SurfaceError> {
        let blocks: Vec<&Block> = match name {
            None => self.blocks.iter().filter(|block| block.kind.dimension() == 2).collect(),
            Some(name) if self.names(2).contains(&name) => self.blocks(2, name).collect(),
            Some(name) => return Err(SurfaceError::File(MshError::whole(self.no_name(2, name)))),
        };
        let mut points = Vec::new();
        let mut corners = Vec::new();
        let mut number = vec![usize::MAX; self.nodes.len()];
        for block in blocks {
            for (row, nodes) in block.cells() {
                if block.kind.number != TRIANGLE {
                    let cell = row.tag;
                    let kind = block.kind.described();
                    return Err(SurfaceError::File(self.at(row, Fault::NoTriangle { cell, kind })));
                }
                let mut triangle = [0; 3];
                for (corner, &node) in triangle.iter_mut().zip(nodes) {
                    if number[node] == usize::MAX {
                        number[node] = points.len();
                        points.push(self.nodes[node].1);
                    }
                    *corner = number[node];
                }
                corners.push(triangle);
            }
        }
        Triangles::new(points, corners).map_err(SurfaceError::Surface)
    }
}
