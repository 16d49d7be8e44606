//! `[[expect]]` of a case, of an arm and of a study: what is asked, and the one bound on it.

use std::collections::BTreeMap;

use carom_formula::Formula;
use carom_record::question::{Question, Series};
use carom_record::{Bound, Deviation, Expect, Norm, OrderOf};

use super::Preset;
use super::conform;
use super::document::Document;
use super::keys::EXPECT;
use super::problem::Problem;
use super::tree::Node;
use super::view::View;

/// Whose numbers are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// Those of one run.
    OfARun,
    /// Those of the arms of a study: every one names its arm; and orders of convergence.
    OfArms,
}

/// What `formula = "exact"` stands for.
#[derive(Clone, Copy)]
pub(super) enum Exact<'a> {
    /// These formulas by column.
    Of(&'a BTreeMap<String, String>),
    /// Known when the case is, to which the expectation will belong; or the arms, for an order.
    Later,
    /// Nothing.
    Nobody,
}

/// The expectations of the list `NAME` of the table at `path` (the file's own: empty) in a study
/// file.
pub fn read_expects(
    document: &Document,
    path: &str,
    asked: Asked,
    problems: &mut Vec<Problem>,
) -> Vec<Expect> {
    let Some(list) = document.at(path).and_then(Node::list) else { return Vec::new() };
    let mut found = Vec::new();
    for (i, node) in list.iter().enumerate() {
        let path = format!("{path}[{i}]");
        let Some(table) = node.table() else {
            problems.push(Problem::new(
                &path,
                "this is no table",
                "an expectation is a table",
                "write `{ what = \"…\", value = …, tolerance = … }`",
            ));
            continue;
        };
        problems.extend(conform::table(table, &EXPECT, &path));
        let view = View { table, keys: EXPECT.keys, preset: Preset::Default };
        let later = asked == Asked::OfARun || view.has("against");
        let exact = if later { Exact::Later } else { Exact::Nobody };
        found.extend(one(view, &path, asked, exact, problems));
    }
    found
}

/// One expectation; `None` when it cannot be read, which is then among the problems.
pub(super) fn one(
    v: View,
    path: &str,
    asked: Asked,
    exact: Exact,
    problems: &mut Vec<Problem>,
) -> Option<Expect> {
    let what = v.text("what")?;
    let order = order(v, &what, path, asked, problems).ok()?;
    let norm = v.choice("norm").unwrap_or(if order.is_some() { Norm::Rms } else { Norm::Max });
    let deviation = deviation(v, norm, exact, path, problems).ok()?;
    let bound = bound(v, deviation.is_some() && order.is_none(), path, problems)?;
    let name = |part: &str| format!("{path}.{part}");
    let parsed = match (&order, &deviation) {
        (Some(order), Some(_)) => Series::parse(&order.of).map(drop).map_err(|e| (name("of"), e)),
        // A word is a metric or a column.
        (Some(order), None) => Question::parse(&order.of).map(drop).map_err(|e| (name("of"), e)),
        (None, Some(_)) => Series::parse(&what).map(drop).map_err(|e| (name("what"), e)),
        (None, None) => Question::parse(&what)
            .and_then(|q| if asked == Asked::OfArms { q.of_arms() } else { Ok(()) })
            .map_err(|e| (name("what"), e)),
    };
    if let Err((path, why)) = parsed {
        let wrong = if path.ends_with("of") { order.map_or(what, |o| o.of) } else { what };
        let help = "write for example \"last total / first total\"";
        problems.push(Problem::new(path, format!("{wrong:?} is not a quantity to expect"), why, help));
        return None;
    }
    Some(Expect {
        what,
        bound,
        source: v.text("source"),
        deviation,
        after: v.number("after"),
        before: v.number("before"),
        order,
        norm: v.choice("norm"),
        slow: v.value("slow")?.flag()?,
    })
}

/// Has told what is wrong.
struct Told;

/// The order that is asked for, if one is.
fn order(
    v: View,
    what: &str,
    path: &str,
    asked: Asked,
    problems: &mut Vec<Problem>,
) -> Result<Option<OrderOf>, Told> {
    let given: Vec<_> = ["of", "against", "where", "exact"].into_iter().filter(|k| v.has(k)).collect();
    let mut wrong =
        |what: String, why: &str, help: &str| problems.push(Problem::new(path, what, why, help).at_key());
    match (what == "order", asked, given.as_slice()) {
        (false, _, []) => Ok(None),
        (false, _, [first, ..]) => {
            wrong(format!("`{first}` without an order"), "it belongs to what = \"order\"", "leave it out");
            Err(Told)
        }
        (true, Asked::OfARun, _) => {
            let why = "it is seen in runs with several steps";
            wrong(
                "an order of convergence is no number of one run".into(),
                why,
                "ask for it in the [[expect]] of a study",
            );
            Err(Told)
        }
        (true, Asked::OfArms, ["of", "against", ..]) => Ok(Some(OrderOf {
            of: v.text("of").ok_or(Told)?,
            against: v.text("against").ok_or(Told)?,
            arms: v.text("where"),
            exact: v.number("exact"),
        })),
        (true, Asked::OfArms, _) => {
            let help = "write `what = \"order\", of = \"last A.uy\", against = \"time.step\"`";
            wrong(
                "the order lacks `of` or `against`".into(),
                "it is the order of a number or column in a key of the case",
                help,
            );
            Err(Told)
        }
    }
}

/// The deviation from a formula, if there is one.
fn deviation(
    v: View,
    norm: Norm,
    exact: Exact,
    path: &str,
    problems: &mut Vec<Problem>,
) -> Result<Option<Deviation>, Told> {
    if !v.has("formula") {
        if let Some(key) = ["norm", "scale"].into_iter().find(|k| v.has(k) && !(*k == "norm" && v.has("of")))
        {
            let (why, help) = (
                "it says how the deviation from a formula is measured",
                "add `formula = \"…\"` or leave it out",
            );
            problems.push(
                Problem::new(format!("{path}.{key}"), format!("`{key}` without `formula`"), why, help)
                    .at_key(),
            );
        }
        return Ok(None);
    }
    let (formula, scale) = (v.text("formula").ok_or(Told)?, v.number("scale").ok_or(Told)?);
    let mut wrong = |what: String, why: &str, help: &str, at| {
        let problem = Problem::new(format!("{path}.formula"), what, why, help);
        problems.push(if let Some(at) = at { problem.within(at) } else { problem });
        Err(Told)
    };
    if formula == "exact" {
        let column = v.text("what").unwrap_or_default();
        let found = match exact {
            Exact::Later => None,
            Exact::Nobody => {
                let why = "arms may have different ones; what is asked of several arms has none";
                return wrong("there is no exact formula here".into(), why, "write the formula", None);
            }
            Exact::Of(formulas) => {
                let Some(formula) = formulas.get(&column) else {
                    let what = format!("the case has no exact formula of `{column}`");
                    let help = format!("add `\"{column}\" = \"…\"` to [exact]");
                    return wrong(what, "[exact] says what columns should be", &help, None);
                };
                Some(formula.clone())
            }
        };
        return Ok(Some(Deviation { formula, exact: found, norm, scale }));
    }
    if let Err(error) = Formula::parse(&formula, &["t"]) {
        let help = "write for example \"-0.5*9.81*t^2\"; \"exact\" stands for the case's own, in [exact]";
        return wrong(error.message, "it is a formula in the time t", help, Some(error.at));
    }
    Ok(Some(Deviation { formula, exact: None, norm, scale }))
}

fn bound(v: View, deviation: bool, path: &str, problems: &mut Vec<Problem>) -> Option<Bound> {
    let keys = ["value", "tolerance", "relative", "at_most", "at_least"];
    let given: Vec<_> = keys.into_iter().filter(|k| v.has(k)).collect();
    Some(match given.as_slice() {
        ["value", "tolerance"] => {
            Bound::Near { value: v.number("value")?, tolerance: v.number("tolerance")? }
        }
        ["value", "relative"] => {
            Bound::Relative { value: v.number("value")?, relative: v.number("relative")? }
        }
        ["tolerance"] if deviation => Bound::AtMost(v.number("tolerance")?),
        ["at_most"] => Bound::AtMost(v.number("at_most")?),
        ["at_least"] => Bound::AtLeast(v.number("at_least")?),
        _ => {
            let misspelt = v.table.0.iter().any(|e| !v.keys.iter().any(|k| k.name == e.key));
            if !misspelt {
                let what = "the expectation does not set one bound";
                let why =
                    format!("it has {}", if given.is_empty() { "none".into() } else { given.join(", ") });
                let help = "give `value` and `tolerance`, or `value` and `relative`, or `at_most`, or `at_least`; with a formula `tolerance` is enough";
                problems.push(Problem::new(path, what, why, help).at_key());
            }
            return None;
        }
    })
}
