//! The arms of a study in the order of the ranking, in tables narrow enough for print: errors and
//! costs; energy and contact force; penetration and errors; errors of stresses. A quantity that is
//! not available in any arm has no column.

use carom_record::study::compared::is_stress;
use carom_record::study::design::{Design, Kind};
use carom_record::study::ranking::{Ranking, error, standing};
use carom_record::study::reference::{Reference, Standing};
use carom_record::study::{Arm, Study, step};
use maud::{Markup, html};

use crate::collected::{Origin, in_time, time_unit, twin};
use crate::design::OFF_BUDGET;
use crate::digits::{count, five, three, three_digits};
use crate::document::joined;
use crate::labels::with_unit;
use crate::round_off::Scales;
use crate::text::Label;

/// Largest number of probe stresses that have a column.
const STRESSES: usize = 3;

/// A column with values in less than this fraction of its cells is none.
const SPARSE: usize = 4;

/// In tables of at least `LONG` rows, a value in more than this fraction of the cells of a column
/// is said below the table.
const COMMON: f64 = 0.75;
const LONG: usize = 8;

/// A heading and the cells below it, in the order of the ranked arms.
struct Column {
    head: String,
    cells: Vec<Option<String>>,
}

/// The ranked arms, from which columns are made.
struct Ranked<'a> {
    study: &'a Study,
    arms: Vec<usize>,
    scales: Scales,
}

impl Ranked<'_> {
    fn column(&self, head: &str, cell: impl Fn(usize) -> Option<String>) -> Column {
        Column { head: head.to_owned(), cells: self.arms.iter().map(|arm| cell(*arm)).collect() }
    }

    /// A heading with the unit of a metric.
    fn with_unit(&self, head: &str, metric: &str) -> String {
        let of = self.study.metrics().into_iter().find(|m| m.name == metric);
        with_unit(head, of.map_or("", |m| &m.unit))
    }

    /// The values of a metric.
    fn metric(&self, head: &str, metric: &str) -> Column {
        self.column(head, |arm| {
            let metric = self.study.rows[arm].metrics.iter().find(|m| m.name == metric)?;
            Some(self.scales.shown(metric, metric.value?, three_digits))
        })
    }

    /// The values of a metric that counts something.
    fn count(&self, head: &str, metric: &str) -> Column {
        self.column(head, |arm| self.study.rows[arm].value(metric).map(count))
    }

    /// Relative error of a metric, where the reference establishes a nonzero value.
    fn error(&self, head: &str, metric: &str) -> Column {
        let known = standing(self.study.reference.as_ref(), metric);
        let Standing::Established { value: right, uncertainty } = known else {
            return self.column(head, |_| None);
        };
        let relative = if right == 0.0 { f64::INFINITY } else { uncertainty / right.abs() };
        let mesh = self.study.reference.as_ref().is_none_or(Reference::refines_mesh);
        let head = match relative {
            0.0 => head.to_owned(),
            _ if !mesh => format!("{head} ± {} (step only)", three(relative)),
            _ => format!("{head} ± {}", three(relative)),
        };
        self.column(&head, |arm| {
            let value = self.study.rows[arm].value(metric).filter(|_| relative.is_finite())?;
            Some(three_digits(error(value, right)))
        })
    }

    /// Total variation of the contact force relative to that of the reference, minus 1.
    fn excess_variation(&self) -> Column {
        let right = standing(self.study.reference.as_ref(), "force_variation").established();
        let right = right.map(|known| known.0).filter(|right| *right > 0.0);
        self.column("Excess variation", |arm| {
            Some(three_digits(self.study.rows[arm].value("force_variation")? / right? - 1.0))
        })
    }

    /// Time by which an arm lags the reference.
    fn delay(&self) -> Column {
        self.column(&with_unit("Delay", time_unit(self.study)), |arm| {
            Some(three_digits(self.study.compared.get(arm)?.as_ref()?.late.as_ref()?.1))
        })
    }

    /// Counted cost and processor time relative to the budget.
    fn budgets(&self, design: &Design) -> [Column; 2] {
        let share = |share: f64| {
            let mark = if (share - 1.0).abs() <= OFF_BUDGET { "" } else { " !" };
            format!("{}{mark}", three_digits(share))
        };
        let m = &self.study.manifest;
        let parts = |arm: usize| &m.arms[arm].role;
        let measured = |arm: usize| {
            let level = parts(arm).level;
            if design.kind == Kind::MatchedStep && !m.by_cost(&m.arms[arm]) {
                return None;
            }
            let mut arms = m.arms.iter();
            let anchor =
                arms.position(|a| a.role.level == level && a.role.method.as_ref() == Some(&design.cost_of))?;
            Some(share(self.study.rows[arm].value("cpu_time")? / self.study.rows[anchor].value("cpu_time")?))
        };
        [
            self.column("Counted cost / budget", |arm| parts(arm).cost.map(share)),
            self.column("CPU time / budget", measured),
        ]
    }

    /// Errors of the mean peaks of the probe stresses.
    fn stresses(&self) -> Vec<Column> {
        let metrics = self.study.metrics();
        let peaks = metrics.iter().filter_map(|m| m.name.strip_suffix(":peak_mean")).filter(|c| is_stress(c));
        let error = |c: &str| self.error(&format!("Error of {c} peak"), &format!("{c}:peak_mean"));
        peaks.take(STRESSES).map(error).collect()
    }
}

/// The tables, and the headings of what they show.
pub(crate) fn tables(study: &Study, ranking: &Ranking, origins: &[Origin]) -> (Markup, Vec<String>) {
    let arms = ranking.levels.iter().flatten().map(|r| r.arm).collect();
    let ranked = Ranked { study, arms, scales: Scales::of(study) };
    let error_of = |arm: usize| {
        let ranked = ranking.levels.iter().flatten().find(|r| r.arm == arm)?;
        Some(match ranked.uncertainty {
            0.0 => three_digits(ranked.error),
            range => format!("{} ± {}", three_digits(ranked.error), three_digits(range)),
        })
    };
    let m = &study.manifest;
    let matched = m.design.as_ref().filter(|_| m.arms.iter().any(|arm| m.by_cost(arm)));
    let error = if study.manifest.ensemble.is_some() { "Error, median of the ensemble" } else { "Error" };
    let mut first = vec![
        ranked.column(&with_unit("Δt", time_unit(study)), |arm| {
            let arm = &study.manifest.arms[arm];
            // A step that was found has as many digits as are of use.
            step(arm, "time.step").map(if study.manifest.by_cost(arm) { three } else { five })
        }),
        ranked.column(error, error_of),
        ranked.delay(),
        ranked.count("Steps", "steps"),
        ranked.count("Newton iterations", "newton_iterations"),
        ranked.count("Rejected", "rejected_steps"),
        ranked.metric("CPU (s)", "cpu_time"),
        ranked.metric("Wall (s)", "wall_time"),
    ];
    first.extend(matched.into_iter().flat_map(|design| ranked.budgets(design)));
    let second = [
        ranked.metric("Energy drift", "energy_drift"),
        ranked.metric("Lost at end", "energy_lost"),
        ranked.metric("Lost in impact", "energy_lost_impact"),
        ranked.metric("By integrator", "dissipated_integrator"),
        ranked.metric("By contact", "dissipated_contact"),
        ranked.excess_variation(),
        ranked.metric("High-frequency power", "force_high_frequency"),
        ranked.metric(&ranked.with_unit("Chatter", "chatter"), "chatter"),
    ];
    let third = [
        ranked.metric(&ranked.with_unit("Max. penetration", "penetration"), "penetration"),
        ranked.metric(&ranked.with_unit("Mean penetration", "penetration"), "penetration_mean"),
        ranked.error("Error of x impulse", "impulse_x"),
        ranked.error("Error of y impulse", "impulse_y"),
        ranked.error("Error of restitution", "restitution"),
        ranked.error("Error of contact duration", "contact_duration"),
    ];
    let fourth = ranked.stresses();
    let all = first.iter().chain(&second).chain(&third).chain(&fourth);
    let heads = all.filter(|c| c.cells.iter().any(Option::is_some)).map(|c| c.head.clone()).collect();
    let same = |arm: usize| {
        let first = twin(origins, arm).filter(|first| ranked.arms.contains(first))?;
        Some(study.manifest.arms[first].method())
    };
    let table = |title: &str, columns: &[Column]| table(title, ranking, &ranked, columns, &same);
    let tables = html! {
        (table("Error and cost", &first))
        (table("Energy and roughness of the contact force", &second))
        (table("Penetration and errors", &third))
        (table("Errors of stresses", &fourth))
    };
    (tables, heads)
}

/// The value that nearly all cells of a long column have.
fn common(column: &Column) -> Option<&str> {
    let mut texts: Vec<&str> = column.cells.iter().flatten().map(String::as_str).collect();
    texts.sort_unstable();
    let most = texts.chunk_by(|a, b| a == b).max_by_key(|same| same.len())?;
    let cells = column.cells.len();
    (cells >= LONG && most.len() as f64 > COMMON * cells as f64).then(|| most[0])
}

/// What a column says that is not shown as one: the values of a few arms, or the common one and
/// the others.
fn said(column: &Column, name: impl Fn(usize) -> String) -> String {
    let common = common(column);
    let others = column.cells.iter().enumerate().filter(|(_, cell)| cell.as_deref() != common);
    let others = others.filter_map(|(row, cell)| match (cell, common) {
        (None, None) => None,
        (cell, _) => Some(format!("{}: {}", name(row), cell.as_deref().unwrap_or("–"))),
    });
    let others: Vec<String> = others.collect();
    match common {
        None => format!("{}; of no other arm.", others.join("; ")),
        Some(value) if others.is_empty() => format!("{value} in all arms."),
        Some(value) => format!("{value}, but {}.", others.join("; ")),
    }
}

/// A table of the ranked arms; `same` is the method that an arm is identical to.
fn table<'a>(
    title: &str,
    ranking: &Ranking,
    Ranked { study, arms, .. }: &Ranked,
    columns: &[Column],
    same: &impl Fn(usize) -> Option<&'a str>,
) -> Markup {
    let (known, missing): (Vec<_>, Vec<_>) =
        columns.iter().partition(|c| c.cells.iter().any(Option::is_some));
    if known.is_empty() {
        return Markup::default();
    }
    // A few values are said below the table, and so is one that nearly all arms have.
    let is_said = |c: &&Column| {
        SPARSE * c.cells.iter().filter(|cell| cell.is_some()).count() < c.cells.len() || common(c).is_some()
    };
    let (told, shown): (Vec<&Column>, Vec<&Column>) = known.into_iter().partition(is_said);
    let name = |row: usize| study.rows[arms[row]].name.clone();
    let steps = study.manifest.design.as_ref().map_or(&[][..], |design| &design.steps);
    let level_words = |level: usize| match steps.get(level) {
        Some(h) => format!("Level {}: Δt = {}", level + 1, in_time(study, *h)),
        None => format!("Level {}", level + 1),
    };
    let chosen = ranking.verdict.as_ref().ok().map(|verdict| verdict.arm);
    let is_matched_step = study.manifest.design.as_ref().is_some_and(|d| d.kind == Kind::MatchedStep);
    let by_cost = |arm: &Arm| is_matched_step && study.manifest.by_cost(arm);
    // The cells of a column run through all levels.
    let mut rows = 0..;
    html! {
        h3 { (title) }
        table.metrics.ranking {
            thead {
                tr {
                    th.n { "Place" } th { "Method" }
                    @for column in &shown { th.n { (Label(&column.head)) } }
                }
            }
            @for (level, ranked) in ranking.levels.iter().enumerate() {
                @if ranking.levels.len() > 1 {
                    tr { td colspan=(shown.len() + 2) { b { (Label(&level_words(level))) } } }
                }
                @for (r, row) in ranked.iter().zip(rows.by_ref()) {
                    @let arm = &study.manifest.arms[r.arm];
                    tr {
                        td.n { (r.place) }
                        td.method {
                            @if chosen == Some(r.arm) { b { "▸ " (Label(arm.method())) } } @else { (Label(arm.method())) }
                            @if by_cost(arm) { span.small { " (matched by cost)" } }
                            @if let Some(first) = same(r.arm) { span.small { " (identical to " (Label(first)) ")" } }
                        }
                        @for column in &shown { td.n { (column.cells[row].as_deref().unwrap_or("–")) } }
                    }
                }
            }
        }
        @for column in &told {
            p.small { (Label(&column.head)) ": " (Label(&said(column, name))) }
        }
        @if !missing.is_empty() {
            p.small { "Not available: " (joined(missing.iter().map(|c| Label(&c.head)), ", ")) "." }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seven of eight cells are the same; of three of four, a short table, all are shown.
    #[test]
    fn a_common_value_is_said_once() {
        let column = |cells: &[&str]| Column {
            head: String::new(),
            cells: cells
                .iter()
                .map(|cell| Some((*cell).to_owned()).filter(|cell| !cell.is_empty()))
                .collect(),
        };
        let long = column(&["0", "0", "5", "0", "0", "0", "0", "0"]);
        assert_eq!(said(&long, |row| format!("arm {row}")), "0, but arm 2: 5.");
        assert_eq!(common(&column(&["0", "0", "5", "0"])), None);
        assert_eq!(
            said(&column(&["", "1", "", "", ""]), |row| format!("arm {row}")),
            "arm 1: 1; of no other arm."
        );
        assert_eq!(said(&column(&["0"; 9]), |_| String::new()), "0 in all arms.");
    }
}
