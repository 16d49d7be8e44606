//! Factors between the units of two labels, `lb in/s^2` and `N`, for comparing records in different
//! systems of units. A label is a product of units with integer powers; what follows a slash, or
//! stands in brackets after it, is divided by. Definitions: *The International System of Units*,
//! 9th ed., and NIST SP 811, appendix B.8 (inch, foot, pound, slug, pound-force).

/// A unit in kilograms, metres and seconds: its value and its powers of them.
type Unit = (f64, [i32; 3]);

/// Units without a prefix.
const WHOLE: [(&str, Unit); 9] = [
    ("1", (1.0, [0, 0, 0])),
    ("in", (0.0254, [0, 1, 0])),
    ("ft", (0.3048, [0, 1, 0])),
    ("min", (60.0, [0, 0, 1])),
    ("h", (3600.0, [0, 0, 1])),
    ("t", (1e3, [1, 0, 0])),
    ("lb", (0.453_592_37, [1, 0, 0])),
    ("slug", (14.593_902_937_206_364, [1, 0, 0])),
    ("lbf", (4.448_221_615_260_5, [1, 1, -2])),
];

/// Units that may have a prefix.
const PREFIXED: [(&str, Unit); 6] = [
    ("Pa", (1.0, [1, -1, -2])),
    ("N", (1.0, [1, 1, -2])),
    ("J", (1.0, [1, 2, -2])),
    ("g", (1e-3, [1, 0, 0])),
    ("m", (1.0, [0, 1, 0])),
    ("s", (1.0, [0, 0, 1])),
];

/// Prefixes; micro also as it is typed, and as the Greek letter.
const PREFIXES: [(&str, f64); 13] = [
    ("", 1.0),
    ("p", 1e-12),
    ("n", 1e-9),
    ("µ", 1e-6),
    ("μ", 1e-6),
    ("u", 1e-6),
    ("m", 1e-3),
    ("c", 1e-2),
    ("d", 1e-1),
    ("k", 1e3),
    ("M", 1e6),
    ("G", 1e9),
    ("T", 1e12),
];

fn unit(name: &str) -> Option<Unit> {
    if let Some((_, unit)) = WHOLE.iter().find(|(word, _)| *word == name) {
        return Some(*unit);
    }
    let with_prefix = |(base, (value, powers)): &(&str, Unit)| {
        let prefix = name.strip_suffix(base)?;
        let (_, factor) = PREFIXES.iter().find(|(word, _)| *word == prefix)?;
        Some((factor * value, *powers))
    };
    PREFIXED.iter().find_map(with_prefix)
}

/// The value of a label in kilograms, metres and seconds.
fn value(label: &str) -> Option<Unit> {
    let (mut value, mut powers) = (1.0, [0; 3]);
    let (above, below) = label.split_once('/').unwrap_or((label, ""));
    // One slash only: `a/b/c` is ambiguous.
    if below.contains('/') {
        return None;
    }
    let below = below.strip_prefix('(').and_then(|inner| inner.strip_suffix(')')).unwrap_or(below);
    for (part, sign) in [(above, 1), (below, -1)] {
        for word in part.split([' ', '·']).filter(|word| !word.is_empty()) {
            let (name, power) = word.split_once('^').unwrap_or((word, "1"));
            let power = sign * power.parse::<i32>().ok()?;
            let (size, of) = unit(name)?;
            value *= f64::powi(size, power);
            powers = [0, 1, 2].map(|k| powers[k] + power * of[k]);
        }
    }
    Some((value, powers))
}

/// What values in units of `from` are multiplied by to be in units of `to`; none where a unit is
/// not known, or where the two are units of different quantities.
pub fn factor(from: &str, to: &str) -> Option<f64> {
    if from == to {
        return Some(1.0);
    }
    let ((a, one), (b, other)) = (value(from)?, value(to)?);
    (one == other).then_some(a / b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Labels;

    /// NIST SP 811, appendix B.8: 1 lbf = 4.448 222 N, 1 psi = 6.894 757 kPa, 1 ft lbf = 1.355 818
    /// J, 1 pdl (lb ft/s²) = 0.138 255 0 N; and 1 N/mm² = 1 MPa, 1 km/h = 0.277 777 8 m/s.
    #[test]
    fn published_factors() {
        for (from, to, published) in [
            ("lbf", "N", 4.448_222),
            ("lbf/in^2", "kPa", 6.894_757),
            ("ft lbf", "J", 1.355_818),
            ("lb ft/s^2", "N", 0.138_255_0),
            ("N/mm^2", "Pa", 1e6),
            ("km/h", "m/s", 0.277_777_8),
            ("1/ms", "1/s", 1e3),
            ("slug", "lb", 32.174_05),
        ] {
            let found = factor(from, to).unwrap();
            assert!((found / published - 1.0).abs() < 5e-7, "{from}: {found}");
        }
    }

    /// Labels that records have; kilograms are not metres.
    #[test]
    fn every_label_of_a_system_is_known() {
        let all = |l: &Labels| {
            [&l.time, &l.length, &l.velocity, &l.acceleration, &l.force, &l.moment, &l.momentum]
                .into_iter()
                .chain([&l.angular_momentum, &l.energy, &l.stress, &l.none])
                .cloned()
                .collect::<Vec<_>>()
        };
        let si = all(&Labels::of("m", "s", "kg"));
        for system in
            [["mm", "ms", "g"], ["in", "s", "lb"], ["mm", "s", "t"], ["cm", "s", "g"], ["µm", "µs", "µg"]]
        {
            let own = all(&Labels::of(system[0], system[1], system[2]));
            assert!(own.iter().zip(&si).all(|(from, to)| factor(from, to).is_some()), "{own:?}");
        }
        assert_eq!((factor("kg", "m"), factor("slinch", "kg"), factor("a", "a")), (None, None, Some(1.0)));
        assert_eq!((factor("m/s/s", "m/s^2"), factor("m^x", "m")), (None, None));
    }
}
