//! A linear or logarithmic axis with its ticks.

use crate::axis::Axis;

/// Ticks of a decade, from few to many.
const FACTORS: [&[f64]; 4] = [
    &[1.0],
    &[1.0, 2.0, 5.0],
    &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0],
    &[1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
];

/// Number of ticks from which an axis is readable.
const ENOUGH: usize = 3;

/// Decadic logarithms of numbers that are written without a power of ten.
const PLAIN: std::ops::Range<f64> = -3.3..4.0;

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
        let at = |factors: &'static [f64]| {
            let decades = (low.floor() as i64..=high.ceil() as i64).filter(move |d| d % every == 0);
            let all = decades.flat_map(move |d| factors.iter().map(move |factor| (d, *factor)));
            all.filter(move |(d, factor)| (low..=high).contains(&(*d as f64 + factor.log10())))
        };
        // The fewest that show how the axis is divided, without crowding it.
        let most = (1.5 * count).max(4.0) as usize;
        let mut factors = FACTORS[0];
        for finer in FACTORS.into_iter().filter(|_| every == 1) {
            if at(finer).count() <= most {
                factors = finer;
            }
            if at(finer).count() >= ENOUGH {
                break;
            }
        }
        let is_decimal = factors.len() > 1 && PLAIN.contains(&low) && PLAIN.contains(&high);
        let tick = |(d, factor): (i64, f64)| {
            let power = d.to_string().replace('-', "−");
            let label = match factor {
                _ if is_decimal => format!("{}", (factor * 10f64.powi(d as i32) * 1e5).round() / 1e5),
                1.0 => format!("10^{{{power}}}"),
                _ => format!("{factor}·10^{{{power}}}"),
            };
            (d as f64 + factor.log10(), label)
        };
        let ticks = at(factors).map(tick);
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
