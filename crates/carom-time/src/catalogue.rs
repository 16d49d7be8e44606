//! Look-up of schemes by name in the table of kinds.

use std::collections::BTreeMap;

use crate::error::SchemeError;
use crate::integrator::Integrator;
use crate::kind::KindInfo;
use crate::name::Name;
use crate::scheme::ForceRule;
use crate::schemes::KINDS;

/// The kind of this name.
pub(crate) fn info(kind: &str) -> Option<&'static KindInfo> {
    KINDS.iter().find(|info| info.name == kind)
}

/// A scheme by the name and parameters of a case file. `forces` is for the α family.
///
/// ```
/// use carom_time::{ForceRule, Scheme, scheme};
/// let parameters = [("rho_inf".to_owned(), 0.1)].into();
/// let made = scheme("chung-hulbert", &parameters, ForceRule::AverageForces)?;
/// assert_eq!(made.alpha(), Some(Scheme::chung_hulbert(0.1)?));
/// # Ok::<(), carom_time::SchemeError>(())
/// ```
pub fn scheme(
    kind: &str,
    parameters: &BTreeMap<String, f64>,
    forces: ForceRule,
) -> Result<Integrator, SchemeError> {
    let Some(info) = info(kind) else {
        let known = KINDS.iter().map(|info| info.name).collect();
        return Err(SchemeError::UnknownKind { kind: kind.to_owned(), known });
    };
    info.build(parameters, forces)
}

impl Name {
    /// The integrator of this name.
    ///
    /// # Errors
    /// As [`scheme`].
    pub fn integrator(&self) -> Result<Integrator, SchemeError> {
        let given = self.parameters.iter().map(|(key, value)| ((*key).to_owned(), *value)).collect();
        scheme(self.kind, &given, self.forces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn build(kind: &str, parameters: &[(&str, f64)]) -> Result<Integrator, SchemeError> {
        let parameters = parameters.iter().map(|(key, value)| ((*key).to_owned(), *value)).collect();
        scheme(kind, &parameters, ForceRule::AverageForces)
    }

    /// Against the papers that each scheme names.
    #[test]
    fn parameters_are_the_published_ones() {
        let table: &[(&str, &[(&str, f64)], [f64; 4])] = &[
            ("newmark", &[("beta", 0.25), ("gamma", 0.5)], [0.0, 0.0, 0.25, 0.5]),
            ("newmark", &[("rho_inf", 1.0)], [0.0, 0.0, 0.25, 0.5]),
            ("newmark", &[("rho_inf", 0.6)], [0.0, 0.0, 0.390625, 0.75]),
            ("newmark", &[("rho_inf", 0.0)], [0.0, 0.0, 1.0, 1.5]),
            ("hu", &[], [0.0, 0.0, 1.0, 1.5]),
            ("hht", &[("alpha", 0.05)], [0.0, 0.05, 0.275625, 0.55]),
            ("hht", &[("alpha", 1.0 / 3.0)], [0.0, 1.0 / 3.0, 4.0 / 9.0, 5.0 / 6.0]),
            ("wbz", &[("rho_inf", 0.6)], [-0.25, 0.0, 0.390625, 0.75]),
            ("wbz", &[("rho_inf", 0.0)], [-1.0, 0.0, 1.0, 1.5]),
            ("chung-hulbert", &[("rho_inf", 1.0)], [0.5, 0.5, 0.25, 0.5]),
            ("chung-hulbert", &[("rho_inf", 0.6)], [0.125, 0.375, 0.390625, 0.75]),
            ("chung-hulbert", &[("rho_inf", 0.1)], [-0.8 / 1.1, 0.1 / 1.1, 1.0 / 1.21, 1.45 / 1.1]),
            ("chung-hulbert", &[("rho_inf", 0.0)], [-1.0, 0.0, 1.0, 1.5]),
        ];
        for (kind, parameters, expected) in table {
            let s = build(kind, parameters).unwrap().alpha().unwrap();
            for (got, want) in [s.alpha_m, s.alpha_f, s.beta, s.gamma].iter().zip(expected) {
                assert!((got - want).abs() < 1e-15, "{kind} {parameters:?}: {s:?}");
            }
        }
    }

    #[test]
    fn errors_name_the_key_and_what_is_valid() {
        let error = build("chung-hulber", &[]).unwrap_err();
        assert_eq!((error.key(), error.known().len()), ("kind", KINDS.len()));
        let error = build("wbz", &[]).unwrap_err();
        assert!(matches!(error, SchemeError::Missing { key: "rho_inf", .. }));
        let error = build("newmark", &[("beta", 0.25)]).unwrap_err();
        assert!(matches!(error, SchemeError::Missing { key: "gamma", .. }));
        assert_eq!(
            error.to_string(),
            "scheme `newmark` requires `beta` and `gamma`, or `rho_inf`; `gamma` is missing"
        );
        let error = build("newmark", &[("beta", 0.25), ("gamma", 0.5), ("rho_inf", 1.0)]).unwrap_err();
        assert!(matches!(&error, SchemeError::Superfluous { key, .. } if key == "rho_inf"));
        let error = build("hu", &[("rho_inf", 0.0)]).unwrap_err();
        assert_eq!(error.to_string(), "`rho_inf` cannot be given here: scheme `hu` requires no parameters");
        for value in [1.2, -0.1, f64::NAN, f64::INFINITY] {
            let error = build("chung-hulbert", &[("rho_inf", value)]).unwrap_err();
            assert!(
                matches!(error, SchemeError::OutOfRange { key: "rho_inf", range: "[0, 1]", .. }),
                "{error}"
            );
        }
        assert_eq!(build("newmark", &[("beta", 0.0), ("gamma", 0.5)]).unwrap_err().key(), "beta");
        let error = build("hht", &[("alpha", -0.05)]).unwrap_err().to_string();
        assert!(error.contains("write alpha = 0.05"), "{error}");
        assert!(build("hht", &[("alpha", f64::NAN)]).is_err() && build("hht", &[("alpha", 0.4)]).is_ok());
    }
}
