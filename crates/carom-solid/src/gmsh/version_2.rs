//! Sections of version 2.2: nodes one by one, each cell with its physical group.

use super::cell_type::CellType;
use super::error::{Fault, MshError};
use super::file::Row;
use super::raw::{RawBlock, position};
use super::source::{Encoding, Source};

/// Counts are text even in binary files.
fn count(source: &mut Source, what: &'static str, bytes: usize) -> Result<usize, MshError> {
    let place = source.place();
    let count = source.as_text(|s| {
        let count = s.int(what)?;
        s.end_row()?;
        Ok(count)
    })?;
    source.room(what, count, bytes).map_err(|error| MshError { place, ..error })
}

/// Tags and positions.
pub(super) fn nodes(source: &mut Source) -> Result<Vec<(Row, [f64; 3])>, MshError> {
    rows(source, |_| Ok(()))
}

/// Tags and positions of nodes with parameters (`Mesh.SaveParametric`): after its position, a node
/// has the dimension and the tag of its entity, and a parameter on curves or two on surfaces.
pub(super) fn parametric_nodes(source: &mut Source) -> Result<Vec<(Row, [f64; 3])>, MshError> {
    const WITHIN: &str = "$ParametricNodes";
    rows(source, |source| {
        let dimension = source.int(WITHIN)?;
        source.int(WITHIN)?;
        for _ in 0..if dimension < 3 { dimension } else { 0 } {
            source.double(WITHIN)?;
        }
        Ok(())
    })
}

/// Rows of tag and position, and what `rest` reads after these.
fn rows(
    source: &mut Source,
    rest: impl Fn(&mut Source) -> Result<(), MshError>,
) -> Result<Vec<(Row, [f64; 3])>, MshError> {
    const WITHIN: &str = "$Nodes";
    let count = count(source, "nodes", 28)?;
    let mut nodes = Vec::with_capacity(count);
    for _ in 0..count {
        let place = source.place();
        let row = Row::new(source.int(WITHIN)?, place);
        nodes.push((row, position(source, row.tag)?));
        rest(source)?;
        source.end_row()?;
    }
    Ok(nodes)
}

/// Cells; consecutive ones of the same type and group form a block.
pub(super) fn elements(source: &mut Source) -> Result<Vec<RawBlock>, MshError> {
    const WITHIN: &str = "$Elements";
    let total = count(source, "cells", 8)?;
    let mut blocks = Vec::new();
    let mut found = 0;
    while found < total {
        if source.encoding == Encoding::Text {
            let place = source.place();
            let row = Row::new(source.int(WITHIN)?, place);
            let kind = kind(source, row.tag)?;
            let tags = tags(source)?;
            cell(source, row, kind, tags, &mut blocks)?;
            source.end_row()?;
            found += 1;
        } else {
            let kind = kind(source, found as i64 + 1)?;
            let count = source.int(WITHIN)?;
            let count = source.room("cells", count, 4 * (1 + kind.nodes))?;
            if count == 0 || found + count > total {
                let fault =
                    Fault::Total { what: "cells", count: total as u64, found: (found + count) as u64 };
                return Err(source.error(fault));
            }
            let tags = tags(source)?;
            for _ in 0..count {
                let place = source.place();
                let row = Row::new(source.int(WITHIN)?, place);
                cell(source, row, kind, tags, &mut blocks)?;
            }
            found += count;
        }
    }
    Ok(blocks)
}

fn kind(source: &mut Source, cell: i64) -> Result<CellType, MshError> {
    let place = source.place();
    let kind = source.int("$Elements")?;
    CellType::of(kind).ok_or(MshError { place, fault: Fault::UnknownType { cell, kind } })
}

/// Number of tags of a cell.
fn tags(source: &mut Source) -> Result<usize, MshError> {
    let tags = source.int("$Elements")?;
    source.room("tags of a cell", tags, 4)
}

/// Tags and nodes of a cell; the first tag is the physical group, the others are ignored.
fn cell(
    source: &mut Source,
    row: Row,
    kind: CellType,
    tags: usize,
    blocks: &mut Vec<RawBlock>,
) -> Result<(), MshError> {
    let mut group = 0;
    for i in 0..tags {
        let tag = source.int("$Elements")?;
        if i == 0 {
            group = tag.abs();
        }
    }
    let last = blocks.pop_if(|b| b.kind == kind && b.owner == group);
    let mut block = last.unwrap_or_else(|| RawBlock {
        kind,
        dimension: 0,
        owner: group,
        rows: Vec::new(),
        nodes: Vec::new(),
    });
    block.rows.push(row);
    for _ in 0..kind.nodes {
        block.nodes.push(source.int("$Elements")?);
    }
    blocks.push(block);
    Ok(())
}
