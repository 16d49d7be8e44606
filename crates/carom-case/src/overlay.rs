//! Reads measured data.

use std::path::Path;

use super::document::Document;
use super::keys::OVERLAY;
use super::problem::Problem;
use super::tree::Node;
use super::view::View;
use super::{OverlaySpec, Preset, conform, load_table};

/// The measured data of a study file, whose files start at `folder`.
pub fn read_overlays(document: &Document, folder: &Path, problems: &mut Vec<Problem>) -> Vec<OverlaySpec> {
    let list = document.at("overlay").and_then(Node::list).unwrap_or_default();
    let mut found = Vec::new();
    for (i, table) in list.iter().enumerate().filter_map(|(i, node)| Some((i, node.table()?))) {
        let path = format!("overlay[{i}]");
        problems.extend(conform::table(table, &OVERLAY, &path));
        let view = View { table, keys: OVERLAY.keys, preset: Preset::Default };
        found.extend(read(view, folder, &path, problems));
    }
    found
}

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
        Err(error) => {
            let what = format!("the measured data \"{file}\" cannot be used");
            problems.push(Problem::new(format!("{path}.file"), what, error.why, error.help));
            None
        }
    }
}
