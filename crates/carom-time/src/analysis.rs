//! Properties of the scheme on the test oscillator a + ω²u = 0 at Ω = ωΔt.
//!
//! In two-step form (13)–(15) read, with the shift z and q = Ω²,
//!
//! ```text
//! [(1 − α_m)z + α_m](z − 1)² + q [(1 − α_f)z + α_f] [βz² + (½ + γ − 2β)z + (½ − γ + β)] = 0
//! ```
//!
//! and with z = (1 + s)/(1 − s), m = 1 − 2α_m, f = 1 − 2α_f, g = 2γ − 1, h = 4β − 2γ,
//!
//! ```text
//! 4s²(1 + ms) + q (1 + fs)(1 + gs + hs²) = 0
//! ```
//!
//! from which everything below follows: roots without cancellation at small Ω, the limit Ω → ∞,
//! stability by Routh and Hurwitz. Definitions of damping and period error: Hilber and Hughes 1978.
//! Both force rules coincide on this linear equation.
use crate::cubic::{Root, cubic, quadratic};
use crate::scheme::Scheme;

/// Tolerance of the condition for order 2: parameters come from quotients.
const ROUND_OFF: f64 = 1e-12;

/// The oscillating pair of roots at one Ω.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Principal {
    /// |z|, the amplification per step.
    pub modulus: f64,
    /// Numerical damping ratio ξ = −ln|z| / arg z.
    pub damping_ratio: f64,
    /// Relative period elongation, PE = Ω / arg z − 1, including the shift by damping.
    pub period_error: f64,
}

/// Analysis on the test oscillator. `omega_dt` is Ω = ωΔt > 0.
impl Scheme {
    /// m, f, g, h of the polynomial in s.
    fn coefficients(&self) -> [f64; 4] {
        [
            1.0 - 2.0 * self.alpha_m,
            1.0 - 2.0 * self.alpha_f,
            2.0 * self.gamma - 1.0,
            4.0 * self.beta - 2.0 * self.gamma,
        ]
    }

    /// The amplification matrix A of one step, (u, Δt v, Δt² a)_{s+1} = A (u, Δt v, Δt² a)_s.
    /// Row-major.
    pub fn amplification(&self, omega_dt: f64) -> [[f64; 3]; 3] {
        let q = omega_dt * omega_dt;
        let Self { alpha_m, alpha_f, beta, gamma, .. } = *self;
        let new = 1.0 - alpha_f;
        let lead = (1.0 - alpha_m) + new * beta * q;
        let a = [-q / lead, -new * q / lead, -(alpha_m + new * q * (0.5 - beta)) / lead];
        let row = |free: [f64; 3], share: f64| {
            [free[0] + share * a[0], free[1] + share * a[1], free[2] + share * a[2]]
        };
        [row([1.0, 1.0, 0.5 - beta], beta), row([0.0, 1.0, 1.0 - gamma], gamma), a]
    }

    /// The roots in s at q = Ω²; missing ones lie at infinity, z = −1.
    fn s_roots(&self, omega_dt: f64) -> Vec<Root> {
        let q = omega_dt * omega_dt;
        let [m, f, g, h] = self.coefficients();
        cubic(4.0 * m + q * f * h, 4.0 + q * (h + f * g), q * (f + g), q)
    }

    /// The three eigenvalues of [`Scheme::amplification`]: first the principal pair, if it
    /// oscillates, last the spurious root.
    pub fn roots(&self, omega_dt: f64) -> [Root; 3] {
        padded(&self.s_roots(omega_dt))
    }

    /// Largest modulus of the eigenvalues at Ω.
    ///
    /// ```
    /// let trapezoidal = carom_time::Scheme::newmark(0.25, 0.5)?;
    /// assert!((trapezoidal.spectral_radius(3.0) - 1.0).abs() < 1e-15);
    /// # Ok::<(), carom_time::SchemeError>(())
    /// ```
    pub fn spectral_radius(&self, omega_dt: f64) -> f64 {
        largest(&self.roots(omega_dt))
    }

    /// ρ∞: the spectral radius as Ω → ∞, from the limit polynomial (1 + fs)(1 + gs + hs²) = 0.
    ///
    /// ```
    /// let rho_inf = carom_time::Scheme::chung_hulbert(0.6)?.spectral_radius_at_infinity();
    /// assert!((rho_inf - 0.6).abs() < 1e-14);
    /// assert_eq!(carom_time::Scheme::hu().spectral_radius_at_infinity(), 0.0);
    /// # Ok::<(), carom_time::SchemeError>(())
    /// ```
    pub fn spectral_radius_at_infinity(&self) -> f64 {
        let force_root = self.alpha_f / (1.0 - self.alpha_f);
        largest(&self.constrained_roots()).max(force_root.abs())
    }

    /// The map (Δt v, Δt² a)_s → (Δt v, Δt² a)_{s+1} of a dof whose position is constrained, as by
    /// contact. Row-major.
    pub fn constrained_map(&self) -> [[f64; 2]; 2] {
        let Self { beta, gamma, .. } = *self;
        [[1.0 - gamma / beta, 1.0 - 0.5 * gamma / beta], [-1.0 / beta, 1.0 - 0.5 / beta]]
    }

    /// Eigenvalues of [`Scheme::constrained_map`], which are those at Ω → ∞ except −α_f/(1 − α_f):
    /// the roots of 1 + gs + hs² = 0.
    pub fn constrained_roots(&self) -> [Root; 2] {
        let [_, _, g, h] = self.coefficients();
        // Most members have a double root by construction; g and h satisfy it only to the round-off
        // of β and γ.
        let snap = 16.0 * f64::EPSILON * (self.beta.abs() + self.gamma.abs());
        let roots = padded(&quadratic(h, g, 1.0, snap));
        [roots[0], roots[1]]
    }

    /// The oscillating pair at Ω, if it exists.
    ///
    /// ```
    /// let at = carom_time::Scheme::hu().principal(std::f64::consts::TAU / 10.0);
    /// let xi = at.map_or(0.0, |pair| pair.damping_ratio);
    /// assert!((xi - 0.297).abs() < 5e-4);
    /// ```
    pub fn principal(&self, omega_dt: f64) -> Option<Principal> {
        let s = self.s_roots(omega_dt).into_iter().find(|root| root.im > 0.0)?;
        // |z|² = 1 + 4 Re s / |1 − s|², arg z = arg((1 + s)(1 − s̄)).
        let away = (1.0 - s.re).mul_add(1.0 - s.re, s.im * s.im);
        let log_modulus = 0.5 * (4.0 * s.re / away).ln_1p();
        let angle = (2.0 * s.im).atan2(1.0 - s.re * s.re - s.im * s.im);
        Some(Principal {
            modulus: log_modulus.exp(),
            damping_ratio: -log_modulus / angle,
            period_error: omega_dt / angle - 1.0,
        })
    }

    /// Order of convergence on smooth motion: 2 iff γ = ½ − α_m + α_f, else 1; 0 if errors grow
    /// from step to step (α_m > ½).
    pub fn order(&self) -> u8 {
        let shift = self.gamma - (0.5 - self.alpha_m + self.alpha_f);
        match () {
            () if self.alpha_m > 0.5 => 0,
            () if shift.abs() <= ROUND_OFF * (1.0 + self.alpha_m.abs() + self.alpha_f.abs()) => 2,
            () => 1,
        }
    }

    /// Whether the scheme is stable for every Ω: m ≥ 0, fh ≥ 0, h + fg ≥ 0, f + g ≥ m, g(h + f² +
    /// fg) ≥ 0 (Routh and Hurwitz for every q > 0).
    pub fn is_a_stable(&self) -> bool {
        let [m, f, g, h] = self.coefficients();
        [m, f * h, h + f * g, f + g - m, g * (h + f * f + f * g)].iter().all(|&x| x >= -ROUND_OFF)
    }

    /// |v₁| / (Ω ω|u₀|) as Ω → ∞ of a stiff mode released from u₀ with a₀ = −ω²u₀: |1 − γ/(2β)|.
    /// Zero means no overshoot in velocity. Displacements of the family do not overshoot beyond a
    /// factor independent of Ω (Hilber and Hughes 1978).
    pub fn velocity_overshoot(&self) -> f64 {
        (1.0 - 0.5 * self.gamma / self.beta).abs()
    }
}

/// Roots in z from those in s, padded with −1.
fn padded(s_roots: &[Root]) -> [Root; 3] {
    let mut z = [Root::real(-1.0); 3];
    for (z, s) in z.iter_mut().zip(s_roots) {
        let away = (1.0 - s.re).mul_add(1.0 - s.re, s.im * s.im);
        *z = Root { re: ((1.0 - s.re) * (1.0 + s.re) - s.im * s.im) / away, im: 2.0 * s.im / away };
    }
    z
}

fn largest(roots: &[Root]) -> f64 {
    roots.iter().map(|root| root.modulus()).fold(0.0, f64::max)
}
