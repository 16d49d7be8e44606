//! `study.csv`, `study_tidy.csv` and `claims.csv`. A value that is not there is an empty cell; numbers read back to the same bits.

use super::{Study, Verdict};
use crate::{RecordError, Status, files};

/// A status as tables name it.
pub(super) fn word(status: Option<Status>) -> &'static str {
    match status {
        None => "waiting",
        Some(Status::Running) => "running",
        Some(Status::Finished) => "finished",
        Some(Status::Stopped) => "stopped",
        Some(Status::Failed) => "failed",
    }
}

fn cell(value: Option<f64>) -> String {
    value.map_or_else(String::new, |x| format!("{x:?}"))
}

impl Study {
    /// Writes the tables beside `study.json`.
    ///
    /// # Errors
    /// What the machine refused.
    pub fn write_tables(&self) -> Result<(), RecordError> {
        let names: Vec<&str> = self.metrics().iter().map(|m| m.name.as_ref()).collect();
        let header = ["arm", "status", "reason"].iter().copied().chain(names.iter().copied()).map(String::from);
        let wide = self.rows.iter().map(|row| {
            let first = [row.name.clone(), word(row.status).into(), row.reason.clone().unwrap_or_default()];
            first.into_iter().chain(names.iter().map(|name| cell(row.value(name)))).collect()
        });
        self.write("study.csv", std::iter::once(header.collect()).chain(wide))?;

        let header = ["arm", "metric", "value", "unit"].map(String::from).to_vec();
        let tidy = self.rows.iter().flat_map(|row| {
            row.metrics.iter().map(|m| vec![row.name.clone(), m.name.to_string(), cell(m.value), m.unit.clone()])
        });
        self.write("study_tidy.csv", std::iter::once(header).chain(tidy))?;

        if self.verdicts.is_empty() {
            return Ok(());
        }
        let header = ["claim", "compare", "left", "right", "verdict"].map(String::from).to_vec();
        let line = |v: &Verdict| {
            vec![v.claim.text.clone(), v.claim.compare.clone(), cell(v.left), cell(v.right), v.word().to_string()]
        };
        self.write("claims.csv", std::iter::once(header).chain(self.verdicts.iter().map(line)))
    }

    fn write(&self, name: &str, lines: impl Iterator<Item = Vec<String>>) -> Result<(), RecordError> {
        let path = self.directory.join(name);
        let mut writer = csv::Writer::from_writer(Vec::new());
        for line in lines {
            writer.write_record(&line).map_err(|e| RecordError::io("write", &path)(e.into()))?;
        }
        let bytes = writer.into_inner().map_err(|e| RecordError::io("write", &path)(e.into_error()))?;
        files::write_atomically(&path, &[&bytes])
    }
}
