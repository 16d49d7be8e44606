//! A linear or logarithmic axis with its ticks.

use crate::axis::Axis;

/// A linear or logarithmic scale.
pub(super) struct Scale {
    pub(super) axis: Axis,
    log: bool,
}

impl Scale {
    pub(super) fn new(values: (f64, f64), count: f64, tight: bool, log: bool) -> Self {
        if !log {
            return Self { axis: Axis::new(values, count, tight), log };
        }
        let (low, high) =
            if values.0.is_finite() { (values.0.log10(), values.1.log10()) } else { (0.0, 1.0) };
        let air = if tight { 0.0 } else { 0.06 * (high - low).max(0.3) };
        let low = low - air;
        let high = high + air;
        let (low, high) = if high - low < 0.2 { (low - 0.15, high + 0.15) } else { (low, high) };
        let every = ((high - low) / count).ceil().max(1.0) as i64;
        let factors: &[f64] = match high - low {
            span if span < 0.6 => &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0],
            span if span < 1.7 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let decades = (low.floor() as i64..=high.ceil() as i64).filter(|d| d % every == 0);
        let tick = |d: i64, f: &f64| {
            let power = d.to_string().replace('-', "−");
            let label = match d {
                -3..=2 if factors.len() > 1 => format!("{}", (f * 10f64.powi(d as i32) * 1e4).round() / 1e4),
                _ if *f == 1.0 => format!("10^{{{power}}}"),
                _ => format!("{f}·10^{{{power}}}"),
            };
            (d as f64 + f.log10(), label)
        };
        let ticks = decades
            .flat_map(|d| factors.iter().map(move |f| tick(d, f)))
            .filter(|(x, _)| (low..=high).contains(x));
        Self { axis: Axis { low, high, ticks: ticks.collect(), exponent: 0, offset: 0.0 }, log }
    }

    /// 0 at the low end, 1 at the high end; NaN for values that a logarithmic axis cannot show.
    pub(super) fn position(&self, value: f64) -> f64 {
        self.axis.position(if !self.log {
            value
        } else if value > 0.0 {
            value.log10()
        } else {
            f64::NAN
        })
    }
}
