//! Formulas in named variables: what a case file may say where a number depends on place or time.
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
//! Operators, weakest first: `||`, `&&`, `< <= > >= == !=` (1 if true, 0 if not), `+ -`, `* /`, signs, `^` (from the right: `-2^2` is −4,
//! `2^-1` is ½). Functions: sin cos tan asin acos atan sinh cosh tanh exp ln sqrt abs sign floor, `min(a, b)`, `max(a, b)`, `mod(a, b)` =
//! a − b⌊a/b⌋, `atan2(y, x)`, `if(condition, then, else)`, of which only the branch taken is evaluated. Constant: `pi`.
//!
//! A value may be infinite or not a number (`1/t` at 0): whoever evaluates knows the place and the time, and refuses it with them.

mod function;
mod jet;
mod parse;

use std::ops::Range;

use serde::{Serialize, Serializer};

use function::{Function, power};
use jet::{Jet, Number};

/// What is wrong with a formula, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FormulaError {
    /// In words, with what to try.
    pub message: String,
    /// Bytes of the text it is about; empty where something is missing.
    pub at: Range<usize>,
}

impl std::fmt::Display for FormulaError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} (at character {})", self.message, self.at.start + 1)
    }
}

impl std::error::Error for FormulaError {}

/// A formula that was read. Two are equal if their texts and variables are.
#[derive(Clone, Debug)]
pub struct Formula {
    text: String,
    variables: Vec<String>,
    tree: Tree,
}

/// A formula's operations.
#[derive(Clone, Debug, PartialEq)]
enum Tree {
    Number(f64),
    Variable(usize),
    Negative(Box<Tree>),
    Binary(Binary, Box<[Tree; 2]>),
    One(Function, Box<Tree>),
    Two(Function, Box<[Tree; 2]>),
    Choice(Box<[Tree; 3]>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
    And,
    Or,
}

impl Formula {
    /// Reads a formula in these variables.
    ///
    /// # Errors
    /// Anything that is no formula, unknown names, wrong numbers of arguments: with the place in the text.
    pub fn parse(text: &str, variables: &[&str]) -> Result<Self, FormulaError> {
        let tree = parse::tree(text, variables)?;
        Ok(Self { text: text.to_owned(), variables: variables.iter().map(|&v| v.to_owned()).collect(), tree })
    }

    /// A number as a formula.
    pub fn constant(value: f64) -> Self {
        Self { text: value.to_string(), variables: Vec::new(), tree: Tree::Number(value) }
    }

    /// The formula as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the formula depends on a variable of this name.
    pub fn depends_on(&self, variable: &str) -> bool {
        self.variables.iter().position(|v| v == variable).is_some_and(|k| self.tree.mentions(k))
    }

    /// Value where the variables, in the order they were given to [`Self::parse`], have these values.
    ///
    /// # Panics
    /// With fewer values than variables.
    pub fn value(&self, values: &[f64]) -> f64 {
        self.tree.evaluate(&|k| values[k])
    }

    /// Value, first and second derivative with respect to variable number `variable`. At a kink (`min`, `abs`, `if`) the derivatives are those of
    /// the branch taken.
    ///
    /// # Panics
    /// With fewer values than variables.
    pub fn with_derivatives(&self, values: &[f64], variable: usize) -> [f64; 3] {
        let slope = |k| if k == variable { 1.0 } else { 0.0 };
        self.tree.evaluate(&|k| Jet([values[k], slope(k), 0.0])).0
    }

    /// Value, gradient and second derivatives (row-major) with respect to the first `n` variables, by derivatives along directions:
    /// ∂²f/∂x∂y = ½ (f″ along (1, 1) − ∂²f/∂x² − ∂²f/∂y²).
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
        let along = |i: usize, j: usize| {
            let slope = |k| if k == i || k == j { 1.0 } else { 0.0 };
            self.tree.evaluate(&|k| Jet([values[k], slope(k), 0.0])).0
        };
        let own: Vec<[f64; 3]> = (0..n).map(|i| along(i, i)).collect();
        let mixed = |i: usize, j: usize| {
            if i == j { own[i][2] } else { 0.5 * (along(i.min(j), i.max(j))[2] - own[i][2] - own[j][2]) }
        };
        let second = (0..n * n).map(|k| mixed(k / n, k % n)).collect();
        (own.first().map_or_else(|| self.value(values), |o| o[0]), own.iter().map(|o| o[1]).collect(), second)
    }
}

impl Tree {
    fn evaluate<N: Number>(&self, variable: &impl Fn(usize) -> N) -> N {
        match self {
            Self::Number(value) => N::constant(*value),
            Self::Variable(k) => variable(*k),
            Self::Negative(a) => -a.evaluate(variable),
            Self::Binary(operator, operands) => operator.of(operands.each_ref().map(|a| a.evaluate(variable))),
            Self::One(function, a) => function.of(a.evaluate(variable)),
            Self::Two(function, operands) => {
                let [a, b] = operands.each_ref().map(|a| a.evaluate(variable));
                function.of_two(a, b)
            }
            Self::Choice(operands) => {
                let [condition, then, otherwise] = &**operands;
                if condition.evaluate(variable).value() == 0.0 { otherwise } else { then }.evaluate(variable)
            }
        }
    }

    fn mentions(&self, variable: usize) -> bool {
        let any = |operands: &[Self]| operands.iter().any(|a| a.mentions(variable));
        match self {
            Self::Number(_) => false,
            Self::Variable(k) => *k == variable,
            Self::Negative(a) | Self::One(_, a) => a.mentions(variable),
            Self::Binary(_, operands) | Self::Two(_, operands) => any(&**operands),
            Self::Choice(operands) => any(&**operands),
        }
    }
}

impl Binary {
    fn of<N: Number>(self, [a, b]: [N; 2]) -> N {
        let (x, y) = (a.value(), b.value());
        let truth = |holds: bool| N::constant(f64::from(u8::from(holds)));
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Power => power(a, b),
            Self::Less => truth(x < y),
            Self::LessOrEqual => truth(x <= y),
            Self::Greater => truth(x > y),
            Self::GreaterOrEqual => truth(x >= y),
            Self::Equal => truth(x == y),
            Self::NotEqual => truth(x != y),
            Self::And => truth(x != 0.0 && y != 0.0),
            Self::Or => truth(x != 0.0 || y != 0.0),
        }
    }
}

impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text && self.variables == other.variables
    }
}

/// As its text; who reads it back knows the variables.
impl Serialize for Formula {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.text)
    }
}
