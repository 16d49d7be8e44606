//! Checks of the times n·Δt: the last one must be `end`.

use super::super::TimeSpec;
use super::super::problem::rounded;
use super::Check;

/// More steps than any run takes: 10⁹ steps of a microsecond take a quarter of an hour, of a
/// millisecond twelve days.
const MOST_STEPS: f64 = 1e9;

impl TimeSpec {
    /// Number of steps to the end; the reader has checked that `end` is a multiple of `step`, up to
    /// a relative error of 10⁻⁶. With a phase, the first and the last step are parts of one.
    pub fn steps(&self) -> usize {
        (self.end / self.step).round() as usize + usize::from(self.phase > 0.0)
    }
}

impl Check<'_> {
    pub(super) fn time(&mut self) {
        let Some(time) = &self.draft.time else { return };
        let end = time.end;
        let step = time.step;
        if !(end.is_finite() && step.is_finite() && end > 0.0 && step > 0.0) {
            return;
        }
        let steps = (end / step).round();
        if end < step * (1.0 - 1e-6) {
            let why = format!("the run ends at {end}, before the end of its first step");
            self.add(
                "time.step",
                format!("the step {step} is longer than the run"),
                why,
                "choose step ≤ end",
            );
        } else if steps > MOST_STEPS {
            let why =
                format!("end / step = {:.3e}, and at most {MOST_STEPS:e} steps are allowed", end / step);
            self.add(
                "time.step",
                "the run has too many steps",
                why,
                "choose a longer step or an earlier end",
            );
        } else if (end / step - steps).abs() > 1e-6 * steps {
            let below = (end / step).floor();
            let above = (end / step).ceil();
            let why = format!("a run has a whole number of steps, and end / step = {}", rounded(end / step));
            let help = format!(
                "use step = {} or step = {}, or end = {} or end = {}",
                rounded(end / above),
                rounded(end / below),
                rounded(below * step),
                rounded(above * step)
            );
            self.add("time.end", format!("the end {end} is not a multiple of the step {step}"), why, help);
        }
        let times = self
            .document
            .root()
            .get("output")
            .and_then(|o| o.table()?.get("at_times")?.list())
            .unwrap_or(&[]);
        for (i, t) in times.iter().enumerate() {
            if let Some(t) = t.number().filter(|t| t.is_finite() && !(0.0..=end).contains(t)) {
                let what = format!("the time {t} is outside the run");
                self.add(
                    format!("output.at_times[{i}]"),
                    what,
                    format!("the run goes from 0 to {end}"),
                    "leave it out",
                );
            }
        }
    }
}
