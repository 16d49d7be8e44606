//! Sections of version 4.1: entities own physical groups; nodes and cells are grouped by entity.

use std::collections::HashMap;

use super::cell_type::CellType;
use super::error::{Fault, MshError};
use super::file::Row;
use super::raw::{RawBlock, position};
use super::source::Source;

/// Physical groups by dimension and tag of the entity.
pub(super) fn entities(source: &mut Source) -> Result<HashMap<(i64, i64), Vec<i64>>, MshError> {
    const WITHIN: &str = "$Entities";
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = source.count("entities", 36)?;
    }
    source.end_row()?;
    let mut groups = HashMap::new();
    for (dimension, count) in (0..).zip(counts) {
        for _ in 0..count {
            let tag = source.int(WITHIN)?;
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                source.double(WITHIN)?;
            }
            let physical = source.count("physical groups", 4)?;
            // A negative group has reversed orientation.
            let of: Vec<i64> =
                (0..physical).map(|_| source.int(WITHIN).map(i64::abs)).collect::<Result<_, _>>()?;
            if dimension > 0 {
                for _ in 0..source.count("boundaries of an entity", 4)? {
                    source.int(WITHIN)?;
                }
            }
            source.end_row()?;
            groups.insert((dimension, tag), of);
        }
    }
    Ok(groups)
}

/// Tags and positions.
pub(super) fn nodes(source: &mut Source) -> Result<Vec<(Row, [f64; 3])>, MshError> {
    const WITHIN: &str = "$Nodes";
    let (blocks, total) = header(source, WITHIN, "blocks of nodes", "nodes", 32)?;
    let mut nodes = Vec::with_capacity(total);
    for _ in 0..blocks {
        let dimension = source.int(WITHIN)?;
        source.int(WITHIN)?;
        let parametric = source.int(WITHIN)? != 0;
        let count = source.count("nodes", 32)?;
        source.end_row()?;
        let mut tags = Vec::with_capacity(count);
        for _ in 0..count {
            let place = source.place();
            tags.push(Row::new(source.size(WITHIN)?, place));
            source.end_row()?;
        }
        for row in tags {
            nodes.push((row, position(source, row.tag)?));
            for _ in 0..if parametric { dimension.clamp(0, 3) } else { 0 } {
                source.double(WITHIN)?;
            }
            source.end_row()?;
        }
    }
    same(source, "nodes", total, nodes.len())?;
    Ok(nodes)
}

/// Cells by entity.
pub(super) fn elements(source: &mut Source) -> Result<Vec<RawBlock>, MshError> {
    const WITHIN: &str = "$Elements";
    let (count, total) = header(source, WITHIN, "blocks of cells", "cells", 16)?;
    let mut blocks = Vec::new();
    let mut found = 0;
    for _ in 0..count {
        let place = source.place();
        let dimension = source.int(WITHIN)?;
        let owner = source.int(WITHIN)?;
        let number = source.int(WITHIN)?;
        let Some(kind) = CellType::of(number) else {
            return Err(MshError {
                place,
                fault: Fault::UnknownType { cell: found as i64 + 1, kind: number },
            });
        };
        let count = source.count("cells", 8 * (1 + kind.nodes))?;
        source.end_row()?;
        let mut block =
            RawBlock { kind, dimension, owner, rows: Vec::with_capacity(count), nodes: Vec::new() };
        for _ in 0..count {
            let place = source.place();
            block.rows.push(Row::new(source.size(WITHIN)?, place));
            for _ in 0..kind.nodes {
                block.nodes.push(source.size(WITHIN)?);
            }
            source.end_row()?;
        }
        found += count;
        blocks.push(block);
    }
    same(source, "cells", total, found)?;
    Ok(blocks)
}

/// `blocks total minTag maxTag`.
fn header(
    source: &mut Source,
    within: &'static str,
    blocks: &'static str,
    what: &'static str,
    bytes: usize,
) -> Result<(usize, usize), MshError> {
    let blocks = source.count(blocks, 20)?;
    let total = source.count(what, bytes)?;
    source.size(within)?;
    source.size(within)?;
    source.end_row()?;
    Ok((blocks, total))
}

fn same(source: &Source, what: &'static str, count: usize, found: usize) -> Result<(), MshError> {
    if count == found {
        return Ok(());
    }
    Err(source.error(Fault::Total { what, count: count as u64, found: found as u64 }))
}
