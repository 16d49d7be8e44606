//! `[[expect]]` of a case, of an arm and of a study: a quantity and one bound on it.

use std::collections::BTreeMap;

use carom_formula::Formula;
use carom_record::question::{Quantity, Question, Series};
use carom_record::{Bound, Deviation, Expect, Norm, OrderOf};

use super::keys::Kind::Number;
use super::keys::{Keys, NOT_NEGATIVE, POSITIVE, Table, View};

/// An expected value with one bound: `value` and `tolerance`, `value` and `relative`, `at_most`, or
/// `at_least`. With a `formula`, `tolerance` alone is sufficient.
#[derive(Keys)]
#[keys(name = "[[expect]]")]
pub(crate) struct ExpectKeys {
    /// Quantity: min | max | first | last | at T | time of min | time of max | range | drift | peak
    /// | rms of a column or of [ columns with + - * / ]; the name of a metric; `stopped`; or an
    /// expression of these. Operators need blanks on both sides.
    #[key(example = "\"min A.uy\"")]
    what: String,
    /// Expected values of the column `what`, as a formula in t; the bound is on the norm of the
    /// deviation from it.
    #[key(example = "\"-0.5*9.81*t^2\"")]
    formula: Option<String>,
    /// Norm of the deviation: largest absolute value, or root mean square over the rows. Default:
    /// max; for an order, rms.
    #[key(example = "\"rms\"")]
    norm: Option<Norm>,
    /// Number that divides the deviation.
    #[key(Number(POSITIVE), default = "1.0")]
    scale: f64,
    /// Only rows strictly after this time are used. Not with a metric: it is of the whole run.
    #[key(unit = "time", example = "0.52")]
    after: Option<f64>,
    /// Only rows strictly before this time are used. Not with a metric: it is of the whole run.
    #[key(unit = "time", example = "1.147")]
    before: Option<f64>,
    /// Expected value.
    #[key(example = "-0.7827")]
    value: Option<f64>,
    /// Absolute tolerance.
    #[key(Number(NOT_NEGATIVE), example = "4e-3")]
    tolerance: Option<f64>,
    /// Relative tolerance.
    #[key(Number(NOT_NEGATIVE), example = "0.01")]
    relative: Option<f64>,
    /// Upper bound.
    #[key(example = "0.0")]
    at_most: Option<f64>,
    /// Lower bound.
    #[key(example = "0.0")]
    at_least: Option<f64>,
    /// Where the expected value comes from.
    #[key(example = "\"exact solution\"")]
    source: Option<String>,
    /// In a study, with what = "order": the quantity or column whose order of convergence is
    /// observed.
    #[key(example = "\"last A.uy\"")]
    of: Option<String>,
    /// With what = "order": the key of the case that is refined from arm to arm.
    #[key(example = "\"time.step\"")]
    against: Option<String>,
    /// With what = "order": only arms whose names contain these whole words.
    #[key(example = "\"hu\"")]
    r#where: Option<String>,
    /// With what = "order": the exact value that errors are computed against.
    #[key(example = "1.0")]
    exact: Option<f64>,
    /// Skipped by `carom verify --fast`.
    #[key(default = "false")]
    slow: bool,
}

/// Runs that an expectation is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// A single run: orders of convergence are not allowed.
    OfARun,
    /// The arms of a study: every quantity names its arm; orders of convergence are allowed too.
    OfArms,
}

/// Formulas that `formula = "exact"` in an expectation refers to.
#[derive(Clone, Copy)]
pub(super) enum Exact<'a> {
    /// Formulas of the case, by column.
    Of(&'a BTreeMap<String, String>),
    /// The formulas of a case that is not known yet; for an order, of the cases of the arms.
    Later,
    /// None: the expectation is about several arms, whose cases may have different formulas.
    Nobody,
}

/// The keys of an `[[expect]]`.
pub const EXPECT: Table = ExpectKeys::TABLE;

/// The expectations of a study or of one of its arms.
pub fn expects(v: &View, asked: Asked) -> Option<Vec<Option<Expect>>> {
    v.each("expect", |v| {
        let later = asked == Asked::OfARun || v.has("against");
        one(v, asked, if later { Exact::Later } else { Exact::Nobody })
    })
}

/// Reads one expectation; `None` if it cannot be read, after its problem has been reported.
pub(super) fn one(v: &View, asked: Asked, exact: Exact) -> Option<Expect> {
    let keys = ExpectKeys::read(v)?;
    let of_order = ["of", "against", "where", "exact"].into_iter().filter(|k| v.has(k)).collect::<Vec<_>>();
    let order = match (keys.what == "order", of_order.first()) {
        (true, _) => Some(keys.order(v, asked)?),
        (false, None) => None,
        (false, Some(first)) => {
            let what = format!("`{first}` without what = \"order\"");
            return v.wrong_key("", what, "it describes an order of convergence", "leave it out");
        }
    };
    let deviation = if v.has("formula") { Some(keys.deviation(v, exact)?) } else { None };
    if deviation.is_none()
        && let Some(key) = ["norm", "scale"].into_iter().find(|k| v.has(k) && !(*k == "norm" && v.has("of")))
    {
        let why = "it defines how the deviation from a formula is measured";
        let help = "add `formula = \"…\"` or leave it out";
        v.wrong_key::<()>(key, format!("`{key}` without `formula`"), why, help);
    }
    let bound = keys.bound(v, deviation.is_some() && order.is_none())?;
    let (key, wanted) = order.as_ref().map_or(("what", &keys.what), |order| ("of", &order.of));
    let parsed = if deviation.is_some() {
        Series::parse(wanted).map(|_| false)
    } else {
        // A single word is a metric or, of an order, a column.
        let of_arms = order.is_none() && asked == Asked::OfArms;
        Question::parse(wanted).and_then(|question| {
            if of_arms {
                question.of_arms()?;
            }
            let is_metric = |quantity: &&Quantity| matches!(quantity, Quantity::Metric(..));
            Ok(order.is_none() && question.quantities().iter().any(is_metric))
        })
    };
    let asks_for_metrics = match parsed {
        Ok(asks_for_metrics) => asks_for_metrics,
        Err(why) => {
            let help = "write for example \"last total / first total\"";
            return v.wrong(key, format!("{wanted:?} is not a valid quantity"), why, help);
        }
    };
    if asks_for_metrics && let Some(key) = ["after", "before"].into_iter().find(|key| v.has(key)) {
        let why = "a metric is computed from the whole run; `after` and `before` select rows of columns";
        let help = "leave it out, or ask for rows of a column: FORM COLUMN";
        return v.wrong(key, format!("`{key}` cannot be used with a metric"), why, help);
    }
    let ExpectKeys { what, source, after, before, norm, slow, .. } = keys;
    Some(Expect { what, bound, source, deviation, after, before, order, norm, slow })
}

impl ExpectKeys {
    /// The order of convergence that is expected.
    fn order(&self, v: &View, asked: Asked) -> Option<OrderOf> {
        if asked == Asked::OfARun {
            let why = "it is observed over several runs, for example with different time steps";
            let help = "move it to the [[expect]] of a study";
            return v.wrong_key("", "one run has no order of convergence", why, help);
        }
        let (Some(of), Some(against)) = (self.of.clone(), self.against.clone()) else {
            let help = "write `what = \"order\", of = \"last A.uy\", against = \"time.step\"`";
            let why = "an order is that of a quantity or column (`of`) with respect to a key of the case (`against`)";
            return v.wrong_key("", "the order has no `of` or no `against`", why, help);
        };
        Some(OrderOf { of, against, arms: self.r#where.clone(), exact: self.exact })
    }

    /// The deviation from a formula.
    fn deviation(&self, v: &View, exact: Exact) -> Option<Deviation> {
        let norm = self.norm.unwrap_or(if self.what == "order" { Norm::Rms } else { Norm::Max });
        let formula = self.formula.clone()?;
        let scale = self.scale;
        if formula == "exact" {
            let column = &self.what;
            let found = match exact {
                Exact::Later => None,
                Exact::Nobody => {
                    let why = "an exact formula belongs to one case, and this expectation is about several arms, which may differ in it";
                    let what = "formula = \"exact\" cannot be used here";
                    return v.wrong("formula", what, why, "write the formula itself");
                }
                Exact::Of(formulas) => {
                    let Some(formula) = formulas.get(column) else {
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
            let help = "write for example \"-0.5*9.81*t^2\"; \"exact\" refers to the formula of the column in [exact]";
            let problem = v.problem("formula", error.message, "it is a formula in the time t", help);
            return v.report(problem.within(error.at));
        }
        Some(Deviation { formula, exact: None, norm, scale })
    }

    fn bound(&self, v: &View, deviation: bool) -> Option<Bound> {
        let keys = ["value", "tolerance", "relative", "at_most", "at_least"];
        let given: Vec<_> = keys.into_iter().filter(|k| v.has(k)).collect();
        Some(match given.as_slice() {
            ["value", "tolerance"] => Bound::Near { value: self.value?, tolerance: self.tolerance? },
            ["value", "relative"] => Bound::Relative { value: self.value?, relative: self.relative? },
            ["tolerance"] if deviation => Bound::AtMost(self.tolerance?),
            ["at_most"] => Bound::AtMost(self.at_most?),
            ["at_least"] => Bound::AtLeast(self.at_least?),
            _ => {
                let what = "the expectation needs exactly one bound";
                let why =
                    format!("it has {}", if given.is_empty() { "none".into() } else { given.join(", ") });
                let help = "give `value` and `tolerance`, or `value` and `relative`, or `at_most`, or `at_least`; with a formula `tolerance` is enough";
                return v.wrong_key("", what, why, help);
            }
        })
    }
}
