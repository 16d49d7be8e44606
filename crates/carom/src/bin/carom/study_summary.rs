//! The tables of a study on standard output, and its page.

use std::path::Path;

use carom_record::study::ranking::{Apart, Ranking};
use carom_record::study::{Row, Study, StudyManifest, Verdict};
use carom_record::{Status, Warning};
use carom_report::{ReportError, ReportSummary};
use carom_study::Outcome;
use serde_json::json;

use crate::exit::Failure;
use crate::shared::{of_arms, warnings};
use crate::text::{missed, short, short_or_dash};
use crate::{console, out, table};

/// Metrics of the table that is printed; all are in study.csv.
const SHOWN: [&str; 6] =
    ["contact_duration", "impulse_y", "restitution", "energy_lost", "newton_iterations", "wall_time"];

/// Share of the energy up to which it is round-off.
const ROUND_OFF: f64 = 1e-12;

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
pub(crate) fn print(outcome: &Outcome, directory: &Path, page: bool) -> Result<(), Failure> {
    let page = if page { Some(report(directory)?.page) } else { None };
    let study = &outcome.study;
    let claim = |v: &Verdict| {
        let ensemble =
            v.ensemble.as_ref().map(|confirmed| json!({ "held": confirmed.count, "of": confirmed.members }));
        json!({ "claim": v.claim.text, "left": v.left, "right": v.right, "verdict": v.word(), "ensemble": ensemble })
    };
    out::event(&json!({
        "event": if outcome.interrupted { "interrupted" } else { "done" },
        "directory": directory,
        "report": page,
        "claims": study.verdicts.iter().map(claim).collect::<Vec<_>>(),
        "warnings": warnings(&study.warnings(), &study.manifest),
    }))?;
    if !console::is_silent() {
        warn(study);
    }
    out::summary(&text(study))?;
    Ok(out::summary(&page.as_deref().unwrap_or(directory).display().to_string())?)
}

/// Prints the warnings of the arms. What was found in several arms differs in its numbers: it is
/// said once, of the first one.
fn warn(study: &Study) {
    let mut found: Vec<Vec<(&Warning, Vec<usize>)>> = Vec::new();
    for (warning, arms) in study.warnings() {
        let is_new_in = |(other, known): &(&Warning, Vec<usize>)| {
            other.id == warning.id
                && other.place == warning.place
                && !known.iter().any(|arm| arms.contains(arm))
        };
        match found.iter_mut().find(|same| same.iter().all(is_new_in)) {
            Some(same) => same.push((warning, arms)),
            None => found.push(vec![(warning, arms)]),
        }
    }
    for same in found {
        let mut warning = same[0].0.clone();
        let mut arms: Vec<usize> = same.iter().flat_map(|(_, arms)| arms.clone()).collect();
        if same.len() > 1 {
            let first = &study.rows[arms[0]].name;
            warning.what = format!("{} (\"{first}\"; with other numbers in the others)", warning.what);
        }
        arms.sort_unstable();
        console::say(console::warning("warning: ", &of_arms(&arms, &study.manifest), &warning));
    }
}

fn text(study: &Study) -> String {
    let mut lines = metrics(study);
    lines.extend(study.manifest.off_budget().map(|arm| {
        let share = arm
            .role
            .cost
            .map_or_else(|| "an unknown part of".to_owned(), |share| format!("{share:.2} times"));
        format!("not at equal cost: {} took {share} its budget", arm.name)
    }));
    lines.extend(study.verdicts.iter().map(claim));
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

/// The metrics of the arms as a table.
fn metrics(study: &Study) -> Vec<String> {
    // Bars have no impulse along y.
    let has = |name: &str| study.rows.iter().any(|row| row.value(name).is_some());
    let impulse = if has("impulse_y") || !has("impulse_x") { "impulse_y" } else { "impulse_x" };
    let columns = SHOWN.map(|name| if name == "impulse_y" { impulse } else { name });
    let columns: Vec<&str> = columns.into_iter().filter(|name| has(name)).collect();
    let head = |name: &str| match study.rows.iter().find_map(|row| unit(row, name)) {
        Some(unit) => format!("{name} [{unit}]"),
        None => name.to_owned(),
    };
    let mut rows =
        vec![std::iter::once(String::new()).chain(columns.iter().map(|name| head(name))).collect::<Vec<_>>()];
    for (arm, row) in study.rows.iter().enumerate() {
        let reason = || row.reason.as_deref().unwrap_or("?");
        let cells = match row.status {
            Some(Status::Finished) => columns.iter().map(|name| cell(row, name)).collect(),
            Some(Status::Failed) => {
                let alike =
                    study.finished_alike(arm).map_or_else(String::new, |others| format!(" ({others})"));
                vec![format!("failed: {}{alike}", reason())]
            }
            Some(_) => vec!["not finished".to_owned()],
            None if row.is_damaged() => vec![format!("damaged: {}", reason())],
            None => vec!["not started".to_owned()],
        };
        rows.push(std::iter::once(row.name.clone()).chain(cells).collect());
    }
    table::lines(&rows, &(1..=columns.len()).collect::<Vec<_>>())
}

fn claim(v: &Verdict) -> String {
    let word = v
        .ensemble
        .as_ref()
        .map_or_else(|| format!("{:9}", v.word()), |confirmed| format!("confirmed in {}", confirmed.words()));
    let bound =
        v.bound.map_or_else(String::new, |(sign, bound)| format!(", claimed {sign} {}", short(bound)));
    let ratio = v.ensemble.as_ref().and_then(|confirmed| confirmed.ratio.as_ref()).map_or_else(
        String::new,
        |ratio| {
            let (low, high) = ratio.range();
            format!("; ratio {}, {} to {}{bound}", short(ratio.median()), short(low), short(high))
        },
    );
    let [left, right] = [v.left, v.right].map(short_or_dash);
    format!("{word}  {}  ({left} against {right}{ratio})", v.claim.text)
}

/// A metric of an arm. A share far below one is round-off.
fn cell(row: &Row, name: &str) -> String {
    let is_zero = |x: f64| x != 0.0 && x.abs() < ROUND_OFF && unit(row, name).is_none();
    match row.value(name) {
        Some(x) if is_zero(x) => "≈ 0".to_owned(),
        value => short_or_dash(value),
    }
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
            lines.extend(reasons.iter().map(|reason| format!("  {reason}")));
            lines.extend(set_apart(study, ranking));
            return lines;
        }
    };
    let name = &study.manifest.arms[verdict.arm].name;
    let mut lines = vec![String::new(), format!("recommended for the goal \"{goal}\": {name}")];
    lines.extend(verdict.reasons.iter().map(|reason| format!("  {reason}")));
    if !verdict.alike.is_empty() {
        lines.push(format!("  tied with it: {}", verdict.alike.join(" · ")));
    }
    lines.push(format!("confidence: {}", verdict.confidence.word()));
    lines.extend(verdict.confidence_reasons.iter().map(|reason| format!("  {reason}")));
    lines.extend(set_apart(study, ranking));
    lines
}

/// The arms that are not ranked, each with the reason.
fn set_apart(study: &Study, ranking: &Ranking) -> Vec<String> {
    if ranking.apart.is_empty() {
        return Vec::new();
    }
    let of = |apart: &Apart| format!("  {}: {}", study.manifest.arms[apart.arm].name, apart.why);
    std::iter::once("not ranked:".to_owned()).chain(ranking.apart.iter().map(of)).collect()
}
