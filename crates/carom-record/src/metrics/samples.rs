//! Functions of sampled values.
//!
//! ```text
//! total variation    TV = Σ |xᵢ₊₁ − xᵢ|
//! roughness          TV/(2 max x − x_first − x_last) − 1
//! peak mean          max_t |P(t + w) − P(t)|/w
//! ```

/// Value of a column at a time, linearly interpolated between rows.
pub(crate) fn at(times: &[f64], values: &[f64], time: f64) -> Option<f64> {
    let i = times.partition_point(|&t| t < time);
    if times.get(i) == Some(&time) {
        return values.get(i).copied();
    }
    let before = i.checked_sub(1)?;
    let after = i;
    let s = (time - times[before]) / (times.get(after)? - times[before]);
    Some(values[before] + s * (values.get(after)? - values[before]))
}

/// Σ |xᵢ₊₁ − xᵢ|.
pub(super) fn total_variation(values: &[f64]) -> f64 {
    values.windows(2).map(|w| (w[1] - w[0]).abs()).sum()
}

/// Total variation, divided by that of a single rise to the largest value and fall, minus 1: 0 for
/// a single hump. None for a constant.
pub fn roughness(values: &[f64]) -> Option<f64> {
    let top = extreme(values, f64::gt)?.1;
    let least = 2.0 * top - values.first()? - values.last()?;
    (least > 0.0).then(|| total_variation(values) / least - 1.0)
}

/// Integral from the first row to each row, with the trapezoidal rule.
pub fn integral(times: &[f64], values: &[f64]) -> Vec<f64> {
    let pieces = times.windows(2).zip(values.windows(2));
    let pieces = pieces.map(|(t, x)| 0.5 * (x[0] + x[1]) * (t[1] - t[0]));
    let sums = pieces.scan(0.0, |sum, piece| {
        *sum += piece;
        Some(*sum)
    });
    std::iter::once(0.0).chain(sums).take(values.len()).collect()
}

/// Largest mean over a time window of the quantity whose integrals are given, one per component:
/// max |P(t + w) − P(t)|/w. Between rows P is linear, and the norm convex: the largest window
/// begins or ends at a row.
pub fn peak_mean(times: &[f64], integrals: &[&[f64]], window: f64) -> Option<f64> {
    let end = *times.last()?;
    let mean = |t: f64| {
        let change = |p: &&[f64]| Some((at(times, p, (t + window).min(end))? - at(times, p, t)?) / window);
        integrals.iter().map(change).try_fold(0.0, |sum, f| Some(f64::hypot(sum, f?)))
    };
    let first = *times.first()?;
    let last = end - window;
    let ending = times.iter().map(|t| t - window);
    times.iter().copied().chain(ending).filter(|&t| first <= t && t <= last).filter_map(mean).reduce(f64::max)
}

/// Row and value that beats all others, the first of equal ones; NaN is ignored.
pub(crate) fn extreme(values: &[f64], beats: fn(&f64, &f64) -> bool) -> Option<(usize, f64)> {
    let finite = values.iter().copied().enumerate().filter(|(_, x)| !x.is_nan());
    finite.reduce(|best, next| if beats(&next.1, &best.1) { next } else { best })
}
