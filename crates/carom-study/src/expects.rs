//! Checks that what the expectations and measured data of a study refer to exists in the records of
//! its arms: names of arms, columns and metrics.

use std::collections::BTreeSet;

use carom_record::metrics::Overlay;
use carom_record::question::{Quantity, Question, Series, column_metric_names, metric_names};
use carom_record::study::{Comparison, Sought};
use carom_record::{OrderOf, Reason};
use carom_run::case::{Case, Problem, history_columns};

use crate::file::StudyFile;
use crate::names::quoted;
use crate::resolved::Planned;

/// Arms and measured data whose names a study can contain.
struct Known<'a> {
    arms: &'a [Planned],
    overlays: &'a [Overlay],
}

/// Adds the problems of a study's measured data, expectations and claims.
pub(crate) fn check(file: &StudyFile, arms: &[Planned], problems: &mut Vec<Problem>) {
    let known = Known { arms, overlays: &file.overlays };
    overlays(&known, problems);
    for (i, expect) in file.expects.iter().enumerate() {
        if let Some(order) = &expect.order {
            order_of(i, order, arms, problems);
        }
        let asked = match (&expect.order, &expect.deviation) {
            (Some(order), _) => order.quantity(),
            (None, Some(_)) => Series::parse(&expect.what).map(Sought::Column),
            (None, None) => Question::parse(&expect.what).map(Sought::Number),
        };
        if let Err(what) = asked.and_then(|asked| known.answers(&asked)) {
            let key = if expect.order.is_some() { "of" } else { "what" };
            let why = "expectations of a study use the records of its arms";
            let help = "write for example 'last A.uy of \"ARM\"'";
            problems.push(Problem::new(format!("expect[{i}].{key}"), what, why, help));
        }
    }
    for (i, claim) in file.claims.iter().enumerate() {
        let Ok(comparison) = Comparison::parse(&claim.compare) else { continue };
        if let Some(what) = comparison.questions().iter().find_map(|asked| known.question(asked).err()) {
            let why = "claims compare numbers of the records of the arms";
            let help = "`carom explain` lists the metrics; a column is asked for as 'last A.uy of \"ARM\"'";
            problems.push(Problem::new(format!("claim[{i}].compare"), what, why, help));
        }
    }
}

/// Adds the problems of an expected order: a key that no arm sets, an exact value of a column.
fn order_of(i: usize, order: &OrderOf, arms: &[Planned], problems: &mut Vec<Problem>) {
    let key = |(set, _): &(String, String)| set.split('=').next().unwrap_or_default().trim().to_owned();
    let keys: BTreeSet<String> = arms.iter().flat_map(|arm| &arm.draft.sets).map(key).collect();
    let is_one_case = arms.iter().all(|arm| arm.draft.case.is_none());
    if is_one_case && !keys.contains(&order.against) {
        let what = format!("no arm sets `{}`", order.against);
        let why = "an order is observed from arms that differ in this key";
        let keys: Vec<&String> = keys.iter().collect();
        problems.push(Problem::new(format!("expect[{i}].against"), what, why, meant(&order.against, &keys)));
    }
    if order.exact.is_some() && matches!(order.quantity(), Ok(Sought::Column(_))) {
        let what = format!("`exact` is the exact value of a number, and `{}` is a column", order.of);
        let why = "the error of a column is that with respect to a formula of t, or to the reference";
        let help = format!("write for example `of = \"last {}\"`, or leave `exact` out", order.of);
        problems.push(Problem::new(format!("expect[{i}].exact"), what, why, help));
    }
}

/// Adds the problems of measured data: a name that is used twice, a column that no arm has.
fn overlays(known: &Known, problems: &mut Vec<Problem>) {
    for (i, Overlay { name, column, .. }) in known.overlays.iter().enumerate() {
        let twice = known.overlays[..i].iter().any(|other| other.name == *name);
        let of_case = known.arms.iter().any(|arm| arm.case.overlays.iter().any(|other| other.name == *name));
        if twice || of_case {
            let why = if twice {
                "figures and metrics identify measured data by name"
            } else {
                "the case has measured data of this name, which are compared with every arm too"
            };
            let what = format!("two [[overlay]] are named \"{name}\"");
            problems.push(Problem::new(format!("overlay[{i}].name"), what, why, "rename one of them"));
        }
        let columns: Vec<String> = known.arms.iter().flat_map(|arm| columns(&arm.case)).collect();
        if !columns.contains(column) {
            let what = format!("the records of the arms will have no column `{column}`");
            let why = "measured data are compared with a column of history.csv";
            problems.push(Problem::new(format!("overlay[{i}].column"), what, why, meant(column, &columns)));
        }
    }
}

/// Names of the columns of a case.
fn columns(case: &Case) -> Vec<String> {
    history_columns(case).into_iter().map(|column| column.name).collect()
}

/// Asks whether the most similar name was meant.
fn meant(given: &str, names: &[impl AsRef<str>]) -> String {
    let names = names.iter().map(AsRef::as_ref);
    let near = names.min_by_key(|name| strsim::damerau_levenshtein(name, given));
    near.map_or_else(String::new, |near| format!("did you mean `{near}`?"))
}

impl Known<'_> {
    /// Whether the records will have what a quantity is computed from.
    fn answers(&self, asked: &Sought) -> Result<(), Reason> {
        match asked {
            Sought::Number(question) => self.question(question),
            Sought::Column(series) => self.series(series),
        }
    }

    fn question(&self, question: &Question) -> Result<(), Reason> {
        question.quantities().into_iter().try_for_each(|quantity| match quantity {
            Quantity::Reduced(_, columns) => self.series(columns),
            Quantity::Metric(name, arm) => self.metric(name, arm.as_deref()),
        })
    }

    fn series(&self, series: &Series) -> Result<(), Reason> {
        let mut asked = series.columns.quantities().into_iter();
        asked.try_for_each(|asked| self.column(&asked.column, asked.arm.as_deref()))
    }

    fn metric(&self, name: &str, arm: Option<&str>) -> Result<(), Reason> {
        match name.rsplit_once(':') {
            Some(("energy_lost", _)) => self.arms_of(arm).map(drop),
            Some(("overlay_rms" | "overlay_peak" | "overlay_shift", of)) => self.measured(of, arm),
            Some((of, what)) if column_metric_names().contains(&what) => self.column(of, arm),
            _ if metric_names().contains(&name) => self.arms_of(arm).map(drop),
            _ => {
                let names = metric_names();
                let meant = meant(name, &names);
                let all = names.join(", ");
                Err(format!("there is no metric `{name}`: {meant} the metrics are: {all}").into())
            }
        }
    }

    /// Whether there are measured data of this name, in the study or in the cases of the arms.
    fn measured(&self, name: &str, arm: Option<&str>) -> Result<(), Reason> {
        for arm in self.arms_of(arm)? {
            let overlays = self.overlays.iter().map(|overlay| overlay.name.as_str());
            let names: Vec<&str> =
                overlays.chain(arm.case.overlays.iter().map(|o| o.name.as_str())).collect();
            if !names.contains(&name) {
                let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                let arm = &arm.draft.name;
                return Err(format!(
                    "arm \"{arm}\" has no measured data `{name}`; the tables [[overlay]] are: {known}"
                )
                .into());
            }
        }
        Ok(())
    }

    fn column(&self, column: &str, arm: Option<&str>) -> Result<(), Reason> {
        for Planned { draft, case, .. } in self.arms_of(arm)? {
            let columns = columns(case);
            if !columns.iter().any(|own| own == column) {
                let meant = meant(column, &columns);
                return Err(format!(
                    "the record of arm \"{}\" will have no column `{column}`: {meant}",
                    draft.name
                )
                .into());
            }
        }
        Ok(())
    }

    /// The arms of a quantity: the one it names, or all.
    fn arms_of(&self, arm: Option<&str>) -> Result<Vec<&Planned>, Reason> {
        let found: Vec<_> =
            self.arms.iter().filter(|own| arm.is_none_or(|arm| arm == own.draft.name)).collect();
        match arm {
            Some(arm) if found.is_empty() => {
                let known = quoted(self.arms.iter().map(|own| own.draft.name.as_str()));
                Err(format!("no arm is named \"{arm}\"; the arms are: {known}").into())
            }
            _ => Ok(found),
        }
    }
}
