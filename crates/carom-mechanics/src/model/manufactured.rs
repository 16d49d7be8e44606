//! A motion prescribed by formulas, and the load for which it is a solution: the method of
//! manufactured solutions.
//!
//! ```text
//! b = ρ₀ ÿ − Div P(∂y/∂X)          per reference volume; ÿ, ∂y/∂X and ∂²y/∂X² are the formulas' own derivatives
//! error_l2 = √∫ |y_h − y|² dΩ₀,   error_h1 = √∫ |∂y_h/∂X − ∂y/∂X|² dΩ₀
//! ```
//!
//! All boundary nodes follow the formulas, and the bodies start with their positions and
//! velocities. With cells of degree k the errors converge with the orders k + 1 and k (P. J.
//! Roache, "Code verification by the method of manufactured solutions", J. Fluids Eng. 124, 2002).

use carom_formula::Formula;

use super::body_instance::BodyInstance;
use super::formulas::{Arguments, NoValue, finite};

const WHAT: &str = "the motion of [manufactured]";

/// The motion y(X, t), a formula for each component.
pub struct Manufactured {
    y: Vec<Formula>,
    /// Whether the scheme balances ρ₀ ÿ, which load steps do not.
    has_inertia: bool,
}

/// y, H = ∂y/∂X − 1 and second derivatives at a point, flat.
struct Deformation {
    y: Vec<f64>,
    h: Vec<f64>,
    second: Vec<f64>,
}

impl Manufactured {
    /// The motion with these components.
    pub fn new(y: Vec<Formula>, has_inertia: bool) -> Self {
        Self { y, has_inertia }
    }

    /// Position and velocity at a point.
    ///
    /// # Errors
    /// A formula without a finite value or derivative there.
    pub fn motion(&self, place: &[f64], time: f64) -> Result<[Vec<f64>; 2], NoValue> {
        let mut motion = [Vec::new(), Vec::new()];
        for formula in &self.y {
            let along = formula.with_derivatives(Arguments::new(place, time).as_slice(), place.len());
            for (value, component) in along.into_iter().zip(&mut motion) {
                component.push(finite(value, formula, WHAT, place, time)?);
            }
        }
        Ok(motion)
    }

    fn deformation(&self, place: &[f64], time: f64) -> Result<Deformation, NoValue> {
        let mut deformation = Deformation { y: Vec::new(), h: Vec::new(), second: Vec::new() };
        for (i, formula) in self.y.iter().enumerate() {
            let (value, mut gradient, second) =
                formula.with_gradient(Arguments::new(place, time).as_slice(), place.len());
            for number in std::iter::once(&value).chain(&gradient).chain(&second) {
                finite(*number, formula, WHAT, place, time)?;
            }
            gradient[i] -= 1.0;
            deformation.y.push(value);
            deformation.h.extend(gradient);
            deformation.second.extend(second);
        }
        Ok(deformation)
    }

    /// Force per reference volume at a point of a cell.
    fn load_into(
        &self,
        part: &BodyInstance,
        cell: usize,
        place: &[f64],
        time: f64,
        load: &mut [f64],
    ) -> Result<(), NoValue> {
        let Deformation { h, second, .. } = self.deformation(place, time)?;
        part.body.stress_divergence(cell, &h, &second, load).map_err(|det_f| {
            let formula = self.y.iter().map(Formula::text).collect::<Vec<_>>().join(", ");
            let what = "the strain energy of [manufactured], of the determinant J,".to_owned();
            NoValue { what, formula, place: place.to_vec(), time, value: det_f }
        })?;
        load.iter_mut().for_each(|load| *load = -*load);
        for (load, formula) in load.iter_mut().zip(&self.y).filter(|_| self.has_inertia) {
            let [.., acceleration] =
                formula.with_derivatives(Arguments::new(place, time).as_slice(), place.len());
            *load += part.body.density(cell) * finite(acceleration, formula, WHAT, place, time)?;
        }
        Ok(())
    }

    /// force += ∫φᵃ b dΩ₀.
    ///
    /// # Errors
    /// The first point where the load has no value.
    pub(super) fn add_load(
        &self,
        parts: &[BodyInstance],
        time: f64,
        force: &mut [f64],
    ) -> Result<(), NoValue> {
        parts.iter().try_for_each(|part| {
            part.add_body_force(
                None,
                |cell, place, load| self.load_into(part, cell, place, time, load),
                force,
            )
        })
    }

    /// Errors of positions in L² and of their gradients at a time.
    pub fn errors(&self, parts: &[BodyInstance], y: &[f64], time: f64) -> [f64; 2] {
        let mut squares = [0.0; 2];
        let square = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        for part in parts {
            for cell in 0..part.body.mesh().cell_count() {
                part.body.each_moved_point(cell, part.of(y), &mut |place, moved, h, volume| {
                    let Ok(exact) = self.deformation(place, time) else { return squares = [f64::NAN; 2] };
                    squares[0] += volume * square(moved, &exact.y);
                    squares[1] += volume * square(h, &exact.h);
                });
            }
        }
        squares.map(f64::sqrt)
    }
}
