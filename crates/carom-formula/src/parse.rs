//! From text to a formula's operations, with winnow. White space is allowed between all symbols of
//!
//! ```text
//! expression = sign* operand (operator sign* operand)*
//! operand    = number | name | name "(" expression ("," expression)* ")" | "(" expression ")"
//! number     = (digit+ ("." digit*)? | "." digit+) (("e" | "E") ("+" | "-")? digit+)?
//! name       = letter (letter | digit | "_")*
//! ```
//!
//! Precedences are binding powers (V. R. Pratt, Top down operator precedence, *POPL* 1973). There
//! is no backtracking beyond one symbol, so the leftmost mistake is the one reported.

use std::ops::Range;

use winnow::ascii::{digit0, digit1, multispace0};
use winnow::combinator::Infix::{self, Left, Right};
use winnow::combinator::{self, Prefix, alt, delimited, opt, preceded, separated, terminated};
use winnow::error::{ErrMode, ParseError, ParserError};
use winnow::stream::{AsChar, LocatingSlice, Location, Stateful};
use winnow::token::{one_of, take_while};
use winnow::{ModalResult, Parser};

use crate::error::FormulaError;
use crate::function::{CONSTANTS, Function};
use crate::tree::Tree::{self, Call, Number};

/// Longer texts are rejected: parsing is recursive, and no real formula is that long.
const LONGEST: usize = 4096;
/// Parentheses within parentheses.
const DEEPEST: usize = 64;

/// The rest of the text and its position.
type Input<'a> = Stateful<LocatingSlice<&'a str>, Scope<'a>>;

#[derive(Clone, Debug)]
struct Scope<'a> {
    variables: &'a [&'a str],
    /// Parentheses that are still open.
    open: usize,
}

/// Error of an alternative that does not match; never reported, because the last alternative has a
/// message.
impl ParserError<Input<'_>> for FormulaError {
    type Inner = Self;

    fn from_input(_: &Input) -> Self {
        Self { message: String::new(), at: 0..0 }
    }

    fn into_inner(self) -> Result<Self, Self> {
        Ok(self)
    }
}

/// Reads a formula in these variables.
pub(crate) fn tree(text: &str, variables: &[&str]) -> Result<Tree, FormulaError> {
    let input = Stateful { input: LocatingSlice::new(text), state: Scope { variables, open: 0 } };
    formula.parse(input).map_err(ParseError::into_inner)
}

fn formula(input: &mut Input) -> ModalResult<Tree, FormulaError> {
    let end = input.len();
    if end > LONGEST {
        let message = format!("the formula is longer than {LONGEST} bytes");
        return reject(message, input.floor_char_boundary(LONGEST)..end);
    }
    if input.trim().is_empty() {
        return reject("the formula is empty", 0..end);
    }
    let tree = terminated(expression, multispace0).parse_next(input)?;
    let at = input.current_token_start();
    match input.chars().next() {
        None => Ok(tree),
        Some(')') => reject("this parenthesis has no opening parenthesis", at..at + 1),
        Some(_) => misplaced(input, "an operator"),
    }
}

/// An error that ends the parsing.
fn reject<T>(message: impl Into<String>, at: Range<usize>) -> ModalResult<T, FormulaError> {
    Err(ErrMode::Cut(FormulaError { message: message.into(), at }))
}

fn misplaced<T>(input: &Input, wanted: &str) -> ModalResult<T, FormulaError> {
    let at = input.current_token_start();
    match input.chars().next() {
        None => reject(format!("the formula ends where {wanted} is expected"), at..at),
        Some(c) => reject(format!("`{c}` found where {wanted} is expected"), at..at + c.len_utf8()),
    }
}

type Error = ErrMode<FormulaError>;

/// Each sign and each power is a call: its parts are functions, which keeps the stack of 4000
/// small.
fn expression(input: &mut Input) -> ModalResult<Tree, FormulaError> {
    combinator::expression(preceded(multispace0, operand))
        .prefix(preceded(multispace0, sign))
        .infix(preceded(multispace0, operator))
        .parse_next(input)
}

#[inline(never)]
fn operand(input: &mut Input) -> ModalResult<Tree, FormulaError> {
    alt((number, named, delimited(open, expression, close))).parse_next(input)
}

#[inline(never)]
fn sign<'a>(input: &mut Input<'a>) -> Result<Prefix<Input<'a>, Tree, Error>, Error> {
    let signs = [("+", Prefix(6, |_: &mut _, a| Ok(a))), ("-", Prefix(6, |_, a| Ok(negative(a))))];
    alt((alt(signs.map(|(symbol, sign)| symbol.value(sign))), no_operand)).parse_next(input)
}

#[inline(never)]
fn operator<'a>(input: &mut Input<'a>) -> Result<Infix<Input<'a>, Tree, Error>, Error> {
    let operators = [
        ("||", Left(1, |_: &mut _, a, b| Ok(Call(Function::Or, vec![a, b])))),
        ("&&", Left(2, |_, a, b| Ok(Call(Function::And, vec![a, b])))),
        ("<=", Left(3, |_, a, b| Ok(Call(Function::LessOrEqual, vec![a, b])))),
        (">=", Left(3, |_, a, b| Ok(Call(Function::GreaterOrEqual, vec![a, b])))),
        ("==", Left(3, |_, a, b| Ok(Call(Function::Equal, vec![a, b])))),
        ("!=", Left(3, |_, a, b| Ok(Call(Function::NotEqual, vec![a, b])))),
        ("<", Left(3, |_, a, b| Ok(Call(Function::Less, vec![a, b])))),
        (">", Left(3, |_, a, b| Ok(Call(Function::Greater, vec![a, b])))),
        ("+", Left(4, |_, a, b| Ok(Call(Function::Add, vec![a, b])))),
        ("-", Left(4, |_, a, b| Ok(Call(Function::Subtract, vec![a, b])))),
        ("*", Left(5, |_, a, b| Ok(Call(Function::Multiply, vec![a, b])))),
        ("/", Left(5, |_, a, b| Ok(Call(Function::Divide, vec![a, b])))),
        ("^", Right(7, |_, a, b| Ok(Call(Function::Power, vec![a, b])))),
    ];
    alt((starred, alt(operators.map(|(symbol, operator)| symbol.value(operator))))).parse_next(input)
}

fn negative(a: Tree) -> Tree {
    if let Number(x) = a { Number(-x) } else { Call(Function::Negative, vec![a]) }
}

fn no_operand<T>(input: &mut Input) -> ModalResult<T, FormulaError> {
    misplaced(input, "a number, a variable or a function")
}

/// The power operator of other languages.
fn starred<T>(input: &mut Input) -> ModalResult<T, FormulaError> {
    let at = "**".span().parse_next(input)?;
    reject("a power is written ^, not **", at)
}

fn open(input: &mut Input) -> ModalResult<(), FormulaError> {
    let at = preceded(multispace0, '('.span()).parse_next(input)?;
    input.state.open += 1;
    if input.state.open > DEEPEST {
        return reject(format!("more than {DEEPEST} nested parentheses"), at);
    }
    Ok(())
}

fn close(input: &mut Input) -> ModalResult<(), FormulaError> {
    if preceded(multispace0, opt(')')).parse_next(input)?.is_none() {
        return misplaced(input, "an operator or a closing parenthesis");
    }
    input.state.open -= 1;
    Ok(())
}

fn number(input: &mut Input) -> ModalResult<Tree, FormulaError> {
    let mantissa = alt(((digit1, opt(('.', digit0))).void(), ('.', digit1).void()));
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1);
    let (text, at) = (mantissa, opt(exponent)).take().with_span().parse_next(input)?;
    match text.parse() {
        Ok(value) if f64::is_finite(value) => Ok(Number(value)),
        _ => reject(format!("the number {text} is too large"), at),
    }
}

/// A variable, a constant or a function with its arguments.
fn named(input: &mut Input) -> ModalResult<Tree, FormulaError> {
    let letters = (one_of(AsChar::is_alpha), take_while(0.., (AsChar::is_alphanum, '_')));
    let (name, at) = letters.take().with_span().parse_next(input)?;
    if opt(open).parse_next(input)?.is_none() {
        return variable(name, input.state.variables).or_else(|message| reject(message, at));
    }
    let (function, count) =
        function(name, input.state.variables).or_else(|message| reject(message, at.clone()))?;
    let arguments: Vec<Tree> =
        terminated(separated(1.., expression, (multispace0, ',')), close).parse_next(input)?;
    let (got, at) = (arguments.len(), at.start..input.current_token_start());
    if got != count {
        let s = if count == 1 { "" } else { "s" };
        return reject(format!("`{name}` takes {count} argument{s}, not {got}"), at);
    }
    Ok(Call(function, arguments))
}

fn variable(name: &str, variables: &[&str]) -> Result<Tree, String> {
    if let Some(k) = variables.iter().position(|v| *v == name) {
        return Ok(Tree::Variable(k));
    }
    if let Some((_, value)) = CONSTANTS.iter().find(|(constant, _)| *constant == name) {
        return Ok(Number(*value));
    }
    if let Some((.., count)) = Function::NAMES.iter().find(|(function, ..)| *function == name) {
        let s = if *count == 1 { "" } else { "s" };
        return Err(format!("`{name}` is a function: write its argument{s} in parentheses"));
    }
    let hint = nearest(name, variables.iter().copied().chain(CONSTANTS.map(|(constant, _)| constant)));
    Err(match hint {
        Some(near) => format!("there is no variable `{name}`: did you mean `{near}`?"),
        None if variables.is_empty() => {
            format!("there is no variable `{name}`: this formula has no variables")
        }
        None => format!("there is no variable `{name}`: the variables are {}", variables.join(", ")),
    })
}

/// A function and the number of its arguments.
fn function(name: &str, variables: &[&str]) -> Result<(Function, usize), String> {
    let names = Function::NAMES.map(|(known, ..)| known);
    if let Some(k) = names.iter().position(|known| *known == name) {
        return Ok((Function::NAMES[k].1, Function::NAMES[k].2));
    }
    if variables.contains(&name) || CONSTANTS.iter().any(|(constant, _)| *constant == name) {
        return Err(format!("`{name}` is not a function: write `{name}*(`"));
    }
    Err(match nearest(name, names) {
        Some(near) => format!("there is no function `{name}`: did you mean `{near}`?"),
        None => format!("there is no function `{name}`: the functions are {}", names.join(", ")),
    })
}

/// The known name nearest to a misspelt one, capitals aside, if near enough to be meant.
fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let distance = |known: &str| {
        if known.eq_ignore_ascii_case(name) { 0 } else { strsim::damerau_levenshtein(name, known) }
    };
    let near = known.into_iter().filter(|k| distance(k) <= if k.len() == 1 { 0 } else { 1 + k.len() / 4 });
    near.min_by_key(|k| distance(k))
}
