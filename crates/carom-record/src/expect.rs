//! Expected values, as a case or a study states them.

use serde::{Deserialize, Serialize};

/// An expected value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Expect {
    /// The quantity: `crate::question`.
    pub what: String,
    /// Bound on the value.
    pub bound: Bound,
    /// Where the expected value comes from.
    pub source: Option<String>,
    /// Expected values of the column; the bound is then on the deviation from them.
    pub deviation: Option<Deviation>,
    /// Time after which rows are used; none for all rows from the first.
    pub after: Option<f64>,
    /// Time before which rows are used; none for all rows up to the last.
    pub before: Option<f64>,
    /// The order of convergence, in a study.
    pub order: Option<OrderOf>,
    /// Norm of deviations, if given.
    pub norm: Option<Norm>,
    /// Whether `carom verify --fast` skips the expectation.
    pub slow: bool,
}

/// An order of convergence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrderOf {
    /// A quantity, or a column.
    pub of: String,
    /// Key of the case that is refined.
    pub against: String,
    /// Text that the names of the arms contain, if not all arms are used.
    pub arms: Option<String>,
    /// The exact value of the quantity.
    pub exact: Option<f64>,
}

/// A column's deviation from a formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Deviation {
    /// Formula in `t`, or `exact`: the formula of the case for the column.
    pub formula: String,
    /// The formula that `exact` refers to.
    pub exact: Option<String>,
    /// Norm of the deviation.
    pub norm: Norm,
    /// Number by which the norm of the deviation is divided.
    pub scale: f64,
}

/// Norm of a function of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Norm {
    /// Largest absolute value.
    Max,
    /// Root mean square over the rows.
    Rms,
}

/// Bound of an expectation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bound {
    /// |got − value| ≤ tolerance.
    Near {
        /// Expected value.
        value: f64,
        /// Absolute tolerance.
        tolerance: f64,
    },
    /// |got − value| ≤ relative·|value|.
    Relative {
        /// Expected value.
        value: f64,
        /// Relative tolerance.
        relative: f64,
    },
    /// got ≤ value.
    AtMost(f64),
    /// got ≥ value.
    AtLeast(f64),
}

impl Bound {
    /// The bound in words: `-0.7827 ± 0.004`.
    pub fn words(self) -> String {
        match self {
            Self::Near { value, tolerance } => format!("{} ± {}", plain(value), plain(tolerance)),
            Self::Relative { value, relative } => {
                format!("{} ± {} %", plain(value), plain(short_percent(relative)))
            }
            Self::AtMost(most) => format!("≤ {}", plain(most)),
            Self::AtLeast(least) => format!("≥ {}", plain(least)),
        }
    }

    /// Whether a number satisfies the bound.
    pub fn holds(self, got: f64) -> bool {
        match self {
            Self::Near { value, tolerance } => (got - value).abs() <= tolerance,
            Self::Relative { value, relative } => (got - value).abs() <= relative * value.abs(),
            Self::AtMost(most) => got <= most,
            Self::AtLeast(least) => got >= least,
        }
    }

    /// The expected value; for an upper or lower bound, the bound itself.
    pub fn value(self) -> f64 {
        match self {
            Self::Near { value, .. }
            | Self::Relative { value, .. }
            | Self::AtMost(value)
            | Self::AtLeast(value) => value,
        }
    }

    /// Absolute tolerance about the expected value; none for an upper or lower bound.
    pub fn tolerance(self) -> Option<f64> {
        match self {
            Self::Near { tolerance, .. } => Some(tolerance),
            Self::Relative { value, relative } => Some(relative * value.abs()),
            Self::AtMost(_) | Self::AtLeast(_) => None,
        }
    }
}

/// A number for messages: small and large ones with an exponent.
fn plain(x: f64) -> String {
    if x != 0.0 && !(1e-4..1e6).contains(&x.abs()) { format!("{x:e}") } else { x.to_string() }
}

/// A share in per cent, rounded so that multiplying by 100 adds no digits.
fn short_percent(share: f64) -> f64 {
    format!("{:.9e}", share * 100.0).parse().unwrap_or(share * 100.0)
}
