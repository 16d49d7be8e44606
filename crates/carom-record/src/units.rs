//! Unit labels of derived quantities, from the case's labels of length, time and mass. No values
//! are converted.
//!
//! Where all three labels are decimal multiples of metre, second and kilogram and so is a derived
//! unit of newton, pascal or joule with a prefix of steps of 1000, it has that name: with mm, ms
//! and g forces are in N, stresses in MPa and energies in mJ. Otherwise it is composed of the
//! labels.

/// Labels of all kinds of columns.
#[derive(Clone, Debug)]
pub struct Labels {
    /// Of time.
    pub time: String,
    /// Of length.
    pub length: String,
    /// Of velocity.
    pub velocity: String,
    /// Of acceleration.
    pub acceleration: String,
    /// Of force.
    pub force: String,
    /// Of moment.
    pub moment: String,
    /// Of momentum.
    pub momentum: String,
    /// Of angular momentum.
    pub angular_momentum: String,
    /// Of energy.
    pub energy: String,
    /// Of stress.
    pub stress: String,
    /// Of what has no unit.
    pub none: String,
}

/// Units with their powers of ten.
type Powers = &'static [(&'static str, i32)];
const LENGTHS: Powers = &[
    ("km", 3),
    ("m", 0),
    ("dm", -1),
    ("cm", -2),
    ("mm", -3),
    ("µm", -6),
    ("μm", -6),
    ("um", -6),
    ("nm", -9),
];
const TIMES: Powers = &[("s", 0), ("ms", -3), ("µs", -6), ("μs", -6), ("us", -6), ("ns", -9)];
const MASSES: Powers =
    &[("t", 3), ("Mg", 3), ("kg", 0), ("g", -3), ("mg", -6), ("µg", -9), ("μg", -9), ("ug", -9)];
const PREFIXES: Powers =
    &[("p", -12), ("n", -9), ("µ", -6), ("m", -3), ("", 0), ("k", 3), ("M", 6), ("G", 9), ("T", 12)];

fn power(label: &str, of: Powers) -> Option<i32> {
    of.iter().find(|(name, _)| *name == label).map(|(_, power)| *power)
}

/// The name of 10^power times a unit.
fn named(unit: &str, power: i32) -> Option<String> {
    let prefix = PREFIXES.iter().find(|(_, p)| *p == power)?.0;
    Some(format!("{prefix}{unit}"))
}

impl Labels {
    /// From those of length, time and mass.
    pub fn of(l: &str, t: &str, m: &str) -> Self {
        let powers = power(l, LENGTHS).zip(power(t, TIMES)).zip(power(m, MASSES));
        // A product of powers of mass, length and time.
        let name = |unit: &str, [mass, length, time]: [i32; 3]| {
            let ((l, t), m) = powers?;
            named(unit, mass * m + length * l + time * t)
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

/// The velocity 1 in units of these labels in m/s; none if they are no decimal multiples of metre
/// and second.
pub fn metres_per_second(length: &str, time: &str) -> Option<f64> {
    Some(10.0_f64.powi(power(length, LENGTHS)? - power(time, TIMES)?))
}

/// The label of stress that belongs to those of force, length and time.
pub(crate) fn stress(force: &str, length: &str, time: &str) -> String {
    if force.is_empty() {
        return String::new();
    }
    if let Some(mass) = force.strip_suffix(&format!(" {length}/{time}^2")) {
        return Labels::of(length, time, mass).stress;
    }
    let newtons = force.strip_suffix('N').and_then(|prefix| power(prefix, PREFIXES));
    let named = newtons.zip(power(length, LENGTHS)).and_then(|(n, l)| named("Pa", n - 2 * l));
    named.unwrap_or_else(|| format!("{force}/{length}^2"))
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!([["in", "s"], ["m", "min"], ["", ""]].map(of), [None; 3]);
    }

    /// One run has one unit of stress, wherever the label comes from. Where only the force has a
    /// name the mass is not known: stresses of 1e15 Pa and more.
    #[test]
    fn stress_belongs_to_force_and_length() {
        let names = |of: Powers| of.iter().map(|(name, _)| *name).chain(["in"]).collect::<Vec<_>>();
        for l in names(LENGTHS) {
            for t in names(TIMES) {
                for m in names(MASSES) {
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
