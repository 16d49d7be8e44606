//! Places of arms in the ranking of their level: arms whose errors are not distinguished share one.

/// Relative difference below which errors are not distinguished.
pub(super) const ALIKE: f64 = 0.05;
/// Relative difference below which processor times count as equal: measurements do not reproduce
/// better than this.
pub(super) const EQUAL_COST: f64 = 0.1;

/// An arm in the ranking of its level.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranked {
    /// Number of the arm.
    pub arm: usize,
    /// Error of the arm: the median over its ensemble.
    pub error: f64,
    /// Largest distance of a member of the arm's ensemble from the median.
    pub uncertainty: f64,
    /// Number of members of the arm's ensemble that have an error, the arm itself included.
    pub members: usize,
    /// Whether the arm did not create much energy; arms that did are placed last.
    pub sound: bool,
    /// Place in the ranking of the level, from 1; arms that are not distinguished share one.
    pub place: usize,
}

impl Ranked {
    /// Whether the error is at most `accuracy`, and the members scatter by no more.
    pub(super) fn has_accuracy(&self, accuracy: f64) -> bool {
        self.error.max(self.uncertainty) <= accuracy
    }
}

/// Whether two errors with their uncertainties are not distinguished, if the reference has this
/// uncertainty.
pub(super) fn alike(a: (f64, f64), b: (f64, f64), reference: f64) -> bool {
    let own = f64::max(a.1 + b.1, ALIKE * f64::min(a.0, b.0));
    (a.0 - b.0).abs() <= f64::max(reference, own)
}

/// Assigns places: one plus the number of arms that are distinguishably better, of which twins
/// count as one. An arm that created much energy is worse than any that did not.
pub(super) fn places(
    ranked: &mut [Ranked],
    better: impl Fn(&Ranked, &Ranked) -> bool,
    is_twin: impl Fn(&Ranked, &Ranked) -> bool,
) {
    let better = |a: &Ranked, b: &Ranked| if a.sound == b.sound { better(a, b) } else { a.sound };
    for i in 0..ranked.len() {
        let mut ahead: Vec<&Ranked> = Vec::new();
        for r in ranked.iter().filter(|r| better(r, &ranked[i])) {
            if !ahead.iter().any(|other| is_twin(other, r)) {
                ahead.push(r);
            }
        }
        ranked[i].place = 1 + ahead.len();
    }
}

/// Whether the error of `a` is smaller than that of `b` and distinguished from it.
pub(super) fn more_accurate(a: &Ranked, b: &Ranked, reference: f64) -> bool {
    a.error < b.error && !alike((a.error, a.uncertainty), (b.error, b.uncertainty), reference)
}

/// Whether the cost `a` is less than `b` by more than the scatter of measured times.
pub(super) fn cheaper(a: f64, b: f64) -> bool {
    (1.0 + EQUAL_COST) * a < b
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(errors: &[(f64, f64)], reference: f64) -> Vec<usize> {
        let ranked = |(arm, &(error, uncertainty)): (usize, &(f64, f64))| Ranked {
            arm,
            error,
            uncertainty,
            members: 1,
            sound: true,
            place: 0,
        };
        let mut ranked: Vec<Ranked> = errors.iter().enumerate().map(ranked).collect();
        places(&mut ranked, |a, b| more_accurate(a, b, reference), |_, _| false);
        ranked.iter().map(|r| r.place).collect()
    }

    /// 1.00 and 1.04 share a place, 1.2 does not; with an uncertainty of 0.3 all three do.
    #[test]
    fn places_are_shared() {
        let three = [(1.0, 0.01), (1.04, 0.01), (1.2, 0.01)];
        assert_eq!((of(&three, 0.0), of(&three, 0.3)), (vec![1, 1, 3], vec![1, 1, 1]));
        // Ranges of 0.15 about 1 and 1.2 overlap.
        assert_eq!(of(&[(1.0, 0.15), (1.2, 0.15)], 0.0), [1, 1]);
        // An arm that may be anything from 0 to 2 is not told from any other; the others are.
        assert_eq!(of(&[(0.9, 1.1), (1.0, 0.0), (2.0, 0.0)], 0.0), [1, 1, 2]);
    }

    #[test]
    fn costs_within_a_tenth_are_equal() {
        assert!(!cheaper(1.0, 1.09) && cheaper(1.0, 1.11) && !cheaper(1.11, 1.0));
    }
}
