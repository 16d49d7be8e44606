//! A .msh file in memory: its nodes, its cells by type and group, its named groups, and the
//! position of each in the file.

use super::cell_type::CellType;
use super::error::{Fault, MshError, Place};

/// Gmsh's names of physical groups of dimension 0, 1, 2 and 3.
pub(super) const GROUPS: [&str; 4] = ["point", "curve", "surface", "volume"];

/// Nodes, cells and named groups of a .msh file.
#[derive(Clone, Debug)]
pub struct MshFile {
    pub(super) text: bool,
    pub(super) groups: Vec<Group>,
    /// Whether nodes of one body may be at one place.
    pub(super) slits: bool,
    pub(super) nodes: Vec<(Row, [f64; 3])>,
    pub(super) blocks: Vec<Block>,
}

/// A physical group by its name, or by its number if it has none.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub(super) dimension: i64,
    pub(super) tag: i64,
    pub(super) name: String,
}

/// Tag of a node or cell, and its line or byte in the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) tag: i64,
    pub(super) place: usize,
}

impl Row {
    pub(super) fn new(tag: i64, place: Place) -> Self {
        match place {
            Place::Line(place) | Place::Byte(place) => Self { tag, place },
            Place::File => Self { tag, place: 0 },
        }
    }
}

/// Cells of one type in the same physical groups.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub(super) kind: CellType,
    pub(super) groups: Vec<i64>,
    pub(super) rows: Vec<Row>,
    /// Indices into the list of nodes, cell after cell.
    pub(super) nodes: Vec<usize>,
}

impl Block {
    pub(super) fn cells(&self) -> impl Iterator<Item = (&Row, &[usize])> {
        self.rows.iter().zip(self.nodes.chunks_exact(self.kind.nodes))
    }
}

impl MshFile {
    /// The same file, in whose bodies nodes at one place may be a slit instead of a mistake.
    #[must_use]
    pub fn with_slits(self, slits: bool) -> Self {
        Self { slits, ..self }
    }

    /// Names of the physical groups of a dimension: 2 surfaces, 1 curves, 0 points; no duplicates.
    /// A group without a name has its number.
    pub fn names(&self, dimension: usize) -> Vec<&str> {
        let mut names = Vec::new();
        for group in self.groups.iter().filter(|g| g.dimension == dimension as i64) {
            if !names.contains(&group.name.as_str()) {
                names.push(&group.name);
            }
        }
        names
    }

    /// An error: no physical group of a dimension has this name.
    pub(super) fn no_name(&self, dimension: usize, name: &str) -> Fault {
        let names = |dimension: usize| self.names(dimension).into_iter().map(str::to_owned);
        let others = (0..GROUPS.len()).rev().filter(|other| *other != dimension);
        let elsewhere = others.flat_map(|d| names(d).map(move |name| format!("{} \"{name}\"", GROUPS[d])));
        Fault::NoName {
            what: GROUPS[dimension.min(3)],
            name: name.to_owned(),
            names: names(dimension).collect(),
            elsewhere: elsewhere.collect(),
        }
    }

    /// Blocks of cells of a dimension in the groups of a name.
    pub(super) fn blocks<'a>(&'a self, dimension: usize, name: &'a str) -> impl Iterator<Item = &'a Block> {
        let d = dimension as i64;
        let in_group = move |block: &Block| {
            let named =
                |tag: &i64| self.groups.iter().any(|g| g.dimension == d && g.tag == *tag && g.name == name);
            block.groups.iter().any(named)
        };
        self.blocks.iter().filter(move |b| b.kind.dimension() == d && in_group(b))
    }

    pub(super) fn at(&self, row: &Row, fault: Fault) -> MshError {
        MshError { place: place(self.text, row), fault }
    }
}

/// Position of a cell in the file.
pub(super) fn place(text: bool, row: &Row) -> Place {
    if text { Place::Line(row.place) } else { Place::Byte(row.place) }
}
