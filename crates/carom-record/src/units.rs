//! Unit labels: those of derived quantities, from the case's labels of length, time and mass, and
//! factors between two labels, `lb in/s^2` and `N`, for comparing records in different systems of
//! units. The values of a record are never converted.
//!
//! Where a derived unit is a multiple of newton, pascal or joule with a prefix of steps of 1000, it
//! has that name: with mm, ms and g forces are in N, stresses in MPa and energies in mJ. Otherwise
//! it is composed of the labels.
//!
//! A label is a product of units with integer powers; what follows a slash, or stands in brackets
//! after it, is divided by. Definitions: *The International System of Units*, 9th ed., and NIST SP
//! 811, appendix B.8 (inch, foot, pound, slug, pound-force).

/// Unit of a column or a metric, in terms of the units of the case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Unit {
    None,
    Time,
    PerTime,
    Force,
    Impulse,
    Length,
    Stress,
    Second,
    /// The unit of the column.
    Column,
}

/// Labels of all kinds of columns.
#[derive(Clone, Debug)]
pub struct Labels {
    /// Unit of time.
    pub time: String,
    /// Unit of length.
    pub length: String,
    /// Unit of velocity.
    pub velocity: String,
    /// Unit of acceleration.
    pub acceleration: String,
    /// Unit of force.
    pub force: String,
    /// Unit of moment.
    pub moment: String,
    /// Unit of momentum.
    pub momentum: String,
    /// Unit of angular momentum.
    pub angular_momentum: String,
    /// Unit of energy.
    pub energy: String,
    /// Unit of stress.
    pub stress: String,
    /// Label of numbers without a unit: empty.
    pub none: String,
}

/// The name of a value in kilograms, metres and seconds as a multiple of a unit of the SI.
fn named(unit: &str, value: f64) -> Option<String> {
    let steps = PREFIXES.iter().filter(|(prefix, _)| !["c", "d"].contains(prefix));
    let mut fitting = steps.filter(|(_, factor)| (value / factor - 1.0).abs() < 1e-9);
    fitting.next().map(|(prefix, _)| format!("{prefix}{unit}"))
}

impl Labels {
    /// Derives the labels of all units from those of length, time and mass.
    pub fn of(l: &str, t: &str, m: &str) -> Self {
        let known = |label: &str, powers: [i32; 3]| Some(unit(label).filter(|known| known.1 == powers)?.0);
        // A product of powers of mass, length and time.
        let name = |unit: &str, [mass, length, time]: [i32; 3]| {
            let masses = known(m, [1, 0, 0])?.powi(mass);
            let lengths = known(l, [0, 1, 0])?.powi(length);
            named(unit, masses * lengths * known(t, [0, 0, 1])?.powi(time))
        };
        let force = name("N", [1, 1, -2]);
        let of_force = |by: &str, composed: String| match &force {
            Some(force) => format!("{force} {by}"),
            None => composed,
        };
        Self {
            time: t.to_owned(),
            length: l.to_owned(),
            velocity: format!("{l}/{t}"),
            acceleration: format!("{l}/{t}^2"),
            moment: of_force(l, format!("{m} {l}^2/{t}^2")),
            momentum: of_force(t, format!("{m} {l}/{t}")),
            angular_momentum: of_force(&format!("{l} {t}"), format!("{m} {l}^2/{t}")),
            energy: name("J", [1, 2, -2]).unwrap_or_else(|| format!("{m} {l}^2/{t}^2")),
            stress: name("Pa", [1, -1, -2]).unwrap_or_else(|| format!("{m}/({l} {t}^2)")),
            force: force.unwrap_or_else(|| format!("{m} {l}/{t}^2")),
            none: String::new(),
        }
    }
}

/// A unit in kilograms, metres and seconds: its value, and its powers of them.
type Size = (f64, [i32; 3]);

/// Units without a prefix.
const WHOLE: [(&str, Size); 9] = [
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
const PREFIXED: [(&str, Size); 6] = [
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

fn unit(name: &str) -> Option<Size> {
    if let Some((_, unit)) = WHOLE.iter().find(|(word, _)| *word == name) {
        return Some(*unit);
    }
    let with_prefix = |(base, (value, powers)): &(&str, Size)| {
        let prefix = name.strip_suffix(base)?;
        let (_, factor) = PREFIXES.iter().find(|(word, _)| *word == prefix)?;
        Some((factor * value, *powers))
    };
    PREFIXED.iter().find_map(with_prefix)
}

/// The value of a label in kilograms, metres and seconds.
fn value(label: &str) -> Option<Size> {
    let mut value = 1.0;
    let mut powers = [0; 3];
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

/// Factor that converts values from the unit `from` to the unit `to`; none where a unit is not
/// known, or where the two are units of different quantities.
pub fn factor(from: &str, to: &str) -> Option<f64> {
    if from == to {
        return Some(1.0);
    }
    let (a, one) = value(from)?;
    let (b, other) = value(to)?;
    (one == other).then_some(a / b)
}

/// The velocity 1 in units of these labels in m/s; none if they are not known.
pub fn metres_per_second(length: &str, time: &str) -> Option<f64> {
    factor(&format!("{length}/{time}"), "m/s")
}

/// The label of stress that belongs to those of force, length and time.
pub(crate) fn stress(force: &str, length: &str, time: &str) -> String {
    if force.is_empty() {
        return String::new();
    }
    if let Some(mass) = force.strip_suffix(&format!(" {length}/{time}^2")) {
        return Labels::of(length, time, mass).stress;
    }
    let label = format!("{force}/{length}^2");
    factor(&label, "Pa").and_then(|pascals| named("Pa", pascals)).unwrap_or(label)
}

#[cfg(test)]
mod tests {
    use super::*;

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

    /// The Brochure of the SI, 9th edition, tables 4 and 7: 1 N = 1 kg m/s², 1 Pa = 1 kg/(m s²),
    /// 1 J = 1 kg m²/s².
    #[test]
    fn derived_units_have_their_names() {
        let of = |l: &str, t: &str, m: &str| {
            let labels = Labels::of(l, t, m);
            [labels.force, labels.stress, labels.energy, labels.momentum]
        };
        assert_eq!(of("m", "s", "kg"), ["N", "Pa", "J", "N s"]);
        // 1e-3 kg · 1e-3 m/(1e-3 s)² = 1 N; 1 N/(1e-3 m)² = 1e6 Pa; 1 N · 1e-3 m = 1e-3 J.
        assert_eq!(of("mm", "ms", "g"), ["N", "MPa", "mJ", "N ms"]);
        assert_eq!(of("mm", "s", "t"), ["N", "MPa", "mJ", "N s"]);
        assert_eq!(of("mm", "ms", "kg"), ["kN", "GPa", "J", "kN ms"]);
        // 1e-5 N has no prefix (it is the dyne); the others are composed too where they have none.
        assert_eq!(of("cm", "s", "g"), ["g cm/s^2", "g/(cm s^2)", "g cm^2/s^2", "g cm/s"]);
        assert_eq!(of("in", "s", "lb")[1], "lb/(in s^2)");
    }

    #[test]
    fn velocities_are_told_where_both_labels_are_known() {
        // 1 mm/ms = 1 m/s; 1 mm/s = 0.001 m/s; 1 km/s = 1000 m/s.
        let of = |labels: [&str; 2]| metres_per_second(labels[0], labels[1]);
        assert_eq!([["mm", "ms"], ["mm", "s"], ["km", "s"]].map(of), [Some(1.0), Some(1e-3), Some(1e3)]);
        assert_eq!([["in", "s"], ["cubit", "s"], ["", ""]].map(of), [Some(0.0254), None, None]);
    }

    /// One run has one unit of stress, wherever the label comes from. Where only the force has a
    /// name the mass is not known: stresses of 1e15 Pa and more.
    #[test]
    fn stress_belongs_to_force_and_length() {
        for l in ["km", "m", "dm", "cm", "mm", "µm", "um", "nm", "in"] {
            for t in ["s", "ms", "µs", "us", "ns", "min"] {
                for m in ["t", "Mg", "kg", "g", "mg", "µg", "lb"] {
                    let labels = Labels::of(l, t, m);
                    let found = stress(&labels.force, l, t);
                    assert!(found == labels.stress || found.ends_with(&format!("N/{l}^2")), "{labels:?}");
                }
            }
        }
        assert_eq!(stress("mN", "mm", "s"), "kPa");
        assert_eq!((stress("", "m", "s"), stress("lbf", "in", "s")), (String::new(), "lbf/in^2".to_owned()));
    }
}
