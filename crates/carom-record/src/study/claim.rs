//! Claims: comparisons of two expressions in numbers of the arms' records.
//!
//! ```text
//! claim := question ( < | <= | > | >= ) question        as in [`crate::question`], every quantity with `of "ARM"`
//! ```

use serde::{Deserialize, Serialize};

use super::arms::ArmRecords;
use super::ensemble::Spread;
use crate::Reason;
use crate::expression::{Expression, Sign, Token, tokens};
use crate::question::{Question, Window};

/// A statement and the comparison that decides it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Claim {
    /// The claim in words.
    pub text: String,
    /// `METRIC of "ARM" > METRIC of "ARM"`: see [`Comparison`].
    pub compare: String,
}

/// A claim with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The claim that is decided.
    pub claim: Claim,
    /// Value on the left of the comparison; none if an arm did not finish or has no such metric.
    pub left: Option<f64>,
    /// Value on the right of the comparison; none if an arm did not finish or has no such metric.
    pub right: Option<f64>,
    /// Whether the claim holds; none if it cannot be decided.
    pub holds: Option<bool>,
    /// The left quantity divided by the right one, without the constant factors of the sides.
    pub ratio: Option<f64>,
    /// Operator and number that the ratio is compared with: `> 2`. If the right side is only a
    /// number, it is this number, and the ratio is the left side. The operator is reversed where
    /// the right side is negative; none where its sign differs between members.
    pub bound: Option<(&'static str, f64)>,
    /// Outcome of the claim over an ensemble, if the study has one.
    pub ensemble: Option<Confirmed>,
}

/// Outcome of a claim over the members of an ensemble.
#[derive(Clone, Debug, PartialEq)]
pub struct Confirmed {
    /// Number of members in which the claim holds.
    pub count: usize,
    /// Number of members in which the claim can be decided.
    pub of: usize,
    /// Number of all members.
    pub members: usize,
    /// The left quantity divided by the right one, without the constant factors of the sides.
    pub ratio: Option<Spread>,
}

impl Confirmed {
    /// `in all`, `in most`, `in some` or `in none` of the members; most are three quarters. What
    /// cannot be decided in a member is not confirmed in it.
    pub fn word(&self) -> &'static str {
        match self.count {
            count if count == self.members => "in all",
            0 => "in none",
            count if 4 * count >= 3 * self.members => "in most",
            _ => "in some",
        }
    }

    /// Whether the claim can be decided in every member.
    pub fn is_decided(&self) -> bool {
        self.of == self.members
    }

    /// `4 of 6`, with the number of members in which the claim cannot be decided.
    pub fn words(&self) -> String {
        let undecided = match self.members - self.of {
            0 => String::new(),
            count => format!(", {count} undecided"),
        };
        format!("{} of {}{undecided}", self.count, self.members)
    }
}

impl Verdict {
    /// Decides a claim from the records of the arms, and from those of the members of their
    /// ensemble, the arms included.
    pub fn of(
        claim: &Claim,
        comparison: Option<&Comparison>,
        records: &ArmRecords,
        members: &[ArmRecords],
    ) -> Self {
        let sides = |records: &ArmRecords| {
            let value = |side: usize| comparison?.sides[side].answer(records, Window::default()).ok();
            (value(0), value(1))
        };
        let (left, right) = sides(records);
        let decided: Vec<(f64, f64)> =
            members.iter().map(sides).filter_map(|(left, right)| left.zip(right)).collect();
        let [fl, fr] = comparison.map_or([1.0; 2], Comparison::factors);
        let ratio = |(l, r): (f64, f64)| l / r * (fr / fl);
        // Dividing by a negative quantity turns the comparison round; by one whose sign differs
        // between members, nothing can be said of the ratio.
        let divisors: Vec<f64> =
            decided.iter().map(|(_, r)| *r).chain(right).map(|r| fl * (r / fr)).collect();
        let bound = comparison.and_then(|c| match () {
            () if divisors.iter().all(|x| *x > 0.0) => Some((c.operator.symbol(), fr / fl)),
            () if divisors.iter().all(|x| *x < 0.0) => Some((c.operator.turned().symbol(), fr / fl)),
            () => None,
        });
        let confirmed = || Confirmed {
            count: decided
                .iter()
                .filter(|(l, r)| comparison.is_some_and(|c| c.operator.holds(*l, *r)))
                .count(),
            of: decided.len(),
            members: members.len(),
            ratio: Spread::of(decided.iter().copied().map(ratio)),
        };
        Self {
            claim: claim.clone(),
            left,
            right,
            holds: left.zip(right).zip(comparison).map(|((l, r), c)| c.operator.holds(l, r)),
            ratio: left.zip(right).map(ratio).filter(|ratio| ratio.is_finite()),
            bound,
            ensemble: (members.len() > 1 && !decided.is_empty()).then(confirmed),
        }
    }

    /// `confirmed`, `refuted` or `undecided`; over an ensemble that is not of one mind, `in most`
    /// or `in some` of its members.
    pub fn word(&self) -> &'static str {
        let ensemble = self.ensemble.as_ref();
        match ensemble.map(Confirmed::word) {
            Some("in all") => return "confirmed",
            Some("in none") if ensemble.is_some_and(Confirmed::is_decided) => return "refuted",
            Some("in none") => return "undecided",
            Some(word) => return word,
            None => {}
        }
        match self.holds {
            Some(true) => "confirmed",
            Some(false) => "refuted",
            None => "undecided",
        }
    }
}

/// A parsed comparison; its numbers come from [`super::Study::open`].
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    sides: [Question; 2],
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
    fn symbol(self) -> &'static str {
        match self {
            Self::Less => "<",
            Self::LessOrEqual => "≤",
            Self::Greater => ">",
            Self::GreaterOrEqual => "≥",
        }
    }

    /// The comparison of the same numbers with the other sign.
    fn turned(self) -> Self {
        match self {
            Self::Less => Self::Greater,
            Self::LessOrEqual => Self::GreaterOrEqual,
            Self::Greater => Self::Less,
            Self::GreaterOrEqual => Self::LessOrEqual,
        }
    }

    fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Self::Less => left < right,
            Self::LessOrEqual => left <= right,
            Self::Greater => left > right,
            Self::GreaterOrEqual => left >= right,
        }
    }
}

impl Comparison {
    /// Parses `left > right`.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn parse(text: &str) -> Result<Self, Reason> {
        let tokens = tokens(text)?;
        let operator = |token: &Token| match token.word()? {
            "<" => Some(Operator::Less),
            "<=" | "≤" => Some(Operator::LessOrEqual),
            ">" => Some(Operator::Greater),
            ">=" | "≥" => Some(Operator::GreaterOrEqual),
            _ => None,
        };
        let found: Vec<_> = tokens.iter().enumerate().filter_map(|(i, t)| Some((i, operator(t)?))).collect();
        let [(at, operator)] = found[..] else {
            return Err(format!(
                "it has {} comparisons (<, <=, >, >= with blanks on both sides); exactly one is needed",
                found.len()
            )
            .into());
        };
        let sides = [Question::of(&tokens[..at])?, Question::of(&tokens[at + 1..])?];
        for side in &sides {
            side.of_arms()?;
        }
        Ok(Self { sides, operator })
    }

    /// Names of the arms that the comparison uses.
    pub fn arms(&self) -> Vec<&str> {
        self.questions().iter().flat_map(Question::arms).flatten().collect()
    }

    /// The constant factors of the sides: 1 and 2 of `a > 2 * b`, which is a / b > 2.
    fn factors(&self) -> [f64; 2] {
        let factor = |side: &Question| match side {
            Expression::Number(value) => *value,
            Expression::Binary(Sign::Times, parts) => match &**parts {
                [Expression::Number(value), _] | [_, Expression::Number(value)] => *value,
                _ => 1.0,
            },
            _ => 1.0,
        };
        self.sides.each_ref().map(factor)
    }

    /// Left and right side of the comparison.
    pub fn questions(&self) -> &[Question] {
        &self.sides
    }
}
