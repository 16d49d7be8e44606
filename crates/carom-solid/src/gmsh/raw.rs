//! Raw data common to both versions of the format: positions of nodes, and cells whose nodes are
//! still tags.

use super::cell_type::CellType;
use super::error::{Fault, MshError};
use super::file::Row;
use super::source::Source;

/// Cells of one type on one entity (4.1) or in one group (2.2), node tags row by row.
pub(super) struct RawBlock {
    pub(super) kind: CellType,
    pub(super) dimension: i64,
    pub(super) owner: i64,
    pub(super) rows: Vec<Row>,
    pub(super) nodes: Vec<i64>,
}

/// Coordinates of a node.
pub(super) fn position(source: &mut Source, tag: i64) -> Result<[f64; 3], MshError> {
    let place = source.place();
    let mut x = [0.0; 3];
    for x in &mut x {
        *x = source.double("$Nodes")?;
    }
    if x.iter().all(|x| x.is_finite()) {
        Ok(x)
    } else {
        Err(MshError { place, fault: Fault::NotFinite(tag) })
    }
}
