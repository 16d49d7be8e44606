//! Round-off in tables: a value that is tiny beside all others of its unit.

use carom_record::metrics::Metric;
use carom_record::study::Study;

/// What is smaller than this share of the largest value of a unit is round-off.
const ROUND_OFF: f64 = 1e-12;

/// Largest values of each unit in a study.
pub(crate) struct Scales(Vec<(String, f64)>);

impl Scales {
    pub(crate) fn of(study: &Study) -> Self {
        // Shares are of one.
        let mut found: Vec<(String, f64)> = vec![(String::new(), 1.0)];
        for metric in study.rows.iter().flat_map(|row| &row.metrics) {
            let Some(size) = metric.value.map(f64::abs).filter(|size| size.is_finite()) else { continue };
            match found.iter_mut().find(|(unit, _)| *unit == metric.unit) {
                Some((_, largest)) => *largest = largest.max(size),
                None => found.push((metric.unit.clone(), size)),
            }
        }
        // Counts have no unit either, but are no scale of shares.
        found[0].1 = 1.0;
        Self(found)
    }

    /// A value of a metric in the given format, or that it is zero up to round-off.
    pub(crate) fn shown(&self, metric: &Metric, value: f64, format: impl Fn(f64) -> String) -> String {
        let scale = self.0.iter().find(|(unit, _)| *unit == metric.unit).map_or(0.0, |known| known.1);
        if value != 0.0 && value.abs() < ROUND_OFF * scale { "≈ 0".to_owned() } else { format(value) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::digits::three;

    /// A penetration of 1e-13 m beside displacements of 5 m is none, one of 1e-11 m is one.
    #[test]
    fn what_is_tiny_beside_its_unit_is_round_off() {
        let with =
            |depth: f64| crate::trend::tests::study(&[("a", vec![("penetration", depth), ("ux", -5.0)])]);
        let shown = |depth: f64| {
            let mut study = with(depth);
            study.rows[0].metrics.iter_mut().for_each(|metric| metric.unit = "m".into());
            Scales::of(&study).shown(&study.rows[0].metrics[0], depth, three)
        };
        let found = [1e-13, 1e-11, 0.0].map(shown);
        assert_eq!(found, ["≈ 0", "1.00e−11", "0"]);
    }
}
