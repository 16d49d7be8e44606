//! `[[expect]]` of a case, of an arm and of a study: a quantity and one bound on it.

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

/// Where the quantity of an expectation comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// One run.
    OfARun,
    /// The arms of a study: every quantity names its arm; orders of convergence are allowed too.
    OfArms,
}

/// What `formula = "exact"` stands for.
#[derive(Clone, Copy)]
pub(super) enum Exact<'a> {
    /// These formulas by column.
    Of(&'a BTreeMap<String, String>),
    /// The formulas of a case that is not known yet; for an order, of the cases of the arms.
    Later,
    /// Nothing: there is no such formula.
    Nobody,
}

/// The expectations of the list at `path` in a study file.
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
                "this is not a table",
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

/// One expectation; `None` if it cannot be read, which is then added to the problems.
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
        // A single word is a metric or a column.
        (Some(order), None) => Question::parse(&order.of).map(drop).map_err(|e| (name("of"), e)),
        (None, Some(_)) => Series::parse(&what).map(drop).map_err(|e| (name("what"), e)),
        (None, None) => Question::parse(&what)
            .and_then(|q| if asked == Asked::OfArms { q.of_arms() } else { Ok(()) })
            .map_err(|e| (name("what"), e)),
    };
    if let Err((path, why)) = parsed {
        let wrong = if path.ends_with("of") { order.map_or(what, |o| o.of) } else { what };
        let help = "write for example \"last total / first total\"";
        problems.push(Problem::new(path, format!("{wrong:?} is not a valid quantity"), why, help));
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

/// The problem has been reported.
struct Reported;

/// The order of convergence that is expected, if any.
fn order(
    v: View,
    what: &str,
    path: &str,
    asked: Asked,
    problems: &mut Vec<Problem>,
) -> Result<Option<OrderOf>, Reported> {
    let given: Vec<_> = ["of", "against", "where", "exact"].into_iter().filter(|k| v.has(k)).collect();
    let mut wrong =
        |what: String, why: &str, help: &str| problems.push(Problem::new(path, what, why, help).at_key());
    match (what == "order", asked, given.as_slice()) {
        (false, _, []) => Ok(None),
        (false, _, [first, ..]) => {
            wrong(
                format!("`{first}` without what = \"order\""),
                "it describes an order of convergence",
                "leave it out",
            );
            Err(Reported)
        }
        (true, Asked::OfARun, _) => {
            let why = "it is observed over several runs, for example with different time steps";
            wrong("one run has no order of convergence".into(), why, "move it to the [[expect]] of a study");
            Err(Reported)
        }
        (true, Asked::OfArms, ["of", "against", ..]) => Ok(Some(OrderOf {
            of: v.text("of").ok_or(Reported)?,
            against: v.text("against").ok_or(Reported)?,
            arms: v.text("where"),
            exact: v.number("exact"),
        })),
        (true, Asked::OfArms, _) => {
            let help = "write `what = \"order\", of = \"last A.uy\", against = \"time.step\"`";
            wrong(
                "the order has no `of` or no `against`".into(),
                "an order is that of a quantity or column (`of`) with respect to a key of the case (`against`)",
                help,
            );
            Err(Reported)
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
) -> Result<Option<Deviation>, Reported> {
    if !v.has("formula") {
        if let Some(key) = ["norm", "scale"].into_iter().find(|k| v.has(k) && !(*k == "norm" && v.has("of")))
        {
            let (why, help) = (
                "it defines how the deviation from a formula is measured",
                "add `formula = \"…\"` or leave it out",
            );
            problems.push(
                Problem::new(format!("{path}.{key}"), format!("`{key}` without `formula`"), why, help)
                    .at_key(),
            );
        }
        return Ok(None);
    }
    let (formula, scale) = (v.text("formula").ok_or(Reported)?, v.number("scale").ok_or(Reported)?);
    let mut wrong = |what: String, why: &str, help: &str, at| {
        let problem = Problem::new(format!("{path}.formula"), what, why, help);
        problems.push(if let Some(at) = at { problem.within(at) } else { problem });
        Err(Reported)
    };
    if formula == "exact" {
        let column = v.text("what").unwrap_or_default();
        let found = match exact {
            Exact::Later => None,
            Exact::Nobody => {
                let why = "an exact formula belongs to one case, and this expectation is about several arms, which may differ in it";
                return wrong(
                    "formula = \"exact\" cannot be used here".into(),
                    why,
                    "write the formula itself",
                    None,
                );
            }
            Exact::Of(formulas) => {
                let Some(formula) = formulas.get(&column) else {
                    let what = format!("the case has no exact formula for `{column}`");
                    let help = format!("add `\"{column}\" = \"…\"` to [exact]");
                    return wrong(what, "formula = \"exact\" refers to a formula in [exact]", &help, None);
                };
                Some(formula.clone())
            }
        };
        return Ok(Some(Deviation { formula, exact: found, norm, scale }));
    }
    if let Err(error) = Formula::parse(&formula, &["t"]) {
        let help =
            "write for example \"-0.5*9.81*t^2\"; \"exact\" refers to the formula of the column in [exact]";
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
                let what = "the expectation needs exactly one bound";
                let why =
                    format!("it has {}", if given.is_empty() { "none".into() } else { given.join(", ") });
                let help = "give `value` and `tolerance`, or `value` and `relative`, or `at_most`, or `at_least`; with a formula `tolerance` is enough";
                problems.push(Problem::new(path, what, why, help).at_key());
            }
            return None;
        }
    })
}
