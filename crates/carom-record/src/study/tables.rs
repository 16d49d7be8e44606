//! `study.csv`, `study_tidy.csv`, `claims.csv`, `reference.csv` and `ranking.csv`. A missing value
//! is an empty cell; numbers read back to the same bits.

use super::arm::step;
use super::ensemble::Spread;
use super::measure::standing;
use super::reference::Standing;
use super::{Row, Study, Verdict};
use crate::metrics::Metric;
use crate::{RecordError, Status, files};

/// The status of an arm in the tables.
fn word(row: &Row) -> &'static str {
    match row.status {
        None if row.is_damaged() => "damaged",
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
        // Without measured times, so that its bytes do not depend on what computed the study.
        let metrics = self.metrics().into_iter().filter(|m| !m.is_measured());
        let names: Vec<&str> = metrics.map(|m| m.name.as_ref()).collect();
        let header = [&["arm", "status", "reason"], &names[..]].concat();
        let wide = self.rows.iter().map(|row| {
            let first = [row.name.clone(), word(row).into(), row.reason.clone().unwrap_or_default()];
            first.into_iter().chain(names.iter().map(|name| cell(row.value(name)))).collect()
        });
        self.write("study.csv", &header, wide)?;

        let header = ["arm", "metric", "value", "unit"];
        let tidy = self.rows.iter().flat_map(|row| {
            row.metrics
                .iter()
                .map(|m| vec![row.name.clone(), m.name.to_string(), cell(m.value), m.unit.clone()])
        });
        self.write("study_tidy.csv", &header, tidy)?;

        self.write_ensemble()?;
        self.write_ranking()?;
        if self.verdicts.is_empty() {
            return Ok(());
        }
        let header = [
            "claim",
            "compare",
            "left",
            "right",
            "verdict",
            "held",
            "of",
            "ratio",
            "ratio_low",
            "ratio_high",
            "bound",
        ];
        let line = |v: &Verdict| {
            let confirmed = v.ensemble.as_ref();
            let count = |n: Option<usize>| n.map_or_else(String::new, |n| n.to_string());
            let ratio = confirmed.and_then(|confirmed| confirmed.ratio.as_ref());
            let bound = v.bound.map_or_else(String::new, |(sign, bound)| format!("{sign} {bound}"));
            vec![
                v.claim.text.clone(),
                v.claim.compare.clone(),
                cell(v.left),
                cell(v.right),
                v.word().to_string(),
                count(confirmed.map(|confirmed| confirmed.count)),
                count(confirmed.map(|confirmed| confirmed.of)),
                cell(ratio.map(Spread::median).or(v.ratio)),
                cell(ratio.map(|r| r.range().0)),
                cell(ratio.map(|r| r.range().1)),
                bound,
            ]
        };
        self.write("claims.csv", &header, self.verdicts.iter().map(line))
    }

    /// `ensemble.csv`: median and range of every metric over the members of every arm.
    fn write_ensemble(&self) -> Result<(), RecordError> {
        if self.manifest.ensemble.is_none() {
            return Ok(());
        }
        let header = ["arm", "metric", "unit", "members", "median", "low", "high"];
        let lines = self.rows.iter().enumerate().flat_map(|(arm, row)| {
            row.metrics.iter().filter_map(move |m| {
                let spread = self.spread(arm, &m.name)?;
                let (low, high) = spread.range();
                let first =
                    [row.name.clone(), m.name.to_string(), m.unit.clone(), spread.count().to_string()];
                let numbers = [spread.median(), low, high].map(|x| cell(Some(x)));
                Some(first.into_iter().chain(numbers).collect())
            })
        });
        self.write("ensemble.csv", &header, lines)
    }

    /// `reference.csv`: reference value and uncertainty of every metric; `ranking.csv`: level,
    /// place and error of every arm.
    fn write_ranking(&self) -> Result<(), RecordError> {
        if let Some(reference) = &self.reference {
            let header = [
                "metric",
                "unit",
                "established",
                "value",
                "uncertainty",
                "order",
                "members_half_width",
                "why not",
                "refined",
            ];
            // A band on the given mesh says nothing of the error of that mesh.
            let refined = if reference.refines_mesh() { "mesh and step" } else { "step only" };
            let metrics = self.metrics().into_iter().filter(|m| !m.is_work());
            let line = |m: &Metric| {
                let estimate = reference.estimate(&m.name).ok();
                let (yes, known, why) = match standing(Some(reference), &m.name) {
                    Standing::Established { value, uncertainty } => {
                        ("yes", Some((value, uncertainty)), String::new())
                    }
                    Standing::Not(why) => ("no", estimate.map(|e| (e.value, e.uncertainty)), why),
                };
                vec![
                    m.name.to_string(),
                    m.unit.clone(),
                    yes.to_owned(),
                    cell(known.map(|k| k.0)),
                    cell(known.map(|k| k.1)),
                    cell(estimate.and_then(|e| e.order)),
                    cell(estimate.map(|e| e.spread)),
                    why,
                    refined.to_owned(),
                ]
            };
            self.write("reference.csv", &header, metrics.map(line))?;
        }
        let Some(ranking) = &self.ranking else { return Ok(()) };
        let header = ["level", "place", "arm", "method", "step", "error", "error_half_width", "cpu_time"];
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
                    cell(Some(r.uncertainty)),
                    cell(cpu),
                ]
            })
        });
        self.write("ranking.csv", &header, lines)
    }

    fn write(
        &self,
        name: &str,
        header: &[&str],
        lines: impl Iterator<Item = Vec<String>>,
    ) -> Result<(), RecordError> {
        let path = self.directory.join(name);
        let failed = |e: csv::Error| RecordError::io("write", &path)(e.into());
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(header).map_err(failed)?;
        for line in lines {
            writer.write_record(&line).map_err(failed)?;
        }
        let bytes = writer.into_inner().map_err(|e| RecordError::io("write", &path)(e.into_error()))?;
        files::write_atomically(&path, &[&bytes])
    }
}
