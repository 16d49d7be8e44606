//! A straight line through points by least squares, with 95 % confidence intervals of its slope and
//! of its values (N. R. Draper, H. Smith, *Applied Regression Analysis*, ch. 1):
//!
//! ```text
//! b = S_xy/S_xx,  s² = Σ (y − ŷ)²/(n − 2),  b ± t s/√S_xx,  ŷ(x) ± t s √(1/n + (x − x̄)²/S_xx)
//! ```
//!
//! with the quantile t of Student's distribution with n − 2 degrees of freedom.

/// 97.5 % quantiles of Student's distribution with 1, 2, … degrees of freedom.
const STUDENT: [f64; 30] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
    2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042,
];

/// The 97.5 % quantile for any number of degrees of freedom: of the table, or of the expansion
/// about the normal distribution (M. Abramowitz, I. Stegun, *Handbook of Mathematical Functions*,
/// 26.7.5).
fn student(degrees: usize) -> f64 {
    const Z: f64 = 1.959_963_985;
    if let Some(t) = degrees.checked_sub(1).and_then(|k| STUDENT.get(k)) {
        return *t;
    }
    let v = degrees as f64;
    let odd = |a: f64, b: f64, c: f64| a * Z.powi(5) + b * Z.powi(3) + c * Z;
    Z + odd(0.0, 1.0, 1.0) / (4.0 * v) + odd(5.0, 16.0, 3.0) / (96.0 * v * v)
}

/// A fitted line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fit {
    pub(super) slope: f64,
    /// Half-width of the interval of the slope.
    pub(super) uncertainty: f64,
    middle: (f64, f64),
    count: f64,
    width: f64,
    /// t s
    spread: f64,
}

impl Fit {
    /// Through at least three points with different x.
    pub(super) fn of(x: &[f64], y: &[f64]) -> Option<Self> {
        let n = x.len().min(y.len());
        if n < 3 || x.iter().chain(y).any(|v| !v.is_finite()) {
            return None;
        }
        let mean = |v: &[f64]| v[..n].iter().sum::<f64>() / n as f64;
        let middle = (mean(x), mean(y));
        let sum = |f: &dyn Fn(f64, f64) -> f64| {
            x.iter().zip(y).map(|(x, y)| f(x - middle.0, y - middle.1)).sum::<f64>()
        };
        let width = sum(&|x, _| x * x);
        if width <= 0.0 {
            return None;
        }
        let slope = sum(&|x, y| x * y) / width;
        let rest = sum(&|x, y| (y - slope * x).powi(2)) / (n - 2) as f64;
        let spread = student(n - 2) * rest.sqrt();
        Some(Self { slope, uncertainty: spread / width.sqrt(), middle, count: n as f64, width, spread })
    }

    /// Value of the line and half-width of its interval.
    pub(super) fn at(&self, x: f64) -> (f64, f64) {
        let d = x - self.middle.0;
        (self.middle.1 + self.slope * d, self.spread * (1.0 / self.count + d * d / self.width).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// NIST/SEMATECH e-Handbook of Statistical Methods, table 1.3.6.7.2.
    #[test]
    fn quantiles() {
        for (degrees, t) in
            [(1, 12.706), (30, 2.042), (31, 2.040), (40, 2.021), (60, 2.000), (100, 1.984), (100_000, 1.960)]
        {
            assert!((student(degrees) - t).abs() < 6e-4, "{degrees}: {}", student(degrees));
        }
    }

    /// By hand: (0, 0), (1, 2), (2, 1): slope 1/2, mean (1, 1), residuals −1/2, 1, −1/2, so s² =
    /// 3/2 with one degree of freedom and S_xx = 2.
    #[test]
    fn three_points() {
        let fit = Fit::of(&[0.0, 1.0, 2.0], &[0.0, 2.0, 1.0]).unwrap();
        let t = 12.706;
        assert!((fit.slope - 0.5).abs() < 1e-12 && (fit.uncertainty - t * (0.75_f64).sqrt()).abs() < 1e-9);
        let (value, half) = fit.at(1.0);
        assert!((value - 1.0).abs() < 1e-12 && (half - t * (0.5_f64).sqrt()).abs() < 1e-9);
        let (value, half) = fit.at(2.0);
        assert!(
            (value - 1.5).abs() < 1e-12 && (half - t * (1.5_f64 * (1.0 / 3.0 + 0.5)).sqrt()).abs() < 1e-9
        );
        assert!(Fit::of(&[1.0, 1.0, 1.0], &[0.0, 1.0, 2.0]).is_none());
        assert!(Fit::of(&[0.0, 1.0], &[0.0, 1.0]).is_none());
    }
}
