//! `study.csv`, `study_tidy.csv`, `claims.csv`, `ensemble.csv`, `reference.csv`, `ranking.csv`,
//! `ranking.tex` and `verdict.json`.

use serde::Serialize;

use super::arm::step;
use super::ensemble::Spread;
use super::ranking::Ranking;
use super::{Row, Study, Verdict};
use crate::files::write_unsynced;
use crate::metrics::Metric;
use crate::{RecordError, Status, json, table};

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

impl Study {
    /// Writes the tables next to `study.json`.
    ///
    /// # Errors
    /// Input/output or system error.
    pub fn write_tables(&self) -> Result<(), RecordError> {
        self.write_arms()?;
        self.write_ensemble()?;
        self.write_reference()?;
        self.write_ranking()?;
        self.write_claims()
    }

    /// `study.csv`: one row per arm; `study_tidy.csv`: one row per arm and metric.
    fn write_arms(&self) -> Result<(), RecordError> {
        // Without measured times, so that its bytes do not depend on what computed the study.
        let metrics = self.metrics().into_iter().filter(|m| !m.is_measured());
        let names: Vec<&str> = metrics.map(|m| m.name.as_ref()).collect();
        let header = [&["arm", "status", "reason"], &names[..]].concat();
        let wide = self.rows.iter().map(|row| {
            let values: Vec<Option<f64>> = names.iter().map(|name| row.value(name)).collect();
            (&row.name, word(row), &row.reason, values)
        });
        table::write(&self.directory.join("study.csv"), &header, wide)?;
        let tidy = self
            .rows
            .iter()
            .flat_map(|row| row.metrics.iter().map(move |m| (&row.name, &m.name, m.value, &m.unit)));
        table::write(&self.directory.join("study_tidy.csv"), &["arm", "metric", "value", "unit"], tidy)
    }

    /// `claims.csv`, if the study has claims.
    fn write_claims(&self) -> Result<(), RecordError> {
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
        if self.verdicts.is_empty() {
            return Ok(());
        }
        let line = |v: &Verdict| {
            let confirmed = v.ensemble.as_ref();
            let ratio = confirmed.and_then(|confirmed| confirmed.ratio.as_ref());
            let bound = v.bound.map_or_else(String::new, |(sign, bound)| format!("{sign} {bound}"));
            (
                v.claim.text.clone(),
                v.claim.compare.clone(),
                v.left,
                v.right,
                v.word(),
                confirmed.map(|confirmed| confirmed.count),
                confirmed.map(|confirmed| confirmed.members),
                ratio.map(Spread::median).or(v.ratio),
                ratio.map(|ratio| ratio.range().0),
                ratio.map(|ratio| ratio.range().1),
                bound,
            )
        };
        table::write(&self.directory.join("claims.csv"), &header, self.verdicts.iter().map(line))
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
                Some((&row.name, &m.name, &m.unit, spread.count(), spread.median(), spread.range()))
            })
        });
        table::write(&self.directory.join("ensemble.csv"), &header, lines)
    }

    /// `reference.csv`: reference value and uncertainty of every metric.
    fn write_reference(&self) -> Result<(), RecordError> {
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
        let Some(reference) = &self.reference else { return Ok(()) };
        // A band on the given mesh says nothing of the error of that mesh.
        let refined = if reference.refines_mesh() { "mesh and step" } else { "step only" };
        let line = |m: &Metric| {
            let estimate = reference.estimate(&m.name).ok();
            let standing = self.standing(&m.name);
            let known = standing.as_ref().ok();
            (
                m.name.clone(),
                m.unit.clone(),
                if known.is_some() { "yes" } else { "no" },
                known.map(|known| known.value).or(estimate.map(|e| e.value)),
                known.map(|known| known.uncertainty).or(estimate.map(|e| e.uncertainty)),
                estimate.and_then(|e| e.order),
                estimate.map(|e| e.spread),
                standing.as_ref().err().map(ToString::to_string),
                refined,
            )
        };
        let metrics = self.metrics().into_iter().filter(|m| !m.is_work());
        table::write(&self.directory.join("reference.csv"), &header, metrics.map(line))
    }

    /// `ranking.csv`: level, place and error of every arm for all goals; `ranking.tex`: those of
    /// the study's goal; `verdict.json`: the recommendations for all goals. Neither depends on the
    /// order of the arms, on times or on the machine.
    fn write_ranking(&self) -> Result<(), RecordError> {
        let Some(ranking) = &self.ranking else { return Ok(()) };
        let header = [
            "goal",
            "level",
            "place",
            "arm",
            "method",
            "step",
            "error",
            "error_low",
            "error_high",
            "noise",
            "cost",
        ];
        let all = || std::iter::once(ranking).chain(&self.other_rankings);
        let ranked = all().flat_map(|ranking| {
            let levels = ranking.levels.iter().enumerate();
            levels.flat_map(move |(level, ranked)| ranked.iter().map(move |r| (ranking.goal, level, r)))
        });
        let lines = ranked.map(|(goal, level, r)| {
            let arm = &self.manifest.arms[r.arm];
            let named = (goal.word(), level, r.place, &arm.name, &arm.role.method);
            (named, step(arm, "time.step"), r.error, r.interval, r.noise, r.cost)
        });
        table::write(&self.directory.join("ranking.csv"), &header, lines)?;
        write_unsynced(&self.directory.join("ranking.tex"), &[self.latex(ranking).as_bytes()])?;
        let verdicts: Vec<_> = all().map(|ranking| self.stated(ranking)).collect();
        json::write(&self.directory.join("verdict.json"), &verdicts)
    }

    /// The verdict of a ranking as it is stored.
    fn stated<'a>(&'a self, ranking: &'a Ranking) -> Stated<'a> {
        let name = |arm: usize| self.manifest.arms[arm].name.as_str();
        let mut apart: Vec<_> =
            ranking.apart.iter().map(|apart| (name(apart.arm), apart.why.as_str())).collect();
        apart.sort_unstable();
        let verdict = ranking.verdict.as_ref().ok();
        let ranked = || ranking.levels.iter().flatten();
        Stated {
            goal: ranking.goal.word(),
            measure: ranking.measure.as_ref().ok().map(|measure| measure.words.as_str()),
            recommended: verdict.map(|verdict| name(verdict.arm)),
            error: verdict.and_then(|verdict| Some(ranked().find(|r| r.arm == verdict.arm)?.interval)),
            confidence: verdict.map(|verdict| verdict.confidence.word()),
            tied: verdict.map_or(&[], |verdict| &verdict.alike),
            reasons: ranking.verdict.as_ref().map_or_else(|why| why, |verdict| &verdict.reasons),
            doubts: verdict.map_or(&[], |verdict| &verdict.confidence_reasons),
            off_budget: self.manifest.off_budget().map(|arm| (arm.name.as_str(), arm.role.cost)).collect(),
            apart,
        }
    }
}

/// A verdict in `verdict.json`.
#[derive(Serialize)]
struct Stated<'a> {
    goal: &'a str,
    measure: Option<&'a str>,
    recommended: Option<&'a str>,
    /// Ends of the interval of the error.
    error: Option<[f64; 2]>,
    confidence: Option<&'a str>,
    tied: &'a [String],
    reasons: &'a [String],
    doubts: &'a [String],
    /// Arms of matched cost that missed their budget, with the share of it that they took.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    off_budget: Vec<(&'a str, Option<f64>)>,
    apart: Vec<(&'a str, &'a str)>,
}
