//! Smoothness of the contact force, and steadiness of contact, in the first episode or in all of
//! them.
//!
//! ```text
//! high frequency  1 − Σ_{|k| ≤ 16} |X_k|² / (N Σ x_n²),   X_k = Σ_n x_n exp(−2πi k n/N)       power above 16 cycles per episode (Parseval)
//! chatter         Σ (activations + releases) / (time in contact)
//! ```
//!
//! The N rows of the episode are assumed to be equally spaced in time. A force that is constant
//! during contact has no power at high frequency, and a smooth pulse almost none.

use super::given::Given;

/// Largest number of cycles per episode that counts as a low frequency.
const CYCLES: usize = 16;

/// Fraction of the power of equally spaced samples above 16 cycles in their span; none for too few
/// samples, or if all are zero.
pub fn high_frequency(samples: &[f64]) -> Option<f64> {
    let n = samples.len();
    let power = samples.iter().map(|x| x * x).sum::<f64>();
    if n < 4 * CYCLES || power == 0.0 || !power.is_finite() {
        return None;
    }
    let square = |k: usize| {
        // k·n is reduced modulo N before the multiplication, which is exact.
        let angle = |i: usize| std::f64::consts::TAU * ((k * i) % n) as f64 / n as f64;
        let (re, im) = samples.iter().enumerate().fold((0.0, 0.0), |(re, im), (i, x)| {
            let (sin, cos) = angle(i).sin_cos();
            (re + x * cos, im + x * sin)
        });
        re * re + im * im
    };
    let low = square(0) + 2.0 * (1..=CYCLES).map(square).sum::<f64>();
    // Only round-off can make it negative.
    Some(f64::max(0.0, 1.0 - low / (n as f64 * power)))
}

pub(super) fn high(given: &Given) -> Option<f64> {
    high_frequency(given.force_of_first()?.get(given.rows_in_contact()?)?)
}

pub(super) fn chatter(given: &Given) -> Option<f64> {
    let [activations, releases] = ["activations", "releases"].map(|name| given.history.column(name));
    let switches = activations?.iter().chain(releases?).sum::<f64>();
    let last = given.history.times().len().checked_sub(1)?;
    let duration =
        given.episodes.iter().map(|e| given.time(e.end.unwrap_or(last)) - given.time(e.start)).sum::<f64>();
    (duration > 0.0).then(|| switches / duration)
}

/// Mean penetration over the rows with contact; none if rows stand for several steps, because such
/// a row has the largest penetration of all of them.
pub(super) fn mean_penetration(given: &Given) -> Option<f64> {
    let steps = given.history.column("step").unwrap_or_default();
    if steps.windows(2).any(|two| two[1] - two[0] > 1.0) {
        return None;
    }
    let depth = given.history.column("penetration")?;
    let active = given.history.column("active")?;
    let (sum, rows) =
        depth.iter().zip(active).filter(|(_, n)| **n > 0.0).fold((0.0, 0), |(s, n), (d, _)| (s + d, n + 1));
    (rows > 0).then(|| sum / f64::from(rows))
}
