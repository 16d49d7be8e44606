//! The verdict of a study and what stands behind it: ranking, what cannot be ranked on, orders by
//! phase.

use std::fmt::Write as _;

use carom_record::metrics::WORK;
use carom_record::study::design::Goal;
use carom_record::study::ranking::{Ranking, error, standing};
use carom_record::study::reference::Standing;
use carom_record::study::{Study, step};

use crate::digits::{five, three};
use crate::laboratory::methods;
use crate::ranked;
use crate::text::{escape, html};

/// Metrics whose error against the reference a user should know before taking a recommendation.
const SIDE: [(&str, &str); 8] = [
    ("energy_lost", "energy lost"),
    ("dissipated_integrator", "dissipated by the integrator"),
    ("dissipated_contact", "taken by contact"),
    ("force_variation", "error of the force's variation"),
    ("impulse_x", "error of the impulse along x"),
    ("impulse_y", "error of the impulse along y"),
    ("contact_duration", "error of the contact's duration"),
    ("restitution", "error of restitution"),
];

/// What the columns of the ranking hold.
const COLUMNS: [&str; 9] = [
    "Errors and energies are relative.",
    "±: the uncertainty of the reference.",
    "Energy drift: its largest change at any time.",
    "Lost in an impact: over the one that changes the energy most.",
    "By integrator: what it took by the end.",
    "By contact: what it took by the end.",
    "TV beyond: total variation of the contact force over the reference's, minus 1.",
    "Peak: the stress averaged over a sixteenth of the contact.",
    "Orders: of the errors against the reference at the two finest levels, before the first contact and after it.",
];

/// The box at the top; nothing for a study without a goal.
pub(crate) fn show(out: &mut String, study: &Study) {
    let Some(ranking) = &study.ranking else { return };
    let goal = format!("goal: {} ({})", ranking.goal.word(), escape(ranking.goal.meaning()));
    let Some(verdict) = &ranking.verdict else {
        let why = match &ranking.measure {
            Err(why) => why.clone(),
            Ok(measure) => format!("no arm has a value of: {}", measure.words),
        };
        let _ = writeln!(
            out,
            "<section class=\"verdict none\"><h2>No recommendation</h2>\n<p>{goal}. Nothing can be ranked: {}.</p></section>",
            html(&why)
        );
        return;
    };
    let arm = &study.manifest.arms[verdict.arm];
    let name = arm.role.method.as_ref().unwrap_or(&arm.name);
    let at = step(arm, "time.step").map_or_else(String::new, |h| format!(", Δt = {}", five(h)));
    let _ = writeln!(
        out,
        "<section class=\"verdict\"><h2>Recommended: {}{at}</h2>\n<p>{goal}.</p>\n<dl>",
        escape(name)
    );
    let sets = arm.sets.iter().filter(|set| !set.trim_start().starts_with("time.step"));
    let sets: Vec<String> = sets.map(|set| format!("<code>{}</code>", escape(set))).collect();
    if !sets.is_empty() {
        let _ = writeln!(out, "<dt>In the case</dt><dd>{}</dd>", sets.join("<br>"));
    }
    let mut entry = |head: &str, lines: &[String]| {
        let _ = write!(out, "<dt>{head}</dt>");
        for line in lines {
            let _ = write!(out, "<dd>{}</dd>", html(line));
        }
        out.push('\n');
    };
    entry("Why", &verdict.reasons);
    if !verdict.alike.is_empty() {
        entry("Not told apart from it", &[verdict.alike.join(" · ")]);
    }
    entry("What it costs", &[costs(study, verdict.arm)]);
    entry("What it distorts", &distorts(study, verdict.arm));
    entry(&format!("Confidence: {}", verdict.confidence.word()), &verdict.confidence_reasons);
    out.push_str("</dl></section>\n");
}

fn costs(study: &Study, arm: usize) -> String {
    let cost = |i: usize| study.rows[i].value("cpu_time");
    let level = study.manifest.arms[arm].role.level;
    let same = methods(study)
        .into_iter()
        .flat_map(|(_, arms)| arms)
        .filter(|i| study.manifest.arms[*i].role.level == level);
    let least = same.filter_map(cost).fold(f64::INFINITY, f64::min);
    let of = |name: &str| study.rows[arm].value(name).map_or("–".into(), three);
    let against = cost(arm)
        .filter(|c| least > 0.0 && c.is_finite())
        .map_or_else(String::new, |c| format!(", {} times the least of its level", three(c / least)));
    format!(
        "{} s of processor time{against}; {} steps, {} Newton iterations, {} factorisations, {} rejected steps",
        of("cpu_time"),
        of("steps"),
        of("newton_iterations"),
        of("factorisations"),
        of("rejected_steps")
    )
}

/// Side effects that can be told, each with the least of its level.
fn distorts(study: &Study, arm: usize) -> Vec<String> {
    let level = study.manifest.arms[arm].role.level;
    let same: Vec<usize> = methods(study)
        .into_iter()
        .flat_map(|(_, arms)| arms)
        .filter(|i| study.manifest.arms[*i].role.level == level)
        .collect();
    let mut lines = Vec::new();
    for (metric, words) in SIDE {
        let Standing::Established { value: right, .. } = standing(study.reference.as_ref(), metric) else {
            continue;
        };
        // An error that is relative to nothing says nothing.
        if right == 0.0 && !metric.starts_with("energy") && !metric.starts_with("dissipated") {
            continue;
        }
        let of = |i: usize| study.rows[i].value(metric).map(|v| error(v, right));
        let Some(mine) = study.rows[arm].value(metric) else { continue };
        let least = same.iter().filter_map(|i| of(*i)).fold(f64::INFINITY, f64::min);
        let shown = if right == 0.0 { mine } else { error(mine, right) };
        lines.push(format!("{words}: {} (least of its level {})", three(shown), three(least)));
    }
    if let Some((column, late)) =
        study.compared.get(arm).and_then(Option::as_ref).and_then(|c| c.late.clone())
    {
        lines.push(format!(
            "{column} is {} by {}",
            if late < 0.0 { "early" } else { "late" },
            three(late.abs())
        ));
    }
    lines
}

/// Ranking and what cannot be ranked on.
pub(crate) fn rankings(out: &mut String, study: &Study) {
    let Some(ranking) = &study.ranking else { return };
    out.push_str("<h2>Ranking</h2>\n");
    if let Ok(measure) = &ranking.measure {
        let _ = writeln!(
            out,
            "<p>By {}; uncertainty of the errors {}.</p>",
            html(&measure.words),
            three(measure.uncertainty)
        );
        ranked_table(out, study, ranking);
    }
    other_goals(out, study);
    let Some(reference) = &study.reference else {
        out.push_str("<p>The study has no finished reference: only what has a right value by itself, such as energy, can be ranked.</p>\n");
        return;
    };
    let mut not = Vec::new();
    let mut yes = Vec::new();
    for metric in study.metrics().into_iter().filter(|m| !WORK.iter().any(|(d, _)| d.name == m.name)) {
        match standing(Some(reference), &metric.name) {
            Standing::Not(why) => not.push((metric.name.to_string(), why)),
            Standing::Established { value, uncertainty } => yes.push((metric, value, uncertainty)),
        }
    }
    let _ = writeln!(
        out,
        "<p>Reference: {}.</p>\n<details><summary>What it establishes, with its uncertainty</summary>\n<table><thead><tr><th>Metric</th><th>Unit</th><th class=\"n\">Value</th><th class=\"n\">±</th></tr></thead>",
        escape(&reference.what)
    );
    for (metric, value, uncertainty) in yes {
        let _ = writeln!(
            out,
            "<tr><td><code>{}</code></td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>",
            escape(&metric.name),
            html(&metric.unit),
            three(value),
            three(uncertainty)
        );
    }
    out.push_str("</table></details>\n<details open><summary>Not established by a refinement: never ranked on</summary>\n<table>\n");
    let deviations = reference.columns().into_iter().filter_map(|c| match reference.uncertainty(c) {
        Standing::Not(why) => Some((format!("deviation of {c}"), why)),
        Standing::Established { .. } => None,
    });
    for (name, why) in not.into_iter().chain(deviations) {
        let _ = writeln!(out, "<tr><td><code>{}</code></td><td>{}</td></tr>", escape(&name), escape(&why));
    }
    out.push_str("</table></details>\n");
}

/// What would be recommended by the other goals.
fn other_goals(out: &mut String, study: &Study) {
    out.push_str("<h3>By other goals</h3>\n<table><thead><tr><th>Goal</th><th>Recommended</th><th class=\"n\">Δt</th><th>Confidence</th><th>By</th></tr></thead>\n");
    for ranking in &study.other_rankings {
        let cells = match (&ranking.verdict, &ranking.measure) {
            (Some(verdict), Ok(measure)) => {
                let arm = &study.manifest.arms[verdict.arm];
                let mut name = escape(arm.role.method.as_ref().unwrap_or(&arm.name));
                if !verdict.alike.is_empty() {
                    let alike = escape(&verdict.alike.join(" · "));
                    let _ = write!(name, "<br><span class=\"small\">not told apart: {alike}</span>");
                }
                let at = step(arm, "time.step").map_or("–".into(), five);
                format!(
                    "<td>{name}</td><td class=\"n\">{at}</td><td>{}</td><td>{}</td>",
                    verdict.confidence.word(),
                    html(&measure.words)
                )
            }
            (_, Err(why)) => {
                format!(
                    "<td colspan=\"4\">nothing can be ranked: <span class=\"small\">{}</span></td>",
                    escape(why)
                )
            }
            (None, Ok(measure)) => format!(
                "<td colspan=\"4\">no arm has a value of: <span class=\"small\">{}</span></td>",
                html(&measure.words)
            ),
        };
        let _ = writeln!(out, "<tr><td>{}</td>{cells}</tr>", ranking.goal.word());
    }
    out.push_str("</table>\n");
}

fn ranked_table(out: &mut String, study: &Study, ranking: &Ranking) {
    ranked::tables(out, study, ranking);
    let placed = |arm: &usize| ranking.levels.iter().flatten().any(|r| r.arm == *arm);
    let without = methods(study).into_iter().flat_map(|(_, arms)| arms).filter(|arm| !placed(arm));
    let without: Vec<String> = without.map(|arm| escape(&study.rows[arm].name)).collect();
    if !without.is_empty() {
        let why =
            if ranking.goal == Goal::Cost { "not accurate enough" } else { "without a value of the measure" };
        let _ = writeln!(out, "<p class=\"small\">In no place, because {why}: {}.</p>", without.join("; "));
    }
    out.push_str("<p class=\"small\">Arms that share a place are not told apart: their errors differ by no more than the uncertainty of the reference, or 5 %.");
    if study.manifest.arms.iter().any(|arm| study.manifest.by_cost(arm)) {
        out.push_str(" An exclamation mark: off the budget by more than 10 %.");
    }
    out.push_str("</p>\n<ul class=\"small\">\n");
    for line in COLUMNS {
        let _ = writeln!(out, "<li>{line}</li>");
    }
    out.push_str("</ul>\n<p class=\"small\">All digits are in <a href=\"ranking.csv\">ranking.csv</a> and <a href=\"reference.csv\">reference.csv</a>.</p>\n");
}

/// Observed orders before the first contact and after it.
pub(crate) fn phases(out: &mut String, study: &Study) {
    if study.phase_orders.is_empty() {
        return;
    }
    out.push_str("<h2>Order before and after the first contact</h2>\n<table><thead><tr><th>Method</th><th>Column</th><th>Before the first contact</th><th>After it</th></tr></thead>\n");
    let cell = |order: &Result<f64, String>| match order {
        Ok(order) => format!("{order:.2}").replace('-', "−"),
        Err(why) => format!("<span class=\"small\">no order ({})</span>", escape(why)),
    };
    for o in &study.phase_orders {
        let _ = writeln!(
            out,
            "<tr><td>{}</td><td><code>{}</code></td><td>{}</td><td>{}</td></tr>",
            escape(&o.method),
            escape(&o.column),
            cell(&o.smooth),
            cell(&o.across)
        );
    }
    out.push_str("</table>\n<p class=\"small\">From the errors against the reference at the two finest levels, root mean square over the rows before the reference's first contact, and over those after its end.</p>\n");
}
