//! Trends of a sweep: metrics against every key whose numbers differ between arms, each with a
//! fitted line and its 95 % confidence interval. Metrics and keys that are positive and span a
//! factor of three are fitted as a power.

use carom_record::metrics::Metric;
use carom_record::study::{Refinement, Study, numeric_keys};
use maud::{Markup, html};

use crate::collected::time_unit;
use crate::curves::label;
use crate::digits::three;
use crate::fit::Fit;
use crate::labels::{file_name, with_unit};
use crate::plot::{Curve, Pane, Plot};
use crate::text::Label;

/// Fewest values of a key.
const LEAST: usize = 3;
/// Panes of a figure.
const MOST: usize = 9;
/// Factor between the largest and the smallest number from which logarithms are used.
const WIDE: f64 = 3.0;
/// Metrics that are shown first, where they exist.
const FIRST: [&str; 7] = [
    "overlay_rms",
    "restitution",
    "contact_duration",
    "impulse_y",
    "impulse_x",
    "peak_mean_force",
    "energy_lost",
];

/// A metric against a key in a group of arms.
struct Trend {
    x: Vec<f64>,
    y: Vec<f64>,
    fit: Option<Fit>,
    /// Whether x and y, or x alone, are logarithms in the fit.
    power: bool,
}

fn spans(values: &[f64]) -> bool {
    let (low, high) = crate::axis::range(values);
    low > 0.0 && high / low >= WIDE
}

fn trend(study: &Study, group: &Refinement, metric: &str, power: bool) -> Trend {
    let value = |(arm, x): (&usize, &f64)| {
        let row = &study.rows[*arm];
        Some((*x, row.value(metric).filter(|_| !row.is_unsound())?))
    };
    let (x, y): (Vec<f64>, Vec<f64>) = group.arms.iter().zip(&group.steps).filter_map(value).unzip();
    let log = |v: &[f64]| v.iter().map(|v| v.ln()).collect::<Vec<_>>();
    let fit = if power { Fit::of(&log(&x), &log(&y)) } else { Fit::of(&x, &y) };
    Trend { x, y, fit, power }
}

impl Trend {
    /// The fitted line at twenty points: x, lower edge, value, upper edge.
    fn line(&self) -> Option<[Vec<f64>; 4]> {
        let fit = self.fit?;
        let (low, high) = crate::axis::range(&self.x);
        let places = (0..=20).map(|k| f64::from(k) / 20.0);
        let x = places.map(|s| if self.power { low * (high / low).powf(s) } else { low + s * (high - low) });
        let x: Vec<f64> = x.collect();
        let edge = |sign: f64| {
            let at = |x: &f64| {
                let (value, half) = fit.at(if self.power { x.ln() } else { *x });
                let y = value + sign * half;
                if self.power { y.exp() } else { y }
            };
            x.iter().map(at).collect::<Vec<f64>>()
        };
        Some([x.clone(), edge(-1.0), edge(0.0), edge(1.0)])
    }

    fn words(&self) -> Option<String> {
        let fit = self.fit?;
        let of = if self.power { "exponent" } else { "slope" };
        Some(format!("{of} {} ± {}", three(fit.slope), three(fit.uncertainty)))
    }
}

/// Metrics that vary, those of [`FIRST`] first.
fn metrics<'a>(study: &'a Study, groups: &[Refinement]) -> Vec<&'a Metric> {
    let arms = || groups.iter().flat_map(|group| &group.arms);
    let known = |name: &str| {
        let values: Vec<f64> = arms().filter_map(|arm| study.rows[*arm].value(name)).collect();
        let (low, high) = crate::axis::range(&values);
        values.len() >= LEAST && high - low > 1e-9 * high.abs().max(low.abs())
    };
    let rank = |name: &str| {
        let base = name.split_once(':').map_or(name, |(base, _)| base);
        FIRST.iter().position(|first| *first == base).unwrap_or(FIRST.len())
    };
    let mut found: Vec<_> = study.metrics().into_iter().filter(|m| !m.is_work() && known(&m.name)).collect();
    found.sort_by_key(|m| rank(&m.name));
    found.truncate(MOST);
    found
}

/// Name of a key in labels: its last part; `1/cells` where its values count cells.
fn axis(key: &str) -> String {
    let last = key.rsplit_once('.').map_or(key, |(_, last)| last);
    if last == "cells" { "1/cells".to_owned() } else { last.to_owned() }
}

/// A figure for every key.
pub(crate) fn plots(study: &Study) -> Vec<Plot> {
    numeric_keys(&study.manifest, LEAST).iter().filter_map(|(key, groups)| plot(study, key, groups)).collect()
}

fn plot(study: &Study, key: &str, groups: &[Refinement]) -> Option<Plot> {
    let all: Vec<f64> = groups.iter().flat_map(|group| group.steps.iter().copied()).collect();
    let wide = spans(&all);
    let pane = |metric: &&Metric| {
        let values = |group: &Refinement| -> Vec<f64> {
            group.arms.iter().filter_map(|arm| study.rows[*arm].value(&metric.name)).collect()
        };
        let power = wide && groups.iter().all(|group| spans(&values(group)));
        let mut pane = Pane { y_label: with_unit(&metric.name, &metric.unit), ..Pane::default() };
        let mut told = String::new();
        for (style, group) in groups.iter().enumerate() {
            let name = if groups.len() == 1 { "arms".to_owned() } else { label(&group.common) };
            let trend = trend(study, group, &metric.name, power);
            if groups.len() == 1 {
                told = trend.words().unwrap_or_default();
            }
            if let Some([x, low, middle, high]) = trend.line() {
                if groups.len() == 1 {
                    pane.band = Some([x.clone(), low, high]);
                }
                pane.curves.push(Curve {
                    label: format!("fit of {name}"),
                    style,
                    x,
                    y: middle,
                    unlisted: true,
                    ..Curve::default()
                });
            }
            pane.curves.push(Curve {
                label: name,
                style,
                x: trend.x,
                y: trend.y,
                marked: true,
                points: true,
                unlisted: groups.len() == 1,
                ..Curve::default()
            });
        }
        pane.title = told;
        pane
    };
    let metrics = metrics(study, groups);
    let panes: Vec<Pane> = metrics.iter().map(pane).collect();
    (!panes.is_empty()).then(|| Plot {
        name: format!("trend-{}", file_name(key)),
        caption: format!(
            "Metrics against `{key}`. Lines: least squares{}.{} Arms that failed or created energy are left out.",
            if wide { ", of logarithms where a metric spans a factor of three" } else { "" },
            if groups.len() == 1 { " Grey: 95 % confidence interval of the line." } else { "" }
        ),
        x_label: if key.starts_with("time.") { with_unit(&axis(key), time_unit(study)) } else { axis(key) },
        log: [wide, false],
        across: 3,
        same: false,
        direct: false,
        panes,
    })
}

/// Slopes and exponents with their intervals.
pub(crate) fn section(study: &Study) -> Markup {
    let keys = numeric_keys(&study.manifest, LEAST);
    html! {
        @if !keys.is_empty() {
            h2 { "Trends" }
            @for (key, groups) in &keys {
                details {
                    summary { "Slopes and exponents in " code { (key) } }
                    table.metrics {
                        thead { tr { th { "Metric" } th { "Unit" } th { "Arms" } th { "95 % interval" } } }
                        @for metric in metrics(study, groups) {
                            @for group in groups {
                                @let values: Vec<f64> = group.arms.iter().filter_map(|arm| study.rows[*arm].value(&metric.name)).collect();
                                @let power = spans(&group.steps) && spans(&values);
                                @if let Some(words) = trend(study, group, &metric.name, power).words() {
                                    tr {
                                        td { code { (metric.name) } } td { (Label(&metric.unit)) }
                                        td { (label(&group.common)) } td { (words) }
                                    }
                                }
                            }
                        }
                    }
                }
            }
            p.small {
                "Exponent: of the power of the key that fits best, where metric and key are positive and span a \
                 factor of three; slope: of a straight line, in the unit of the metric per unit of the key. \
                 Interval: that of least squares, as if the deviations were accidental."
            }
        }
    }
}
