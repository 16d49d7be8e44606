//! Functions and constants of formulas, with the derivatives of the functions. A new function is
//! one line in [`Function::NAMES`] and one in each `match`.

use crate::jet::Number;

/// A function of one argument or two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Sign,
    Floor,
    Min,
    Max,
    Mod,
    Atan2,
    /// Chooses between its second and third argument: three of them.
    If,
}

/// Named constants.
pub(crate) const CONSTANTS: [(&str, f64); 1] = [("pi", std::f64::consts::PI)];

impl Function {
    /// Names and numbers of arguments.
    pub(crate) const NAMES: [(&str, Self, usize); 20] = [
        ("sin", Self::Sin, 1),
        ("cos", Self::Cos, 1),
        ("tan", Self::Tan, 1),
        ("asin", Self::Asin, 1),
        ("acos", Self::Acos, 1),
        ("atan", Self::Atan, 1),
        ("sinh", Self::Sinh, 1),
        ("cosh", Self::Cosh, 1),
        ("tanh", Self::Tanh, 1),
        ("exp", Self::Exp, 1),
        ("ln", Self::Ln, 1),
        ("sqrt", Self::Sqrt, 1),
        ("abs", Self::Abs, 1),
        ("sign", Self::Sign, 1),
        ("floor", Self::Floor, 1),
        ("min", Self::Min, 2),
        ("max", Self::Max, 2),
        ("mod", Self::Mod, 2),
        ("atan2", Self::Atan2, 2),
        ("if", Self::If, 3),
    ];

    /// A function of one argument. At a kink (|0|, a jump of sign or floor) the derivative is that
    /// of the right-hand branch.
    pub(crate) fn of<N: Number>(self, argument: N) -> N {
        let x = argument.value();
        let jumps = |value| argument.map(value, || [0.0; 2]);
        match self {
            Self::Sin => argument.map(x.sin(), || [x.cos(), -x.sin()]),
            Self::Cos => argument.map(x.cos(), || [-x.sin(), -x.cos()]),
            Self::Tan => {
                let t = x.tan();
                argument.map(t, || [1.0 + t * t, 2.0 * t * (1.0 + t * t)])
            }
            Self::Asin => argument.map(x.asin(), || inverse_sine(x)),
            Self::Acos => argument.map(x.acos(), || inverse_sine(x).map(|d| -d)),
            Self::Atan => argument.map(x.atan(), || {
                let s = 1.0 / (1.0 + x * x);
                [s, -2.0 * x * s * s]
            }),
            Self::Sinh => argument.map(x.sinh(), || [x.cosh(), x.sinh()]),
            Self::Cosh => argument.map(x.cosh(), || [x.sinh(), x.cosh()]),
            Self::Tanh => {
                let t = x.tanh();
                argument.map(t, || [1.0 - t * t, -2.0 * t * (1.0 - t * t)])
            }
            Self::Exp => argument.map(x.exp(), || [x.exp(); 2]),
            Self::Ln => argument.map(x.ln(), || [1.0 / x, -1.0 / (x * x)]),
            Self::Sqrt => {
                let r = x.sqrt();
                argument.map(r, || [0.5 / r, -0.25 / (r * x)])
            }
            Self::Abs if x < 0.0 => -argument,
            Self::Sign if x == 0.0 => jumps(0.0),
            Self::Sign => jumps(x.signum()),
            Self::Floor => jumps(x.floor()),
            // Unreachable: the parser checks the number of arguments.
            Self::Abs | Self::Min | Self::Max | Self::Mod | Self::Atan2 | Self::If => argument,
        }
    }

    /// A function of two arguments. `mod(a, b)` = a − b⌊a/b⌋ has the sign of b; `atan2(y, x)` is
    /// the angle of (x, y).
    pub(crate) fn of_two<N: Number>(self, a: N, b: N) -> N {
        let (x, y) = (a.value(), b.value());
        match self {
            Self::Min if y < x || y.is_nan() => b,
            Self::Max if y > x || y.is_nan() => b,
            Self::Mod => a - b * N::constant((x / y).floor()),
            Self::Atan2 => angle(a, b),
            _ => a,
        }
    }
}

fn inverse_sine(x: f64) -> [f64; 2] {
    let s = 1.0 / (1.0 - x * x).sqrt();
    [s, x * s * s * s]
}

/// The angle of (x, y). Its derivatives are those of the arctangent of y/x or −x/y, from which it
/// differs by a constant; the one with the smaller argument is used.
fn angle<N: Number>(y: N, x: N) -> N {
    let value = y.value().atan2(x.value());
    let branch =
        if x.value().abs() > y.value().abs() { Function::Atan.of(y / x) } else { -Function::Atan.of(x / y) };
    branch.map(value, || [1.0, 0.0])
}

/// Base to the power of exponent. A constant exponent allows a negative base (where it is whole),
/// and 0⁰ = 1.
pub(crate) fn power<N: Number>(base: N, exponent: N) -> N {
    let (x, n) = (base.value(), exponent.value());
    let value = if n.fract() == 0.0 && n.abs() <= 64.0 { x.powi(n as i32) } else { x.powf(n) };
    if exponent.is_constant() {
        // n xⁿ⁻¹ is 0, not 0·∞, where n is 0.
        let term = |factor: f64, n: f64| if factor == 0.0 { 0.0 } else { factor * x.powf(n) };
        return base.map(value, || [term(n, n - 1.0), term(n * (n - 1.0), n - 2.0)]);
    }
    Function::Exp.of(exponent * Function::Ln.of(base))
}
