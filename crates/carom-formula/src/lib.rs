//! Formulas in named variables, for values of a case file that depend on place or time.
//!
//! ```
//! use carom_formula::Formula;
//!
//! let ramp = Formula::parse("-5*min(t/0.1, 1)", &["X", "Y", "t"])?;
//! assert_eq!(ramp.value(&[0.0, 0.0, 0.05]), -2.5);
//! assert_eq!(ramp.with_derivatives(&[0.0, 0.0, 0.05], 2), [-2.5, -50.0, 0.0]);
//!
//! let wrong = Formula::parse("2*sun(t)", &["t"]).unwrap_err();
//! assert_eq!((wrong.at, wrong.message.as_str()), (2..5, "there is no function `sun`: did you mean `sin`?"));
//! # Ok::<(), carom_formula::FormulaError>(())
//! ```
//!
//! Operators, weakest first: `||`, `&&`, `< <= > >= == !=` (1 if true, 0 if not), `+ -`, `* /`,
//! signs, `^` (from the right: `-2^2` is −4, `2^-1` is ½). Functions: sin cos tan asin acos atan
//! sinh cosh tanh exp ln sqrt abs sign floor, `min(a, b)`, `max(a, b)`, `mod(a, b)` = a − b⌊a/b⌋,
//! `atan2(y, x)`, and `if(condition, then, else)`, which evaluates only the branch taken.
//! Constant: `pi`.
//!
//! A value may be infinite or not a number (`1/t` at 0). The caller checks for this, because it
//! can report place and time.

mod error;
mod function;
mod given;
mod instant;
mod jet;
mod parse;
mod tree;

use std::sync::Arc;

use serde::{Serialize, Serializer};

pub use error::FormulaError;
pub use given::{Function, Functions};
pub use instant::instant;
use jet::Jet;
use tree::Tree;

/// A parsed formula, or a function of a program in its place. Two are equal if their texts and
/// variables are.
#[derive(Clone, Debug)]
pub struct Formula {
    text: String,
    variables: Vec<String>,
    body: Body,
}

#[derive(Clone, Debug)]
enum Body {
    Tree(Tree),
    Given(Arc<dyn Function>),
}

impl Formula {
    /// Parses a formula in these variables.
    ///
    /// # Errors
    /// Syntax errors, unknown names, wrong numbers of arguments, each with its place in the text.
    pub fn parse(text: &str, variables: &[&str]) -> Result<Self, FormulaError> {
        let tree = parse::tree(text, variables)?;
        Ok(Self::of(text.to_owned(), variables, Body::Tree(tree)))
    }

    /// A number as a formula.
    pub fn constant(value: f64) -> Self {
        Self::of(value.to_string(), &[], Body::Tree(Tree::Number(value)))
    }

    /// A function of these variables, called `name` in messages.
    pub fn given(name: &str, function: Arc<dyn Function>, variables: &[&str]) -> Self {
        Self::of(name.to_owned(), variables, Body::Given(function))
    }

    fn of(text: String, variables: &[&str], body: Body) -> Self {
        Self { text, variables: variables.iter().map(|&v| v.to_owned()).collect(), body }
    }

    /// The function of a program, if it is one: it should be called once for many points.
    pub fn function(&self) -> Option<&dyn Function> {
        match &self.body {
            Body::Tree(_) => None,
            Body::Given(function) => Some(function.as_ref()),
        }
    }

    /// The formula as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the formula depends on a variable of this name; a function of a program may depend
    /// on every variable.
    pub fn depends_on(&self, variable: &str) -> bool {
        self.variables.iter().position(|v| v == variable).is_some_and(|k| match &self.body {
            Body::Tree(tree) => tree.mentions(k),
            Body::Given(_) => true,
        })
    }

    /// Value where the variables, in the order they were given to [`Self::parse`], have these
    /// values.
    ///
    /// # Panics
    /// With fewer values than variables.
    pub fn value(&self, values: &[f64]) -> f64 {
        match &self.body {
            Body::Tree(tree) => tree.evaluate(&|k| Jet([values[k]])).value(),
            Body::Given(function) => {
                function.values(values, values.len()).first().copied().unwrap_or(f64::NAN)
            }
        }
    }

    /// Value, first and second derivative with respect to variable number `variable`. At a kink
    /// (`min`, `abs`, `if`) the derivatives are those of the branch taken.
    ///
    /// # Panics
    /// With fewer values than variables.
    pub fn with_derivatives(&self, values: &[f64], variable: usize) -> [f64; 3] {
        self.along(values, [variable; 2])
    }

    /// Value and derivatives along the sum of two variables, or along one given twice.
    fn along(&self, values: &[f64], [i, j]: [usize; 2]) -> [f64; 3] {
        let slope = |k| if k == i || k == j { 1.0 } else { 0.0 };
        match &self.body {
            Body::Tree(tree) => {
                let Jet([value, first, half_second]) = tree.evaluate(&|k| Jet([values[k], slope(k), 0.0]));
                [value, first, 2.0 * half_second]
            }
            // It knows the derivatives in its last variable only.
            Body::Given(function) if i == j && i + 1 == values.len() => {
                function.with_derivatives(values, values.len()).first().copied().unwrap_or([f64::NAN; 3])
            }
            Body::Given(_) => [f64::NAN; 3],
        }
    }

    /// Value, gradient and second derivatives (row-major) with respect to the first `n` variables,
    /// by derivatives along directions: ∂²f/∂x∂y = ½ (f″ along (1, 1) − ∂²f/∂x² − ∂²f/∂y²).
    ///
    /// ```
    /// let f = carom_formula::Formula::parse("X^2*Y + 3*X*t", &["X", "Y", "t"])?;
    /// assert_eq!(f.with_gradient(&[2.0, 5.0, 1.0], 2), (26.0, vec![23.0, 4.0], vec![10.0, 4.0, 4.0, 0.0]));
    /// # Ok::<(), carom_formula::FormulaError>(())
    /// ```
    ///
    /// # Panics
    /// With fewer values than variables.
    pub fn with_gradient(&self, values: &[f64], n: usize) -> (f64, Vec<f64>, Vec<f64>) {
        let own: Vec<[f64; 3]> = (0..n).map(|i| self.along(values, [i; 2])).collect();
        let mixed = |i: usize, j: usize| {
            if i == j { own[i][2] } else { 0.5 * (self.along(values, [i, j])[2] - own[i][2] - own[j][2]) }
        };
        let second = (0..n * n).map(|k| mixed(k / n, k % n)).collect();
        (own.first().map_or_else(|| self.value(values), |o| o[0]), own.iter().map(|o| o[1]).collect(), second)
    }
}

impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text && self.variables == other.variables
    }
}

/// Serialised as its text, without the variables.
impl Serialize for Formula {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.text)
    }
}
