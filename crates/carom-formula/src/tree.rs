//! A formula's operations, and their value in numbers or jets.

use crate::function::{Function, power};
use crate::jet::Number;

/// A formula's operations.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Tree {
    Number(f64),
    Variable(usize),
    Negative(Box<Tree>),
    Binary(Binary, Box<[Tree; 2]>),
    One(Function, Box<Tree>),
    Two(Function, Box<[Tree; 2]>),
    Choice(Box<[Tree; 3]>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Binary {
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

impl Tree {
    /// Value where the variables have these values, of a number or with derivatives.
    pub(crate) fn evaluate<N: Number>(&self, variable: &impl Fn(usize) -> N) -> N {
        match self {
            Self::Number(value) => N::constant(*value),
            Self::Variable(k) => variable(*k),
            Self::Negative(a) => -a.evaluate(variable),
            Self::Binary(operator, operands) => {
                operator.of(operands.each_ref().map(|a| a.evaluate(variable)))
            }
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

    /// Whether a variable occurs, by its number.
    pub(crate) fn mentions(&self, variable: usize) -> bool {
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
