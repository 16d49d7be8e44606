//! Definition, unit and value of a metric.

use std::borrow::Cow;

use super::given::Given;
use crate::units::Unit;
use crate::{History, units};

/// Definition of a metric.
#[derive(Clone, Copy, Debug)]
pub struct Definition {
    /// Name in expectations and studies.
    pub name: &'static str,
    /// Unit of the metric.
    pub unit: Unit,
    /// Formula in columns of the history.
    pub formula: &'static str,
    /// Source of the definition.
    pub source: &'static str,
    /// Meaning, in one line.
    pub meaning: &'static str,
    /// Computes the metric; none if it is not defined for the record.
    pub(crate) value: fn(&Given) -> Option<f64>,
}

impl Unit {
    /// Label in the units of a record.
    pub fn label(self, history: &History) -> String {
        let time = history.unit("time");
        match self {
            Self::None | Self::Column => String::new(),
            Self::Time => time.to_owned(),
            Self::PerTime if time.is_empty() => String::new(),
            Self::PerTime => format!("1/{time}"),
            Self::Force => history.unit("contact_force_x").to_owned(),
            Self::Impulse => history.unit("contact_impulse_x").to_owned(),
            Self::Length => history.unit("penetration").to_owned(),
            Self::Stress => {
                let is_stress = |name: &str| name.contains(".sigma_") || name.ends_with(".von_mises");
                let recorded = history.columns.iter().find(|c| is_stress(&c.name)).map(|c| c.unit.clone());
                let derived =
                    || units::stress(history.unit("contact_force_x"), history.unit("penetration"), time);
                recorded.unwrap_or_else(derived)
            }
            Self::Second => "s".to_owned(),
        }
    }

    /// Kind of unit, in words.
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "–",
            Self::Time => "time",
            Self::PerTime => "1/time",
            Self::Force => "force",
            Self::Impulse => "impulse",
            Self::Length => "length",
            Self::Stress => "stress",
            Self::Second => "s",
            Self::Column => "the column's",
        }
    }
}

/// A metric of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Metric {
    /// Name in expectations and studies.
    pub name: Cow<'static, str>,
    /// Value; none if it is not defined for the record (no contact, or contact has not ended).
    pub value: Option<f64>,
    /// Label of the unit.
    pub unit: String,
    /// Meaning of the metric, in one line.
    pub definition: &'static str,
}

/// A row of a table.
pub(super) const fn d(
    name: &'static str,
    unit: Unit,
    formula: &'static str,
    source: &'static str,
    meaning: &'static str,
    value: fn(&Given) -> Option<f64>,
) -> Definition {
    Definition { name, unit, formula, source, meaning, value }
}

/// Source of what is defined here.
pub(super) const OWN: &str = "this project";
/// Source of what published tables of impacts list.
pub(super) const TABLES: &str = "used by Doyen, Ern, Piperno 2011";
/// Source of total variations.
pub(super) const VARIATION: &str = "total variation: Harten 1983";
