//! Natural frequencies of a model for its tangent at a configuration: ω² of K x = ω² M x, the
//! lowest deformation modes and the highest.
//!
//! ```text
//! lowest    x ← (K + σM)⁻¹ M x, vector by vector, each M-orthogonal to the previous ones (inverse iteration with deflation)
//! highest   x ← M⁻¹ K x (power iteration)
//! ```
//!
//! σ begins with 1e-6 ω²_max and follows Rayleigh's quotient xᵀKx/xᵀMx down to 1e-11: the share
//! of a mode ω₂ in that of the lowest one, ω₁, decreases by (ω₁² + σ)/(ω₂² + σ) in each
//! iteration. What close modes have of each other, Ritz's method separates: eigenvalues of
//! xᵢᵀKxⱼ of five vectors. Rigid modes have ω² below 1e-13 of the highest, their round-off, and
//! are omitted. With a massless node the highest is infinite; σ then refers to the mean
//! eigenvalue trace(K)/trace(M). Contact is open (Bathe, "Finite element procedures", §11.2,
//! §11.6).
//!
//! A penalty spring on its node alone, the other side fixed:
//!
//! ```text
//! ω² = k mᵢ⁻¹,   mᵢ⁻¹ = eᵢᵀ M⁻¹ eᵢ      acceleration of the node under a unit force at it; the stiffest of all nodes
//! ```

use std::sync::Arc;

use carom_algebra::sums::dot;
use carom_algebra::{Mat, principal_axes};

use crate::contact::constraints::Constraints;
use crate::linear::direct::Direct;
use crate::linear::preconditioner::Preconditioner;
use crate::model::Model;
use crate::stage::renewal::Point;
use carom_solid::Configuration;

/// Maximum iterations per vector, and relative change of the quotient at convergence.
const ITERATIONS: usize = 400;
const SETTLED: f64 = 1e-8;
/// Maximum number of vectors, including rigid modes: those of ten free bodies in space.
const VECTORS: usize = 63;
/// ω² relative to the highest below which a mode is rigid.
const RIGID: f64 = 1e-13;
/// The first shift σ, relative to the highest ω².
const SHIFT: f64 = 1e-6;
/// Quotient, relative to the shift, below which the shift follows, and the smallest shift relative
/// to the largest ω² of rigid modes.
const FOLLOWS: f64 = 0.1;
const NEAREST: f64 = 100.0;
/// Iterations of a rigid mode after the first whose quotient is round-off.
const CLEANED: usize = 3;
/// Number of frequencies, and of vectors that are separated for them.
const LOWEST: usize = 3;
const RITZ: usize = 5;

/// Frequencies ω of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frequencies {
    /// The lowest of deformation modes, ascending; at most three.
    pub lowest: Vec<f64>,
    /// The highest; none if a node is massless.
    pub highest: Option<f64>,
}

/// Frequencies of a model at a configuration; none if its tangent or its mass cannot be factored.
pub fn frequencies(model: &Model, at: &Configuration) -> Option<Frequencies> {
    let mut system = Direct::new(model);
    system.assemble(model, at).ok()?;
    let massless = model.free.iter().any(|dof| model.massless[*dof]);
    let highest = if massless { None } else { Some(power(model, &mut system, start(model, 0))?) };
    let scale = highest.unwrap_or_else(|| {
        let [mass, stiffness] = system.diagonals();
        stiffness.iter().sum::<f64>() / mass.iter().sum::<f64>()
    });
    let mut search = Search { model, system, least: RIGID * scale, shift: SHIFT * scale, found: Vec::new() };
    search.factor()?;
    let mut elastic = Vec::new();
    while elastic.len() < RITZ && search.found.len() < VECTORS.min(model.free.len()) {
        if search.next()? > search.least {
            elastic.push(search.found.len() - 1);
        }
    }
    let mut lowest: Vec<f64> = search.separated(&elastic).into_iter().map(f64::sqrt).collect();
    lowest.truncate(LOWEST);
    Some(Frequencies { lowest, highest: highest.map(f64::sqrt) })
}

/// Inverse iteration with deflation.
struct Search<'a> {
    model: &'a Model,
    system: Direct,
    /// The largest ω² of rigid modes.
    least: f64,
    /// σ.
    shift: f64,
    /// Modes x so far, with M x.
    found: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Search<'_> {
    /// Factors K + σM.
    fn factor(&mut self) -> Option<()> {
        let point = Arc::new(Point { mass: self.shift, stiffness: 1.0, ..Point::default() });
        self.system.factor(self.model, &point, true).ok()?;
        self.system.prepare(self.model, &Constraints::none(self.model.dimension)).ok()?;
        Some(())
    }

    /// The next Rayleigh's quotient, that of a rigid mode or of the lowest ones that are left; none
    /// if K + σM cannot be factored.
    fn next(&mut self) -> Option<f64> {
        let mut x = start(self.model, self.found.len() + 1);
        let mut square = f64::INFINITY;
        let mut rigid = 0;
        for _ in 0..ITERATIONS {
            let mut y = solved(self.model, &mut self.system, &mass_product(self.model, &x))?;
            for (mode, mass) in &self.found {
                let share = dot(&y, mass);
                y.iter_mut().zip(mode).for_each(|(y, mode)| *y -= share * mode);
            }
            let quotient = normalise(self.model, &self.system, &mut y);
            x = y;
            let is_settled = (quotient - square).abs() <= SETTLED * quotient.abs();
            square = quotient;
            // The first quotient that is round-off still has a share of deformation.
            rigid += usize::from(quotient.abs() < self.least);
            if is_settled || rigid > CLEANED {
                break;
            }
            let follows = quotient.max(NEAREST * self.least);
            if follows < FOLLOWS * self.shift {
                self.shift = follows;
                self.factor()?;
            }
        }
        let mass = mass_product(self.model, &x);
        self.found.push((x, mass));
        Some(square)
    }

    /// ω² in the span of some of the modes, ascending (W. Ritz).
    fn separated(&self, modes: &[usize]) -> Vec<f64> {
        let mut small = Mat::<RITZ>::ZERO;
        for (i, &mode) in modes.iter().enumerate() {
            let mut force = vec![0.0; self.model.free.len()];
            self.system.stiffness_product(&self.found[mode].0, &mut force);
            for (j, &other) in modes.iter().enumerate() {
                small.0[i][j] = dot(&self.found[other].0, &force);
            }
        }
        // Vectors that are missing have zeros.
        let mut squares: Vec<f64> =
            principal_axes(&small).values.into_iter().filter(|x| *x > self.least).collect();
        squares.sort_by(f64::total_cmp);
        squares
    }
}

/// Where the iteration of a mode begins.
fn start(model: &Model, mode: usize) -> Vec<f64> {
    (0..model.free.len()).map(|i| ((12.9898 + mode as f64) * (i as f64 + 1.0)).sin()).collect()
}

/// Frequency of the stiffest contact spring on its node; none without springs, or if a node is
/// massless.
pub fn spring(model: &Model) -> Option<f64> {
    if model.contacts.iter().all(|c| c.interface.is_constraint())
        || model.free.iter().any(|dof| model.massless[*dof])
    {
        return None;
    }
    let mut system = Direct::new(model);
    system.assemble(model, &Configuration::at(&model.reference)).ok()?;
    system.form_mass(model, &Constraints::none(model.dimension)).ok()?;
    let mut highest: Option<f64> = None;
    let springs = model.contacts.iter().flat_map(|contact| {
        let springs = contact.springs.iter();
        springs.flat_map(|springs| {
            let factor = springs.factors[0];
            let nodes = contact.kinematics.secondary().iter().zip(&springs.diagonal.of_rows);
            nodes.map(move |(node, diagonal)| (*node, factor * diagonal))
        })
    });
    for (node, stiffness) in springs {
        for (i, _) in model.free.iter().enumerate().filter(|(_, dof)| **dof / model.dimension == node) {
            let mut unit = vec![0.0; model.free.len()];
            unit[i] = 1.0;
            let square = stiffness * solved(model, &mut system, &unit)?[i];
            highest = Some(highest.map_or(square, |h| h.max(square)));
        }
    }
    highest.map(f64::sqrt)
}

fn power(model: &Model, system: &mut Direct, mut x: Vec<f64>) -> Option<f64> {
    system.form_mass(model, &Constraints::none(model.dimension)).ok()?;
    let mut square = 0.0;
    for _ in 0..ITERATIONS {
        let quotient = normalise(model, system, &mut x);
        if (quotient - square).abs() <= 1e-6 * quotient {
            return Some(quotient);
        }
        square = quotient;
        let mut force = vec![0.0; x.len()];
        system.stiffness_product(&x, &mut force);
        x = solved(model, system, &force)?;
    }
    Some(square)
}

/// Solves with the last factor for a right-hand side on the free dofs.
fn solved(model: &Model, system: &mut Direct, right: &[f64]) -> Option<Vec<f64>> {
    let mut forces = vec![0.0; model.dofs()];
    let mut answer = vec![0.0; model.dofs()];
    model.free.iter().zip(right).for_each(|(dof, f)| forces[*dof] = *f);
    system.solve(model, [&forces, &[]], &mut answer, &mut Vec::new()).ok()?;
    Some(model.free.iter().map(|dof| answer[*dof]).collect())
}

/// Scales to xᵀMx = 1; returns Rayleigh's quotient.
fn normalise(model: &Model, system: &Direct, x: &mut [f64]) -> f64 {
    let weight = dot(x, &mass_product(model, x)).sqrt();
    x.iter_mut().for_each(|x| *x /= weight);
    let mut force = vec![0.0; x.len()];
    system.stiffness_product(x, &mut force);
    dot(x, &force)
}

/// M x on the free dofs.
fn mass_product(model: &Model, x: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; model.dofs()];
    model.free.iter().zip(x).for_each(|(dof, x)| all[*dof] = *x);
    model.points.carry(&mut all);
    let mut product = vec![0.0; all.len()];
    model.mass.multiply_into(&all, &mut product);
    model.points.gather(&mut product);
    model.free.iter().map(|dof| product[*dof]).collect()
}
