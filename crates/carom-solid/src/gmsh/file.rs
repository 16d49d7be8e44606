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
    /// Groups of which every cell of a body belongs to exactly one; none are asked for if empty.
    pub(super) regions: Vec<String>,
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

    /// The same file, whose bodies consist of regions: every cell belongs to exactly one of the
    /// physical groups with these names, and
    /// [`Mesh::regions`](crate::Mesh::regions) contains its index.
    #[must_use]
    pub fn with_regions(self, regions: Vec<String>) -> Self {
        Self { regions, ..self }
    }

    /// The same file, with a further physical group of a dimension that contains the cells of some
    /// of its groups.
    ///
    /// # Errors
    /// If the file has no such group.
    pub fn with_union(mut self, dimension: usize, name: &str, groups: &[String]) -> Result<Self, MshError> {
        self.known(dimension, groups.iter().map(String::as_str))?;
        let tag = 1 + self.groups.iter().map(|group| group.tag).max().unwrap_or(0);
        let parts: Vec<Vec<i64>> = groups.iter().map(|group| self.tags(dimension, group).collect()).collect();
        for block in self.blocks.iter_mut().filter(|block| block.kind.dimension() == dimension as i64) {
            if parts.iter().flatten().any(|tag| block.groups.contains(tag)) {
                block.groups.push(tag);
            }
        }
        self.groups.push(Group { dimension: dimension as i64, tag, name: name.to_owned() });
        Ok(self)
    }

    /// Whether the physical groups of a dimension have these names.
    ///
    /// # Errors
    /// The first that none has.
    pub(super) fn known<'a>(
        &self,
        dimension: usize,
        mut names: impl Iterator<Item = &'a str>,
    ) -> Result<(), MshError> {
        let all = self.names(dimension);
        match names.find(|name| !all.contains(name)) {
            Some(unknown) => Err(MshError::whole(self.no_name(dimension, unknown))),
            None => Ok(()),
        }
    }

    /// Tags of the physical groups of a dimension and a name.
    fn tags(&self, dimension: usize, name: &str) -> impl Iterator<Item = i64> {
        let same = move |group: &&Group| group.dimension == dimension as i64 && group.name == name;
        self.groups.iter().filter(same).map(|group| group.tag)
    }

    /// Index of the only region to which the cells of a block of a body belong; 0 if none are asked
    /// for.
    pub(super) fn region(&self, dimension: usize, block: &Block, body: &str) -> Result<u16, MshError> {
        let mut of_block = (0..self.regions.len()).filter(|&region| {
            self.tags(dimension, &self.regions[region]).any(|tag| block.groups.contains(&tag))
        });
        let found = [of_block.next(), of_block.next()];
        let wrong =
            |fault: fn(String, i64, Vec<String>) -> Fault, groups: Vec<String>| match block.rows.first() {
                Some(row) => Err(self.at(row, fault(body.to_owned(), row.tag, groups))),
                None => Ok(0),
            };
        match found {
            _ if self.regions.is_empty() => Ok(0),
            [Some(region), None] => Ok(region as u16),
            [Some(a), Some(b)] => {
                let groups = [a, b].map(|region| self.regions[region].clone()).to_vec();
                wrong(|name, cell, groups| Fault::SeveralRegions { name, cell, groups }, groups)
            }
            _ => wrong(|name, cell, groups| Fault::NoRegion { name, cell, groups }, self.regions.clone()),
        }
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
