//! From text to a formula's operations: the grammar `formula.pest` by pest, precedences by its
//! Pratt parser, names and arguments here.

use pest::Parser;
use pest::error::{ErrorVariant, InputLocation};
use pest::iterators::Pair;
use pest::pratt_parser::{Assoc, Op, PrattParser};
use pest_derive::Parser;
use std::sync::LazyLock;

use crate::error::FormulaError;
use crate::function::{CONSTANTS, Function};
use crate::tree::{Binary, Tree};

/// Longer texts are refused: no formula is, and reading one recurses.
const LONGEST: usize = 4096;
/// Parentheses within parentheses; pest recurses.
const DEEPEST: usize = 64;

#[derive(Parser)]
#[grammar = "formula.pest"]
struct Grammar;

/// Weakest first; a sign binds weaker than a power, as in print.
static PRECEDENCE: LazyLock<PrattParser<Rule>> = LazyLock::new(|| {
    let left = |rule| Op::infix(rule, Assoc::Left);
    PrattParser::new()
        .op(left(Rule::or))
        .op(left(Rule::and))
        .op(left(Rule::compare))
        .op(left(Rule::add) | left(Rule::subtract))
        .op(left(Rule::multiply) | left(Rule::divide))
        .op(Op::prefix(Rule::sign))
        .op(Op::infix(Rule::power, Assoc::Right))
});

/// Reads a formula in these variables.
pub(crate) fn tree(text: &str, variables: &[&str]) -> Result<Tree, FormulaError> {
    refuse_deep(text)?;
    let mut pairs = Grammar::parse(Rule::formula, text).map_err(|error| syntax(text, &error))?;
    let formula = pairs.next().and_then(|formula| formula.into_inner().next());
    formula
        .map_or_else(|| Err(wrong("the formula is empty", 0..text.len())), |pair| expression(pair, variables))
}

fn wrong(message: impl Into<String>, at: std::ops::Range<usize>) -> FormulaError {
    FormulaError { message: message.into(), at }
}

fn refuse_deep(text: &str) -> Result<(), FormulaError> {
    if text.len() > LONGEST {
        return Err(wrong(format!("the formula is longer than {LONGEST} bytes"), LONGEST..text.len()));
    }
    let mut depth = 0_usize;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            return Err(wrong(format!("more than {DEEPEST} nested parentheses"), at..at + 1));
        }
    }
    Ok(())
}

/// Pest says which rules it expected; a person wants to know what is there and what is missing.
fn syntax(text: &str, error: &pest::error::Error<Rule>) -> FormulaError {
    let at = match error.location {
        InputLocation::Pos(at) => at,
        InputLocation::Span((start, _)) => start,
    };
    let expected: &[Rule] = match &error.variant {
        ErrorVariant::ParsingError { positives, .. } => positives,
        ErrorVariant::CustomError { .. } => &[],
    };
    let operand =
        expected.iter().any(|r| matches!(r, Rule::number | Rule::name | Rule::expression | Rule::call));
    let wanted = if operand { "a number, a variable or a function" } else { "an operator" };
    let unclosed = text[..at].matches('(').count() > text[..at].matches(')').count();
    let or_parenthesis = if unclosed && !operand { " or a closing parenthesis" } else { "" };
    match text[at..].chars().next() {
        None if text.trim().is_empty() => wrong("the formula is empty", 0..text.len()),
        None => wrong(format!("the formula ends where {wanted}{or_parenthesis} is expected"), at..at),
        Some(')') if !operand && !unclosed => wrong("this parenthesis was never opened", at..at + 1),
        Some('*') if operand && text[..at].ends_with('*') => {
            wrong("a power is written ^, not **", at - 1..at + 1)
        }
        Some(c) => {
            wrong(format!("`{c}` stands where {wanted}{or_parenthesis} is expected"), at..at + c.len_utf8())
        }
    }
}

fn expression(pair: Pair<Rule>, variables: &[&str]) -> Result<Tree, FormulaError> {
    PRECEDENCE
        .map_primary(|operand| primary(operand, variables))
        .map_prefix(|sign, a| {
            let a = a?;
            Ok(match (sign.as_str(), a) {
                ("+", a) => a,
                (_, Tree::Number(x)) => Tree::Number(-x),
                (_, a) => Tree::Negative(Box::new(a)),
            })
        })
        .map_infix(|a, operator, b| Ok(Tree::Binary(binary(&operator), Box::new([a?, b?]))))
        .parse(pair.into_inner())
}

fn binary(operator: &Pair<Rule>) -> Binary {
    match operator.as_str() {
        "+" => Binary::Add,
        "-" => Binary::Subtract,
        "*" => Binary::Multiply,
        "/" => Binary::Divide,
        "<" => Binary::Less,
        "<=" => Binary::LessOrEqual,
        ">" => Binary::Greater,
        ">=" => Binary::GreaterOrEqual,
        "==" => Binary::Equal,
        "!=" => Binary::NotEqual,
        "&&" => Binary::And,
        "||" => Binary::Or,
        _ => Binary::Power,
    }
}

fn primary(pair: Pair<Rule>, variables: &[&str]) -> Result<Tree, FormulaError> {
    let span = pair.as_span().start()..pair.as_span().end();
    match pair.as_rule() {
        Rule::number => match pair.as_str().parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Tree::Number(value)),
            _ => Err(wrong(format!("the number {} is too large", pair.as_str()), span)),
        },
        Rule::name => variable(pair.as_str(), span, variables),
        Rule::call => call(pair, variables),
        _ => expression(pair, variables),
    }
}

fn variable(name: &str, at: std::ops::Range<usize>, variables: &[&str]) -> Result<Tree, FormulaError> {
    if let Some(k) = variables.iter().position(|v| *v == name) {
        return Ok(Tree::Variable(k));
    }
    if let Some((_, value)) = CONSTANTS.iter().find(|(constant, _)| *constant == name) {
        return Ok(Tree::Number(*value));
    }
    if let Some((_, _, arguments)) = Function::NAMES.iter().find(|(function, ..)| *function == name) {
        let example = if *arguments == 1 { "its argument" } else { "its arguments" };
        return Err(wrong(format!("`{name}` is a function: write {example} in parentheses"), at));
    }
    let known: Vec<&str> = variables.iter().copied().chain(CONSTANTS.map(|(name, _)| name)).collect();
    let other_case = known.iter().find(|k| k.eq_ignore_ascii_case(name)).copied();
    let hint = match other_case.or_else(|| nearest(name, &known)) {
        Some(near) => format!("did you mean `{near}`?"),
        None if variables.is_empty() => "this formula has no variables".to_owned(),
        None => format!("the variables are {}", variables.join(", ")),
    };
    Err(wrong(format!("there is no variable `{name}`: {hint}"), at))
}

fn call(pair: Pair<Rule>, variables: &[&str]) -> Result<Tree, FormulaError> {
    let whole = pair.as_span().start()..pair.as_span().end();
    let mut inner = pair.into_inner();
    let Some(name) = inner.next() else { return Err(wrong("a function needs a name", whole)) };
    let at = name.as_span().start()..name.as_span().end();
    let name = name.as_str();
    let Some(&(_, function, count)) = Function::NAMES.iter().find(|(known, ..)| *known == name) else {
        if variables.contains(&name) || CONSTANTS.iter().any(|(constant, _)| *constant == name) {
            return Err(wrong(format!("`{name}` is not a function: write `{name}*(`"), at));
        }
        let names: Vec<&str> = Function::NAMES.iter().map(|(name, ..)| *name).collect();
        let hint = nearest(name, &names).map_or_else(
            || format!("the functions are {}", names.join(", ")),
            |near| format!("did you mean `{near}`?"),
        );
        return Err(wrong(format!("there is no function `{name}`: {hint}"), at));
    };
    let arguments = inner.map(|a| expression(a, variables)).collect::<Result<Vec<_>, _>>()?;
    let got = arguments.len();
    let arguments_wrong = |_| {
        let s = if count == 1 { "" } else { "s" };
        wrong(format!("`{name}` takes {count} argument{s}, not {got}"), whole.clone())
    };
    match count {
        1 => <[Tree; 1]>::try_from(arguments)
            .map_err(arguments_wrong)
            .map(|[a]| Tree::One(function, Box::new(a))),
        2 => arguments.try_into().map_err(arguments_wrong).map(|pair| Tree::Two(function, Box::new(pair))),
        _ => arguments.try_into().map_err(arguments_wrong).map(|three| Tree::Choice(Box::new(three))),
    }
}

/// The known name nearest to a misspelt one, if near enough to be meant.
fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    let distance = |known: &str| strsim::damerau_levenshtein(name, known);
    known
        .iter()
        .copied()
        .filter(|k| k.len() > 1 && distance(k) <= 1 + k.len() / 4)
        .min_by_key(|k| distance(k))
}
