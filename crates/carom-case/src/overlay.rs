//! Reads measured data.

use super::keys::Kind::{Name, Number};
use super::keys::{Keys, POSITIVE, Table, View};
use super::{OverlaySpec, load_table};

/// Measured data of one column: drawn with it, and compared by the metrics `overlay_rms:NAME`,
/// `overlay_peak:NAME` and `overlay_shift:NAME`.
#[derive(Keys)]
#[keys(name = "[[overlay]]")]
struct OverlayKeys {
    /// Name in figures and metrics.
    #[key(Name, example = "\"test-3\"")]
    name: String,
    /// CSV file with a line of headings, relative to the folder of the case or study; its lines
    /// that begin with # are comments.
    #[key(example = "\"measured.csv\"")]
    file: String,
    /// The column of history.csv that was measured.
    #[key(example = "\"A.uy\"")]
    column: String,
    /// Heading of the times in the file.
    #[key(default = "\"t\"")]
    time: String,
    /// Heading of the values in the file.
    #[key(default = "\"value\"")]
    value: String,
    /// Times of the case in one unit of those of the file: 1e-3 for ms in a case in s.
    #[key(Number(POSITIVE), default = "1.0")]
    time_scale: f64,
    /// Values of the column in one unit of those of the file: −1e-3 for mm downwards in a case in m
    /// upwards.
    #[key(default = "1.0")]
    scale: f64,
    /// Where the data come from.
    #[key(example = "\"own test, 3 May\"")]
    source: Option<String>,
}

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
