//! Roots of real polynomials up to degree three, for the analysis of schemes.
//!
//! Cubic: Newton's iteration to an outer real root from a start beyond which it is monotone, then
//! deflation from the end with the smaller loss (W. Kahan, *To Solve a Real Cubic Equation*, 1986).
//! Quadratic: the larger root by addition, the other by the product.

/// A root in the complex plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Root {
    pub(crate) const fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    /// |z|.
    pub fn modulus(self) -> f64 {
        self.re.hypot(self.im)
    }
}

/// Roots of a z² + b z + c; fewer if leading coefficients vanish. A discriminant within ± `snap`
/// counts as zero: the round-off of the coefficients must not split a known double root into two
/// with half the digits.
pub(crate) fn quadratic(a: f64, b: f64, c: f64, snap: f64) -> Vec<Root> {
    if a == 0.0 {
        return if b == 0.0 { vec![] } else { vec![Root::real(-c / b)] };
    }
    let half = -0.5 * b;
    let discriminant = half.mul_add(half, -a * c);
    if discriminant.abs() <= snap {
        return vec![Root::real(half / a); 2];
    }
    if discriminant < 0.0 {
        let im = (-discriminant).sqrt() / a.abs();
        return vec![Root { re: half / a, im }, Root { re: half / a, im: -im }];
    }
    let larger = half + discriminant.sqrt().copysign(half);
    vec![Root::real(larger / a), Root::real(c / larger)]
}

/// Roots of a z³ + b z² + c z + d; fewer if leading coefficients vanish.
pub(crate) fn cubic(a: f64, b: f64, c: f64, d: f64) -> Vec<Root> {
    if a == 0.0 {
        return quadratic(b, c, d, 0.0);
    }
    let (x, b1, c2) = if d == 0.0 {
        (0.0, b, c)
    } else {
        let x = outer_root(a, b, c, d);
        let b1 = a * x + b;
        // Deflate upwards from d or downwards from a, whichever perturbs less.
        if (a * x * x).abs() > (d / x).abs() {
            let c2 = -d / x;
            (x, (c2 - c) / x, c2)
        } else {
            (x, b1, b1 * x + c)
        }
    };
    let mut roots = quadratic(a, b1, c2, 0.0);
    roots.push(Root::real(x));
    roots
}

/// The real root beyond the inflection point that Newton's iteration reaches monotonically.
fn outer_root(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let value = |x: f64| ((a * x + b) * x + c) * x + d;
    let slope = |x: f64| (3.0 * a * x + 2.0 * b) * x + c;
    let inflection = -b / a / 3.0;
    let (v, s) = (value(inflection) / a, slope(inflection) / a);
    let mut reach = v.abs().cbrt();
    if s < 0.0 {
        reach = 1.324718 * reach.max((-s).sqrt());
    }
    let side = 1.0f64.copysign(v);
    let mut x = inflection;
    let mut next = inflection - side * reach;
    // Monotone towards the inflection point until round-off reverses it.
    for _ in 0..200 {
        if side * next <= side * x && x != inflection {
            break;
        }
        x = next;
        let s = slope(x);
        if s == 0.0 {
            break;
        }
        next = x - value(x) / s;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expands (z − z₁)(z − z₂)(z − z₃).
    fn expanded(r: &[Root]) -> [f64; 3] {
        let times = |a: Root, b: Root| Root { re: a.re * b.re - a.im * b.im, im: a.re * b.im + a.im * b.re };
        let (ab, ac, bc) = (times(r[0], r[1]), times(r[0], r[2]), times(r[1], r[2]));
        [-(r[0].re + r[1].re + r[2].re), ab.re + ac.re + bc.re, -times(ab, r[2]).re]
    }

    #[test]
    fn roots_rebuild_their_polynomial() {
        let numbers = [-1e3, -7.0, -1.0, -1e-3, 0.0, 1e-6, 0.3, 1.0, 2.5, 40.0];
        for b in numbers {
            for c in numbers {
                for d in numbers {
                    let roots = cubic(1.0, b, c, d);
                    let largest = roots.iter().map(|root| root.modulus()).fold(0.0, f64::max);
                    let scale = [largest, largest * largest, largest * largest * largest];
                    for ((got, want), scale) in expanded(&roots).iter().zip([b, c, d]).zip(scale) {
                        assert!(
                            (got - want).abs() <= 1e-14 * scale.max(want.abs()),
                            "{b} {c} {d}: {roots:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn multiple_and_missing_roots() {
        let triple = cubic(1.0, 3.0, 3.0, 1.0);
        assert!(triple.iter().all(|root| (root.re + 1.0).hypot(root.im) < 1e-5), "{triple:?}");
        assert_eq!(cubic(0.0, 1.0, 0.0, 4.0), [Root { re: 0.0, im: 2.0 }, Root { re: 0.0, im: -2.0 }]);
        assert_eq!(quadratic(0.0, 0.0, 1.0, 0.0), []);
        assert_eq!(quadratic(1.0, -2.0, 1.0 + 1e-15, 1e-14), [Root::real(1.0); 2]);
    }
}
