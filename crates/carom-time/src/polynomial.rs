//! Characteristic polynomials of small matrices and their roots, for schemes without a closed form.
//!
//! Coefficients by Faddeev and Le Verrier, all roots simultaneously by Ehrlich and Aberth (O.
//! Aberth, Math. Comp. 27 (1973) 339–344); zero roots are removed first.
use crate::cubic::{Root, cubic};

/// Coefficients of det(z I − A), the leading one (1) first.
pub(crate) fn characteristic(a: &[Vec<f64>]) -> Vec<f64> {
    let n = a.len();
    let mut coefficients = vec![1.0];
    let mut m = vec![vec![0.0; n]; n];
    for k in 1..=n {
        // M ← A M + c I, c ← −tr(A M)/k.
        let mut next = product(a, &m);
        let last = coefficients[k - 1];
        for (i, row) in next.iter_mut().enumerate() {
            row[i] += last;
        }
        m = next;
        let am = product(a, &m);
        coefficients.push(-(0..n).map(|i| am[i][i]).sum::<f64>() / k as f64);
    }
    coefficients
}

fn product(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = a.len();
    (0..n).map(|i| (0..n).map(|j| (0..n).map(|k| a[i][k] * b[k][j]).sum()).collect()).collect()
}

/// All roots of a monic polynomial. Coefficients below the round-off of the largest count as zero.
pub(crate) fn roots(coefficients: &[f64]) -> Vec<Root> {
    let size = coefficients.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    let mut degree = coefficients.len() - 1;
    let mut found = Vec::new();
    while degree > 0 && coefficients[degree].abs() <= 1e-15 * size {
        found.push(Root::real(0.0));
        degree -= 1;
    }
    let p = &coefficients[..=degree];
    found.extend(match degree {
        0 => Vec::new(),
        1 => vec![Root::real(-p[1])],
        2 => cubic(0.0, 1.0, p[1], p[2]),
        3 => cubic(1.0, p[1], p[2], p[3]),
        _ => aberth(p),
    });
    found
}

fn times(a: Root, b: Root) -> Root {
    Root { re: a.re * b.re - a.im * b.im, im: a.re * b.im + a.im * b.re }
}

fn over(a: Root, b: Root) -> Root {
    let square = b.re * b.re + b.im * b.im;
    Root { re: (a.re * b.re + a.im * b.im) / square, im: (a.im * b.re - a.re * b.im) / square }
}

fn aberth(p: &[f64]) -> Vec<Root> {
    let n = p.len() - 1;
    let radius = 1.0 + p[1..].iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    let mut z: Vec<Root> = (0..n)
        .map(|k| {
            let (im, re) = (std::f64::consts::TAU * k as f64 / n as f64 + 0.4).sin_cos();
            Root { re: radius * re, im: radius * im }
        })
        .collect();
    for _ in 0..500 {
        let mut moved = 0.0_f64;
        for k in 0..n {
            let (mut value, mut slope) = (Root::real(p[0]), Root::real(0.0));
            for &c in &p[1..] {
                slope = Root { re: value.re + times(slope, z[k]).re, im: value.im + times(slope, z[k]).im };
                value = times(value, z[k]);
                value.re += c;
            }
            if value.modulus() == 0.0 {
                continue;
            }
            let newton = over(value, slope);
            let mut sum = Root::real(0.0);
            for j in (0..n).filter(|&j| j != k) {
                let away = Root { re: z[k].re - z[j].re, im: z[k].im - z[j].im };
                let inverse = over(Root::real(1.0), away);
                sum = Root { re: sum.re + inverse.re, im: sum.im + inverse.im };
            }
            let product = times(newton, sum);
            let step = over(newton, Root { re: 1.0 - product.re, im: -product.im });
            if step.re.is_finite() && step.im.is_finite() {
                z[k] = Root { re: z[k].re - step.re, im: z[k].im - step.im };
                moved = moved.max(step.modulus());
            }
        }
        if moved <= 1e-16 * radius {
            break;
        }
    }
    z
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The companion matrix of a polynomial reproduces it, and its roots rebuild it.
    #[test]
    fn roots_are_the_eigenvalues() {
        // (z − 0.5)(z + 0.3)(z² − 1.6 z + 0.8)
        let p = [1.0, -1.8, 0.97, 0.08, -0.12];
        let mut a = vec![vec![0.0; 4]; 4];
        for j in 0..4 {
            a[0][j] = -p[j + 1];
        }
        for i in 1..4 {
            a[i][i - 1] = 1.0;
        }
        for (got, want) in characteristic(&a).iter().zip(p) {
            assert!((got - want).abs() < 1e-15);
        }
        let found = roots(&p);
        for (re, im) in [(0.5, 0.0), (-0.3, 0.0), (0.8, 0.4), (0.8, -0.4)] {
            assert!(found.iter().any(|z| (z.re - re).hypot(z.im - im) < 1e-12), "{found:?}");
        }
        assert_eq!(roots(&[1.0, -0.5, 0.0]).len(), 2);
    }
}
