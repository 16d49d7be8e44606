//! Arms as a ranking has them.

/// An arm in the ranking.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranked {
    /// Number of the arm.
    pub arm: usize,
    /// Largest error of the arm's members.
    pub error: f64,
    /// Largest noise of its members, of averaged quantities.
    pub noise: Option<f64>,
    /// Ends of the interval that contains the error with respect to the exact solution.
    pub interval: [f64; 2],
    /// Counted cost.
    pub cost: f64,
    /// Place in its level, from 1.
    pub place: usize,
}

/// An arm that is not ranked.
#[derive(Clone, Debug, PartialEq)]
pub struct Apart {
    /// Number of the arm.
    pub arm: usize,
    /// The reason.
    pub why: String,
}
