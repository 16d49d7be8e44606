//! Meshes from and to Gmsh: .msh files of version 4.1 and 2.2, text and binary, of order 1 to 3.
//!
//! A body is a *named* physical surface (dimension 1: curve), its sides are the named physical curves (points) on its boundary. Gmsh's node
//! order is ours. What can be put right without changing the geometry is, and [`Mesh::repairs`](crate::Mesh::repairs) says so; the rest is
//! an error with line or byte.
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let file = carom_solid::gmsh::read(&std::fs::read("impact.msh")?)?;
//! let cylinder = file.body("cylinder")?;
//! assert!(cylinder.sides.contains_key("arc"));
//! # Ok(())
//! # }
//! ```

mod bar;
mod body;
mod cell_type;
mod checks;
mod error;
mod part;
mod read;
mod source;
mod version_2;
mod version_4;
mod write;

pub use error::{Fault, MshError, Place};
pub use read::read;
pub use write::write_msh41;

use cell_type::CellType;

/// Nodes, cells and named groups of a .msh file.
#[derive(Clone, Debug)]
pub struct MshFile {
    text: bool,
    groups: Vec<Group>,
    nodes: Vec<(Row, [f64; 3])>,
    blocks: Vec<Block>,
}

/// A named physical group.
#[derive(Clone, Debug)]
struct Group {
    dimension: i64,
    tag: i64,
    name: String,
}

/// Tag of a node or cell, and the line or byte it was read at.
#[derive(Clone, Copy, Debug)]
struct Row {
    tag: i64,
    place: usize,
}

impl Row {
    fn new(tag: i64, place: Place) -> Self {
        match place {
            Place::Line(place) | Place::Byte(place) => Self { tag, place },
            Place::File => Self { tag, place: 0 },
        }
    }
}

/// Cells of one type in the same physical groups.
#[derive(Clone, Debug)]
struct Block {
    kind: CellType,
    groups: Vec<i64>,
    rows: Vec<Row>,
    /// Places in the list of nodes, cell after cell.
    nodes: Vec<usize>,
}

impl Block {
    fn cells(&self) -> impl Iterator<Item = (&Row, &[usize])> {
        self.rows.iter().zip(self.nodes.chunks_exact(self.kind.nodes))
    }
}

impl MshFile {
    /// Names of the physical groups of a dimension: 2 surfaces, 1 curves, 0 points. Each once.
    pub fn names(&self, dimension: usize) -> Vec<&str> {
        let mut names = Vec::new();
        for group in self.groups.iter().filter(|g| g.dimension == dimension as i64) {
            if !names.contains(&group.name.as_str()) {
                names.push(&group.name);
            }
        }
        names
    }

    /// Blocks of cells of a dimension in the groups of a name.
    fn blocks<'a>(&'a self, dimension: usize, name: &'a str) -> impl Iterator<Item = &'a Block> {
        let d = dimension as i64;
        let in_group = move |block: &Block| {
            let named = |tag: &i64| self.groups.iter().any(|g| g.dimension == d && g.tag == *tag && g.name == name);
            block.groups.iter().any(named)
        };
        self.blocks.iter().filter(move |b| b.kind.dimension() == d && in_group(b))
    }

    fn at(&self, row: &Row, fault: Fault) -> MshError {
        MshError { place: read::place(self.text, row), fault }
    }
}
