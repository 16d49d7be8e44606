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
    /// Its error: the median over its ensemble.
    pub error: f64,
    /// Largest distance of a member of its ensemble from the median.
    pub uncertainty: f64,
    /// Place, from 1; arms that are not distinguished share one.
    pub place: usize,
}

/// Assigns places: one more than the number of arms that are distinguishably better.
pub(super) fn places(ranked: &mut [Ranked], uncertainty: f64) {
    let alike = |a: &Ranked, b: &Ranked| {
        let own = f64::max(a.uncertainty + b.uncertainty, ALIKE * f64::min(a.error, b.error));
        (a.error - b.error).abs() <= f64::max(uncertainty, own)
    };
    for i in 0..ranked.len() {
        let one = &ranked[i];
        ranked[i].place = 1 + ranked.iter().filter(|r| r.error < one.error && !alike(r, one)).count();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1.00 and 1.04 share a place, 1.2 does not; with an uncertainty of 0.3 all three do.
    #[test]
    fn places_are_shared() {
        let of = |uncertainty: f64| {
            let mut ranked: Vec<Ranked> = [1.0, 1.04, 1.2]
                .iter()
                .enumerate()
                .map(|(arm, e)| Ranked { arm, error: *e, uncertainty: 0.01, place: 0 })
                .collect();
            places(&mut ranked, uncertainty);
            ranked.iter().map(|r| r.place).collect::<Vec<_>>()
        };
        assert_eq!((of(0.0), of(0.3)), (vec![1, 1, 3], vec![1, 1, 1]));
        // Ranges of 0.15 about 1 and 1.2 overlap.
        let mut wide = [1.0, 1.2].map(|error| Ranked { arm: 0, error, uncertainty: 0.15, place: 0 });
        places(&mut wide, 0.0);
        assert_eq!(wide.map(|r| r.place), [1, 1]);
        // An arm that may be anything from 0 to 2 is not told from any other; the others are.
        let mut vague = [(0.9, 1.1), (1.0, 0.0), (2.0, 0.0)].map(|(error, uncertainty)| Ranked {
            arm: 0,
            error,
            uncertainty,
            place: 0,
        });
        places(&mut vague, 0.0);
        assert_eq!(vague.map(|r| r.place), [1, 1, 2]);
    }
}
