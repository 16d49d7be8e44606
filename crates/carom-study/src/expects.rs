//! Checks that what the expectations and measured data of a study refer to exists in the records of
//! its arms: names of arms, columns and metrics.

use carom_record::metrics::Overlay;
use carom_record::question::{Asked, Quantity, Question, Series, column_metric_names, metric_names};
use carom_record::study::{Claim, Comparison};
use carom_record::{Expect, Expression, OrderOf, Reason};
use carom_run::case::{Case, Problem, history_columns};

/// Arms and measured data whose names the expectations of a study can contain.
struct Known<'a> {
    arms: &'a [(&'a str, &'a Case)],
    overlays: &'a [Overlay],
}

/// Adds the problems of a study's measured data: a name that is used twice, a column that no arm
/// has.
pub(crate) fn overlays(overlays: &[Overlay], arms: &[(&str, &Case)], problems: &mut Vec<Problem>) {
    for (i, Overlay { name, column, .. }) in overlays.iter().enumerate() {
        let twice = overlays[..i].iter().any(|other| other.name == *name);
        let of_case = arms.iter().any(|(_, case)| case.overlays.iter().any(|other| other.name == *name));
        if twice || of_case {
            let why = if twice {
                "figures and metrics identify measured data by name"
            } else {
                "the case has measured data of this name, which are compared with every arm too"
            };
            let what = format!("two [[overlay]] are named \"{name}\"");
            problems.push(Problem::new(format!("overlay[{i}].name"), what, why, "rename one of them"));
        }
        let columns: Vec<String> = arms.iter().flat_map(|(_, case)| names(case)).collect();
        if !columns.contains(column) {
            let what = format!("the records of the arms will have no column `{column}`");
            let why = "measured data are compared with a column of history.csv";
            let near = columns.iter().min_by_key(|c| strsim::damerau_levenshtein(c, column));
            let help = near.map_or_else(String::new, |near| format!("did you mean `{near}`?"));
            problems.push(Problem::new(format!("overlay[{i}].column"), what, why, help));
        }
    }
}

/// Adds the problems of a study's expectations.
pub(crate) fn check(
    expects: &[Expect],
    overlays: &[Overlay],
    arms: &[(&str, &Case)],
    problems: &mut Vec<Problem>,
) {
    let known = &Known { arms, overlays };
    for (i, expect) in expects.iter().enumerate() {
        let path = format!("expect[{i}].what");
        let wrong = match (&expect.order, &expect.deviation) {
            (Some(order), _) => order_of(order, known).map_err(|what| (format!("expect[{i}].of"), what)),
            (None, Some(_)) => {
                Series::parse(&expect.what).and_then(|s| series(&s, arms)).map_err(|what| (path, what))
            }
            (None, None) => {
                Question::parse(&expect.what).and_then(|q| question(&q, known)).map_err(|what| (path, what))
            }
        };
        if let Err((path, what)) = wrong {
            let why = "expectations of a study use the records of its arms";
            problems.push(Problem::new(path, what, why, "write for example 'last A.uy of \"ARM\"'"));
        }
    }
}

/// Adds the problems of a study's claims: metrics and columns that no record has.
pub(crate) fn claims(
    claims: &[Claim],
    overlays: &[Overlay],
    arms: &[(&str, &Case)],
    problems: &mut Vec<Problem>,
) {
    let known = &Known { arms, overlays };
    for (i, claim) in claims.iter().enumerate() {
        let Ok(comparison) = Comparison::parse(&claim.compare) else { continue };
        if let Some(what) = comparison.questions().iter().find_map(|asked| question(asked, known).err()) {
            let why = "claims compare numbers of the records of the arms";
            let help = "`carom explain` lists the metrics; a column is asked for as 'last A.uy of \"ARM\"'";
            problems.push(Problem::new(format!("claim[{i}].compare"), what, why, help));
        }
    }
}

fn question(question: &Question, known: &Known) -> Result<(), Reason> {
    question.quantities().into_iter().try_for_each(|quantity| match quantity {
        Quantity::Reduced(_, columns) => series(columns, known.arms),
        Quantity::Metric(name, arm) => metric(name, arm.as_deref(), known),
    })
}

fn series(series: &Series, arms: &[(&str, &Case)]) -> Result<(), Reason> {
    series.columns.quantities().into_iter().try_for_each(|asked| column(asked, arms))
}

fn metric(name: &str, arm: Option<&str>, known: &Known) -> Result<(), Reason> {
    let arms = known.arms;
    match name.rsplit_once(':') {
        Some(("energy_lost", _)) => arms_of(arm, arms).map(drop),
        Some(("overlay_rms" | "overlay_peak" | "overlay_shift", of)) => measured(of, arm, known),
        Some((of, what)) if column_metric_names().contains(&what) => {
            column(&Asked { column: of.to_owned(), arm: arm.map(str::to_owned) }, arms)
        }
        _ if metric_names().contains(&name) => arms_of(arm, arms).map(drop),
        _ => {
            let names = metric_names();
            let near = names.iter().min_by_key(|known| strsim::damerau_levenshtein(known, name));
            let near = near.map_or_else(String::new, |near| format!("did you mean `{near}`? "));
            Err(format!("there is no metric `{name}`: {near}the metrics are: {}", names.join(", ")).into())
        }
    }
}

/// Whether there are measured data of this name, in the study or in the cases of the arms.
fn measured(name: &str, arm: Option<&str>, known: &Known) -> Result<(), Reason> {
    let of_study: Vec<&str> = known.overlays.iter().map(|overlay| overlay.name.as_str()).collect();
    for (arm, case) in arms_of(arm, known.arms)? {
        let mut names = of_study.clone();
        names.extend(case.overlays.iter().map(|overlay| overlay.name.as_str()));
        if !names.contains(&name) {
            let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            return Err(format!(
                "arm \"{arm}\" has no measured data `{name}`; the tables [[overlay]] are: {known}"
            )
            .into());
        }
    }
    Ok(())
}

/// Names of the columns of a case.
fn names(case: &Case) -> impl Iterator<Item = String> + use<> {
    history_columns(case).into_iter().map(|column| column.name)
}

fn column(asked: &Asked, arms: &[(&str, &Case)]) -> Result<(), Reason> {
    for (name, case) in arms_of(asked.arm.as_deref(), arms)? {
        let columns: Vec<String> = names(case).collect();
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

fn order_of(order: &OrderOf, known: &Known) -> Result<(), Reason> {
    match Question::parse(&order.of) {
        // A single word that is not a metric is a column.
        Ok(Expression::Quantity(Quantity::Metric(name, None)))
            if !name.contains(':') && !metric_names().contains(&name.as_str()) =>
        {
            column(&Asked { column: name, arm: None }, known.arms)
        }
        Ok(parsed) => question(&parsed, known),
        Err(_) => series(&Series::parse(&order.of)?, known.arms),
    }
}
