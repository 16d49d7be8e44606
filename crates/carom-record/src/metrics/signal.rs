//! Distance of two records in a vector quantity, apart from its rough part.
//!
//! ```text
//! e = a − b,   ⟨e⟩(t) = [E(t + w/2) − E(t − w/2)]/w     E: the integral of e, for forces the recorded impulse
//! smooth = ‖⟨e⟩‖,   rough = ‖e − ⟨e⟩‖,   ‖e‖² = 1/T ∫ |e|² dt over the span that both have in common
//! ```
//!
//! Both have limits under refinement of step and mesh, unlike the total variation of a stress or a
//! contact force. Windows are cut at the ends of the common span. Without a window, ⟨e⟩ = e, and e
//! is that at the rows of a, linear between them: a time integrator says nothing about the motion
//! between its steps.

use std::ops::Range;

use super::samples::{at, integral};

/// Least and largest number of equal parts of the span that norms are sums over.
const PARTS: (f64, f64) = (4099.0, 65_537.0);
/// Parts of a window.
const PER_WINDOW: f64 = 8.0;
/// Parts of a row; no simple fraction, so that an oscillation from row to row is seen at all
/// phases.
const PER_ROW: f64 = 1.373;

/// Instants at which errors are sampled; a prime number, so that a periodic motion is not seen at
/// one phase only.
const SAMPLES: usize = 1021;

/// Window of an average, and the span within which it stays.
struct Around {
    window: f64,
    common: Range<f64>,
}

/// Components of a vector quantity over time, with their integrals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Signal<'a> {
    times: &'a [f64],
    values: Vec<&'a [f64]>,
    integrals: Vec<Vec<f64>>,
    /// Whether the integrals were recorded: their rate is then constant between rows.
    recorded: bool,
}

/// Norms of a difference of two signals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distance {
    /// Norm of the average over the window.
    pub smooth: f64,
    /// Norm of what the average leaves out.
    pub rough: f64,
}

impl Distance {
    /// Both norms divided by a scale.
    #[must_use]
    pub fn relative_to(self, scale: f64) -> Self {
        Self { smooth: self.smooth / scale, rough: self.rough / scale }
    }
}

impl<'a> Signal<'a> {
    /// A signal that is integrated with the trapezoidal rule.
    pub fn of(times: &'a [f64], values: Vec<&'a [f64]>) -> Self {
        let integrals = values.iter().map(|x| integral(times, x)).collect();
        Self { times, values, integrals, recorded: false }
    }

    /// A signal whose integrals were recorded, one per component.
    #[must_use]
    pub fn with_integrals(self, integrals: Vec<Vec<f64>>) -> Self {
        Self { integrals, recorded: true, ..self }
    }

    /// Integral of a component up to a time; that of values is exact for values linear between
    /// rows.
    fn sum(&self, component: usize, time: f64) -> Option<f64> {
        let sums = &self.integrals[component];
        if self.recorded {
            return at(self.times, sums, time);
        }
        let row = self.times.partition_point(|t| *t <= time).checked_sub(1)?;
        let values = self.values[component];
        let mean = f64::midpoint(values[row], at(self.times, values, time)?);
        Some(sums[row] + mean * (time - self.times[row]))
    }

    /// Value of a component at a time, and its average over a span around it.
    fn around(&self, component: usize, time: f64, span: &Range<f64>) -> Option<[f64; 2]> {
        let value = at(self.times, self.values[component], time)?;
        if span.is_empty() {
            return Some([value; 2]);
        }
        let change = self.sum(component, span.end)? - self.sum(component, span.start)?;
        Some([value, change / (span.end - span.start)])
    }

    /// The span that two signals with the same components have in common.
    fn common(&self, other: &Self) -> Option<Range<f64>> {
        let first = self.times.first()?.max(*other.times.first()?);
        let last = self.times.last()?.min(*other.times.last()?);
        let is_alike = !self.values.is_empty() && self.values.len() == other.values.len();
        (first < last && is_alike).then_some(first..last)
    }

    /// Difference of a component from that of another signal at the rows of this one, linear
    /// between them.
    fn off_at_rows(&self, other: &Self, component: usize, time: f64) -> Option<f64> {
        let values = self.values[component];
        let error = |row: usize| {
            Some(values.get(row)? - at(other.times, other.values[component], *self.times.get(row)?)?)
        };
        let after = self.times.partition_point(|t| *t < time);
        let before = after.saturating_sub(1);
        let Some(errors) = error(before).zip(error(after)) else {
            // The other record ends between two rows.
            return Some(at(self.times, values, time)? - at(other.times, other.values[component], time)?);
        };
        if after == before {
            return Some(errors.0);
        }
        let share = (time - self.times[before]) / (self.times[after] - self.times[before]);
        Some(errors.0 + share * (errors.1 - errors.0))
    }

    /// Difference of a component from that of another signal at a time, and its average; the window
    /// is cut at the ends of the common span, as one of the records may go on for longer.
    fn off(&self, other: &Self, component: usize, time: f64, around: &Around) -> Option<[f64; 2]> {
        if around.window <= 0.0 {
            return Some([self.off_at_rows(other, component, time)?; 2]);
        }
        let half = around.window / 2.0;
        let span = (time - half).max(around.common.start)..(time + half).min(around.common.end);
        let own = self.around(component, time, &span)?;
        let known = other.around(component, time, &span)?;
        Some([own[0] - known[0], own[1] - known[1]])
    }

    /// Distance from another signal with the same components; none if they have no span in common.
    pub fn distance(&self, other: &Self, window: f64) -> Option<Distance> {
        let common = self.common(other)?;
        let length = common.end - common.start;
        let of_windows = if window > 0.0 { PER_WINDOW * length / window } else { 0.0 };
        let of_rows = PER_ROW * self.times.len().max(other.times.len()) as f64;
        let parts = of_windows.max(of_rows).ceil().clamp(PARTS.0, PARTS.1);
        let around = Around { window, common };
        let mut sums = [0.0; 2];
        for k in 0..parts as usize {
            let time = around.common.start + (k as f64 + 0.5) / parts * length;
            for component in 0..self.values.len() {
                let [error, smooth] = self.off(other, component, time, &around)?;
                sums[0] += smooth * smooth;
                sums[1] += (error - smooth).powi(2);
            }
        }
        let [smooth, rough] = sums.map(|sum| (sum / parts).sqrt());
        Some(Distance { smooth, rough })
    }

    /// Averaged differences from another signal at even instants of its span, zero after the end of
    /// this one. Their root of the sum of squares is the smooth distance, up to the sampling.
    pub fn errors(&self, other: &Self, window: f64) -> Option<Vec<f64>> {
        let around = Around { window, common: self.common(other)? };
        let first = *other.times.first()?;
        let length = other.times.last()? - first;
        let count = SAMPLES as f64;
        let at = |k: usize| first + (k as f64 + 0.5) / count * length;
        let off = |(component, k): (usize, usize)| {
            self.off(other, component, at(k), &around).map_or(0.0, |off| off[1] / count.sqrt())
        };
        let all = (0..self.values.len()).flat_map(|component| (0..SAMPLES).map(move |k| (component, k)));
        Some(all.map(off).collect())
    }

    /// Largest distance of smooth values between rows from their chords, root mean square over the
    /// rows: h² |x''|/8 by second differences.
    pub fn chords(&self) -> f64 {
        let rows = self.times.len().saturating_sub(2).max(1) as f64;
        let off = |x: &[f64]| (x[0] - 2.0 * x[1] + x[2]) / 8.0;
        let squares = self.values.iter().flat_map(|values| values.windows(3)).map(|x| off(x).powi(2));
        (squares.sum::<f64>() / rows).sqrt()
    }

    /// Norms of the signal itself.
    pub fn norms(&self, window: f64) -> Option<Distance> {
        let zero = vec![0.0; self.times.len()];
        let none = Signal::of(self.times, vec![&zero; self.values.len()]);
        self.distance(&none, window)
    }
}
