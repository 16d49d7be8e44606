//! Warnings about valid but unusual input. They are shown by `check` and `run`, in the manifest, in
//! the log and on the page; none of them stops a run.

use carom_solid::Element;

use super::{Case, Plane};

/// Poisson's ratio above which straight triangles of degree 1 lock: at 0.45 the bulk modulus is ten
/// times the shear modulus.
const LOCKING: f64 = 0.45;

impl Case {
    /// The warnings: what, why, and what to try.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        // In plane stress the thickness changes freely, so nothing locks.
        if self.dimension != 2 || self.plane != Plane::Strain {
            return warnings;
        }
        for body in self.bodies.iter().filter(|b| b.element == Element::T3) {
            let Some(material) = self.materials.iter().find(|m| m.name == body.material) else { continue };
            let poisson = material.lambda / (2.0 * (material.lambda + material.mu));
            // A ratio given as 0.45 and recomputed from Λ and μ differs in its last digits.
            if poisson > LOCKING + 1e-9 {
                warnings.push(format!(
                    "body \"{}\" is nearly incompressible (Poisson's ratio {}), and T3 elements lock in plane strain: the response will be too \
                     stiff; try element = \"T6\" or \"T10\"",
                    body.name,
                    (poisson * 1e4).round() / 1e4
                ));
            }
        }
        warnings
    }
}
