//! Checks of derivatives by central differences, for tests.

/// Largest |analytic − numeric| over all entries of a Jacobian, relative to its largest numeric
/// entry.
///
/// `f` maps `x` (n entries) to m entries; `jacobian` is m × n, row-major. Central differences with
/// step `h`, Richardson-extrapolated once (error O(h⁴)).
///
/// ```
/// let error = carom_algebra::jacobian_error(&[3.0], 1e-3, |x| vec![x[0].powi(3)], &[27.0]);
/// assert!(error < 1e-11);
/// ```
pub fn jacobian_error(x: &[f64], h: f64, mut f: impl FnMut(&[f64]) -> Vec<f64>, jacobian: &[f64]) -> f64 {
    let n = x.len();
    let mut at = x.to_vec();
    let mut slope = |j: usize, h: f64| -> Vec<f64> {
        at[j] = x[j] + h;
        let plus = f(&at);
        at[j] = x[j] - h;
        let minus = f(&at);
        at[j] = x[j];
        plus.iter().zip(&minus).map(|(p, m)| (p - m) / (2.0 * h)).collect()
    };
    let mut error = 0.0_f64;
    let mut size = 0.0_f64;
    for j in 0..n {
        let fine = slope(j, 0.5 * h);
        let coarse = slope(j, h);
        for i in 0..fine.len() {
            let numeric = (4.0 * fine[i] - coarse[i]) / 3.0;
            error = error.max((numeric - jacobian[i * n + j]).abs());
            size = size.max(numeric.abs());
        }
    }
    error / size.max(f64::MIN_POSITIVE)
}
