//! VTU → `FieldSet`. Of the files of other programs only those are read that have the same
//! structure: one piece, and all values appended as raw binary data.

use serde::Deserialize;

use super::{Block, Cell, CellArray, CellMaterials, FieldSet, MATERIAL, NAMED, PointArray};
use crate::Reason;

const APPENDED: &[u8] = b"<AppendedData encoding=\"raw\">\n_";

/// The XML before the binary data.
#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct Head {
    unstructured_grid: Grid,
}

#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct Grid {
    field_data: Section,
    piece: Piece,
}

#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct Piece {
    #[serde(rename = "@NumberOfPoints")]
    number_of_points: usize,
    point_data: Section,
    cell_data: Section,
    points: Section,
    cells: Section,
}

#[derive(Deserialize)]
struct Section {
    #[serde(rename = "DataArray", default)]
    arrays: Vec<DataArray>,
}

/// An array, whose values are in the text, or in the binary data from `offset` on.
#[derive(Deserialize)]
struct DataArray {
    #[serde(rename = "@Name")]
    name: String,
    #[serde(rename = "@NumberOfComponents")]
    components: Option<usize>,
    #[serde(rename = "@offset")]
    offset: Option<usize>,
    #[serde(rename = "InformationKey")]
    unit: Option<String>,
    #[serde(rename = "$text")]
    number: Option<String>,
}

impl FieldSet {
    /// Reads the bytes of a field file.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn from_vtu(bytes: &[u8]) -> Result<Self, Reason> {
        let cut = bytes.windows(APPENDED.len()).position(|w| w == APPENDED);
        let cut = cut.ok_or("no appended raw data")?;
        let head = std::str::from_utf8(&bytes[..cut]).map_err(|e| e.to_string())?;
        let data = &bytes[cut + APPENDED.len()..];
        let head: Head =
            quick_xml::de::from_str(&format!("{head}</VTKFile>")).map_err(|error| error.to_string())?;
        let Grid { field_data, piece } = head.unstructured_grid;
        let n = piece.number_of_points;
        let coordinates = numbers(data, piece.points.array("points")?, n, 3)?;
        let whole = |bytes| usize::try_from(i64::from_le_bytes(bytes)).map_err(|e| e.to_string());
        let wholes = |name| {
            let values = values::<8>(data, piece.cells.array(name)?)?;
            values.into_iter().map(whole).collect::<Result<Vec<_>, _>>().map_err(Reason::from)
        };
        let connectivity = wholes("connectivity")?;
        if let Some(node) = connectivity.iter().find(|&&node| node >= n) {
            return Err(format!("a cell refers to node {node}, but there are {n} points").into());
        }
        let types = values::<1>(data, piece.cells.array("types")?)?;
        let bodies = values::<4>(data, piece.cell_data.array("body")?)?;
        let cells = bodies.len();
        let mut blocks = Blocks { names: field_data.names(NAMED)?, found: Vec::new(), last: None };
        let mut start = 0;
        for ((end, [kind]), body) in wholes("offsets")?.into_iter().zip(types).zip(bodies) {
            let nodes = connectivity.get(start..end).ok_or("cells reach beyond the connectivity")?;
            blocks.push(i32::from_le_bytes(body) as usize, kind, nodes)?;
            start = end;
        }
        let mut materials = CellMaterials { names: field_data.names(MATERIAL)?, of_cells: Vec::new() };
        if let Ok(array) = piece.cell_data.array("material") {
            let numbers = values::<4>(data, array)?.into_iter().map(i32::from_le_bytes);
            materials.of_cells = numbers.map(|number| number as usize).collect();
            if materials.of_cells.len() != cells
                || materials.of_cells.iter().any(|number| *number >= materials.names.len())
            {
                return Err("a cell has no material of a name".into());
            }
        }
        let mut of_cells = Vec::new();
        for array in
            piece.cell_data.arrays.iter().filter(|array| !["body", "material"].contains(&&*array.name))
        {
            let values = numbers(data, array, cells, 1)?;
            let unit = array.unit.clone().unwrap_or_default();
            of_cells.push(CellArray { name: array.name.clone(), unit, values });
        }
        let mut arrays = Vec::new();
        for array in piece.point_data.arrays {
            let components = array.components.unwrap_or(1);
            let values = numbers(data, &array, n, components)?;
            let unit = array.unit.unwrap_or_default();
            arrays.push(PointArray { name: array.name, unit, components, values });
        }
        let points = coordinates.as_chunks::<3>().0.to_vec();
        Ok(Self { points, blocks: blocks.found, arrays, of_cells, materials })
    }
}

impl Section {
    fn array(&self, name: &str) -> Result<&DataArray, Reason> {
        self.arrays.iter().find(|a| a.name == name).ok_or_else(|| format!("there is no array {name}").into())
    }

    /// Names of the bodies or materials by number, from those that begin with a word.
    fn names(&self, word: &str) -> Result<Vec<String>, Reason> {
        let mut names = Vec::new();
        for array in &self.arrays {
            let Some(name) = array.name.strip_prefix(word) else { continue };
            let number = array.number.as_deref().unwrap_or_default().trim();
            if number.parse() != Ok(names.len()) {
                return Err(
                    format!("{word}`{name}` has the number {number} instead of {}", names.len()).into()
                );
            }
            names.push(name.to_owned());
        }
        Ok(names)
    }
}

/// Values of an appended array, `B` bytes each.
fn values<const B: usize>(data: &[u8], array: &DataArray) -> Result<Vec<[u8; B]>, Reason> {
    let block = || {
        let (length, data) = data.get(array.offset?..)?.split_first_chunk::<8>()?;
        data.get(..usize::try_from(u64::from_le_bytes(*length)).ok()?)
    };
    let bytes =
        block().ok_or_else(|| format!("array `{}` reaches beyond the end of the file", array.name))?;
    match bytes.as_chunks::<B>() {
        (chunks, []) => Ok(chunks.to_vec()),
        _ => Err(format!("array `{}` ends with an incomplete value", array.name).into()),
    }
}

fn numbers(data: &[u8], array: &DataArray, points: usize, components: usize) -> Result<Vec<f64>, Reason> {
    let expected = points.checked_mul(components).ok_or("too many points")?;
    let values: Vec<f64> = values(data, array)?.into_iter().map(f64::from_le_bytes).collect();
    if values.len() == expected {
        return Ok(values);
    }
    Err(format!("array `{}` has {} values instead of {expected}", array.name, values.len()).into())
}

/// Blocks of successive cells of the same body, type and degree.
struct Blocks {
    names: Vec<String>,
    found: Vec<Block>,
    last: Option<(usize, Cell, usize)>,
}

impl Blocks {
    fn push(&mut self, body: usize, kind: u8, nodes: &[usize]) -> Result<(), Reason> {
        let (cell, degree) = Cell::of_type(kind, nodes.len()).ok_or_else(|| {
            format!("cells of VTK type {kind} with {} nodes are not supported", nodes.len())
        })?;
        if self.last != Some((body, cell, degree)) {
            let name = self.names.get(body).cloned().ok_or("a cell belongs to an unnamed body")?;
            self.found.push(Block { body: name, cell, degree, connectivity: Vec::new() });
            self.last = Some((body, cell, degree));
        }
        if let Some(block) = self.found.last_mut() {
            block.connectivity.extend(nodes);
        }
        Ok(())
    }
}
