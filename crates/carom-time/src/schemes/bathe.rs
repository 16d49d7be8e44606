//! The composite rule of Noh and Bathe 2019 (ρ∞-Bathe): the trapezoidal rule to γΔt, then a
//! three-point rule to Δt,
//!
//! ```text
//! u₁ = u₀ + γΔt (v₀ + v₁)/2,                    v₁ = v₀ + γΔt (a₀ + a₁)/2
//! u₂ = u₀ + Δt (q₀ v₀ + q₁ v₁ + q₂ v₂),         v₂ = v₀ + Δt (q₀ a₀ + q₁ a₁ + q₂ a₂)
//! γ = 2/(2 + √(2 + 2ρ∞)),   q₁ = (ρ∞ + 1)/(2γ(ρ∞ − 1) + 4),   q₀ = (γ − 1) q₁ + ½,   q₂ = ½ − γ q₁
//! ```
//!
//! with M a₁ + f₁ = 0 and M a₂ + f₂ = 0: two solves per step, contact imposed at both ends with
//! separate multipliers. γ is (2 − √(2 + 2ρ∞))/(1 − ρ∞) without the 0/0 at ρ∞ = 1. At ρ∞ = 0 it is
//! TR-BDF2 (Bank and others 1985) with γ = 2 − √2 and equal stage matrices. Order 2.
use crate::error::SchemeError;
use crate::kind::{Build, KindInfo, Member};
use crate::parameter::RHO_INF;
use crate::scheme::in_unit_interval;
use crate::stage::{Kernel, Memory, Stage};

pub(super) const KIND: KindInfo = KindInfo {
    name: "bathe",
    summary: "Composite rule of Noh and Bathe.",
    reference: "Noh, Bathe 2019",
    sets: &[&[RHO_INF]],
    members: &[
        Member::new(&[("rho_inf", 0.0)], 2, 0.0),
        Member::new(&[("rho_inf", 0.6)], 2, 0.6),
        Member::new(&[("rho_inf", 1.0)], 2, 1.0).hidden(),
    ],
    build: Build::Stages(|p| Ok(Box::new(Bathe::new(p[0])?))),
};

/// The composite rule for a given ρ∞.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bathe {
    /// End of the first stage.
    pub gamma: f64,
    /// Weights of start, first and second stage.
    pub q: [f64; 3],
}

impl Bathe {
    /// From its spectral radius at infinity, in [0, 1].
    ///
    /// ```
    /// let bathe = carom_time::schemes::bathe::Bathe::new(0.0)?;
    /// assert!((bathe.gamma - (2.0 - 2f64.sqrt())).abs() < 1e-15 && (bathe.q[1] - 0.5f64.sqrt() / 2.0).abs() < 1e-15);
    /// # Ok::<(), carom_time::SchemeError>(())
    /// ```
    pub fn new(rho_inf: f64) -> Result<Self, SchemeError> {
        let r = in_unit_interval(rho_inf)?;
        let gamma = 2.0 / (2.0 + (2.0 + 2.0 * r).sqrt());
        let q1 = (r + 1.0) / (2.0 * gamma * (r - 1.0) + 4.0);
        Ok(Self { gamma, q: [(gamma - 1.0) * q1 + 0.5, q1, 0.5 - gamma * q1] })
    }
}

impl Kernel for Bathe {
    fn stages(&self) -> usize {
        2
    }

    fn notes(&self) -> &'static [&'static str] {
        &[
            "two solves per step; the recorded multiplier is that of the second stage, because that of the first has spikes at impact",
        ]
    }

    fn stage_into(&self, k: usize, dt: f64, memory: &Memory, stage: &mut Stage) {
        let [q0, q1, q2] = self.q;
        let (_, v0, a0) = memory.states[0];
        stage.velocity.at_start.clear();
        stage.acceleration.at_start.clear();
        if k == 0 {
            let h = self.gamma * dt;
            stage.at_the_end(self.gamma, [0.0, q0, q1]);
            stage.velocity.slope = 2.0 / h;
            stage.velocity.at_start.extend(v0.iter().map(|v| -v));
            stage.acceleration.slope = 4.0 / (h * h);
            stage.acceleration.at_start.extend(v0.iter().zip(a0).map(|(v, a)| -4.0 * v / h - a));
            return;
        }
        let (_, v1, a1) = memory.states[1];
        stage.at_the_end(1.0, [0.0, 0.0, q2]);
        stage.velocity.slope = 1.0 / (q2 * dt);
        stage.velocity.at_start.extend(v0.iter().zip(v1).map(|(v0, v1)| -(q0 * v0 + q1 * v1) / q2));
        stage.acceleration.slope = 1.0 / (q2 * q2 * dt * dt);
        let velocities = stage.velocity.at_start.iter().zip(v0);
        let known = a0.iter().zip(a1).map(|(a0, a1)| q0 * a0 + q1 * a1);
        let at_start =
            velocities.zip(known).map(|((at_start, v0), known)| ((at_start - v0) / dt - known) / q2);
        stage.acceleration.at_start.extend(at_start);
    }
}
