//! Groups of arms that differ only in one key, and their observed orders of convergence.
//!
//! ```text
//! of a number   p from f₁ − f₂ and f₂ − f₃ of the three finest steps; with an exact value or a reference, from the errors of the two finest;
//!               beside exact formulas the exact value is that of the same reduction of the formulas at the rows of each arm
//! of a column   the same with e_k = ‖c_k − c_{k+1}‖ (rms over the rows whose times all three recorded), or e_k = ‖c_k − reference‖
//! ```
//!
//! A reference that differs from the arms only in its step h_r has an error of its own, C h_rᵖ:
//! then p is that of e₁/e₂ = (h₁ᵖ − h_rᵖ)/(h₂ᵖ − h_rᵖ).

use std::collections::BTreeMap;

use carom_formula::Formula;

use super::arm::{Arm, case_without, step};
use super::arms::{ArmRecords, Needs};
use super::manifest::StudyManifest;
use super::reference::Reference;
use crate::Reason;
use crate::order::{ROUND_OFF, from_differences, from_errors};
use crate::question::{self, Asked, Quantity, Question, Records, Rows, Series};
use crate::{Deviation, Expect, Expectation, Expression, Norm, OrderOf};

/// Arms that differ in one key, the coarsest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Refinement {
    /// The changes they have in common, after the case if it is not that of the study; or the text
    /// that their names contain.
    pub common: Vec<String>,
    /// Numbers of the arms.
    pub arms: Vec<usize>,
    /// Their steps: the value of the key, or 1/value of a count.
    pub steps: Vec<f64>,
}

/// Whether a name contains a text as whole words or numbers: `hu` is not in `chung-hulbert`, nor
/// `0.1` in `0.15`.
pub fn has_words(name: &str, text: &str) -> bool {
    let inside = |a: Option<char>, b: Option<char>| {
        a.zip(b).is_some_and(|(a, b)| a.is_alphanumeric() && b.is_alphanumeric())
    };
    name.match_indices(text).any(|(at, _)| {
        let before = &name[..at];
        let after = &name[at + text.len()..];
        !inside(before.chars().last(), text.chars().next())
            && !inside(text.chars().last(), after.chars().next())
    })
}

/// Groups of at least two arms that differ only in `key`, in the order of their first arms. With
/// `name`: one group of all arms whose names contain it, with any other changes. The reference is
/// not included, but the three runs of a computed reference are a group of their own. `value` gives
/// the value of an arm for the key.
fn groups(
    manifest: &StudyManifest,
    key: &str,
    name: Option<&str>,
    value: fn(&Arm, &str) -> Option<f64>,
) -> Vec<Refinement> {
    let mut groups: Vec<Refinement> = Vec::new();
    for (i, arm) in manifest.arms.iter().enumerate() {
        let reference =
            if arm.role.fine { name.is_some() } else { manifest.reference.as_ref() == Some(&arm.name) };
        let Some(step) =
            value(arm, key).filter(|_| !reference && name.is_none_or(|n| has_words(&arm.name, n)))
        else {
            continue;
        };
        let common =
            name.map_or_else(|| others(arm, key).map(str::to_owned).collect(), |name| vec![name.to_owned()]);
        let is_alike =
            |group: &&mut Refinement| name.is_some() || differ_in(key, arm, &manifest.arms[group.arms[0]]);
        let Some(group) = groups.iter_mut().find(is_alike) else {
            groups.push(Refinement { common, arms: vec![i], steps: vec![step] });
            continue;
        };
        let at = group.steps.partition_point(|s| *s > step);
        group.steps.insert(at, step);
        group.arms.insert(at, i);
    }
    groups.retain(|g| g.arms.len() > 1);
    groups
}

/// The case of an arm, if it is not that of the study, and its changes of other keys.
fn others<'a>(arm: &'a Arm, key: &str) -> impl Iterator<Item = &'a str> {
    let is_other = move |set: &&String| set.split('=').next().is_none_or(|k| k.trim() != key);
    let sets = arm.sets.iter().filter(is_other).map(String::as_str);
    arm.case_path.as_deref().into_iter().chain(sets)
}

/// The case of an arm, if it is not that of the study, and its changes of other keys in the order
/// of keys, of several of one key the last: their order has no meaning, unless one replaces a table
/// and another one a key of it.
fn changes_beside<'a>(arm: &'a Arm, key: &str) -> Vec<&'a str> {
    let name = |set: &str| set.split('=').next().unwrap_or_default().trim().to_owned();
    let mut last: BTreeMap<String, &str> = BTreeMap::new();
    for set in others(arm, key) {
        last.insert(name(set), set);
    }
    let is_within = |inner: &String| last.keys().any(|outer| inner.starts_with(&format!("{outer}.")));
    if last.keys().any(is_within) {
        return others(arm, key).collect();
    }
    last.into_values().collect()
}

/// Whether two arms differ in a key alone, or in nothing, whatever values of the case they state.
pub(super) fn differ_in(key: &str, arm: &Arm, other: &Arm) -> bool {
    changes_beside(arm, key) == changes_beside(other, key)
        || arm.case.is_object() && case_without(arm, key) == case_without(other, key)
}

/// The exact solution of an arm at the rows of its record.
struct ExactOf<'a> {
    arm: &'a Arm,
    records: &'a ArmRecords,
    reference: Option<&'a Reference>,
}

impl Records for ExactOf<'_> {
    fn metric(&self, name: &str, _: Option<&str>) -> Result<f64, Reason> {
        let none = || Reason::from(format!("`{name}` has no exact value: give it as `exact`"));
        let known = self.reference.ok_or_else(none)?.estimate(name)?;
        if known.uncertainty > EXACT * known.value.abs() { Err(none()) } else { Ok(known.value) }
    }

    fn column(&self, asked: &Asked) -> Result<Rows<'_>, Reason> {
        let name = &asked.column;
        let text = self.arm.facts.exact.get(name);
        let text = text.ok_or_else(|| format!("the case has no [exact] formula for `{name}`"))?;
        let formula = Formula::parse(text, &["t"]).map_err(|why| format!("`{text}`: {why}"))?;
        let Rows { times, steps, .. } = self.records.column(asked)?;
        let values: Vec<f64> = times.iter().map(|t| formula.value(&[*t])).collect();
        Ok(Rows { times, steps, values: values.into() })
    }
}

/// Relative uncertainty up to which a value is exact.
const EXACT: f64 = 1e-9;

/// A quantity that an expectation is about.
pub enum Sought {
    /// A number of a record.
    Number(Question),
    /// A column of a record.
    Column(Series),
}

impl OrderOf {
    /// The quantity of the order.
    ///
    /// # Errors
    /// What is wrong with its text.
    pub fn quantity(&self) -> Result<Sought, Reason> {
        match Question::parse(&self.of) {
            // A single word that is not a metric is a column.
            Ok(Expression::Quantity(Quantity::Metric(name, None)))
                if !name.contains(':') && !question::metric_names().contains(&name.as_str()) =>
            {
                Series::parse(&name).map(Sought::Column)
            }
            Ok(question) => Ok(Sought::Number(question)),
            Err(_) => Series::parse(&self.of).map(Sought::Column),
        }
    }
}

/// The questions and columns of arms that the expectations of a study need.
pub(super) fn needs(manifest: &StudyManifest) -> Needs {
    let mut needs = Needs::default();
    for expect in &manifest.expects {
        let arms = manifest.arms.iter().map(|a| a.name.as_str());
        match expect.order.as_ref().map(OrderOf::quantity) {
            None => needs.questions.extend(Question::parse(&expect.what)),
            Some(Ok(Sought::Number(question))) => {
                needs.questions.extend(arms.map(|arm| question.of_arm(arm)));
            }
            Some(Ok(Sought::Column(series))) => needs.series.extend(arms.map(|arm| series.of_arm(arm))),
            Some(Err(_)) => {}
        }
    }
    needs
}

/// Outcomes of an expected order: one per group of arms.
pub(super) fn judge(
    expect: &Expect,
    order: &OrderOf,
    manifest: &StudyManifest,
    records: &ArmRecords,
    reference: Option<&Reference>,
) -> Vec<Expectation> {
    let errors = manifest.reference.is_some() || order.exact.is_some() || expect.deviation.is_some();
    let least = if errors { 2 } else { 3 };
    let groups = groups(manifest, &order.against, order.arms.as_deref(), step);
    let words = |group: &str| {
        // The words that select a group may end with the comma that follows them in its names.
        let group = group.trim_end_matches([',', ' ']);
        let place = if group.is_empty() { String::new() } else { format!(", {group}") };
        format!("order of {} in {}{place}", order.of, order.against)
    };
    let fine = |g: &Refinement| g.arms.iter().any(|i| manifest.arms[*i].role.fine);
    let enough: Vec<&Refinement> = groups.iter().filter(|g| g.arms.len() >= least && !fine(g)).collect();
    if enough.is_empty() {
        let why = format!("there are no {least} arms that differ only in {}", order.against);
        return vec![Expectation {
            what: words(order.arms.as_deref().unwrap_or_default()),
            ..expect.verdict(Err(why.into()))
        }];
    }
    let verdict = |group: &&Refinement| {
        let got = Observed { expect, order, manifest, records, reference }.of(group);
        Expectation { what: words(&group.common.join(", ")), ..expect.verdict(got) }
    };
    enough.iter().map(verdict).collect()
}

/// The deviation that defines the errors: from a formula, or from the exact formula in the case of
/// an arm.
fn deviation(
    expect: &Expect,
    manifest: &StudyManifest,
    arm: usize,
    series: &Series,
    norm: Norm,
) -> Result<Option<Deviation>, Reason> {
    let exact = manifest.reference.as_deref() == Some("exact");
    let known = expect.deviation.clone().map(|d| Deviation { norm, ..d });
    let standing = || Deviation { formula: "exact".into(), exact: None, norm, scale: 1.0 };
    let Some(deviation) = known.or_else(|| exact.then(standing)) else { return Ok(None) };
    if deviation.formula != "exact" {
        return Ok(Some(deviation));
    }
    let column = match &series.columns {
        Expression::Quantity(asked) => &asked.column,
        _ => return Err("only a single column can have an exact formula".into()),
    };
    let formula = manifest.arms[arm].facts.exact.get(column);
    let formula = formula.ok_or_else(|| format!("the case has no [exact] formula for `{column}`"))?;
    Ok(Some(Deviation { exact: Some(formula.clone()), ..deviation }))
}

/// The two finest arms of a group.
struct Finest {
    steps: [f64; 2],
    arms: [usize; 2],
}

impl Finest {
    fn of(group: &Refinement) -> Result<Self, Reason> {
        let [.., h1, h2] = group.steps[..] else { return Err("two steps are needed".into()) };
        let [.., two, three] = group.arms[..] else { return Err("two arms are needed".into()) };
        Ok(Self { steps: [h1, h2], arms: [two, three] })
    }

    /// The order from two errors of values of this size.
    fn of_errors(&self, errors: [f64; 2], size: f64) -> Result<f64, Reason> {
        if errors.iter().any(|error| error.abs() <= ROUND_OFF * size) {
            return Err("the errors are round-off".into());
        }
        from_errors(self.steps, errors)
    }
}

/// The order from two differences of values of this size at three steps.
fn of_differences(steps: [f64; 3], differences: [f64; 2], size: f64) -> Result<f64, Reason> {
    if differences.iter().any(|difference| difference.abs() <= ROUND_OFF * size) {
        return Err("the differences are round-off".into());
    }
    from_differences(steps, differences)
}

/// Largest absolute value.
fn size<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// An expected order, with the records and the reference that it is computed from.
struct Observed<'a> {
    expect: &'a Expect,
    order: &'a OrderOf,
    manifest: &'a StudyManifest,
    records: &'a ArmRecords,
    /// The reference of the study, if it has finished.
    reference: Option<&'a Reference>,
}

impl Observed<'_> {
    fn of(&self, group: &Refinement) -> Result<f64, Reason> {
        match &self.order.quantity()? {
            Sought::Number(question) => self.of_number(question, group),
            Sought::Column(series) => self.of_column(series, group),
        }
    }

    fn arm(&self, arm: usize) -> &Arm {
        &self.manifest.arms[arm]
    }

    /// The arm that all are compared with; none beside an exact solution.
    fn standing(&self) -> Option<&Arm> {
        let name = self.manifest.reference.as_ref()?;
        self.manifest.arms.iter().find(|arm| arm.name == *name)
    }

    fn of_number(&self, question: &Question, group: &Refinement) -> Result<f64, Reason> {
        let window = self.expect.window();
        let value = |arm: usize| question.of_arm(&self.arm(arm).name).answer(self.records, window);
        let finest = Finest::of(group)?;
        let [two, three] = finest.arms;
        let values = [value(two)?, value(three)?];
        let size = size(&values);
        if let Some(exact) = self.order.exact {
            return finest.of_errors(values.map(|value| value - exact), size);
        }
        if self.manifest.reference.as_deref() == Some("exact") {
            let exact = |arm: usize| {
                let arm = self.arm(arm);
                let exact = ExactOf { arm, records: self.records, reference: self.reference };
                question.of_arm(&arm.name).answer(&exact, window)
            };
            return finest.of_errors([values[0] - exact(two)?, values[1] - exact(three)?], size);
        }
        if let Some(reference) = self.standing() {
            let right = question.of_arm(&reference.name).answer(self.records, window)?;
            return self.beside(reference, &finest, values.map(|value| value - right), size);
        }
        let third = group.arms.len().checked_sub(3).ok_or("three steps are needed")?;
        let coarse = value(group.arms[third])?;
        let [h1, h2] = finest.steps;
        of_differences([group.steps[third], h1, h2], [coarse - values[0], values[0] - values[1]], size)
    }

    fn of_column(&self, series: &Series, group: &Refinement) -> Result<f64, Reason> {
        if self.order.exact.is_some() {
            return Err(format!(
                "`exact` is the exact value of a number, and `{}` is a column",
                self.order.of
            )
            .into());
        }
        let norm = self.expect.norm.unwrap_or(Norm::Rms);
        // Values of arms at the times of rows that all of them have.
        let columns = |arms: &[&Arm]| {
            let columns: Vec<Series> = arms.iter().map(|arm| series.of_arm(&arm.name)).collect();
            question::common(&columns, self.records, self.expect.window())
        };
        let apart = |a: &[f64], b: &[f64]| {
            let differences: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
            norm.of(&differences)
        };
        let finest = Finest::of(group)?;
        let [two, three] = finest.arms;
        let of_arm = |arm: usize| deviation(self.expect, self.manifest, arm, series, norm);
        if let (Some(coarse), Some(fine)) = (of_arm(two)?, of_arm(three)?) {
            let (times, values) = columns(&[self.arm(two), self.arm(three)])?;
            let errors = [coarse.of(&times, &values[0])?, fine.of(&times, &values[1])?];
            return finest.of_errors(errors, size(values.iter().flatten()) / fine.scale);
        }
        if let Some(reference) = self.standing() {
            let (_, values) = columns(&[self.arm(two), self.arm(three), reference])?;
            let errors = [apart(&values[0], &values[2]), apart(&values[1], &values[2])];
            return self.beside(reference, &finest, errors, size(values.iter().flatten()));
        }
        let third = group.arms.len().checked_sub(3).ok_or("three steps are needed")?;
        let coarse = self.arm(group.arms[third]);
        let (_, values) = columns(&[coarse, self.arm(two), self.arm(three)])?;
        let differences = [apart(&values[0], &values[1]), apart(&values[1], &values[2])];
        let [h1, h2] = finest.steps;
        of_differences([group.steps[third], h1, h2], differences, size(values.iter().flatten()))
    }

    /// The order from errors with respect to a run, which has an error of its own if it differs
    /// from the arms in the same key alone.
    fn beside(&self, reference: &Arm, finest: &Finest, errors: [f64; 2], size: f64) -> Result<f64, Reason> {
        let key = self.order.against.as_str();
        let is_alike = finest.arms.iter().all(|arm| differ_in(key, reference, self.arm(*arm)));
        let [h1, h2] = finest.steps;
        match step(reference, key).filter(|_| is_alike) {
            Some(own) => of_differences([h1, h2, own], [errors[0] - errors[1], errors[1]], size),
            None => finest.of_errors(errors, size),
        }
    }
}

/// Keys in which arms differ only by their values, with their groups of at least `least` arms;
/// `value`: [`step`], or [`scalar`] for numbers of any sign.
pub fn refined_keys(
    manifest: &StudyManifest,
    least: usize,
    value: fn(&Arm, &str) -> Option<f64>,
) -> BTreeMap<String, Vec<Refinement>> {
    let keys = manifest
        .arms
        .iter()
        .flat_map(|a| &a.sets)
        .filter_map(|set| Some(set.split_once('=')?.0.trim().to_owned()));
    let mut found = BTreeMap::new();
    for key in keys {
        found.entry(key).or_insert_with_key(|key| {
            let mut groups = groups(manifest, key, None, value);
            groups.retain(|g| g.arms.len() >= least && g.steps.windows(2).all(|h| h[0] > h[1]));
            groups
        });
    }
    found.retain(|_, groups| !groups.is_empty());
    found
}
