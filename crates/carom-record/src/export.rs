//! The history of a run as text for other programs, with the units of its columns.

use std::io;

use serde_json::json;

use crate::{Column, Run};

impl Run {
    /// Names, units, then one line per row: shortest decimals that read back to the same bits.
    ///
    /// # Errors
    /// Input/output or system error.
    pub fn to_csv(&self) -> io::Result<String> {
        let Self { history, .. } = self;
        let mut writer =
            csv::WriterBuilder::new().terminator(csv::Terminator::Any(b'\n')).from_writer(Vec::new());
        writer.write_record(history.columns.iter().map(|column| &column.name))?;
        writer.write_record(history.columns.iter().map(|column| &column.unit))?;
        for row in 0..history.times().len() {
            let columns = history.columns.iter().zip(&history.values);
            writer.write_record(columns.map(|(column, values)| cell(column, values.get(row).copied())))?;
        }
        let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
        String::from_utf8(bytes).map_err(io::Error::other)
    }

    /// Columns with name, unit, description and values; a value that is not finite is null.
    pub fn to_json(&self) -> String {
        let columns = self.history.columns.iter().zip(&self.history.values);
        let columns = columns.map(|(column, values)| {
            let Column { name, unit, description, .. } = column;
            json!({ "name": name, "unit": unit, "description": description, "values": values })
        });
        let columns: Vec<_> = columns.collect();
        let Self { manifest, .. } = self;
        json!({ "title": manifest.facts.title, "version": manifest.version, "columns": columns }).to_string()
    }
}

fn cell(column: &Column, value: Option<f64>) -> String {
    match value {
        None => String::new(),
        Some(value) if column.integer && value.fract() == 0.0 => format!("{value}"),
        Some(value) => format!("{value:?}"),
    }
}
