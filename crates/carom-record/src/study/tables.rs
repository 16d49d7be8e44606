//! `study.csv`, `study_tidy.csv`, `claims.csv`, `reference.csv` and `ranking.csv`. A missing value
//! is an empty cell; numbers read back to the same bits.

use super::arm::step;
use super::measure::standing;
use super::reference::Standing;
use super::{Study, Verdict};
use crate::metrics::{Metric, WORK};
use crate::{RecordError, Status, files};

/// A status in the tables.
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
    /// Writes the tables next to `study.json`.
    ///
    /// # Errors
    /// Input/output or system error.
    pub fn write_tables(&self) -> Result<(), RecordError> {
        let names: Vec<&str> = self.metrics().iter().map(|m| m.name.as_ref()).collect();
        let header =
            ["arm", "status", "reason"].iter().copied().chain(names.iter().copied()).map(String::from);
        let wide = self.rows.iter().map(|row| {
            let first = [row.name.clone(), word(row.status).into(), row.reason.clone().unwrap_or_default()];
            first.into_iter().chain(names.iter().map(|name| cell(row.value(name)))).collect()
        });
        self.write("study.csv", std::iter::once(header.collect()).chain(wide))?;

        let header = ["arm", "metric", "value", "unit"].map(String::from).to_vec();
        let tidy = self.rows.iter().flat_map(|row| {
            row.metrics
                .iter()
                .map(|m| vec![row.name.clone(), m.name.to_string(), cell(m.value), m.unit.clone()])
        });
        self.write("study_tidy.csv", std::iter::once(header).chain(tidy))?;

        self.write_ranking()?;
        if self.verdicts.is_empty() {
            return Ok(());
        }
        let header = ["claim", "compare", "left", "right", "verdict"].map(String::from).to_vec();
        let line = |v: &Verdict| {
            vec![
                v.claim.text.clone(),
                v.claim.compare.clone(),
                cell(v.left),
                cell(v.right),
                v.word().to_string(),
            ]
        };
        self.write("claims.csv", std::iter::once(header).chain(self.verdicts.iter().map(line)))
    }

    /// `reference.csv`: reference value and uncertainty of every metric; `ranking.csv`: level,
    /// place and error of every arm.
    fn write_ranking(&self) -> Result<(), RecordError> {
        if let Some(reference) = &self.reference {
            let header = ["metric", "unit", "established", "value", "uncertainty", "why not"]
                .map(String::from)
                .to_vec();
            let metrics = self.metrics().into_iter().filter(|m| !WORK.iter().any(|(d, _)| d.name == m.name));
            let line = |m: &Metric| {
                let end = match standing(Some(reference), &m.name) {
                    Standing::Established { value, uncertainty } => {
                        ["yes".to_owned(), cell(Some(value)), cell(Some(uncertainty)), String::new()]
                    }
                    Standing::Not(why) => ["no".to_owned(), String::new(), String::new(), why],
                };
                [m.name.to_string(), m.unit.clone()].into_iter().chain(end).collect()
            };
            self.write("reference.csv", std::iter::once(header).chain(metrics.map(line)))?;
        }
        let Some(ranking) = &self.ranking else { return Ok(()) };
        let header =
            ["level", "place", "arm", "method", "step", "error", "cpu_time"].map(String::from).to_vec();
        let lines = ranking.levels.iter().enumerate().flat_map(|(level, ranked)| {
            ranked.iter().map(move |r| {
                let arm = &self.manifest.arms[r.arm];
                let (step, cpu) = (step(arm, "time.step"), self.rows[r.arm].value("cpu_time"));
                let method = arm.role.method.clone().unwrap_or_default();
                vec![
                    level.to_string(),
                    r.place.to_string(),
                    arm.name.clone(),
                    method,
                    cell(step),
                    cell(Some(r.error)),
                    cell(cpu),
                ]
            })
        });
        self.write("ranking.csv", std::iter::once(header).chain(lines))
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
