//! Rigid obstacles: how they move.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::formula::FormulaSpec;

/// A rigid triangulated surface, from a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceSpec {
    /// The file.
    pub file: PathBuf,
    /// The physical surface of a file from Gmsh; none: all of it.
    pub group: Option<String>,
    /// Factor of its coordinates, > 0.
    pub scale: f64,
    /// Whether its triangles are clockwise as seen from outside.
    pub reverse: bool,
    /// BLAKE3 of the file.
    pub hash: String,
    /// Number of its triangles.
    pub triangles: usize,
    /// Number of its edges with a triangle on one side only.
    pub rim: usize,
    /// Number of triangles between touching solids, which are no part of it.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub inner: usize,
}

#[allow(clippy::trivially_copy_pass_by_ref)] // as serde calls it
fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// Motion of a rigid primary.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ObstacleMotion {
    /// It does not move.
    #[default]
    Fixed,
    /// It follows formulas in t.
    Prescribed {
        /// Displacements by direction: 0 is x, 1 is y; the others are zero.
        moves: Vec<(usize, FormulaSpec)>,
        /// Rotation in degrees, counter-clockwise, with its centre.
        rotate: Option<(FormulaSpec, Vec<f64>)>,
    },
    /// It is free in translation.
    Free {
        /// Its mass, > 0.
        mass: f64,
        /// Initial velocity.
        velocity: Vec<f64>,
        /// Gravitational acceleration: formulas in t.
        gravity: Vec<FormulaSpec>,
    },
}

impl ObstacleMotion {
    /// Whether it does not move.
    pub fn is_fixed(&self) -> bool {
        *self == Self::Fixed
    }

    /// Number of nodes that carry it: its position, and its angle.
    pub fn nodes(&self) -> usize {
        match self {
            Self::Fixed => 0,
            Self::Prescribed { rotate: Some(_), .. } => 2,
            Self::Prescribed { .. } | Self::Free { .. } => 1,
        }
    }
}
