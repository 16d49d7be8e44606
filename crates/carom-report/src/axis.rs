//! Axes with round ticks, and a power of ten factored out of numbers far from one.

/// Ticks of an axis from `low` to `high`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Axis {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) ticks: Vec<(f64, String)>,
    /// Tick labels are in units of 10^exponent.
    pub(crate) exponent: i32,
}

/// Round step (1, 2 or 5 times a power of ten) that gives about `count` intervals.
pub(crate) fn round_step(span: f64, count: f64) -> f64 {
    let raw = span / count;
    let power = 10f64.powi(raw.log10().floor() as i32);
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * power >= raw * 0.999).unwrap_or(10.0);
    factor * power
}

impl Axis {
    /// An axis that ends at the data (`tight`) or at round numbers around them.
    pub(crate) fn new(range: (f64, f64), count: f64, tight: bool) -> Self {
        let (mut low, mut high) = range;
        if !(low.is_finite() && high.is_finite()) || low > high {
            (low, high) = (0.0, 1.0);
        }
        // Differences of larger numbers overflow; steps below 1e-290 underflow.
        (low, high) = (low.max(-1e300), high.min(1e300));
        let size = low.abs().max(high.abs());
        if high - low <= 1e-12 * size || high - low < 1e-290 {
            let half = if size < 1e-280 { 1.0 } else { 0.1 * size };
            (low, high) = (low - half, high + half);
        }
        let step = round_step(high - low, count);
        if !tight {
            // A margin of 2 %, then rounded outwards to half a step.
            let air = 0.02 * (high - low);
            let half = 0.5 * step;
            low = if low == 0.0 { 0.0 } else { ((low - air) / half).floor() * half };
            high = if high == 0.0 { 0.0 } else { ((high + air) / half).ceil() * half };
        }
        let size = low.abs().max(high.abs());
        let order = size.log10().floor() as i32;
        let exponent = if (-3..4).contains(&order) { 0 } else { order.div_euclid(3) * 3 };
        let scale = 10f64.powi(exponent);
        let decimals = (-(step / scale * 1.0001).log10().floor()).clamp(0.0, 12.0) as usize;
        let first = (low / step - 1e-9).ceil() as i64;
        let last = (high / step + 1e-9).floor() as i64;
        let ticks = (first..=last.min(first + 50)).map(|i| {
            let value = i as f64 * step;
            // A minus sign, not a hyphen, and no negative zero.
            let text = format!("{:.decimals$}", value.abs() / scale);
            (value, if value < 0.0 { format!("−{text}") } else { text })
        });
        Self { low, high, ticks: ticks.collect(), exponent }
    }

    /// 0 at the low end, 1 at the high end.
    pub(crate) fn position(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }
}

/// Smallest and largest finite value.
pub(crate) fn range<'a>(values: impl IntoIterator<Item = &'a f64>) -> (f64, f64) {
    let finite = values.into_iter().copied().filter(|x| x.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(range: (f64, f64), tight: bool) -> (String, i32) {
        let axis = Axis::new(range, 5.0, tight);
        (axis.ticks.iter().map(|t| t.1.as_str()).collect::<Vec<_>>().join(" "), axis.exponent)
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(labels((0.0, 0.75), true), ("0.0 0.2 0.4 0.6".into(), 0));
        assert_eq!(labels((-0.7827, 0.0), false), ("−0.8 −0.6 −0.4 −0.2 0.0".into(), 0));
        assert_eq!(labels((0.0, 2.6e7), true), ("0 10 20".into(), 6));
        assert_eq!(labels((-3e-7, 3e-7), true), ("−200 0 200".into(), -9));
    }

    #[test]
    fn degenerate_ranges_do_not_panic() {
        assert_eq!(labels((3.0, 3.0), true).1, 0);
        assert!(!labels((f64::NAN, f64::NAN), false).0.is_empty());
        assert!(!labels((f64::INFINITY, f64::NEG_INFINITY), false).0.is_empty());
        assert!(!labels((0.0, 5e-324), false).0.is_empty());
        assert!(!labels((-f64::MAX, f64::MAX), false).0.is_empty());
    }
}
