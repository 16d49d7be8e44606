//! The numbers of one record: its metrics and columns by their names.

use super::names::{column_metric_names, unknown};
use super::quantity::{Asked, Records, Rows};
use crate::metrics::{self, Given, OVERLAY, PRESSURE, WORK};
use crate::{History, Reason, Run, Status};

fn no_arms(arm: Option<&str>) -> Result<(), Reason> {
    arm.map_or(Ok(()), |arm| Err(format!("this is a single run, which has no arm \"{arm}\"").into()))
}

/// A metric of a record, of one of its columns or of measured data.
fn metric(given: &Given, name: &str) -> Result<f64, Reason> {
    if let Some(n) = name.strip_prefix("energy_lost:") {
        let n = n
            .parse()
            .map_err(|_| format!("`{n}` is not the number of an impact; the first one is energy_lost:1"))?;
        if given.run.is_some_and(|run| run.manifest.facts.is_static) {
            return Err("energy_lost:N is not defined for load steps".into());
        }
        return metrics::energy_lost_at(given.history, n)
            .ok_or_else(|| format!("the record has no completed impact number {n}").into());
    }
    if let Some((before, after)) = name.rsplit_once(':') {
        let measured = given.run.into_iter().flat_map(|run| &run.manifest.facts.overlays);
        let measured = measured.into_iter().find(|overlay| overlay.name == after);
        if let Some((definition, overlay)) = OVERLAY.iter().find(|d| d.name == before).zip(measured) {
            let value = (definition.value)(&given.beside(overlay));
            return value.ok_or_else(|| format!("{before} is not defined for this record").into());
        }
        given.history.column(before).ok_or_else(|| no_column(before))?;
        let definition = metrics::of_any_column().find(|d| d.name == after).ok_or_else(|| {
            format!("`{after}` is not a metric of a column; these are: {}", column_metric_names().join(", "))
        })?;
        let value = (definition.value)(&given.with_column(before));
        return value.ok_or_else(|| format!("{after} of `{before}` is not defined for this record").into());
    }
    let definition = metrics::of_no_column().find(|d| d.name == name).ok_or_else(|| unknown(name))?;
    (definition.value)(given).ok_or_else(|| match name {
        _ if WORK.iter().any(|d| d.name == name) => format!("the manifest has no {name}").into(),
        _ if PRESSURE.iter().any(|d| d.name == name) => {
            format!("{name} is defined only for {}", defined(name)).into()
        }
        _ if given.run.is_some_and(|run| run.manifest.facts.is_static) => {
            format!("not defined for load steps; definition: {}", definition.meaning).into()
        }
        _ => format!("not defined for this record; definition: {}", definition.meaning).into(),
    })
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
        metric(&Given::of(self), name)
    }

    fn column(&self, asked: &Asked) -> Result<Rows<'_>, Reason> {
        no_arms(asked.arm.as_deref())?;
        rows(self, &asked.column)
    }
}

impl Records for Run {
    fn metric(&self, name: &str, arm: Option<&str>) -> Result<f64, Reason> {
        no_arms(arm)?;
        match name {
            "stopped" => Ok(f64::from(u8::from(self.manifest.status == Status::Failed))),
            _ => metric(&Given::of_run(self), name),
        }
    }

    fn column(&self, asked: &Asked) -> Result<Rows<'_>, Reason> {
        Records::column(&self.history, asked)
    }
}
