//! Reads measured data.

use std::cell::RefCell;
use std::path::Path;

use super::document::Document;
use super::keys::OVERLAY;
use super::problem::Problem;
use super::tree::Node;
use super::view::View;
use super::{OverlaySpec, conform, load_table};

/// The measured data of a study file, whose files start at `folder`.
pub fn read_overlays(document: &Document, folder: &Path, problems: &mut Vec<Problem>) -> Vec<OverlaySpec> {
    let list = document.at("overlay").and_then(Node::list).unwrap_or_default();
    let reported = RefCell::new(Vec::new());
    let mut found = Vec::new();
    for (i, table) in list.iter().enumerate().filter_map(|(i, node)| Some((i, node.table()?))) {
        let path = format!("overlay[{i}]");
        reported.borrow_mut().extend(conform::table(table, &OVERLAY, &path));
        let view = View { folder, path, ..View::of_keys(table, OVERLAY.keys, &reported) };
        found.extend(read(&view));
    }
    problems.extend(reported.take());
    found
}

/// Reads an `[[overlay]]`.
pub(super) fn read(v: &View) -> Option<OverlaySpec> {
    // A misspelt key is reported once, not as headings that the file does not have too.
    if v.has_unknown_key() {
        return None;
    }
    let (file, time, value) = (v.text("file")?, v.text("time")?, v.text("value")?);
    let (time_scale, scale) = (v.number("time_scale")?, v.number("scale")?);
    match load_table::columns(&v.folder.join(&file), &file, [&time, &value]) {
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
            v.wrong("file", what, error.why, error.help)
        }
    }
}
