//! Groups of arms that differ only in one key, and their observed orders of convergence.
//!
//! ```text
//! of a number   p from f₁ − f₂ and f₂ − f₃ of the three finest steps; with an exact value or a reference, from the errors of the two finest
//! of a column   the same with e_k = ‖c_k − c_{k+1}‖ (rms over the rows whose times all three recorded), or e_k = ‖c_k − reference‖
//! ```
//!
//! A reference that differs from the arms only in its step h_r has an error of its own, C h_rᵖ:
//! then p is that of e₁/e₂ = (h₁ᵖ − h_rᵖ)/(h₂ᵖ − h_rᵖ).

use std::collections::BTreeMap;

use super::arm::{Arm, step};
use super::arms::{ArmRecords, Needs};
use super::manifest::StudyManifest;
use crate::Reason;
use crate::order::{from_differences, from_errors};
use crate::question::{self, Quantity, Question, Series};
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
        match groups.iter_mut().find(|g| g.common == common) {
            Some(group) => {
                let at = group.steps.partition_point(|s| *s > step);
                group.steps.insert(at, step);
                group.arms.insert(at, i);
            }
            None => groups.push(Refinement { common, arms: vec![i], steps: vec![step] }),
        }
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
) -> Vec<Expectation> {
    let reference = manifest.reference.as_deref().filter(|name| *name != "exact");
    let exact = manifest.reference.as_deref() == Some("exact");
    let errors = exact || order.exact.is_some() || expect.deviation.is_some() || reference.is_some();
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
        let got = observed(expect, order, group, manifest, records, reference);
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

fn observed(
    expect: &Expect,
    order: &OrderOf,
    group: &Refinement,
    manifest: &StudyManifest,
    records: &ArmRecords,
    reference: Option<&str>,
) -> Result<f64, Reason> {
    let [.., h1, h2] = group.steps[..] else { return Err("two steps are needed".into()) };
    let [.., two, three] = group.arms[..] else { return Err("two arms are needed".into()) };
    let name = |arm: usize| manifest.arms[arm].name.as_str();
    let norm = expect.norm.unwrap_or(Norm::Rms);
    let window = expect.window();
    let quantity = order.quantity()?;
    // Values of arms with their times; a number is one value without a time.
    let of_arms = |arms: &[&str]| match &quantity {
        Sought::Number(question) => {
            let value = |arm: &&str| Ok(vec![question.of_arm(arm).answer(records, window)?]);
            Ok((Vec::new(), arms.iter().map(value).collect::<Result<_, Reason>>()?))
        }
        Sought::Column(series) => {
            let columns: Vec<Series> = arms.iter().map(|arm| series.of_arm(arm)).collect();
            question::common(&columns, records, window)
        }
    };
    let finest = || of_arms(&[name(two), name(three)]);
    match &quantity {
        Sought::Number(_) => {
            if let Some(exact) = order.exact {
                let (_, values) = finest()?;
                return from_errors([h1, h2], [values[0][0] - exact, values[1][0] - exact]);
            }
        }
        Sought::Column(series) => {
            if let Some(deviation) = deviation(expect, manifest, three, series, norm)? {
                let (times, columns) = finest()?;
                let error = |column: usize| deviation.of(&times, &columns[column]);
                return from_errors([h1, h2], [error(0)?, error(1)?]);
            }
        }
    }
    let apart = |a: &[f64], b: &[f64]| {
        let differences: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
        match quantity {
            Sought::Number(_) => differences[0],
            Sought::Column(_) => norm.of(&differences),
        }
    };
    if let Some(reference) = reference {
        let (_, values) = of_arms(&[name(two), name(three), reference])?;
        let errors = [apart(&values[0], &values[2]), apart(&values[1], &values[2])];
        // A reference that differs from the arms only in its step has an error of its own.
        let key = order.against.as_str();
        let arms = &manifest.arms;
        let alike = |arm: &&Arm| [two, three].iter().all(|i| others(arm, key).eq(others(&arms[*i], key)));
        let arm = arms.iter().find(|arm| arm.name == reference).filter(alike);
        return match arm.and_then(|arm| step(arm, key)) {
            Some(own) => from_differences([h1, h2, own], [errors[0] - errors[1], errors[1]]),
            None => from_errors([h1, h2], errors),
        };
    }
    let first = group.steps.len().checked_sub(3).ok_or("three steps are needed")?;
    let (_, values) = of_arms(&[name(group.arms[first]), name(two), name(three)])?;
    let differences = [apart(&values[0], &values[1]), apart(&values[1], &values[2])];
    from_differences([group.steps[first], h1, h2], differences)
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
