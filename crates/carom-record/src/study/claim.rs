//! Claims: two expressions in numbers of the arms' records, and which of them is larger.
//!
//! ```text
//! claim := sum ( < | <= | > | >= ) sum
//! sum   := product { ( + | - ) product }        product := value { ( * | / ) value }
//! value := NUMBER | WHAT of "ARM"               blanks around every operator, since names may contain signs
//! WHAT  := a metric (`restitution`, `B.sigma_yy:roughness`, `wall_time`) or what an `[[expect]]` may ask for (`last A.uy`)
//! ```

use super::Claim;
use crate::metrics::Metric;
use crate::{Run, evaluate};

/// A claim with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// What was claimed.
    pub claim: Claim,
    /// Value left of the comparison; none when an arm did not finish or has no such metric.
    pub left: Option<f64>,
    /// Value right of it.
    pub right: Option<f64>,
    /// Whether it holds; none when it cannot be told.
    pub holds: Option<bool>,
}

impl Verdict {
    pub(super) fn of(claim: &Claim, comparison: Option<&Comparison>) -> Self {
        let (left, right) = comparison.map_or((None, None), |c| (c.sides[0].value(), c.sides[1].value()));
        let holds = left.zip(right).zip(comparison).map(|((l, r), c)| c.operator.holds(l, r));
        Self { claim: claim.clone(), left, right, holds }
    }

    /// `confirmed`, `denied` or `undecided`.
    pub fn word(&self) -> &'static str {
        match self.holds {
            Some(true) => "confirmed",
            Some(false) => "denied",
            None => "undecided",
        }
    }
}

/// A parsed comparison; its numbers come from [`super::Study::open`].
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    sides: [Expression; 2],
    operator: Operator,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Operator {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

impl Operator {
    fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Self::Less => left < right,
            Self::LessOrEqual => left <= right,
            Self::Greater => left > right,
            Self::GreaterOrEqual => left >= right,
        }
    }
}

/// A sum of products; every factor multiplies or divides.
#[derive(Clone, Debug, PartialEq)]
struct Expression(Vec<(f64, Vec<(bool, Value)>)>);

#[derive(Clone, Debug, PartialEq)]
enum Value {
    Number(f64),
    Of { what: String, arm: String, found: Option<f64> },
}

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Word(String),
    Arm(String),
}

impl Comparison {
    /// Parses `left > right`.
    ///
    /// # Errors
    /// In words, what is not as it should be.
    pub fn parse(text: &str) -> Result<Self, String> {
        let tokens = tokens(text)?;
        let operator = |token: &Token| match token {
            Token::Word(word) => match word.as_str() {
                "<" => Some(Operator::Less),
                "<=" | "≤" => Some(Operator::LessOrEqual),
                ">" => Some(Operator::Greater),
                ">=" | "≥" => Some(Operator::GreaterOrEqual),
                _ => None,
            },
            Token::Arm(_) => None,
        };
        let found: Vec<_> = tokens.iter().enumerate().filter_map(|(i, t)| Some((i, operator(t)?))).collect();
        let [(at, operator)] = found[..] else {
            return Err(format!("it has {} comparisons (<, <=, >, >= between blanks); it needs one", found.len()));
        };
        Ok(Self { sides: [expression(&tokens[..at])?, expression(&tokens[at + 1..])?], operator })
    }

    /// Names of the arms it speaks of.
    pub fn arms(&self) -> Vec<&str> {
        let values = self.sides.iter().flat_map(|side| &side.0).flat_map(|(_, product)| product);
        values.filter_map(|(_, v)| if let Value::Of { arm, .. } = v { Some(arm.as_str()) } else { None }).collect()
    }

    /// Takes what it asks of an arm from its record.
    pub(super) fn look_up(&mut self, name: &str, run: &Run, metrics: &[Metric]) {
        let values = self.sides.iter_mut().flat_map(|side| &mut side.0).flat_map(|(_, product)| product);
        for (_, value) in values {
            if let Value::Of { what, arm, found } = value
                && arm == name
            {
                let metric = metrics.iter().find(|m| m.name == what.as_str());
                *found = metric.map_or_else(|| evaluate(&run.history, what).ok(), |m| m.value);
            }
        }
    }
}

impl Expression {
    fn value(&self) -> Option<f64> {
        let product = |factors: &Vec<(bool, Value)>| {
            factors.iter().try_fold(1.0, |x, (times, value)| {
                let v = match value {
                    Value::Number(v) => *v,
                    Value::Of { found, .. } => (*found)?,
                };
                Some(if *times { x * v } else { x / v })
            })
        };
        let sum = self.0.iter().try_fold(0.0, |sum, (sign, factors)| Some(sum + sign * product(factors)?))?;
        sum.is_finite().then_some(sum)
    }
}

fn tokens(text: &str) -> Result<Vec<Token>, String> {
    let mut found = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let end = if matches!(first, '"' | '\'') {
            let inside = &rest[1..];
            let length = inside.find(first).ok_or_else(|| format!("the quote at `{rest}` is not closed"))?;
            found.push(Token::Arm(inside[..length].to_owned()));
            length + 2
        } else {
            let length = rest.find(char::is_whitespace).unwrap_or(rest.len());
            found.push(Token::Word(rest[..length].to_owned()));
            length
        };
        rest = rest[end..].trim_start();
    }
    Ok(found)
}

fn expression(tokens: &[Token]) -> Result<Expression, String> {
    let mut terms = vec![(1.0, Vec::new())];
    let mut words: Vec<&str> = Vec::new();
    let (mut times, mut arm) = (true, None);
    // A last `+` closes the last value.
    let end = Token::Word("+".to_owned());
    let mut rest = tokens.iter().chain(std::iter::once(&end)).peekable();
    while let Some(token) = rest.next() {
        match token {
            Token::Arm(name) if arm.is_none() && words.last() == Some(&"of") => arm = Some(name.clone()),
            Token::Arm(name) => return Err(format!("\"{name}\" does not follow `of`")),
            Token::Word(word) if matches!(word.as_str(), "+" | "-" | "*" | "/") => {
                let Some((_, product)) = terms.last_mut() else { break };
                product.push((times, value(&words, arm.take())?));
                words.clear();
                times = word != "/";
                if rest.peek().is_some() && matches!(word.as_str(), "+" | "-") {
                    terms.push((if word == "-" { -1.0 } else { 1.0 }, Vec::new()));
                }
            }
            Token::Word(word) if arm.is_none() => words.push(word),
            Token::Word(word) => return Err(format!("`{word}` follows the name of an arm: an operator was expected")),
        }
    }
    Ok(Expression(terms))
}

fn value(words: &[&str], arm: Option<String>) -> Result<Value, String> {
    match (words, arm) {
        ([what @ .., "of"], Some(arm)) if !what.is_empty() => Ok(Value::Of { what: what.join(" "), arm, found: None }),
        ([number], None) => number
            .parse()
            .map(Value::Number)
            .map_err(|_| format!("`{number}` is no number; a metric is written: {number} of \"ARM\"")),
        ([], _) => Err("a value is missing".to_owned()),
        (words, _) => Err(format!("`{}` is not METRIC of \"ARM\"", words.join(" "))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(text: &str, numbers: &[(&str, &str, f64)]) -> (Option<f64>, Option<f64>, &'static str) {
        let mut comparison = Comparison::parse(text).unwrap();
        for value in comparison.sides.iter_mut().flat_map(|s| &mut s.0).flat_map(|(_, p)| p) {
            if let (_, Value::Of { what, arm, found }) = value {
                *found = numbers.iter().find(|n| n.0 == what && n.1 == arm).map(|n| n.2);
            }
        }
        let claim = Claim { text: String::new(), compare: text.into() };
        let v = Verdict::of(&claim, Some(&comparison));
        (v.left, v.right, v.word())
    }

    #[test]
    fn arithmetic_and_verdicts() {
        let numbers = [("r", "Hu, a", 6.0), ("last A.uy", "b > c", -0.5), ("r", "b > c", 2.0)];
        let of = |text| verdict(text, &numbers);
        assert_eq!(of("r of \"Hu, a\" > 2 * r of \"b > c\""), (Some(6.0), Some(4.0), "confirmed"));
        assert_eq!(of("r of 'Hu, a' / r of 'b > c' - 1 <= 1.5"), (Some(2.0), Some(1.5), "denied"));
        assert_eq!(of("1 - 2 - 3 < last A.uy of 'b > c'"), (Some(-4.0), Some(-0.5), "confirmed"));
        assert_eq!(of("r of 'nobody' < 1"), (None, Some(1.0), "undecided"));
    }

    #[test]
    fn what_is_wrong_is_said() {
        let wrong = |text: &str| Comparison::parse(text).unwrap_err();
        assert!(wrong("r of 'a'").contains("0 comparisons"));
        assert!(wrong("r of 'a' > r of b").contains("not METRIC of"));
        assert!(wrong("r > 1").contains("no number"));
        assert!(wrong("r of 'a > 1").contains("not closed"));
        assert!(wrong("r of 'a' 2 > 1").contains("operator"));
        assert!(wrong("r of 'a' > ").contains("missing"));
    }
}
