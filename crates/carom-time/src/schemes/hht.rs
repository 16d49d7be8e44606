//! Hilber, Hughes and Taylor 1977: averaged forces. Their α is −α_f; here α = α_f ≥ 0,
//!
//! ```text
//! γ = ½ + α,   β = (1 + α)²/4,   ρ∞ = (1 − α)/(1 + α) up to α = 1/3, α/(1 − α) above
//! ```
//!
//! Order 2.
use std::ops::Bound::{Excluded, Included};

use crate::error::SchemeError;
use crate::kind::{Build, KindInfo, Member};
use crate::parameter::Parameter;
use crate::scheme::{Scheme, finite};

pub(super) const KIND: KindInfo = KindInfo {
    name: "hht",
    summary: "Hilber–Hughes–Taylor.",
    reference: "Hilber, Hughes, Taylor 1977",
    sets: &[&[Parameter {
        key: "alpha",
        range: (Included(0.0), Excluded(1.0)),
        meaning: "Weight α = α_f ≥ 0 of the old forces; the opposite of the α of Hilber, Hughes and Taylor.",
        example: "0.1",
    }]],
    members: &[
        Member::new(&[("alpha", 0.05)], 2, 19.0 / 21.0),
        Member::new(&[("alpha", 0.25)], 2, 0.6),
        Member::new(&[("alpha", 1.0 / 3.0)], 2, 0.5).hidden(),
        Member::new(&[("alpha", 0.4)], 2, 2.0 / 3.0).hidden(),
    ],
    build: Build::Alpha(|_, p| Scheme::hht(p[0])),
};

impl Scheme {
    /// Hilber, Hughes and Taylor 1977 by α = α_f ≥ 0 (their α is −α_f): γ = ½ + α, β = (1 + α)²/4.
    /// Above 1/3 ρ∞ increases again: it is used as given; [`Scheme::remarks`] reports it.
    ///
    /// ```
    /// let hht = carom_time::Scheme::hht(0.25)?;
    /// assert_eq!((hht.gamma, hht.beta), (0.75, 0.390625));
    /// let rejected = carom_time::Scheme::hht(-0.05).unwrap_err().to_string();
    /// assert!(rejected.contains("write alpha = 0.05"));
    /// # Ok::<(), carom_time::SchemeError>(())
    /// ```
    pub fn hht(alpha: f64) -> Result<Self, SchemeError> {
        if alpha < 0.0 && alpha.is_finite() {
            let hint = format!(
                "write alpha = {}: here alpha is the weight of the old forces, the opposite of the α of the 1977 paper",
                -alpha
            );
            return Err(SchemeError::OutOfRange { key: "alpha", value: alpha, range: "[0, 1)", hint });
        }
        if alpha >= 1.0 {
            let hint = "the usual range is 0 to 1/3".to_owned();
            return Err(SchemeError::OutOfRange { key: "alpha", value: alpha, range: "[0, 1)", hint });
        }
        finite("alpha", alpha)?;
        Self::generalized_alpha(0.0, alpha, 0.25 * (1.0 + alpha) * (1.0 + alpha), 0.5 + alpha)
    }
}
