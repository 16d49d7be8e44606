//! Checks that the expectations of a study exist in the records of its arms: names of arms, columns
//! and metrics.

use carom_record::question::{Asked, Quantity, Question, Series, column_metric_names, metric_names};
use carom_record::{Expect, Expression, OrderOf, Reason};
use carom_run::case::{Case, Problem, history_columns};

/// Adds the problems of a study's expectations.
pub(crate) fn check(expects: &[Expect], arms: &[(&str, &Case)], problems: &mut Vec<Problem>) {
    for (i, expect) in expects.iter().enumerate() {
        let path = format!("expect[{i}].what");
        let wrong = match (&expect.order, &expect.deviation) {
            (Some(order), _) => order_of(order, arms).map_err(|what| (format!("expect[{i}].of"), what)),
            (None, Some(_)) => {
                Series::parse(&expect.what).and_then(|s| series(&s, arms)).map_err(|what| (path, what))
            }
            (None, None) => {
                Question::parse(&expect.what).and_then(|q| question(&q, arms)).map_err(|what| (path, what))
            }
        };
        if let Err((path, what)) = wrong {
            let why = "expectations of a study use the records of its arms";
            problems.push(Problem::new(path, what, why, "write for example 'last A.uy of \"ARM\"'"));
        }
    }
}

fn question(question: &Question, arms: &[(&str, &Case)]) -> Result<(), Reason> {
    question.quantities().into_iter().try_for_each(|quantity| match quantity {
        Quantity::Reduced(_, columns) => series(columns, arms),
        Quantity::Metric(name, arm) => metric(name, arm.as_deref(), arms),
    })
}

fn series(series: &Series, arms: &[(&str, &Case)]) -> Result<(), Reason> {
    series.columns.quantities().into_iter().try_for_each(|asked| column(asked, arms))
}

fn metric(name: &str, arm: Option<&str>, arms: &[(&str, &Case)]) -> Result<(), Reason> {
    match name.rsplit_once(':') {
        Some(("energy_lost", _)) => arms_of(arm, arms).map(drop),
        Some(("overlay_rms" | "overlay_peak" | "overlay_shift", of)) => measured(of, arm, arms),
        Some((of, what)) if column_metric_names().contains(&what) => {
            column(&Asked { column: of.to_owned(), arm: arm.map(str::to_owned) }, arms)
        }
        _ if metric_names().contains(&name) => arms_of(arm, arms).map(drop),
        _ => {
            Err(format!("there is no metric `{name}`; the metrics are: {}", metric_names().join(", ")).into())
        }
    }
}

/// Whether the cases of the arms have measured data of this name.
fn measured(name: &str, arm: Option<&str>, arms: &[(&str, &Case)]) -> Result<(), Reason> {
    for (arm, case) in arms_of(arm, arms)? {
        let names: Vec<&str> = case.overlays.iter().map(|overlay| overlay.name.as_str()).collect();
        if !names.contains(&name) {
            let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            return Err(format!(
                "the case of arm \"{arm}\" has no measured data `{name}`; its tables [[overlay]] are: {known}"
            )
            .into());
        }
    }
    Ok(())
}

fn column(asked: &Asked, arms: &[(&str, &Case)]) -> Result<(), Reason> {
    for (name, case) in arms_of(asked.arm.as_deref(), arms)? {
        let columns = history_columns(case);
        if !columns.contains(&asked.column) {
            let near = columns.iter().min_by_key(|c| strsim::damerau_levenshtein(c, &asked.column));
            let near = near.map_or_else(String::new, |near| format!(": did you mean `{near}`?"));
            return Err(
                format!("the record of arm \"{name}\" will have no column `{}`{near}", asked.column).into()
            );
        }
    }
    Ok(())
}

/// The arms of a quantity: the one it names, or all.
fn arms_of<'a>(
    arm: Option<&str>,
    arms: &'a [(&'a str, &'a Case)],
) -> Result<Vec<&'a (&'a str, &'a Case)>, Reason> {
    let Some(name) = arm else { return Ok(arms.iter().collect()) };
    let found: Vec<_> = arms.iter().filter(|(other, _)| *other == name).collect();
    if found.is_empty() {
        let known: Vec<_> = arms.iter().map(|(name, _)| format!("\"{name}\"")).collect();
        return Err(format!("no arm is named \"{name}\"; the arms are: {}", known.join(", ")).into());
    }
    Ok(found)
}

fn order_of(order: &OrderOf, arms: &[(&str, &Case)]) -> Result<(), Reason> {
    match Question::parse(&order.of) {
        // A single word that is not a metric is a column.
        Ok(Expression::Quantity(Quantity::Metric(name, None)))
            if !name.contains(':') && !metric_names().contains(&name.as_str()) =>
        {
            column(&Asked { column: name, arm: None }, arms)
        }
        Ok(parsed) => question(&parsed, arms),
        Err(_) => series(&Series::parse(&order.of)?, arms),
    }
}
