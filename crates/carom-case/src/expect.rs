//! `[[expect]]` of a case, of an arm and of a study: a quantity and one bound on it.

use std::cell::RefCell;
use std::collections::BTreeMap;

use carom_formula::Formula;
use carom_record::question::{Question, Series};
use carom_record::{Bound, Deviation, Expect, Norm, OrderOf};

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
    let reported = RefCell::new(Vec::new());
    let mut found = Vec::new();
    for (i, node) in list.iter().enumerate() {
        let path = format!("{path}[{i}]");
        let Some(table) = node.table() else {
            let (what, why) = ("this is not a table", "an expectation is a table");
            let help = "write `{ what = \"…\", value = …, tolerance = … }`";
            reported.borrow_mut().push(Problem::new(path, what, why, help));
            continue;
        };
        reported.borrow_mut().extend(conform::table(table, &EXPECT, &path));
        let view = View { path, ..View::of_keys(table, EXPECT.keys, &reported) };
        let later = asked == Asked::OfARun || view.has("against");
        let exact = if later { Exact::Later } else { Exact::Nobody };
        found.extend(one(&view, asked, exact));
    }
    problems.extend(reported.take());
    found
}

/// One expectation; `None` if it cannot be read, which is then added to the problems.
pub(super) fn one(v: &View, asked: Asked, exact: Exact) -> Option<Expect> {
    let what = v.text("what")?;
    let of_order = ["of", "against", "where", "exact"].into_iter().filter(|k| v.has(k)).collect::<Vec<_>>();
    let order = match (what == "order", of_order.first()) {
        (true, _) => Some(order(v, &of_order, asked)?),
        (false, None) => None,
        (false, Some(first)) => {
            let what = format!("`{first}` without what = \"order\"");
            let why = "it describes an order of convergence";
            return v.report(v.problem("", what, why, "leave it out").at_key());
        }
    };
    let norm = v.choice("norm").unwrap_or(if order.is_some() { Norm::Rms } else { Norm::Max });
    let deviation = if v.has("formula") { Some(deviation(v, norm, exact)?) } else { None };
    if deviation.is_none()
        && let Some(key) = ["norm", "scale"].into_iter().find(|k| v.has(k) && !(*k == "norm" && v.has("of")))
    {
        let why = "it defines how the deviation from a formula is measured";
        let help = "add `formula = \"…\"` or leave it out";
        v.report::<()>(v.problem(key, format!("`{key}` without `formula`"), why, help).at_key());
    }
    let bound = bound(v, deviation.is_some() && order.is_none())?;
    let parsed = match (&order, &deviation) {
        (Some(order), Some(_)) => Series::parse(&order.of).map(drop).map_err(|e| ("of", e)),
        // A single word is a metric or a column.
        (Some(order), None) => Question::parse(&order.of).map(drop).map_err(|e| ("of", e)),
        (None, Some(_)) => Series::parse(&what).map(drop).map_err(|e| ("what", e)),
        (None, None) => Question::parse(&what)
            .and_then(|q| if asked == Asked::OfArms { q.of_arms() } else { Ok(()) })
            .map_err(|e| ("what", e)),
    };
    if let Err((key, why)) = parsed {
        let wrong = if key == "of" { order.map_or(what, |o| o.of) } else { what };
        let help = "write for example \"last total / first total\"";
        return v.wrong(key, format!("{wrong:?} is not a valid quantity"), why, help);
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
        slow: v.flag("slow")?,
    })
}

/// The order of convergence that is expected, with the keys that are given for it.
fn order(v: &View, given: &[&str], asked: Asked) -> Option<OrderOf> {
    match (asked, given) {
        (Asked::OfARun, _) => {
            let why = "it is observed over several runs, for example with different time steps";
            let help = "move it to the [[expect]] of a study";
            v.report(v.problem("", "one run has no order of convergence", why, help).at_key())
        }
        (Asked::OfArms, ["of", "against", ..]) => Some(OrderOf {
            of: v.text("of")?,
            against: v.text("against")?,
            arms: v.text("where"),
            exact: v.number("exact"),
        }),
        (Asked::OfArms, _) => {
            let help = "write `what = \"order\", of = \"last A.uy\", against = \"time.step\"`";
            let why = "an order is that of a quantity or column (`of`) with respect to a key of the case (`against`)";
            v.report(v.problem("", "the order has no `of` or no `against`", why, help).at_key())
        }
    }
}

/// The deviation from a formula.
fn deviation(v: &View, norm: Norm, exact: Exact) -> Option<Deviation> {
    let (formula, scale) = (v.text("formula")?, v.number("scale")?);
    if formula == "exact" {
        let column = v.text("what").unwrap_or_default();
        let found = match exact {
            Exact::Later => None,
            Exact::Nobody => {
                let why = "an exact formula belongs to one case, and this expectation is about several arms, which may differ in it";
                let what = "formula = \"exact\" cannot be used here";
                return v.wrong("formula", what, why, "write the formula itself");
            }
            Exact::Of(formulas) => {
                let Some(formula) = formulas.get(&column) else {
                    let what = format!("the case has no exact formula for `{column}`");
                    let help = format!("add `\"{column}\" = \"…\"` to [exact]");
                    let why = "formula = \"exact\" refers to a formula in [exact]";
                    return v.wrong("formula", what, why, help);
                };
                Some(formula.clone())
            }
        };
        return Some(Deviation { formula, exact: found, norm, scale });
    }
    if let Err(error) = Formula::parse(&formula, &["t"]) {
        let help =
            "write for example \"-0.5*9.81*t^2\"; \"exact\" refers to the formula of the column in [exact]";
        let problem = v.problem("formula", error.message, "it is a formula in the time t", help);
        return v.report(problem.within(error.at));
    }
    Some(Deviation { formula, exact: None, norm, scale })
}

fn bound(v: &View, deviation: bool) -> Option<Bound> {
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
            if !v.has_unknown_key() {
                let what = "the expectation needs exactly one bound";
                let why =
                    format!("it has {}", if given.is_empty() { "none".into() } else { given.join(", ") });
                let help = "give `value` and `tolerance`, or `value` and `relative`, or `at_most`, or `at_least`; with a formula `tolerance` is enough";
                return v.report(v.problem("", what, why, help).at_key());
            }
            return None;
        }
    })
}
