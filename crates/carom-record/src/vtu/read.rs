//! VTU → `FieldSet`, only for files written by this crate; other VTU files are an error.

use std::collections::HashMap;

use quick_xml::events::{BytesStart, Event};

use super::{Block, Cell, FieldSet, NAMED, PointArray};
use crate::Reason;

const APPENDED: &[u8] = b"<AppendedData encoding=\"raw\">\n_";

/// A `DataArray` of the XML head.
struct Array {
    section: String,
    name: String,
    unit: String,
    components: usize,
    offset: Option<usize>,
    text: String,
}

fn attribute(tag: &BytesStart, name: &str) -> Option<String> {
    let attribute = tag.try_get_attribute(name).ok()??;
    attribute.normalized_value(quick_xml::XmlVersion::Implicit1_0).ok().map(std::borrow::Cow::into_owned)
}

/// Arrays of the head, each with its section, and the number of points.
fn head(text: &str) -> Result<(Vec<Array>, usize), Reason> {
    let mut reader = quick_xml::Reader::from_str(text);
    reader.config_mut().check_end_names = false;
    let (mut arrays, mut points, mut section, mut inside) = (Vec::<Array>::new(), 0, String::new(), "");
    loop {
        let event = reader.read_event().map_err(|e| e.to_string())?;
        match &event {
            Event::Eof => return Ok((arrays, points)),
            Event::Start(tag) | Event::Empty(tag) => match tag.name().as_ref() {
                "Piece" => {
                    let count = attribute(tag, "NumberOfPoints").and_then(|n| n.parse().ok());
                    points = count.ok_or("a Piece without NumberOfPoints")?;
                }
                "DataArray" => {
                    arrays.push(Array {
                        section: section.clone(),
                        name: attribute(tag, "Name").ok_or("a DataArray without a name")?,
                        unit: String::new(),
                        components: attribute(tag, "NumberOfComponents")
                            .and_then(|n| n.parse().ok())
                            .unwrap_or(1),
                        offset: attribute(tag, "offset").and_then(|n| n.parse().ok()),
                        text: String::new(),
                    });
                    inside = if matches!(event, Event::Start(_)) { "text" } else { "" };
                }
                "InformationKey" => inside = "unit",
                name => section = name.into(),
            },
            Event::Text(text) => {
                if let Some(array) = arrays.last_mut() {
                    match inside {
                        "text" => array.text.push_str(&text.xml10_content()),
                        "unit" => array.unit.push_str(&text.xml10_content()),
                        _ => {}
                    }
                }
            }
            Event::GeneralRef(name) => {
                if let Some(array) = arrays.last_mut().filter(|_| inside == "unit") {
                    array
                        .unit
                        .push_str(quick_xml::escape::resolve_predefined_entity(name).unwrap_or_default());
                }
            }
            Event::End(_) => inside = "",
            _ => {}
        }
    }
}

/// Values of an appended array, `B` bytes each.
fn values<const B: usize>(data: &[u8], array: &Array) -> Result<Vec<[u8; B]>, Reason> {
    let block = || {
        let data = data.get(array.offset?..)?;
        let (length, data) = data.split_first_chunk::<8>()?;
        data.get(..usize::try_from(u64::from_le_bytes(*length)).ok()?)
    };
    let bytes =
        block().ok_or_else(|| format!("array `{}` reaches beyond the end of the file", array.name))?;
    let (chunks, remainder) = bytes.as_chunks::<B>();
    if remainder.is_empty() {
        Ok(chunks.to_vec())
    } else {
        Err(format!("array `{}` ends with an incomplete value", array.name).into())
    }
}

fn numbers(data: &[u8], array: &Array, expected: usize) -> Result<Vec<f64>, Reason> {
    let values: Vec<f64> = values(data, array)?.into_iter().map(f64::from_le_bytes).collect();
    if values.len() == expected {
        return Ok(values);
    }
    Err(format!("array `{}` has {} values instead of {expected}", array.name, values.len()).into())
}

/// Names of the bodies by number.
fn bodies_of(arrays: &[Array]) -> Result<Vec<String>, Reason> {
    let fields = || arrays.iter().filter(|a| a.section == "FieldData");
    // Files of earlier versions have one array of null-terminated strings.
    if let Some(all) = fields().find(|a| a.name == "bodies") {
        let codes = all.text.split_whitespace().map(str::parse).collect::<Result<Vec<u8>, _>>();
        let codes = codes.map_err(|e| format!("body names: {e}"))?;
        return Ok(codes.split(|&c| c == 0).map(|n| String::from_utf8_lossy(n).into_owned()).collect());
    }
    let numbered = fields().filter_map(|a| Some((a.name.strip_prefix(NAMED)?, a.text.trim())));
    let mut names = Vec::new();
    for (name, number) in numbered {
        if number.parse() != Ok(names.len()) {
            return Err(format!("body `{name}` has the number {number} instead of {}", names.len()).into());
        }
        names.push(name.to_owned());
    }
    Ok(names)
}

impl Block {
    /// Blocks of successive cells of the same body, type and degree; a cell is given by its body,
    /// its VTK type and its point numbers.
    pub(crate) fn gather(cells: Vec<(usize, u8, &[usize])>, names: &[String]) -> Result<Vec<Self>, Reason> {
        let mut blocks: Vec<Self> = Vec::new();
        let mut last = None;
        for (body, kind, nodes) in cells {
            let (cell, degree) = Cell::of_type(kind, nodes.len()).ok_or_else(|| {
                format!("cells of VTK type {kind} with {} nodes are not supported", nodes.len())
            })?;
            if last != Some((body, cell, degree)) {
                let name = names.get(body).cloned().ok_or("a cell belongs to an unnamed body")?;
                blocks.push(Self { body: name, cell, degree, connectivity: Vec::new() });
                last = Some((body, cell, degree));
            }
            if let Some(block) = blocks.last_mut() {
                block.connectivity.extend(nodes);
            }
        }
        Ok(blocks)
    }
}

impl FieldSet {
    /// Reads the bytes of a field file.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn from_vtu(bytes: &[u8]) -> Result<Self, Reason> {
        let cut = bytes.windows(APPENDED.len()).position(|w| w == APPENDED).ok_or("no appended raw data")?;
        let (text, data) = (&bytes[..cut], &bytes[cut + APPENDED.len()..]);
        let (arrays, n) = head(std::str::from_utf8(text).map_err(|e| e.to_string())?)?;
        let by_name: HashMap<(&str, &str), &Array> =
            arrays.iter().map(|a| ((a.section.as_str(), a.name.as_str()), a)).collect();
        let find =
            |section, name| by_name.get(&(section, name)).copied().ok_or(format!("no {name} in {section}"));

        let coordinates = n.checked_mul(3).ok_or("too many points")?;
        let points = numbers(data, find("Points", "points")?, coordinates)?.as_chunks::<3>().0.to_vec();
        let index = |bytes| usize::try_from(i64::from_le_bytes(bytes)).map_err(|e| e.to_string());
        let read = |name| {
            values::<8>(data, find("Cells", name)?)?.into_iter().map(index).collect::<Result<Vec<_>, _>>()
        };
        let (connectivity, ends) = (read("connectivity")?, read("offsets")?);
        if let Some(node) = connectivity.iter().find(|&&node| node >= n) {
            return Err(format!("a cell refers to node {node}, but there are {n} points").into());
        }
        let types = values::<1>(data, find("Cells", "types")?)?;
        let bodies = values::<4>(data, find("CellData", "body")?)?;
        let names = bodies_of(&arrays)?;

        let mut start = 0;
        let cells = ends.iter().zip(types).zip(bodies).map(|((&end, [kind]), body)| {
            let nodes = connectivity.get(start..end).ok_or("cells reach beyond the connectivity")?;
            start = end;
            Ok((i32::from_le_bytes(body) as usize, kind, nodes))
        });
        let blocks = Block::gather(cells.collect::<Result<Vec<_>, Reason>>()?, &names)?;
        let arrays = arrays.iter().filter(|a| a.section == "PointData").map(|a| {
            let expected = n.checked_mul(a.components).ok_or("too many points")?;
            let values = numbers(data, a, expected)?;
            Ok(PointArray { name: a.name.clone(), unit: a.unit.clone(), components: a.components, values })
        });
        let arrays = arrays.collect::<Result<_, Reason>>()?;
        Ok(Self { points, blocks, arrays })
    }
}
