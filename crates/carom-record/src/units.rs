//! Unit labels: those of derived quantities, from the case's labels of length, time and mass, and
//! factors between two labels, `lb in/s^2` and `N`, for comparing records in different systems of
//! units. The values of a record are converted only beside others, in a study.
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
pub fn stress(force: &str, length: &str, time: &str) -> String {
    if force.is_empty() {
        return String::new();
    }
    if let Some(mass) = force.strip_suffix(&format!(" {length}/{time}^2")) {
        return Labels::of(length, time, mass).stress;
    }
    let label = format!("{force}/{length}^2");
    factor(&label, "Pa").and_then(|pascals| named("Pa", pascals)).unwrap_or(label)
}
