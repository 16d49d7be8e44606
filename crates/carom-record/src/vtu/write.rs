//! `FieldSet` → VTU.

use std::fmt::Write as _;

use quick_xml::escape::escape;

use super::{CellMaterials, FieldSet, MATERIAL, NAMED};
use crate::RecordError;
use crate::decimal::decimal;

/// The XML head and the binary data after it, written together.
#[derive(Default)]
struct Parts {
    head: String,
    data: Vec<u8>,
}

impl Parts {
    /// Appends one array: its byte count (UInt64), then its values, little-endian.
    fn array<const B: usize>(
        &mut self,
        kind: &str,
        attributes: &str,
        unit: &str,
        values: impl Iterator<Item = [u8; B]>,
    ) {
        let offset = self.data.len();
        self.data.extend([0; 8]);
        values.for_each(|v| self.data.extend(v));
        let bytes = (self.data.len() - offset - 8) as u64;
        self.data[offset..offset + 8].copy_from_slice(&bytes.to_le_bytes());
        let _ = write!(
            self.head,
            "<DataArray type=\"{kind}\" {attributes} format=\"appended\" offset=\"{offset}\""
        );
        if unit.is_empty() {
            self.head.push_str("/>\n");
        } else {
            let key = "InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\"";
            let _ = writeln!(self.head, ">\n<{key}>{}</InformationKey>\n</DataArray>", escape(unit));
        }
    }
}

impl FieldSet {
    /// Checks that all lengths are consistent.
    fn check(&self) -> Result<(), RecordError> {
        let error = |what| Err(RecordError::Field { what });
        let n = self.points.len();
        for array in &self.arrays {
            if array.values.len() != n * array.components {
                let name = &array.name;
                let got = array.values.len();
                let c = array.components;
                return error(format!("array `{name}` has {got} values for {n} points of {c} components"));
            }
        }
        for block in &self.blocks {
            let body = &block.body;
            let size = block.cell.nodes(block.degree);
            if !(1..=3).contains(&block.degree) || !block.connectivity.len().is_multiple_of(size) {
                let got = block.connectivity.len();
                let degree = block.degree;
                return error(format!(
                    "body `{body}` has {got} node numbers in cells of {size} nodes, degree {degree}"
                ));
            }
            if let Some(node) = block.connectivity.iter().find(|&&node| node >= n) {
                return error(format!("body `{body}` refers to node {node}, but there are {n} points"));
            }
        }
        let cells: usize = self.blocks.iter().map(|block| block.cells().count()).sum();
        if let Some(array) = self.of_cells.iter().find(|array| array.values.len() != cells) {
            return error(format!(
                "array `{}` has {} values for {cells} cells",
                array.name,
                array.values.len()
            ));
        }
        let CellMaterials { names, of_cells } = &self.materials;
        if !of_cells.is_empty() && (of_cells.len() != cells || of_cells.iter().any(|k| *k >= names.len())) {
            let got = of_cells.len();
            return error(format!(
                "{got} cells have one of {} materials, but there are {cells}",
                names.len()
            ));
        }
        Ok(())
    }

    /// The bytes of a VTU file.
    pub fn to_vtu(&self, time: f64) -> Result<Vec<u8>, RecordError> {
        self.check()?;
        let cells: usize = self.blocks.iter().map(|b| b.cells().count()).sum();
        let mut p = Parts::default();
        p.head.push_str(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             <UnstructuredGrid>\n<FieldData>\n",
        );
        p.array(
            "Float64",
            "Name=\"TimeValue\" NumberOfTuples=\"1\"",
            "",
            std::iter::once(decimal(time).to_le_bytes()),
        );
        for (number, block) in self.blocks.iter().enumerate() {
            let name = escape(&block.body);
            let _ = writeln!(
                p.head,
                "<DataArray type=\"Int32\" Name=\"{NAMED}{name}\" NumberOfTuples=\"1\" format=\"ascii\">{number}</DataArray>"
            );
        }
        for (number, name) in self.materials.names.iter().enumerate() {
            let name = escape(name);
            let _ = writeln!(
                p.head,
                "<DataArray type=\"Int32\" Name=\"{MATERIAL}{name}\" NumberOfTuples=\"1\" format=\"ascii\">{number}</DataArray>"
            );
        }
        p.head.push_str("</FieldData>\n");
        let _ = writeln!(
            p.head,
            "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{cells}\">\n<PointData>",
            self.points.len()
        );
        for array in &self.arrays {
            let mut attributes =
                format!("Name=\"{}\" NumberOfComponents=\"{}\"", escape(&array.name), array.components);
            let names: &[&str] = match array.components {
                3 if array.name.starts_with("principal") => &["1", "2", "3"],
                3 => &["X", "Y", "Z"],
                6 => &["XX", "YY", "ZZ", "XY", "YZ", "XZ"],
                _ => &[],
            };
            for (i, name) in names.iter().enumerate() {
                let _ = write!(attributes, " ComponentName{i}=\"{name}\"");
            }
            p.array("Float64", &attributes, &array.unit, array.values.iter().map(|v| v.to_le_bytes()));
        }
        p.head.push_str("</PointData>\n<CellData>\n");
        let body = self
            .blocks
            .iter()
            .enumerate()
            .flat_map(|(i, b)| b.cells().map(move |_| (i as i32).to_le_bytes()));
        p.array("Int32", "Name=\"body\"", "", body);
        if !self.materials.of_cells.is_empty() {
            let materials = self.materials.of_cells.iter().map(|&number| (number as i32).to_le_bytes());
            p.array("Int32", "Name=\"material\"", "", materials);
        }
        for array in &self.of_cells {
            let attributes = format!("Name=\"{}\"", escape(&array.name));
            p.array("Float64", &attributes, &array.unit, array.values.iter().map(|v| v.to_le_bytes()));
        }
        p.head.push_str("</CellData>\n<Points>\n");
        let points = self.points.iter().flatten().map(|x| x.to_le_bytes());
        p.array("Float64", "Name=\"points\" NumberOfComponents=\"3\"", "", points);
        p.head.push_str("</Points>\n<Cells>\n");
        let connectivity =
            self.blocks.iter().flat_map(|b| &b.connectivity).map(|&n| (n as i64).to_le_bytes());
        p.array("Int64", "Name=\"connectivity\"", "", connectivity);
        let ends = self.blocks.iter().flat_map(|b| b.cells().map(<[usize]>::len)).scan(0, |end, size| {
            *end += size as i64;
            Some(end.to_le_bytes())
        });
        p.array("Int64", "Name=\"offsets\"", "", ends);
        let types = self.blocks.iter().flat_map(|b| b.cells().map(|_| [b.cell.file_type(b.degree)]));
        p.array("UInt8", "Name=\"types\"", "", types);
        p.head.push_str("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
        let mut bytes = p.head.into_bytes();
        bytes.append(&mut p.data);
        bytes.extend(b"\n</AppendedData>\n</VTKFile>\n");
        Ok(bytes)
    }
}
