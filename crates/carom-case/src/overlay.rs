//! Reads measured data.

use super::keys::{Keys, Table, View};
use super::spec::OverlayKeys;
use super::{OverlaySpec, load_table};

/// The keys of an `[[overlay]]`.
pub const OVERLAY: Table = OverlayKeys::TABLE;

/// The measured data of a case or a study.
pub fn overlays(v: &View) -> Option<Vec<Option<OverlaySpec>>> {
    v.each("overlay", read)
}

/// Reads an `[[overlay]]`.
fn read(v: &View) -> Option<OverlaySpec> {
    let OverlayKeys { name, file, column, time, value, time_scale, scale, source } = OverlayKeys::read(v)?;
    match load_table::columns(&v.folder.join(&file), &file, [&time, &value]) {
        Ok(table) => {
            let times = table.times.iter().map(|t| t * time_scale).collect();
            let values = table.values.iter().map(|x| x * scale).collect();
            Some(OverlaySpec { name, file, column, times, values, source })
        }
        Err(error) => {
            let what = format!("the measured data \"{file}\" cannot be used");
            v.wrong("file", what, error.why, error.help)
        }
    }
}
