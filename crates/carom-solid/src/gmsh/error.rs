//! Errors of mesh files: where, what, why, and what to try.

use std::fmt;

/// Position in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Line of a text, from 1.
    Line(usize),
    /// Byte of a binary file, from 0.
    Byte(usize),
    /// The file as a whole.
    File,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}: "),
            Self::Byte(byte) => write!(f, "byte {byte}: "),
            Self::File => Ok(()),
        }
    }
}

/// Why a file gave no mesh; [`Display`](fmt::Display) says where and what.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{place}{fault}")]
pub struct MshError {
    /// Where.
    pub place: Place,
    /// What.
    pub fault: Fault,
}

/// What is wrong. Numbers of nodes and cells are the file's tags.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub enum Fault {
    #[error("this is not a Gmsh mesh: it does not begin with $MeshFormat")]
    NotMsh,
    #[error("Gmsh format version {0} is not supported")]
    Version(String),
    #[error("the header is invalid: {0}")]
    Header(&'static str),
    #[error("the file ends within {0}")]
    Truncated(&'static str),
    #[error("expected {wanted}, found `{found}`")]
    Unexpected { wanted: String, found: String },
    #[error("the line ends before {0}")]
    ShortLine(&'static str),
    #[error("unexpected `{0}` at the end of the line")]
    LongLine(String),
    #[error("the file states {count} {what}, but only {left} bytes are left")]
    Count { what: &'static str, count: u64, left: usize },
    #[error("the file states {count} {what}, but {found} follow")]
    Total { what: &'static str, count: u64, found: u64 },
    #[error("section ${0} occurs twice")]
    SectionTwice(&'static str),
    #[error("there is no section ${0}")]
    NoSection(&'static str),
    #[error("the mesh is partitioned")]
    Partitioned,
    #[error("{what} {tag} occurs twice")]
    TagTwice { what: &'static str, tag: i64 },
    #[error("the coordinates of node {0} are not finite")]
    NotFinite(i64),
    #[error("cell {cell} has the unknown type {kind}")]
    UnknownType { cell: i64, kind: i64 },
    #[error("cell {cell} refers to node {node}, which is not in the file")]
    NoNode { cell: i64, node: i64 },
    #[error("there is no physical {what} \"{name}\"")]
    NoName { what: &'static str, name: String, names: Vec<String>, elsewhere: Vec<String> },
    #[error("the physical {what} \"{name}\" has no cells")]
    NoCells { what: &'static str, name: String },
    #[error("cell {cell} of \"{name}\" is {kind}, an incomplete one of order {order}")]
    Incomplete { name: String, cell: i64, kind: String, order: usize, complete: usize },
    #[error("cell {cell} of \"{name}\" is {kind}, of order {order}")]
    Order { name: String, cell: i64, kind: String, order: usize },
    #[error("cell {cell} of \"{name}\" is {kind}")]
    Shape { name: String, cell: i64, kind: String },
    #[error("cell {cell} of \"{name}\" has order {order}, but the previous cells have order {before}")]
    MixedOrders { name: String, cell: i64, order: usize, before: usize },
    #[error("node {node} of \"{name}\" is at {axis} = {value:e}, another at {axis} = {other:e}")]
    NotFlat { name: String, node: i64, axis: char, value: f64, other: f64 },
    #[error("cell {cell} of \"{name}\" is folded: its Jacobian is {jacobian:.3e} at {at:.6?}")]
    Folded { name: String, cell: i64, jacobian: f64, at: Vec<f64> },
    #[error("nodes {a} and {b} of \"{name}\" are both at {at:.9?}")]
    Coincident { name: String, a: i64, b: i64, at: Vec<f64> },
    #[error("cells {a} and {b} of \"{name}\" lie on the same side of the edge {start}–{end}")]
    Overlap { name: String, a: i64, b: i64, start: i64, end: i64 },
    #[error("the edge {start}–{end} has different interior nodes in {a} and in {b}")]
    EdgeNodes { a: String, b: String, start: i64, end: i64 },
    #[error("cell {cell} of \"{name}\" is {kind}, but the previous cells are not")]
    MixedKinds { name: String, cell: i64, kind: String },
    #[error("cells {cells:?} of \"{name}\" share the facet {corners:?}")]
    Crowded { name: String, cells: Vec<i64>, corners: Vec<i64> },
    #[error("cells {a} and {b} of \"{name}\" lie on the same side of the facet {corners:?}")]
    SameSide { name: String, a: i64, b: i64, corners: Vec<i64> },
    #[error("the facet {corners:?} has different nodes between its corners in {a} and in {b}")]
    FacetNodes { a: String, b: String, corners: Vec<i64> },
    #[error(
        "{facets} facets of the boundary of \"{name}\" meet at the edge {start}–{end} at {at:.6?}, of the cells {cells:?}"
    )]
    Pinched { name: String, facets: usize, start: i64, end: i64, cells: Vec<i64>, at: Vec<f64> },
    #[error("cell {cell} of the surface is {kind}")]
    NoTriangle { cell: i64, kind: String },
    #[error("cell {cell} of \"{name}\" belongs to none of the groups {}", quoted(.groups))]
    NoRegion { name: String, cell: i64, groups: Vec<String> },
    #[error("cell {cell} of \"{name}\" belongs to the groups {}", quoted(.groups))]
    SeveralRegions { name: String, cell: i64, groups: Vec<String> },
    #[error("no cell of \"{name}\" belongs to the physical {what} \"{region}\"")]
    EmptyRegion { what: &'static str, name: String, region: String },
    #[error("node {node} of \"{name}\" belongs to {cells} cells")]
    Branching { name: String, node: i64, cells: usize },
}

/// Names in quotes, separated by commas.
fn quoted(names: &[String]) -> String {
    names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ")
}

impl MshError {
    pub(super) fn whole(fault: Fault) -> Self {
        Self { place: Place::File, fault }
    }

    /// Why this is wrong.
    pub fn why(&self) -> String {
        match &self.fault {
            Fault::NotMsh => "a .msh file of Gmsh begins with the line $MeshFormat".into(),
            Fault::Version(_) => "versions 4.1 and 2.2 are supported, as text and as binary".into(),
            Fault::Header(_) => {
                "$MeshFormat contains the version, 0 (text) or 1 (binary), the size of a number and, in binary files, the integer 1"
                    .into()
            }
            Fault::Truncated(_) | Fault::Count { .. } | Fault::Total { .. } => {
                "the file was cut short, or its counts were changed".into()
            }
            Fault::Unexpected { .. } | Fault::ShortLine(_) | Fault::LongLine(_) => {
                "the file does not follow the format of its version".into()
            }
            Fault::SectionTwice(_) => "it would be unclear which of them is valid".into(),
            Fault::NoSection("Entities") => "it says which cells are in the groups of $PhysicalNames".into(),
            Fault::NoSection(_) => "bodies need nodes and cells".into(),
            Fault::Partitioned => "its cells belong to partitions instead of physical groups".into(),
            Fault::TagTwice { .. } => "a reference to it would be ambiguous".into(),
            Fault::NotFinite(_) => "coordinates must be finite numbers".into(),
            Fault::UnknownType { .. } => "the number of its nodes is unknown, so nothing after it can be read".into(),
            Fault::NoNode { .. } => "every cell refers to nodes of $Nodes".into(),
            Fault::NoName { what, names, elsewhere, .. } if names.is_empty() => match &elsewhere[..] {
                [] => format!("the file contains no physical {what}, nor another physical group"),
                elsewhere => {
                    format!("the file contains no physical {what}, only the physical {}", elsewhere.join(", "))
                }
            },
            Fault::NoName { what, names, .. } => format!("the physical {what}s are: {}", names.join(", ")),
            Fault::NoCells { .. } => "the name is defined, but no cell belongs to it".into(),
            Fault::Incomplete { complete, .. } => {
                format!("the complete one has {complete} nodes, and only complete cells are supported")
            }
            Fault::Order { .. } => {
                "lines, triangles and tetrahedra are supported up to order 3, quadrilaterals and hexahedra up to order 2"
                    .into()
            }
            Fault::Shape { .. } => "bodies in space consist of tetrahedra or of hexahedra".into(),
            Fault::MixedOrders { .. } | Fault::MixedKinds { .. } => "all cells of a body must have the same type".into(),
            Fault::NotFlat { .. } => "a body of dimension 2 lies in a plane z = constant, a bar on the x axis".into(),
            Fault::Folded { .. } => "the Jacobian of a cell must be positive everywhere in it".into(),
            Fault::Coincident { .. } => {
                "cells at the two nodes are not connected, so the body would separate there".into()
            }
            Fault::Overlap { .. } => "an edge separates at most two cells, one on each side".into(),
            Fault::Crowded { .. } | Fault::SameSide { .. } => {
                "a facet separates at most two cells, one on each side".into()
            }
            Fault::FacetNodes { .. } => "neighbouring cells must share every node of their facet; otherwise the body would have a gap there".into(),
            Fault::Pinched { .. } => {
                "two facets of the boundary meet at an edge; the body is connected there along a line only".into()
            }
            Fault::EdgeNodes { .. } => "neighbouring cells must share every node of their edge; otherwise the body would have a gap there".into(),
            Fault::NoTriangle { .. } => "a rigid surface consists of triangles of three nodes".into(),
            Fault::Branching { .. } => "a node of a bar joins at most two cells".into(),
            Fault::NoRegion { .. } => "the group of a cell says of which material it is".into(),
            Fault::SeveralRegions { .. } => "a cell has one material".into(),
            Fault::EmptyRegion { .. } => "its material would be nowhere in the body".into(),
        }
    }

    /// Advice to the user on how to mend the mesh.
    pub fn help(&self) -> &'static str {
        match &self.fault {
            Fault::NotMsh | Fault::Version(_) | Fault::Header(_) => {
                "save the mesh with Gmsh as .msh: gmsh -2 shape.geo -format msh41"
            }
            Fault::NoName { names, .. } if !names.is_empty() => {
                "use one of them, or name the group in Gmsh, and mesh again"
            }
            Fault::NoName { what: "curve", .. } => {
                "add to the geometry, for example, Physical Curve(\"body\") = {1}; and mesh again"
            }
            Fault::NoName { what: "volume", .. } => {
                "add to the geometry, for example, Physical Volume(\"body\") = {1}; and mesh again with gmsh -3"
            }
            Fault::NoName { .. } => {
                "add to the geometry, for example, Physical Surface(\"body\") = {1}; and mesh again"
            }
            Fault::NoCells { what: "volume", .. } => {
                "mesh in space: gmsh -3; then look which entities Physical Volume lists"
            }
            Fault::NoCells { .. } => {
                "mesh the geometry before it is saved: gmsh -2; then look which entities the group lists"
            }
            Fault::NoSection(_) => "mesh the geometry before it is saved: gmsh -2, in space gmsh -3",
            Fault::Incomplete { .. } => "set Mesh.SecondOrderIncomplete = 0 in Gmsh and mesh again",
            Fault::Order { .. } => {
                "set Mesh.ElementOrder in Gmsh to at most 3, for quadrilaterals and hexahedra to at most 2"
            }
            Fault::Shape { .. } => {
                "in Gmsh, leave out Recombine, also in Extrude, and the volume has tetrahedra only; or recombine all its surfaces, and it has hexahedra only"
            }
            Fault::MixedOrders { .. } => "set one Mesh.ElementOrder for the whole mesh",
            Fault::NotFlat { .. } => "draw the geometry in the plane z = 0",
            Fault::Folded { .. } => {
                "optimise high-order cells in Gmsh (Mesh.HighOrderOptimize = 2), or mesh finer"
            }
            Fault::Coincident { .. } => {
                "merge them in Gmsh: Coherence; in the geometry, or Coherence Mesh; or, if the body is to have a slit there, give slits = true"
            }
            Fault::MixedKinds { .. } => {
                "mesh the whole body with one kind of cell; Mesh.SubdivisionAlgorithm = 1 in Gmsh leaves only quadrilaterals, 2 in space only hexahedra"
            }
            Fault::Crowded { .. } | Fault::SameSide { .. } => {
                "look for volumes that overlap or are in the group twice"
            }
            Fault::Pinched { .. } => {
                "join the parts by a face, separate them, or give slits = true if this is what you want"
            }
            Fault::FacetNodes { .. } => "set the order after all volumes are meshed",
            Fault::Overlap { .. } => "look for surfaces that overlap or are in the group twice",
            Fault::EdgeNodes { .. } => "set the order after all surfaces are meshed",
            Fault::NoTriangle { .. } => "set Mesh.ElementOrder = 1 in Gmsh, without Recombine",
            Fault::Branching { .. } => "a bar is one line of cells",
            Fault::NoRegion { .. } => {
                "add the group of this cell; or leave out the group of the whole body, which then consists of the listed groups"
            }
            Fault::SeveralRegions { .. } => "list one of them, or take the cell out of one of them in Gmsh",
            Fault::EmptyRegion { .. } => "leave it out, or look which entities the group lists in Gmsh",
            Fault::Partitioned => "save the mesh without partitions",
            _ => "save the mesh again with Gmsh",
        }
    }
}
