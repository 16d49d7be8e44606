//! Unit labels of derived quantities, from the case's labels of length, time and mass. No values
//! are converted.
//!
//! Where all three labels are decimal multiples of metre, second and kilogram and so is a derived
//! unit of newton, pascal or joule with a prefix of steps of 1000, it has that name: with mm, ms
//! and g forces are in N, stresses in MPa and energies in mJ. Otherwise it is composed of the
//! labels.

use carom_case::Case;

/// Labels of all kinds of columns.
#[derive(Clone, Debug)]
pub(super) struct Labels {
    pub(super) time: String,
    pub(super) length: String,
    pub(super) velocity: String,
    pub(super) acceleration: String,
    pub(super) force: String,
    pub(super) moment: String,
    pub(super) momentum: String,
    pub(super) angular_momentum: String,
    pub(super) energy: String,
    pub(super) stress: String,
    pub(super) none: String,
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
    pub(super) fn of(case: &Case) -> Self {
        Self::of_units(&case.units.length, &case.units.time, &case.units.mass)
    }

    fn of_units(l: &str, t: &str, m: &str) -> Self {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The Brochure of the SI, 9th edition, tables 4 and 7: 1 N = 1 kg m/s², 1 Pa = 1 kg/(m s²),
    /// 1 J = 1 kg m²/s².
    #[test]
    fn derived_units_have_their_names() {
        let of = |l: &str, t: &str, m: &str| {
            let labels = Labels::of_units(l, t, m);
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
}
