//! Explicit schemes: central differences for smooth motion, with various contact conditions. On
//! linear motion
//!
//! ```text
//! z² + (Ω² − 2)z + 1 = 0,   Ω = ωΔt:   |z| = 1 and sin(arg z/2) = Ω/2 up to Ω = 2
//! ```

/// Central differences with a contact condition.
#[derive(Clone, Copy, Debug)]
pub struct Explicit {
    /// One sentence.
    pub summary: &'static str,
    /// Order of convergence on smooth motion.
    pub order: u8,
    /// Whether the contact's coefficient of restitution is used.
    pub restitution: bool,
    /// Treatment of contact.
    pub contact: &'static [&'static str],
}

/// Largest Ω for which no mode grows.
pub(crate) const STABLE: f64 = 2.0;

/// Modulus and angle of the oscillating pair at Ω.
pub(crate) fn oscillation(omega_dt: f64) -> Option<(f64, f64)> {
    (omega_dt < STABLE).then(|| (1.0, 2.0 * (0.5 * omega_dt).asin()))
}

/// Modulus of the larger root.
pub(crate) fn spectral_radius(omega_dt: f64) -> f64 {
    let half = (0.5 * omega_dt * omega_dt - 1.0).max(1.0);
    half + (half * half - 1.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// z = −(7 + 3√5)/2 at Ω = 3.
    #[test]
    fn modes_grow_beyond_the_stable_step() {
        assert!((spectral_radius(3.0) - 0.5 * (7.0 + 45f64.sqrt())).abs() < 1e-12);
        assert_eq!((spectral_radius(1.9), oscillation(2.1)), (1.0, None));
    }
}
