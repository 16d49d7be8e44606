//! Layout of a VTKHDF file, as a function of sizes and names only.
//!
//! One transient unstructured grid with a fixed mesh: all steps have the mesh offsets of the first
//! one, and each has its own part of every point array ("VTKHDF File Format", version 2.2,
//! docs.vtk.org). There is space for `capacity` steps; the number of valid ones is stored in
//! `NSteps` and as the length of `Steps/Values`. Both numbers lie in one sector, so that a single
//! write changes both.

use super::hdf5::{Attribute, Image, Kind, Node};
use super::read::Contents;
use crate::{FieldSet, PointArray};

pub(super) const INTEGER: Kind = Kind::Integer(8);
pub(super) const COUNT: &str = "/VTKHDF/Steps@NSteps";
pub(super) const TIMES: &str = "/VTKHDF/Steps/Values";
pub(super) const STEPS: &str = "/VTKHDF/FieldData/step";
pub(super) const BODIES: &str = "/VTKHDF/CellData/body@bodies";
const SECTOR: u64 = 512;

/// Sizes and names of a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    pub(super) points: u64,
    pub(super) cells: u64,
    /// Number of point numbers of all cells.
    pub(super) connectivity: u64,
    pub(super) bodies: Vec<String>,
    /// Point arrays without values.
    pub(super) arrays: Vec<PointArray>,
    /// Number of steps.
    pub(super) count: u64,
    /// Number of steps there is space for.
    pub(super) capacity: u64,
}

fn text(name: &str, texts: &[String], scalar: bool) -> Attribute {
    let size = texts.iter().map(String::len).max().unwrap_or(0).max(1);
    let padded = |t: &String| t.bytes().chain(std::iter::repeat(0)).take(size).collect::<Vec<u8>>();
    Attribute {
        name: name.into(),
        kind: Kind::Text(size),
        dims: if scalar { vec![] } else { vec![texts.len() as u64] },
        data: texts.iter().flat_map(padded).collect(),
    }
}

fn whole(name: &str, dims: Vec<u64>, values: &[u64]) -> Attribute {
    let data = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    Attribute { name: name.into(), kind: INTEGER, dims, data }
}

fn dataset(kind: Kind, dims: &[u64]) -> Node {
    Node::Dataset { kind, dims: dims.to_vec(), rows: dims[0], attributes: vec![] }
}

fn group(children: Vec<(&str, Node)>) -> Node {
    Node::Group {
        attributes: vec![],
        children: children.into_iter().map(|(n, c)| (n.to_owned(), c)).collect(),
    }
}

/// Path of a point array.
pub(super) fn path_of(array: &PointArray) -> String {
    format!("/VTKHDF/PointData/{}", array.name)
}

impl Layout {
    /// The layout for such fields.
    pub(super) fn of(fields: &FieldSet, count: u64, capacity: u64) -> Self {
        Self {
            points: fields.points.len() as u64,
            cells: fields.blocks.iter().map(|b| b.cells().count() as u64).sum(),
            connectivity: fields.blocks.iter().map(|b| b.connectivity.len() as u64).sum(),
            bodies: fields.blocks.iter().map(|b| b.body.clone()).collect(),
            arrays: fields.arrays.iter().map(|a| PointArray { values: vec![], ..a.clone() }).collect(),
            count,
            capacity,
        }
    }

    /// The layout of an existing file.
    pub(super) fn found(contents: &Contents) -> Result<Self, String> {
        let rows = |path: &str, kind| {
            Ok::<_, String>(contents.dataset(path, kind)?.dims.first().copied().unwrap_or(0))
        };
        let points = rows("/VTKHDF/Points", Kind::Real)?;
        let mut arrays = Vec::new();
        for (path, name) in
            contents.order.iter().filter_map(|p| Some((p, p.strip_prefix("/VTKHDF/PointData/")?)))
        {
            arrays.push(PointArray {
                name: name.into(),
                unit: contents.texts(&format!("{path}@units")).into_iter().next().unwrap_or_default(),
                components: contents.dataset(path, Kind::Real)?.dims.get(1).map_or(1, |&n| n as usize),
                values: vec![],
            });
        }
        let layout = Self {
            points,
            cells: rows("/VTKHDF/Types", Kind::Byte)?,
            connectivity: rows("/VTKHDF/Connectivity", INTEGER)?,
            bodies: contents.texts(BODIES),
            arrays,
            count: contents.number(COUNT)?,
            capacity: rows(STEPS, INTEGER)?,
        };
        let steps = rows(TIMES, Kind::Real)?;
        if steps != layout.count || steps > layout.capacity {
            let (count, capacity) = (layout.count, layout.capacity);
            return Err(format!(
                "its header has {count} steps, but there are {steps} times and space for {capacity}"
            ));
        }
        Ok(layout)
    }

    /// The file without the values.
    pub(super) fn image(&self) -> Image {
        let root = group(vec![("VTKHDF", self.tree())]);
        let sector = |at: Option<&u64>| at.map(|at| at / SECTOR);
        let one_sector = |image: &Image| sector(image.data.get(COUNT)) == sector(image.dims.get(TIMES));
        let image = |shift| Image::new(&root, shift);
        (0..SECTOR as usize).step_by(8).map(image).find(one_sector).unwrap_or_else(|| image(0))
    }

    fn tree(&self) -> Node {
        let (n, capacity) = (self.points, self.capacity);
        let point_array = |array: &PointArray| {
            let mut dims = vec![n * capacity];
            dims.extend((array.components > 1).then_some(array.components as u64));
            let mut attributes = vec![];
            if !array.unit.is_empty() {
                attributes.push(text("units", std::slice::from_ref(&array.unit), true));
            }
            (array.name.clone(), Node::Dataset { kind: Kind::Real, rows: dims[0], dims, attributes })
        };
        let offsets = || dataset(INTEGER, &[capacity]);
        let of_topology = || dataset(INTEGER, &[capacity, 1]);
        let times =
            Node::Dataset { kind: Kind::Real, dims: vec![self.count], rows: capacity, attributes: vec![] };
        let steps = Node::Group {
            attributes: vec![whole("NSteps", vec![], &[self.count])],
            // The times are last, to be near NSteps.
            children: [
                ("NumberOfParts", offsets()),
                ("PartOffsets", offsets()),
                ("PointOffsets", offsets()),
                ("CellOffsets", of_topology()),
                ("ConnectivityIdOffsets", of_topology()),
                (
                    "PointDataOffsets",
                    group(self.arrays.iter().map(|a| (a.name.as_str(), offsets())).collect()),
                ),
                ("CellDataOffsets", group(vec![("body", offsets())])),
                ("FieldDataOffsets", group(vec![("step", offsets())])),
                ("FieldDataSizes", group(vec![("step", dataset(INTEGER, &[capacity, 2]))])),
                ("Values", times),
            ]
            .map(|(name, node)| (name.to_owned(), node))
            .into(),
        };
        let body = Node::Dataset {
            kind: Kind::Integer(4),
            dims: vec![self.cells],
            rows: self.cells,
            attributes: vec![text("bodies", &self.bodies, false)],
        };
        let points =
            Node::Group { attributes: vec![], children: self.arrays.iter().map(point_array).collect() };
        let children = [
            ("NumberOfPoints", dataset(INTEGER, &[1])),
            ("NumberOfCells", dataset(INTEGER, &[1])),
            ("NumberOfConnectivityIds", dataset(INTEGER, &[1])),
            ("Points", dataset(Kind::Real, &[n, 3])),
            ("Connectivity", dataset(INTEGER, &[self.connectivity])),
            ("Offsets", dataset(INTEGER, &[self.cells + 1])),
            ("Types", dataset(Kind::Byte, &[self.cells])),
            ("CellData", group(vec![("body", body)])),
            ("FieldData", group(vec![("step", offsets())])),
            ("PointData", points),
            ("Steps", steps),
        ];
        Node::Group {
            attributes: vec![
                whole("Version", vec![2], &[2, 2]),
                text("Type", &["UnstructuredGrid".into()], true),
            ],
            children: children.map(|(name, node)| (name.to_owned(), node)).into(),
        }
    }
}
