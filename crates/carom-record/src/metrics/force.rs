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
pub(super) fn high_frequency(samples: &[f64]) -> Option<f64> {
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
    high_frequency(given.force().get(given.rows_in_contact()?)?)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::all;
    use crate::{Column, History};

    /// 1 + cos with k cycles in 128 samples has the power 128 + 64: a third of it is in the cosine,
    /// which counts for k > 16.
    #[test]
    fn power_above_sixteen_cycles() {
        let wave = |k: f64| -> Vec<f64> {
            (0..128).map(|i| 1.0 + (std::f64::consts::TAU * k * f64::from(i) / 128.0).cos()).collect()
        };
        assert!((high_frequency(&wave(17.0)).unwrap() - 1.0 / 3.0).abs() < 1e-14);
        assert!((high_frequency(&wave(40.0)).unwrap() - 1.0 / 3.0).abs() < 1e-14);
        assert!(high_frequency(&wave(16.0)).unwrap() < 1e-14);
        // The sign changes with every sample: a cosine of 64 cycles.
        let alternating: Vec<f64> = (0..128).map(|i| 3.0 * f64::from(1 - 2 * (i % 2))).collect();
        assert!((high_frequency(&alternating).unwrap() - 1.0).abs() < 1e-14);
        assert_eq!((high_frequency(&[1.0; 8]), high_frequency(&[0.0; 128])), (None, None));
    }

    /// Contact in rows 2 to 4 and 7, Δt = 0.5: the time in contact is 1.5 + 0.5, with three
    /// activations and three releases.
    #[test]
    fn chatter_and_depth_by_hand() {
        let column = |name: &str| Column {
            name: name.into(),
            unit: "u".into(),
            description: String::new(),
            integer: false,
        };
        let names = ["time", "active", "activations", "releases", "contact_force_x", "penetration"];
        let values = vec![
            (0..9).map(|i| 0.5 * f64::from(i)).collect(),
            vec![0.0, 0.0, 1.0, 2.0, 1.0, 0.0, 0.0, 1.0, 0.0],
            vec![0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
            vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0],
            vec![0.0, 0.0, 4.0, 1.0, -4.0, 0.0, 0.0, 2.0, 0.0],
            vec![0.0, 0.0, 0.1, 0.3, 0.0, 0.9, 0.0, 0.4, 0.0],
        ];
        let history = History::new(names.map(column).to_vec(), values);
        let metrics = all(&history);
        let of = |name: &str| metrics.iter().find(|m| m.name == name).unwrap();
        assert_eq!((of("chatter").value, of("chatter").unit.as_str()), (Some(3.0), "1/u"));
        assert_eq!(of("penetration_mean").value, Some(0.2));
        assert_eq!(of("force_high_frequency").value, None);
    }
}
