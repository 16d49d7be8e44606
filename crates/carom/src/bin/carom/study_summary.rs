//! The tables of a study on standard output, and its page.

use std::path::Path;

use carom_record::Status;
use carom_record::study::ranking::Ranking;
use carom_record::study::{Row, Study, StudyManifest};
use carom_report::{ReportError, ReportSummary};
use carom_study::Outcome;
use serde_json::json;

use crate::exit::Failure;
use crate::shared::{of_arms, warnings};
use crate::summary::{missed, short};
use crate::{console, out};

/// Metrics of the table that is printed; all are in study.csv.
const SHOWN: [&str; 6] =
    ["contact_duration", "impulse_y", "restitution", "energy_lost", "newton_iterations", "wall_time"];

/// Rebuilds tables, figures and page of a study, and the pages of its arms.
pub(crate) fn report(directory: &Path) -> Result<ReportSummary, Failure> {
    let manifest = StudyManifest::read(directory)?;
    for arm in &manifest.arms {
        let arm = directory.join(&arm.directory);
        if arm.join("manifest.json").is_file() {
            match carom_report::report(&arm) {
                // The table of the study says so.
                Err(ReportError::Record(error)) if !error.is_system() => {}
                made => drop(made?),
            }
        }
    }
    Ok(carom_report::study(directory)?)
}

/// Prints the tables of a study, and makes its page.
pub(crate) fn print(outcome: &Outcome, directory: &Path, page: bool, json: bool) -> Result<(), Failure> {
    let page = if page { Some(report(directory)?.page) } else { None };
    if json {
        let study = &outcome.study;
        let claims = study
            .verdicts
            .iter()
            .map(|v| {
                let ensemble = v.ensemble.as_ref().map(|confirmed| json!({ "held": confirmed.count, "of": confirmed.of }));
                json!({ "claim": v.claim.text, "left": v.left, "right": v.right, "verdict": v.word(), "ensemble": ensemble })
            });
        let claims: Vec<_> = claims.collect();
        let event = if outcome.interrupted { "interrupted" } else { "done" };
        out::event(
            &json!({ "event": event, "directory": directory, "report": page, "claims": claims, "warnings": warnings(&study.warnings(), &study.manifest) }),
        )?;
    } else if !console::is_quiet() {
        let study = &outcome.study;
        out::line(&text(study))?;
        for (warning, arms) in study.warnings() {
            console::say(console::warning("warning: ", &of_arms(&arms, &study.manifest), warning));
        }
        out::line(&page.as_deref().unwrap_or(directory).display().to_string())?;
    }
    Ok(())
}

fn text(study: &Study) -> String {
    let width = study.rows.iter().map(|r| r.name.chars().count()).max().unwrap_or(0);
    let head = |name: &str| match study.rows.iter().find_map(|row| unit(row, name)) {
        Some(unit) => format!("{name} [{unit}]"),
        None => name.to_owned(),
    };
    // Bars have no impulse along y.
    let has = |name: &str| study.rows.iter().any(|row| row.value(name).is_some());
    let impulse = if has("impulse_y") || !has("impulse_x") { "impulse_y" } else { "impulse_x" };
    let columns = SHOWN.map(|name| if name == "impulse_y" { impulse } else { name });
    let columns = columns.map(|name| (name, head(name)));
    let heads = columns.iter().fold(String::new(), |row, (_, head)| row + &format!("  {head:>17}"));
    let mut lines = vec![format!("{:width$}{heads}", "")];
    for (arm, row) in study.rows.iter().enumerate() {
        let cells: String = match row.status {
            Some(Status::Finished) => columns.iter().fold(String::new(), |line, (name, head)| {
                let width = head.chars().count().max(17);
                line + &format!("  {:>width$}", row.value(name).map_or("–".into(), short))
            }),
            Some(Status::Failed) => {
                let alike =
                    study.finished_alike(arm).map_or_else(String::new, |others| format!(" ({others})"));
                format!("  failed: {}{alike}", row.reason.as_deref().unwrap_or("?"))
            }
            Some(_) => "  not finished".to_owned(),
            None if row.is_damaged() => format!("  damaged: {}", row.reason.as_deref().unwrap_or("?")),
            None => "  not started".to_owned(),
        };
        lines.push(format!("{:width$}{cells}", row.name));
    }
    for v in &study.verdicts {
        let value = |x: Option<f64>| x.map_or("–".into(), short);
        let word = v.ensemble.as_ref().map_or_else(
            || format!("{:9}", v.word()),
            |confirmed| format!("confirmed in {} of {}", confirmed.count, confirmed.of),
        );
        let bound =
            v.bound.map_or_else(String::new, |(sign, bound)| format!(", claimed {sign} {}", short(bound)));
        let ratio = v.ensemble.as_ref().and_then(|confirmed| confirmed.ratio.as_ref()).map_or_else(
            String::new,
            |ratio| {
                let (low, high) = ratio.range();
                format!("; ratio {}, {} to {}{bound}", short(ratio.median()), short(low), short(high))
            },
        );
        lines.push(format!(
            "{word}  {}  ({} against {}{ratio})",
            v.claim.text,
            value(v.left),
            value(v.right)
        ));
    }
    let arms = study.rows.iter().flat_map(|row| row.expectations.iter().map(move |e| (Some(&row.name), e)));
    for (arm, e) in arms.chain(study.expectations.iter().map(|e| (None, e))) {
        let word = if e.pass { "met" } else { "MISSED" };
        let of = arm.map_or_else(String::new, |arm| format!(" of \"{arm}\""));
        let shown = |got| if e.pass { short(got) } else { missed(got, e.value) };
        let got = e.got.map_or_else(|| e.why.clone().unwrap_or_default(), shown);
        lines.push(format!("{word:9}  {}{of}: {got}  ({})", e.what, e.expected));
    }
    lines.extend(study.ranking.iter().flat_map(|ranking| recommendation(study, ranking)));
    lines.join("\n")
}

/// The unit of a metric; none if it is a number alone.
fn unit<'a>(row: &'a Row, name: &str) -> Option<&'a str> {
    let metric = row.metrics.iter().find(|metric| metric.name == name)?;
    (!metric.unit.is_empty()).then_some(metric.unit.as_str())
}

/// The recommendation of a study with a goal, as on its page.
fn recommendation(study: &Study, ranking: &Ranking) -> Vec<String> {
    let goal = ranking.goal.word();
    let verdict = match &ranking.verdict {
        Ok(verdict) => verdict,
        Err(reasons) => {
            let mut lines = vec![String::new(), format!("no recommendation for the goal \"{goal}\":")];
            let why = ranking.measure.as_ref().err().map(ToString::to_string);
            lines.extend(reasons.iter().chain(&why).map(|reason| format!("  {reason}")));
            return lines;
        }
    };
    let name = &study.manifest.arms[verdict.arm].name;
    let mut lines = vec![String::new(), format!("recommended for the goal \"{goal}\": {name}")];
    lines.extend(verdict.reasons.iter().map(|reason| format!("  {reason}")));
    if !verdict.alike.is_empty() {
        lines.push(format!("  not distinguished from it: {}", verdict.alike.join(" · ")));
    }
    lines.push(format!("confidence: {}", verdict.confidence.word()));
    lines.extend(verdict.confidence_reasons.iter().map(|reason| format!("  {reason}")));
    lines
}
