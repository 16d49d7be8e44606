//! Unit labels of derived quantities, from the case's labels of length, time and mass. No values
//! are converted.

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

impl Labels {
    /// SI names if the case is in metres, seconds and kilograms.
    pub(super) fn of(case: &Case) -> Self {
        let (l, t, m) = (&case.units.length, &case.units.time, &case.units.mass);
        let si = (l.as_str(), t.as_str(), m.as_str()) == ("m", "s", "kg");
        let or = |name: &str, composed: String| if si { name.to_owned() } else { composed };
        Self {
            time: t.clone(),
            length: l.clone(),
            velocity: format!("{l}/{t}"),
            acceleration: format!("{l}/{t}^2"),
            force: or("N", format!("{m} {l}/{t}^2")),
            moment: or("N m", format!("{m} {l}^2/{t}^2")),
            momentum: or("N s", format!("{m} {l}/{t}")),
            angular_momentum: or("N m s", format!("{m} {l}^2/{t}")),
            energy: or("J", format!("{m} {l}^2/{t}^2")),
            stress: or("Pa", format!("{m}/({l} {t}^2)")),
            none: String::new(),
        }
    }
}
