//! A motion given by formulas, and the load that makes it a solution: the method of manufactured solutions.
//!
//! ```text
//! b = ρ₀ ÿ − Div P(∂y/∂X)          per reference volume; ÿ, ∂y/∂X and ∂²y/∂X² are the formulas' own derivatives
//! error_l2 = √∫ |y_h − y|² dΩ₀,   error_h1 = √∫ |∂y_h/∂X − ∂y/∂X|² dΩ₀
//! ```
//!
//! All nodes of the boundary are moved as the formulas say, and the bodies start with their positions and velocities. With cells of degree k the
//! errors fall with the orders k + 1 and k (P. J. Roache, "Code verification by the method of manufactured solutions", J. Fluids Eng. 124, 2002).

use carom_formula::Formula;

use super::formulas::{NoValue, arguments, finite};
use super::{MAX_CELL_DOFS, Part};

const WHAT: &str = "the motion of [manufactured]";

/// The motion y(X, t).
pub struct Manufactured<const D: usize> {
    y: [Formula; D],
}

/// y, H = ∂y/∂X − 1 and second derivatives at a place.
struct Bent<const D: usize> {
    y: [f64; D],
    h: [[f64; D]; D],
    second: [[[f64; D]; D]; D],
}

impl<const D: usize> Manufactured<D> {
    pub(super) fn new(y: [Formula; D]) -> Self {
        Self { y }
    }

    /// Position and velocity of a place.
    ///
    /// # Errors
    /// A formula without a finite value or derivative there.
    pub fn motion(&self, place: &[f64; D], time: f64) -> Result<[[f64; D]; 2], NoValue> {
        let mut motion = [[0.0; D]; 2];
        for (i, formula) in self.y.iter().enumerate() {
            let along = formula.with_derivatives(&arguments(place, time)[..=D], D);
            for (value, kept) in along.into_iter().zip(&mut motion) {
                kept[i] = finite(value, formula, WHAT, place, time)?;
            }
        }
        Ok(motion)
    }

    fn bent(&self, place: &[f64; D], time: f64) -> Result<Bent<D>, NoValue> {
        let mut bent = Bent { y: [0.0; D], h: [[0.0; D]; D], second: [[[0.0; D]; D]; D] };
        for (i, formula) in self.y.iter().enumerate() {
            let (value, gradient, second) = formula.with_gradient::<D>(&arguments(place, time)[..=D]);
            for number in std::iter::once(&value).chain(&gradient).chain(second.as_flattened()) {
                finite(*number, formula, WHAT, place, time)?;
            }
            bent.y[i] = value;
            bent.h[i] = gradient;
            bent.h[i][i] -= 1.0;
            bent.second[i] = second;
        }
        Ok(bent)
    }

    /// Force per reference volume at a place.
    fn load(&self, part: &Part<D>, place: &[f64; D], time: f64) -> Result<[f64; D], NoValue> {
        let Bent { h, second, .. } = self.bent(place, time)?;
        let divergence = part.body.stress_divergence(&h, &second).map_err(|det_f| {
            let formula = self.y.each_ref().map(Formula::text).join(", ");
            let what = "the strain energy of [manufactured], of the determinant J,".to_owned();
            NoValue { what, formula, place: place.to_vec(), time, value: det_f }
        })?;
        let mut load = [0.0; D];
        for (i, formula) in self.y.iter().enumerate() {
            let [.., acceleration] = formula.with_derivatives(&arguments(place, time)[..=D], D);
            load[i] = part.body.density() * finite(acceleration, formula, WHAT, place, time)? - divergence[i];
        }
        Ok(load)
    }

    /// force += ∫φᵃ b dΩ₀.
    ///
    /// # Errors
    /// The first place where the load has no value.
    pub(super) fn add_load(&self, parts: &[Part<D>], time: f64, force: &mut [f64]) -> Result<(), NoValue> {
        for part in parts {
            let mesh = part.body.mesh();
            for cell in 0..mesh.cell_count() {
                let (mut local, mut refused) = ([0.0; MAX_CELL_DOFS], None);
                part.body.each_volume_point(cell, &mut |shape, place, volume| match self.load(part, place, time) {
                    Ok(load) => {
                        for (a, phi) in shape.iter().enumerate() {
                            for i in 0..D {
                                local[a * D + i] += phi * volume * load[i];
                            }
                        }
                    }
                    Err(error) => {
                        refused.get_or_insert(error);
                    }
                });
                if let Some(error) = refused {
                    return Err(error);
                }
                for (a, node) in mesh.cell(cell).iter().enumerate() {
                    for i in 0..D {
                        force[(part.first_node + node) * D + i] += local[a * D + i];
                    }
                }
            }
        }
        Ok(())
    }

    /// Errors of positions in L² and of their gradients at a time.
    pub fn errors(&self, parts: &[Part<D>], y: &[f64], time: f64) -> [f64; 2] {
        let mut squares = [0.0; 2];
        for part in parts {
            let y = &y.as_chunks::<D>().0[part.nodes()];
            for cell in 0..part.body.mesh().cell_count() {
                part.body.each_moved_point(cell, y, &mut |place, moved, h, volume| {
                    let Ok(exact) = self.bent(place, time) else { return squares = [f64::NAN; 2] };
                    for i in 0..D {
                        squares[0] += volume * (moved[i] - exact.y[i]).powi(2);
                        squares[1] += volume * (0..D).map(|j| (h[i][j] - exact.h[i][j]).powi(2)).sum::<f64>();
                    }
                });
            }
        }
        squares.map(f64::sqrt)
    }
}
