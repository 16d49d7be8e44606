//! Axes with round ticks, and a power of ten factored out of numbers far from one.

use crate::labels::{number, scaled, with_unit};

/// Ticks of an axis from `low` to `high`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Axis {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) ticks: Vec<(f64, String)>,
    /// Tick labels are in units of 10^exponent.
    pub(crate) exponent: i32,
    /// Number that is subtracted from the values of the tick labels.
    pub(crate) offset: f64,
}

/// A range smaller than this share of its values has labels with an offset.
const NARROW: f64 = 2e-3;

/// Round step (1, 2 or 5 times a power of ten) that gives about `count` intervals.
pub(crate) fn round_step(span: f64, count: f64) -> f64 {
    let raw = span / count;
    let power = 10f64.powi(raw.log10().floor() as i32);
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * power >= raw * 0.999).unwrap_or(10.0);
    factor * power
}

/// The roundest number within about the length of a range from its lower end, so that labels need
/// only the digits that differ, and the offset few.
fn round_near(low: f64, span: f64) -> f64 {
    let finest = span.log10().ceil() as i32;
    let rounded = |power: i32| {
        let unit = 10f64.powi(power);
        (low / unit).round() * unit
    };
    let is_near = |x: &f64| (x - low).abs() <= 2.0 * span;
    (finest..finest + 16).map(rounded).take_while(is_near).last().unwrap_or_else(|| rounded(finest))
}

/// A number with the fewest digits that give it within a thousandth of `span`.
fn digits_within(x: f64, span: f64) -> String {
    let text = (0..16).map(|decimals| format!("{x:.decimals$}"));
    let is_exact = |text: &String| text.parse().is_ok_and(|y: f64| (x - y).abs() < 1e-3 * span);
    text.into_iter().find(is_exact).map_or_else(|| number(x), |text| text.replace('-', "−"))
}

/// A number with a minus sign, not a hyphen, and no negative zero.
fn signed(x: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", x.abs());
    if x < 0.0 { format!("−{text}") } else { text }
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
        // Values that differ by less than this share are the same to round-off.
        if high - low <= 1e-10 * size || high - low < 1e-290 {
            let half = if size < 1e-280 { 1.0 } else { 0.1 * size };
            (low, high) = (low - half, high + half);
        }
        let mut step = round_step(high - low, count);
        if !tight {
            // A margin of 2 %, then rounded outwards to half a step.
            let air = 0.02 * (high - low);
            let half = 0.5 * step;
            low = if low == 0.0 { 0.0 } else { ((low - air) / half).floor() * half };
            high = if high == 0.0 { 0.0 } else { ((high + air) / half).ceil() * half };
        }
        // One tick alone has no scale.
        let last_of = |step: f64| (high / step + 1e-9).floor() as i64;
        let first_of = |step: f64| (low / step - 1e-9).ceil() as i64;
        while last_of(step) <= first_of(step) {
            step = round_step(0.4 * step, 1.0);
        }
        let size = low.abs().max(high.abs());
        let offset = if high - low < NARROW * size { round_near(low, high - low) } else { 0.0 };
        let size = (low - offset).abs().max((high - offset).abs());
        let order = size.log10().floor() as i32;
        let decimals = |exponent: i32| {
            (-(step / 10f64.powi(exponent) * 1.0001).log10().floor()).clamp(0.0, 12.0) as usize
        };
        let exponent = if (-2..4).contains(&order) { 0 } else { order.div_euclid(3) * 3 };
        // Labels with more than three decimals are too wide; those of a large number stay as they
        // are.
        let exponent = if exponent == 0 && order < 0 && decimals(0) > 3 { -3 } else { exponent };
        let scale = 10f64.powi(exponent);
        let decimals = decimals(exponent);
        let first = first_of(step);
        let last = last_of(step);
        let ticks = (first..=last.min(first + 50)).map(|i| {
            let value = i as f64 * step;
            let shown = if offset == 0.0 { value } else { (i as f64 - (offset / step).round()) * step };
            (value, signed(shown / scale, decimals))
        });
        Self { low, high, ticks: ticks.collect(), exponent, offset }
    }

    /// This axis with tick labels in units of another power of ten, if they have at most three
    /// decimals.
    pub(crate) fn in_units_of(mut self, exponent: i32) -> Self {
        let [(first, _), (second, _), ..] = &self.ticks[..] else { return self };
        let scale = 10f64.powi(exponent);
        let decimals = (-((second - first) / scale * 1.0001).log10().floor()).max(0.0);
        if self.offset != 0.0 || decimals > 3.0 {
            return self;
        }
        for (value, label) in &mut self.ticks {
            *label = signed(*value / scale, decimals as usize);
        }
        self.exponent = exponent;
        self
    }

    /// The label of the axis: quantity, offset and unit.
    pub(crate) fn label(&self, quantity: &str, unit: &str) -> String {
        // The offset is in the unit without a prefix: “F − 0.06 N (µN)”.
        let amount = |offset: f64| match unit {
            "" | "1" => digits_within(offset, self.high - self.low),
            unit => format!("{} {unit}", digits_within(offset, self.high - self.low)),
        };
        let quantity = match self.offset {
            0.0 => quantity.to_owned(),
            offset if offset < 0.0 => format!("{quantity} + {}", amount(-offset)),
            offset => format!("{quantity} − {}", amount(offset)),
        };
        with_unit(&quantity, &scaled(unit, self.exponent))
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
        assert_eq!(labels((-1e-3, 0.0), true), ("−1.0 −0.8 −0.6 −0.4 −0.2 0.0".into(), -3));
    }

    /// Millijoules beside joules.
    #[test]
    fn axes_change_their_unit() {
        let axis = Axis::new((0.0, 0.008), 4.0, false);
        assert_eq!((axis.exponent, axis.ticks[1].1.as_str()), (-3, "2"));
        let axis = axis.in_units_of(0);
        assert_eq!((axis.exponent, axis.ticks[1].1.as_str()), (0, "0.002"));
        assert_eq!(Axis::new((0.0, 8e-7), 4.0, false).in_units_of(0).exponent, -9);
    }

    /// 0.060000 to 0.060008: labels are the millionths above 0.06.
    #[test]
    fn narrow_ranges_have_an_offset() {
        let axis = Axis::new((0.06, 0.060008), 4.0, true);
        assert_eq!(axis.ticks.iter().map(|t| t.1.as_str()).collect::<Vec<_>>(), ["0", "2", "4", "6", "8"]);
        assert_eq!(axis.label("F", "N"), "F − 0.06 N (µN)");
        assert_eq!(axis.label("n", "1"), "n − 0.06 (10^{-6})");
        assert_eq!(Axis::new((-300.0, -299.9), 2.0, true).label("y", "m"), "y + 300 m (m)");
    }

    /// An energy from 2.50044992 J to 2.50045 J: the offset in the label is the one subtracted.
    #[test]
    fn offsets_are_written_with_all_their_digits() {
        for (range, label) in [
            ((2.500_449_92, 2.500_450_001), "E − 2.50045 J (nJ)"),
            ((1.234_567_81, 1.234_567_89), "E − 1.234568 J (nJ)"),
        ] {
            let axis = Axis::new(range, 4.0, false);
            let text = axis.label("E", "J");
            assert_eq!(text, label);
            let written: f64 = text.split(' ').nth(2).unwrap().parse().unwrap();
            for (value, tick) in &axis.ticks {
                let tick: f64 = tick.replace('−', "-").parse().unwrap();
                assert!((written + 1e-9 * tick - value).abs() < 1e-12, "{text}: {tick} at {value}");
            }
        }
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
