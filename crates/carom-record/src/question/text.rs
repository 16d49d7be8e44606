//! Questions as text: the grammar of [`super`], from tokens to quantities.

use super::form::{Form, form};
use super::names::unknown;
use super::quantity::{Asked, Quantity, Question, Series};
use crate::Reason;
use crate::expression::{self, Expression, Token, tokens};

impl Question {
    /// Parses a question.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn parse(text: &str) -> Result<Self, Reason> {
        Self::of(&tokens(text)?)
    }

    pub(crate) fn of(tokens: &[Token]) -> Result<Self, Reason> {
        expression::parse(tokens, &quantity)
    }
}

impl Series {
    /// Parses a column, or an expression in columns.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn parse(text: &str) -> Result<Self, Reason> {
        series(&tokens(text)?)
    }
}

fn quantity(tokens: &[Token]) -> Result<Quantity, Reason> {
    let word = |i: usize| tokens.get(i).and_then(Token::word);
    match (word(0), word(1)) {
        (Some("difference"), _) => return difference(Form::Peak, &tokens[1..]),
        (Some("rms"), Some("difference")) => return difference(Form::Rms, &tokens[2..]),
        _ => {}
    }
    if let Some((form, columns)) = form(tokens)? {
        let series = series(columns).map_err(|e| format!("{e} in `{}`", joined(tokens)))?;
        return Ok(Quantity::Reduced(form, series));
    }
    match tokens {
        [Token::Word(name)] => Ok(Quantity::Metric(name.clone(), None)),
        [Token::Word(name), Token::Word(of), Token::Quoted(arm)] if of == "of" => {
            Ok(Quantity::Metric(name.clone(), Some(arm.clone())))
        }
        _ => Err(unknown(&joined(tokens))),
    }
}

fn series(tokens: &[Token]) -> Result<Series, Reason> {
    let bare = |t: &Token, text| t.word() == Some(text);
    let (inside, by_step) = match tokens {
        [open, inside @ .., close, by, step]
            if bare(open, "[") && bare(close, "]") && bare(by, "by") && bare(step, "step") =>
        {
            (inside, true)
        }
        [open, inside @ .., close] if bare(open, "[") && bare(close, "]") => (inside, false),
        _ => return column(tokens).map(|a| Series { columns: Expression::Quantity(a), by_step: false }),
    };
    Ok(Series { columns: expression::parse(inside, &column)?, by_step })
}

fn column(tokens: &[Token]) -> Result<Asked, Reason> {
    match tokens {
        [Token::Word(column)] => Ok(Asked { column: column.clone(), arm: None }),
        [Token::Word(column), Token::Word(of), Token::Quoted(arm)] if of == "of" => {
            Ok(Asked { column: column.clone(), arm: Some(arm.clone()) })
        }
        [] => Err("a column is missing".into()),
        _ => Err(unknown(&joined(tokens))),
    }
}

fn difference(form: Form, tokens: &[Token]) -> Result<Quantity, Reason> {
    let [Token::Word(column), Token::Word(of), Token::Quoted(one), Token::Word(and), Token::Quoted(other)] =
        tokens
    else {
        return Err(not_a_difference(tokens));
    };
    if (of.as_str(), and.as_str()) != ("of", "and") {
        return Err(not_a_difference(tokens));
    }
    let side = |arm: &String| Expression::Quantity(Asked { column: column.clone(), arm: Some(arm.clone()) });
    let columns = Expression::Binary(expression::Sign::Minus, Box::new([side(one), side(other)]));
    Ok(Quantity::Reduced(form, Series { columns, by_step: false }))
}

fn not_a_difference(tokens: &[Token]) -> Reason {
    format!("`difference {}` must have the form difference COLUMN of \"ARM\" and \"ARM\"", joined(tokens))
        .into()
}

fn joined(tokens: &[Token]) -> String {
    let one = |token: &Token| match token {
        Token::Word(word) => word.clone(),
        Token::Quoted(text) => format!("\"{text}\""),
    };
    tokens.iter().map(one).collect::<Vec<_>>().join(" ")
}
