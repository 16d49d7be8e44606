//! The sections of a .msh file, versions 4.1 and 2.2 (Gmsh reference manual, "Gmsh file formats").

use std::collections::{BTreeSet, HashMap};

use super::error::{Fault, MshError, Place};
use super::file::{Block, Group, MshFile, Row, place};
use super::raw::RawBlock;
use super::source::{Encoding, Source};
use super::{version_2, version_4};

/// Sections read so far. Cells refer to nodes by tag and, in 4.1, to groups through entities, until
/// everything is read.
#[derive(Default)]
pub(super) struct Sections {
    pub(super) groups: Option<Vec<Group>>,
    /// Physical groups of an entity by its dimension and tag.
    pub(super) entities: Option<HashMap<(i64, i64), Vec<i64>>>,
    pub(super) nodes: Option<Vec<(Row, [f64; 3])>>,
    pub(super) blocks: Option<Vec<RawBlock>>,
}

/// Reads a .msh file of version 4.1 or 2.2, text or binary of either byte order.
///
/// # Errors
/// With line or byte: any violation of the format.
pub fn read(bytes: &[u8]) -> Result<MshFile, MshError> {
    let mut source = Source::new(bytes);
    if !matches!(source.next_line(), Ok(Some((_, "$MeshFormat")))) {
        return Err(MshError { place: Place::Line(1), fault: Fault::NotMsh });
    }
    let version = header(&mut source)?;
    end(&mut source, "$EndMeshFormat", "$MeshFormat")?;
    let mut sections = Sections::default();
    while let Some((place, name)) = source.next_line()? {
        let twice = |there: bool, name| {
            if there { Err(MshError { place, fault: Fault::SectionTwice(name) }) } else { Ok(()) }
        };
        match (name, version) {
            ("$PhysicalNames", _) => {
                twice(sections.groups.is_some(), "PhysicalNames")?;
                sections.groups = Some(physical_names(&mut source)?);
                end(&mut source, "$EndPhysicalNames", "$PhysicalNames")?;
            }
            ("$Entities", 4) => {
                twice(sections.entities.is_some(), "Entities")?;
                sections.entities = Some(version_4::entities(&mut source)?);
                end(&mut source, "$EndEntities", "$Entities")?;
            }
            ("$PartitionedEntities", _) => return Err(MshError { place, fault: Fault::Partitioned }),
            ("$Nodes", _) => {
                twice(sections.nodes.is_some(), "Nodes")?;
                let read = if version == 4 { version_4::nodes } else { version_2::nodes };
                sections.nodes = Some(read(&mut source)?);
                end(&mut source, "$EndNodes", "$Nodes")?;
            }
            ("$ParametricNodes", 2) => {
                twice(sections.nodes.is_some(), "Nodes")?;
                sections.nodes = Some(version_2::parametric_nodes(&mut source)?);
                end(&mut source, "$EndParametricNodes", "$ParametricNodes")?;
            }
            ("$Elements", _) => {
                twice(sections.blocks.is_some(), "Elements")?;
                let read = if version == 4 { version_4::elements } else { version_2::elements };
                sections.blocks = Some(read(&mut source)?);
                end(&mut source, "$EndElements", "$Elements")?;
            }
            (name, _) => {
                let Some(other) = name.strip_prefix('$').filter(|n| !n.starts_with("End")) else {
                    return Err(unexpected(place, "a section $…", name));
                };
                source.skip_past(&format!("$End{other}"), "a section that is not read")?;
            }
        }
    }
    if version == 4 && sections.entities.is_none() {
        if sections.groups.as_ref().is_some_and(|groups| !groups.is_empty()) {
            return Err(MshError::whole(Fault::NoSection("Entities")));
        }
        sections.entities = Some(HashMap::new());
    }
    resolved(sections, source.encoding == Encoding::Text)
}

fn header(source: &mut Source) -> Result<u8, MshError> {
    let (place, line) = source.line("$MeshFormat")?;
    let wrong = |fault| Err(MshError { place, fault });
    let words: Vec<_> = line.split_ascii_whitespace().collect();
    let [version, binary, size] = words[..] else {
        return Err(unexpected(place, "version, file type and size", line));
    };
    let number = match version.parse::<f64>() {
        Ok(4.1) => 4,
        Ok(2.2) => 2,
        _ => return wrong(Fault::Version(version.to_owned())),
    };
    match (binary, size) {
        ("0", _) => return Ok(number),
        ("1", "8") => {}
        ("1", _) => return wrong(Fault::Header("a binary file must have numbers of 8 bytes")),
        _ => return wrong(Fault::Header("the file type is neither 0 nor 1")),
    }
    source.encoding = Encoding::Binary { big_endian: false };
    match source.int("$MeshFormat")? {
        1 => {}
        0x0100_0000 => source.encoding = Encoding::Binary { big_endian: true },
        _ => return wrong(Fault::Header("the integer after it is 1 in neither byte order")),
    }
    Ok(number)
}

fn end(source: &mut Source, wanted: &str, section: &'static str) -> Result<(), MshError> {
    let (place, found) = source.line(section)?;
    if found == wanted {
        return Ok(());
    }
    // The file ends within its last word.
    if source.left() == 0 && wanted.starts_with(found) {
        return Err(source.error(Fault::Truncated(section)));
    }
    Err(unexpected(place, wanted, found))
}

fn unexpected(place: Place, wanted: &str, found: &str) -> MshError {
    let fault = Fault::Unexpected { wanted: wanted.to_owned(), found: found.chars().take(40).collect() };
    MshError { place, fault }
}

/// Text in both encodings: `dimension tag "name"`.
fn physical_names(source: &mut Source) -> Result<Vec<Group>, MshError> {
    source.as_text(|source| {
        let count = source.count("physical names", 2)?;
        source.end_row()?;
        let mut groups = Vec::new();
        for _ in 0..count {
            let (place, line) = source.line("$PhysicalNames")?;
            let mut rest = line;
            let mut number = || {
                let (word, after) = rest.trim_start().split_once(char::is_whitespace)?;
                rest = after;
                word.parse::<i64>().ok()
            };
            let numbers = [number(), number()];
            let name = rest.trim().strip_prefix('"').and_then(|name| name.strip_suffix('"'));
            let ([Some(dimension), Some(tag)], Some(name)) = (numbers, name) else {
                return Err(unexpected(place, "dimension, number and \"name\"", line));
            };
            groups.push(Group { dimension, tag, name: name.to_owned() });
        }
        Ok(groups)
    })
}

/// Replaces tags by indices.
fn resolved(sections: Sections, text: bool) -> Result<MshFile, MshError> {
    let missing = |name| MshError::whole(Fault::NoSection(name));
    let raw_nodes = sections.nodes.ok_or_else(|| missing("Nodes"))?;
    let raw_blocks = sections.blocks.ok_or_else(|| missing("Elements"))?;
    let mut groups = sections.groups.unwrap_or_default();
    let mut index = HashMap::with_capacity(raw_nodes.len());
    for (i, (row, _)) in raw_nodes.iter().enumerate() {
        if index.insert(row.tag, i).is_some() {
            return Err(MshError {
                place: place(text, row),
                fault: Fault::TagTwice { what: "node", tag: row.tag },
            });
        }
    }
    let mut blocks = Vec::with_capacity(raw_blocks.len());
    for raw in raw_blocks {
        let groups = match &sections.entities {
            Some(entities) => entities.get(&(raw.dimension, raw.owner)).cloned().unwrap_or_default(),
            None => vec![raw.owner],
        };
        let mut nodes = Vec::with_capacity(raw.nodes.len());
        for (tags, row) in raw.nodes.chunks_exact(raw.kind.nodes).zip(&raw.rows) {
            for &node in tags {
                let fault = Fault::NoNode { cell: row.tag, node };
                nodes.push(*index.get(&node).ok_or(MshError { place: place(text, row), fault })?);
            }
        }
        blocks.push(Block { kind: raw.kind, groups, rows: raw.rows, nodes });
    }
    groups.extend(unnamed(&groups, &blocks));
    Ok(MshFile { text, groups, slits: false, regions: Vec::new(), nodes: raw_nodes, blocks })
}

/// Groups that have cells but no name, named by their number unless another one has that name.
fn unnamed(groups: &[Group], blocks: &[Block]) -> Vec<Group> {
    let of_block = |block: &Block| {
        let dimension = block.kind.dimension();
        block.groups.iter().map(move |tag| (dimension, *tag)).collect::<Vec<_>>()
    };
    // In version 2.2, 0 is no group.
    let tags: BTreeSet<(i64, i64)> = blocks.iter().flat_map(of_block).filter(|(_, tag)| *tag != 0).collect();
    let numbered = |(dimension, tag): (i64, i64)| Group { dimension, tag, name: tag.to_string() };
    let is_new = |group: &Group| {
        let known = |other: &Group| other.tag == group.tag || other.name == group.name;
        !groups.iter().any(|other| other.dimension == group.dimension && known(other))
    };
    tags.into_iter().map(numbered).filter(is_new).collect()
}
