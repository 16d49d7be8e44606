//! Arithmetic expressions in quantities.
//!
//! ```text
//! sum     := product { ( + | - ) product }        product := factor { ( * | / ) factor }
//! factor  := NUMBER | QUANTITY | ( sum )          blanks around operators and brackets, because names may contain them
//! ```
//!
//! A quantity is a sequence of words, quoted strings (names of arms) and groups in square brackets,
//! which may contain operators. [`crate::question`] defines its meaning.

use crate::Reason;

/// An expression in quantities `Q`.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression<Q> {
    /// A number.
    Number(f64),
    /// A quantity.
    Quantity(Q),
    /// Two expressions and the operator between them.
    Binary(Sign, Box<[Expression<Q>; 2]>),
}

/// An arithmetic operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `*`
    Times,
    /// `/`
    Over,
}

impl Sign {
    fn of(word: &str) -> Option<Self> {
        match word {
            "+" => Some(Self::Plus),
            "-" | "−" => Some(Self::Minus),
            "*" => Some(Self::Times),
            "/" => Some(Self::Over),
            _ => None,
        }
    }

    fn apply(self, left: f64, right: f64) -> f64 {
        match self {
            Self::Plus => left + right,
            Self::Minus => left - right,
            Self::Times => left * right,
            Self::Over => left / right,
        }
    }
}

impl<Q> Expression<Q> {
    /// Replaces each quantity of the expression by the result of a function.
    pub(crate) fn map<R>(&self, of: &dyn Fn(&Q) -> R) -> Expression<R> {
        match self {
            Self::Number(value) => Expression::Number(*value),
            Self::Quantity(quantity) => Expression::Quantity(of(quantity)),
            Self::Binary(sign, sides) => {
                Expression::Binary(*sign, Box::new([sides[0].map(of), sides[1].map(of)]))
            }
        }
    }

    /// Evaluates the expression, with a function that gives the value of each quantity.
    ///
    /// # Errors
    /// The first error of a quantity.
    pub fn value<E>(&self, of: &mut dyn FnMut(&Q) -> Result<f64, E>) -> Result<f64, E> {
        match self {
            Self::Number(value) => Ok(*value),
            Self::Quantity(quantity) => of(quantity),
            Self::Binary(sign, sides) => {
                let left = sides[0].value(of)?;
                Ok(sign.apply(left, sides[1].value(of)?))
            }
        }
    }

    /// Quantities of the expression, from left to right.
    pub fn quantities(&self) -> Vec<&Q> {
        match self {
            Self::Number(_) => Vec::new(),
            Self::Quantity(quantity) => vec![quantity],
            Self::Binary(_, sides) => sides.iter().flat_map(Self::quantities).collect(),
        }
    }
}

/// A word, or a quoted string.
#[derive(Clone, Debug, PartialEq)]
pub enum Token {
    /// A word.
    Word(String),
    /// What is in quotes.
    Quoted(String),
}

impl Token {
    /// The word, if it is one.
    pub fn word(&self) -> Option<&str> {
        if let Self::Word(word) = self { Some(word) } else { None }
    }

    fn is(&self, text: &str) -> bool {
        self.word() == Some(text)
    }
}

/// Words and quoted strings of a text.
pub fn tokens(text: &str) -> Result<Vec<Token>, Reason> {
    let mut found = Vec::new();
    let mut remaining = text.trim_start();
    while let Some(first) = remaining.chars().next() {
        let end = if matches!(first, '"' | '\'') {
            let inside = &remaining[1..];
            let length =
                inside.find(first).ok_or_else(|| format!("the quote at `{remaining}` is not closed"))?;
            found.push(Token::Quoted(inside[..length].to_owned()));
            length + 2
        } else {
            let length = remaining.find(char::is_whitespace).unwrap_or(remaining.len());
            found.push(Token::Word(remaining[..length].to_owned()));
            length
        };
        remaining = remaining[end..].trim_start();
    }
    Ok(found)
}

/// Parses a sequence of tokens; `quantity` parses the tokens of one quantity.
pub fn parse<Q>(
    tokens: &[Token],
    quantity: &dyn Fn(&[Token]) -> Result<Q, Reason>,
) -> Result<Expression<Q>, Reason> {
    let mut parser = Parser { remaining: tokens, quantity };
    let expression = parser.sum()?;
    match parser.remaining.first() {
        None => Ok(expression),
        Some(_) => Err("a bracket `)` was not opened".into()),
    }
}

struct Parser<'a, Q> {
    remaining: &'a [Token],
    quantity: &'a dyn Fn(&[Token]) -> Result<Q, Reason>,
}

impl<Q> Parser<'_, Q> {
    fn sum(&mut self) -> Result<Expression<Q>, Reason> {
        self.row(&[Sign::Plus, Sign::Minus], Self::product)
    }

    fn product(&mut self) -> Result<Expression<Q>, Reason> {
        self.row(&[Sign::Times, Sign::Over], Self::factor)
    }

    fn row(
        &mut self,
        signs: &[Sign],
        part: fn(&mut Self) -> Result<Expression<Q>, Reason>,
    ) -> Result<Expression<Q>, Reason> {
        let mut left = part(self)?;
        while let Some(sign) = self.sign().filter(|s| signs.contains(s)) {
            self.remaining = &self.remaining[1..];
            left = Expression::Binary(sign, Box::new([left, part(self)?]));
        }
        Ok(left)
    }

    fn sign(&self) -> Option<Sign> {
        Sign::of(self.remaining.first()?.word()?)
    }

    fn factor(&mut self) -> Result<Expression<Q>, Reason> {
        if self.remaining.first().is_some_and(|t| t.is("(")) {
            self.remaining = &self.remaining[1..];
            let inside = self.sum()?;
            let closed = self.remaining.first().is_some_and(|t| t.is(")"));
            self.remaining =
                self.remaining.get(1..).filter(|_| closed).ok_or("a bracket `(` is not closed")?;
            return Ok(inside);
        }
        let mut depth = 0_i32;
        let ends = |token: &Token| {
            depth += i32::from(token.is("[")) - i32::from(token.is("]"));
            depth == 0 && token.word().is_some_and(|w| Sign::of(w).is_some() || w == ")" || w == "(")
        };
        let length = self.remaining.iter().position(ends).unwrap_or(self.remaining.len());
        let (operand, remaining) = self.remaining.split_at(length);
        self.remaining = remaining;
        match operand {
            [] => Err("a value is missing".into()),
            [Token::Word(word)] if let Ok(number) = word.parse::<f64>() => Ok(Expression::Number(number)),
            operand => (self.quantity)(operand).map(Expression::Quantity),
        }
    }
}
