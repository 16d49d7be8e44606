//! The numbers of one record: its metrics and columns by their names.

use super::names::{column_metric_names, unknown};
use super::quantity::{Asked, Records, Rows};
use crate::Reason;
use crate::metrics::{self, PRESSURE, REBOUND, WORK};
use crate::{History, Run, Status};

fn no_arms(arm: Option<&str>) -> Result<(), Reason> {
    arm.map_or(Ok(()), |arm| Err(format!("this is a single run, which has no arm \"{arm}\"").into()))
}

/// A metric of the history, or of one of its columns.
pub(crate) fn metric(history: &History, name: &str) -> Result<f64, Reason> {
    if let Some(n) = name.strip_prefix("energy_lost:") {
        let n = n
            .parse()
            .map_err(|_| format!("`{n}` is not the number of an impact; the first one is energy_lost:1"))?;
        return metrics::energy_lost_at(history, n)
            .ok_or_else(|| format!("the record has no completed impact number {n}").into());
    }
    if let Some((column, what)) = name.rsplit_once(':') {
        history.column(column).ok_or_else(|| no_column(column))?;
        let (_, value) = metrics::of_column(history, column, what).ok_or_else(|| {
            format!("`{what}` is not a metric of a column; these are: {}", column_metric_names().join(", "))
        })?;
        return value.ok_or_else(|| format!("{what} of `{column}` is not defined for this record").into());
    }
    match metrics::all(history).into_iter().find(|m| m.name == name) {
        Some(metric) => metric.value.ok_or_else(|| undefined(metric.definition)),
        None => Err(unknown(name)),
    }
}

fn undefined(definition: &str) -> Reason {
    format!("not defined for this record; definition: {definition}").into()
}

fn no_column(name: &str) -> Reason {
    format!("there is no column `{name}` in the history").into()
}

/// A column of a history.
pub(crate) fn rows<'a>(history: &'a History, name: &str) -> Result<Rows<'a>, Reason> {
    let values = history.column(name).ok_or_else(|| no_column(name))?;
    let steps = history.column("step").unwrap_or_default();
    Ok(Rows { times: history.times().into(), steps: steps.into(), values: values.into() })
}

impl Records for History {
    fn metric(&self, name: &str, arm: Option<&str>) -> Result<f64, Reason> {
        no_arms(arm)?;
        metric(self, name)
    }

    fn column(&self, asked: &Asked) -> Result<Rows<'_>, Reason> {
        no_arms(asked.arm.as_deref())?;
        rows(self, &asked.column)
    }
}

impl Records for Run {
    fn metric(&self, name: &str, arm: Option<&str>) -> Result<f64, Reason> {
        no_arms(arm)?;
        if name == "stopped" {
            return Ok(f64::from(u8::from(self.manifest.status == Status::Failed)));
        }
        if let Some((_, value)) = WORK.iter().find(|(work, _)| work.name == name) {
            return value(self).ok_or_else(|| format!("the manifest has no {name}").into());
        }
        if let Some((definition, value)) = REBOUND.iter().find(|(rebound, _)| rebound.name == name) {
            return value(self).ok_or_else(|| undefined(definition.meaning));
        }
        if let Some((_, value)) = PRESSURE.iter().find(|(pressure, _)| pressure.name == name) {
            return value(self).ok_or_else(|| format!("{name} is defined only for {}", defined(name)).into());
        }
        if let Some((definition, value)) = metrics::of_overlay(self, name) {
            return value.ok_or_else(|| format!("{} is not defined for this record", definition.name).into());
        }
        metric(&self.history, name)
    }

    fn column(&self, asked: &Asked) -> Result<Rows<'_>, Reason> {
        self.history.column(&asked.column).ok_or_else(|| no_column(&asked.column))?;
        Records::column(&self.history, asked)
    }
}

/// The runs for which a metric of pressure is defined.
fn defined(metric: &str) -> &'static str {
    match metric {
        "traction_max" => "static runs that end in contact with friction",
        "pressure_center" => "static runs in the plane that end in contact",
        "hertz_peak" | "hertz_half_width" => {
            "static runs in the plane that end in contact, with pressures that rise to a maximum"
        }
        _ => "static runs that end in contact",
    }
}
