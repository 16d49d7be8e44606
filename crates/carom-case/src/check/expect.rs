//! Checks that the quantities of expectations exist: columns, metrics, times within the run.

use carom_record::question::{
    Form, Quantity, Question, Series, column_metric_names, form_names, metric_names,
};

use carom_record::units::Labels;

use super::super::columns::Recorded;
use super::super::document::joined;
use super::super::{Fallback, MaterialSpec, suggest};
use super::Check;

impl<'a> Check<'a> {
    /// Names of the bodies that yield.
    fn yielding(&self) -> Vec<&'a str> {
        let materials: Vec<&MaterialSpec> = self.draft.material.iter().flatten().collect();
        let bodies = self.draft.body.iter().flatten();
        bodies.filter(|body| body.yields(&materials)).map(|body| body.name.as_str()).collect()
    }

    pub(super) fn expects(&mut self) {
        let draft = self.draft;
        // Columns are named after bodies, contacts and probes. If one of these could not be read,
        // an unknown column is not necessarily an error; neither if contacts between bodies that do
        // not exist were meant to give it.
        let between = |path: &str| path.starts_with("contact[") && path.contains("].between");
        let complete = !self.problems.iter().any(|p| p.at_key || between(&p.path))
            && draft.probe.iter().all(Option::is_some)
            && draft.material.iter().all(Option::is_some)
            && draft.body.iter().all(Option::is_some)
            && draft.contact.iter().all(Option::is_some)
            && draft.support.iter().all(Option::is_some);
        let recorded = Recorded {
            dimension: draft.dimension.unwrap_or(2),
            bodies: draft.body.iter().flatten().collect(),
            yielding: self.yielding(),
            contacts: draft.contact.iter().flatten().collect(),
            by_contact: draft.contact.len() > 1,
            ties: draft.tie.iter().flatten().collect(),
            supports: draft.support.iter().flatten().collect(),
            probes: draft.probe.iter().flatten().collect(),
            manufactured: self.document.root().get("manufactured").is_some(),
            fallback: draft.time.as_ref().map_or_else(Fallback::default, |time| time.fallback),
        };
        let columns = recorded.columns(&Labels::of("", "", "")).into_iter();
        let known: Vec<String> = columns.map(|column| column.name).collect();
        let end = draft.time.as_ref().map_or(f64::INFINITY, |t| t.end);
        for column in draft.exact.keys().filter(|column| complete && !known.contains(column)) {
            self.no_column(joined("exact", column), column, &known);
        }
        for (i, overlay) in draft.overlay.iter().enumerate().filter(|_| complete) {
            if let Some(overlay) = overlay.as_ref().filter(|o| !known.contains(&o.column)) {
                self.no_column(format!("overlay[{i}].column"), &overlay.column, &known);
            }
        }
        for (i, expect) in draft.expect.iter().enumerate() {
            let Some(expect) = expect else { continue };
            let path = format!("expect[{i}].what");
            let quantities = if expect.deviation.is_some() {
                Series::parse(&expect.what).map(|columns| vec![Quantity::Reduced(Form::Last, columns)])
            } else {
                Question::parse(&expect.what).map(|q| q.quantities().into_iter().cloned().collect())
            };
            let mut wanted: Vec<String> = Vec::new();
            let mut arms = Vec::new();
            // Parse errors were reported when the expectation was read.
            for quantity in quantities.unwrap_or_default() {
                match quantity {
                    Quantity::Reduced(form, columns) => {
                        if let Form::At(time) = form
                            && !(0.0..=end).contains(&time)
                        {
                            let why = format!("the run goes from 0 to {end}");
                            let what = format!("the time {time} is outside the run");
                            self.add(path.clone(), what, why, "write for example \"at 0.5 A.uy\"");
                        }
                        arms.extend(columns.columns.quantities().iter().filter_map(|a| a.arm.clone()));
                        wanted.extend(columns.columns.quantities().iter().map(|a| a.column.clone()));
                    }
                    Quantity::Metric(name, arm) => {
                        arms.extend(arm);
                        match name.rsplit_once(':') {
                            Some(("energy_lost", _)) => {}
                            Some(("overlay_rms" | "overlay_peak" | "overlay_shift", of)) => {
                                if complete {
                                    self.measured(of, &path);
                                }
                            }
                            Some((column, what)) if column_metric_names().contains(&what) => {
                                wanted.push(column.to_owned());
                            }
                            _ => self.metric(&name, &known, &path),
                        }
                    }
                }
            }
            if let Some(arm) = arms.first() {
                let why = "a case is one run; only a study has arms";
                self.add(
                    path.clone(),
                    format!("there is no arm \"{arm}\""),
                    why,
                    format!("leave `of \"{arm}\"` out"),
                );
            }
            for column in wanted.iter().filter(|_| complete).filter(|c| !known.contains(c)) {
                self.no_column(path.clone(), column, &known);
            }
        }
    }

    fn no_column(&mut self, path: String, column: &str, known: &[String]) {
        let why = "a column is one of history.csv; each probe adds columns name.quantity";
        let help = suggest::help(column, known.iter().map(String::as_str));
        self.add(path, format!("history.csv will have no column `{column}`"), why, help);
    }

    fn measured(&mut self, name: &str, path: &str) {
        let names: Vec<&str> = self.draft.overlay.iter().flatten().map(|o| o.name.as_str()).collect();
        if !names.contains(&name) && self.draft.overlay.iter().all(Option::is_some) {
            let help = suggest::help(name, names);
            let why = "the name after the colon is that of an [[overlay]]";
            self.add(path.to_owned(), format!("there are no measured data `{name}`"), why, help);
        }
    }

    fn metric(&mut self, name: &str, columns: &[String], path: &str) {
        let names = metric_names();
        if names.contains(&name) {
            return;
        }
        let why =
            format!("a quantity is FORM COLUMN, where FORM is {}, or the name of a metric", form_names());
        let help = if columns.iter().any(|c| c == name) {
            format!("`{name}` is a column: write for example `last {name}`, or add a `formula`")
        } else {
            suggest::help(name, names.iter().copied())
        };
        self.add(path.to_owned(), format!("there is no metric `{name}`"), why, help);
    }
}
