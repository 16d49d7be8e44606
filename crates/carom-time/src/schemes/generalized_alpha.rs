//! Four raw parameters of eq. (15), index s + 1 − α: an α is the weight of the old term (Chung and
//! Hulbert 1993). Order 2 for γ = ½ − α_m + α_f.
use std::ops::Bound::{Excluded, Unbounded};

use crate::error::SchemeError;
use crate::kind::{Build, KindInfo, Member};
use crate::parameter::{BETA, GAMMA, Parameter};
use crate::scheme::{ForceRule, Scheme};

const SHARE: Parameter = Parameter {
    key: "alpha_m",
    range: (Unbounded, Excluded(1.0)),
    meaning: "Weight of the old inertia force.",
    example: "0.0",
};

pub(super) const KIND: KindInfo = KindInfo {
    name: "generalized-alpha",
    summary: "The generalised-α family, given by its four parameters.",
    reference: "Chung, Hulbert 1993",
    sets: &[&[
        SHARE,
        Parameter {
            key: "alpha_f",
            meaning: "Weight of the old internal, contact and external forces.",
            ..SHARE
        },
        BETA,
        GAMMA,
    ]],
    members: &[Member::new(&[("alpha_m", 0.5), ("alpha_f", 0.5), ("beta", 0.25), ("gamma", 0.5)], 2, 1.0)],
    build: Build::Alpha(|_, p| Scheme::generalized_alpha(p[0], p[1], p[2], p[3])),
};

impl Scheme {
    /// Four raw parameters. Invalid: non-finite values, β ≤ 0 (no implicit step), γ ≤ 0, α_m ≥ 1 or
    /// α_f ≥ 1 (no new inertia or no new force, or one of the wrong sign).
    pub fn generalized_alpha(alpha_m: f64, alpha_f: f64, beta: f64, gamma: f64) -> Result<Self, SchemeError> {
        let scheme = Self { alpha_m, alpha_f, beta, gamma, forces: ForceRule::AverageForces };
        scheme.checked()
    }
}
