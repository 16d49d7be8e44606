//! Reads measured data.

use std::path::Path;

use super::OverlaySpec;
use super::load_table;
use super::problem::Problem;
use super::view::View;

/// Reads an `[[overlay]]`.
pub(super) fn read(v: View, folder: &Path, path: &str, problems: &mut Vec<Problem>) -> Option<OverlaySpec> {
    // A misspelt key is reported once, not as headings that the file does not have too.
    if v.table.0.iter().any(|entry| !v.keys.iter().any(|key| key.name == entry.key)) {
        return None;
    }
    let (file, time, value) = (v.text("file")?, v.text("time")?, v.text("value")?);
    let (time_scale, scale) = (v.number("time_scale")?, v.number("scale")?);
    match load_table::columns(&folder.join(&file), &file, [&time, &value]) {
        Ok(table) => Some(OverlaySpec {
            name: v.text("name")?,
            column: v.text("column")?,
            times: table.times.iter().map(|t| t * time_scale).collect(),
            values: table.values.iter().map(|x| x * scale).collect(),
            source: v.text("source"),
            file,
        }),
        Err(why) => {
            let what = format!("the measured data \"{file}\" cannot be used");
            let help = "the first line of the file has the headings that `time` and `value` name; its path is relative to the folder of the case";
            problems.push(Problem::new(format!("{path}.file"), what, why, help));
            None
        }
    }
}
