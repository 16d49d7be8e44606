//! What a case may do but is seldom meant: said by `check` and `run`, in the manifest, in the log
//! and on the page; nothing is refused.

use carom_solid::Element;

use super::{Case, Plane};

/// Poisson's ratio above which straight triangles of degree 1 lock: at 0.45 the bulk modulus is ten
/// times the shear modulus.
const LOCKING: f64 = 0.45;

impl Case {
    /// Warnings, one sentence of what and why each, and what to try.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        // In plane stress the thickness gives way.
        if self.dimension != 2 || self.plane != Plane::Strain {
            return warnings;
        }
        for body in self.bodies.iter().filter(|b| b.element == Element::T3) {
            let Some(material) = self.materials.iter().find(|m| m.name == body.material) else { continue };
            let poisson = material.lambda / (2.0 * (material.lambda + material.mu));
            // A ratio typed as 0.45 comes back from Λ and μ with its last digits changed.
            if poisson > LOCKING + 1e-9 {
                warnings.push(format!(
                    "body \"{}\" is nearly incompressible (Poisson's ratio {}) and made of T3 in plane strain, which lock: it will be too \
                     stiff; try element = \"T6\" or \"T10\"",
                    body.name,
                    (poisson * 1e4).round() / 1e4
                ));
            }
        }
        warnings
    }
}
