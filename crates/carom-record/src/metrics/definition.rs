//! What a metric is: its definition, its unit in those of the case, and the value a record has of
//! it.

use std::borrow::Cow;

use crate::History;

/// What a metric is.
#[derive(Clone, Copy, Debug)]
pub struct Definition {
    /// Name, as expectations and studies call it.
    pub name: &'static str,
    /// Formula in columns of the history.
    pub formula: &'static str,
    /// Unit.
    pub unit: Unit,
    /// Where the idea comes from.
    pub source: &'static str,
    /// One line of words.
    pub meaning: &'static str,
}

/// Unit of a metric, in those of the case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Unit {
    None,
    Time,
    PerTime,
    Force,
    Impulse,
    Length,
    Stress,
    Second,
    /// That of the column.
    Column,
}

impl Unit {
    /// Its label in the units of a record.
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
                let stress = |name: &str| name.contains(".sigma_") || name.ends_with(".von_mises");
                history.columns.iter().find(|c| stress(&c.name)).map_or_else(String::new, |c| c.unit.clone())
            }
            Self::Second => "s".to_owned(),
        }
    }

    /// Its kind, in words.
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
    /// Name, as expectations and studies call it.
    pub name: Cow<'static, str>,
    /// Value; none when the record has no such thing (no contact, or it has not ended).
    pub value: Option<f64>,
    /// Unit label.
    pub unit: String,
    /// What it means.
    pub definition: &'static str,
}
