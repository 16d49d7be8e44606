//! A formula's operations, and their value in numbers or jets.

use crate::function::Function;
use crate::jet::Jet;

/// A formula's operations.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Tree {
    Number(f64),
    Variable(usize),
    /// A function of one argument to three: the parser counts them.
    Call(Function, Vec<Tree>),
}

impl Tree {
    /// Value where the variables have these values, plain or with derivatives.
    pub(crate) fn evaluate<const N: usize>(&self, variable: &impl Fn(usize) -> Jet<N>) -> Jet<N> {
        match self {
            Self::Number(value) => Jet::constant(*value),
            Self::Variable(k) => variable(*k),
            Self::Call(function, arguments) => match &arguments[..] {
                [a] => function.of(a.evaluate(variable)),
                [a, b] => function.of_two(a.evaluate(variable), b.evaluate(variable)),
                [condition, then, _] if condition.evaluate(variable).value() != 0.0 => {
                    then.evaluate(variable)
                }
                [_, _, otherwise] => otherwise.evaluate(variable),
                _ => Jet::constant(f64::NAN),
            },
        }
    }

    /// Whether a variable occurs, by its number.
    pub(crate) fn mentions(&self, variable: usize) -> bool {
        match self {
            Self::Number(_) => false,
            Self::Variable(k) => *k == variable,
            Self::Call(_, arguments) => arguments.iter().any(|a| a.mentions(variable)),
        }
    }
}
