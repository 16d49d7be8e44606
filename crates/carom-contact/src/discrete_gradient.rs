//! The direction of a frictionless contact force over a step: a discrete gradient of the gap G
//! between y_n and y_{n+1}, with y_½ = (y_n + y_{n+1})/2.
//!
//! ```text
//! ∇̄G = ∇G(y_½) + α d,   α = (ΔG − ∇G(y_½)·Δy) / (|d|² + ε²),   ΔG = G_{n+1} − G_n
//! d  = Δy − t − ω × (y_½ − ȳ_½),   t, ω: least squares over the nodes of the gap
//! ```
//!
//! Then Δy·∇̄G = ΔG, Σ f = 0 and Σ y_½ × f = 0: the force of a gap that stays closed does no work,
//! and has neither a resultant nor a moment. O. Gonzalez (2000) corrects along Δy itself, whose
//! rotation gives the force a moment; C. Hesch and P. Betsch (2009) avoid it with invariants of the
//! gap. d = Δy − (rigid part) needs no invariants. ε suppresses quotients of round-off where the
//! nodes move as a rigid body: the work is then wrong by less than ε |ΔG − ∇G·Δy| / |d|.
//!
//! Both gaps refer to one facet. A closed pair that is handed over had a gap J to the extension of
//! its new facet; its force does the work −λJ. With G_n = 0 instead, the correction would have to
//! account for J too, which it can only by turning the force by any angle where J is not small
//! against d.
//!
//! In the plane there is one rotation ω with the arm r = J x, x = y_½ − ȳ_½, J = [0 −1; 1 0], and
//! with c = Δy − t
//!
//! ```text
//! ω = r·c / r·r,   d = c − ω r,   ∂d/∂y_{n+1} = C − r ⊗ ω' − ½ ω J C,   ω' = (r − ½ J c − ω x) / r·r
//! ```
//!
//! with C the removal of the mean over the nodes.

use crate::rows::Row;

/// ε, relative to the size of the stencil.
const ROUND_OFF: f64 = 1e-7;

/// The discrete gradient of one gap, and buffers. All vectors are over the dofs of the gap's row.
#[derive(Clone, Debug, Default)]
pub struct DiscreteGradient {
    dimension: usize,
    /// ∇G(y_½).
    middle: Vec<f64>,
    gradient: Vec<f64>,
    /// Δy, then Δy − t.
    moved: Vec<f64>,
    centred: Vec<f64>,
    /// x and r.
    arms: Vec<f64>,
    turned: Vec<f64>,
    /// d.
    deforming: Vec<f64>,
    /// ω and r·r.
    rotation: f64,
    inertia: f64,
    /// α and |d|² + ε².
    factor: f64,
    size: f64,
    /// Gradient of α.
    slope: Vec<f64>,
}

impl DiscreteGradient {
    /// Evaluates it from the row at y_½ and the change ΔG, with y_½ and Δy flat over all dofs.
    pub fn evaluate(&mut self, middle: Row, change: f64, y: &[f64], increment: &[f64]) {
        let d = middle.dimension();
        debug_assert!(d <= 2 || middle.nodes.len() == 1, "rotations in space are not there yet");
        self.dimension = d;
        self.middle.clear();
        self.middle.extend_from_slice(middle.gradient);
        gather(middle, y, &mut self.arms);
        gather(middle, increment, &mut self.moved);
        self.centred.clone_from(&self.moved);
        remove_mean(&mut self.arms, d);
        remove_mean(&mut self.centred, d);
        turn_into(&self.arms, d, &mut self.turned);
        self.inertia = dot(&self.turned, &self.turned);
        self.rotation =
            if self.inertia > 0.0 { dot(&self.turned, &self.centred) / self.inertia } else { 0.0 };
        self.deforming.clear();
        let part = |(c, r): (&f64, &f64)| c - self.rotation * r;
        self.deforming.extend(self.centred.iter().zip(&self.turned).map(part));
        // The stencil at the step's start: ε is constant over the iterations.
        let start = self.arms.iter().zip(&self.centred).map(|(x, c)| x - 0.5 * c);
        let stencil: f64 = start.map(|x| x * x).sum();
        let deformed = dot(&self.deforming, &self.deforming);
        self.size = deformed + ROUND_OFF * ROUND_OFF * stencil;
        let missing = change - dot(&self.middle, &self.moved);
        // In one dimension the gap is linear.
        self.factor = if d > 1 && self.size > 0.0 { missing / self.size } else { 0.0 };
        self.gradient.clear();
        let corrected = |(g, d): (&f64, &f64)| g + self.factor * d;
        self.gradient.extend(self.middle.iter().zip(&self.deforming).map(corrected));
    }

    /// ∇̄G, node-major as the gradient of the row.
    pub fn gradient(&self) -> &[f64] {
        &self.gradient
    }

    /// Replaces ∇²G(y_½), row-major in `matrix`, by ∂∇̄G/∂y_{n+1}; `end`: the row at y_{n+1}. It is
    /// not symmetric.
    pub fn derivative_into(&mut self, end: Row, matrix: &mut [f64]) {
        let (n, d) = (self.middle.len(), self.dimension);
        let Self { arms, turned, centred, deforming, middle, moved, slope, .. } = self;
        let (rotation, factor, size) = (self.rotation, self.factor, self.size);
        let turn = |vector: &[f64], i: usize| turned_entry(vector, d, i);
        let of_rotation = |q: usize| {
            let slope = turned[q] - 0.5 * turn(centred, q) - rotation * arms[q];
            if self.inertia > 0.0 { slope / self.inertia } else { 0.0 }
        };
        slope.clear();
        slope.resize(n, 0.0);
        for (q, slope) in slope.iter_mut().enumerate().filter(|_| d > 1 && size > 0.0) {
            let bent = 0.5 * dot(&matrix[q * n..(q + 1) * n], moved);
            let longer = deforming[q] + 0.5 * rotation * turn(deforming, q);
            *slope = (end.gradient[q] - middle[q] - bent - 2.0 * factor * longer) / size;
        }
        let nodes = (n / d.max(1)) as f64;
        for p in 0..n {
            for q in 0..n {
                let same = f64::from(u8::from(p / d == q / d)) - nodes.recip();
                let centring = if p % d == q % d { same } else { 0.0 };
                let turning = match (d, p % d, q % d) {
                    (2, 0, 1) => -same,
                    (2, 1, 0) => same,
                    _ => 0.0,
                };
                let deformation = centring - turned[p] * of_rotation(q) - 0.5 * rotation * turning;
                let entry = &mut matrix[p * n + q];
                *entry = 0.5 * *entry + deforming[p] * slope[q] + factor * deformation;
            }
        }
    }
}

/// The entries of a vector over all dofs at the nodes of a row.
fn gather(row: Row, all: &[f64], part: &mut Vec<f64>) {
    part.clear();
    part.extend(row.entries().map(|(dof, _)| all[dof]));
}

/// Subtracts the mean over the nodes.
fn remove_mean(vector: &mut [f64], d: usize) {
    let nodes = (vector.len() / d.max(1)) as f64;
    for i in 0..d {
        let mean = vector.iter().skip(i).step_by(d).sum::<f64>() / nodes;
        vector.iter_mut().skip(i).step_by(d).for_each(|x| *x -= mean);
    }
}

/// J times a vector of the plane, node by node; zero in one dimension.
fn turn_into(vector: &[f64], d: usize, turned: &mut Vec<f64>) {
    turned.clear();
    turned.extend((0..vector.len()).map(|i| turned_entry(vector, d, i)));
}

fn turned_entry(vector: &[f64], d: usize, i: usize) -> f64 {
    match (d, i % 2) {
        (2, 0) => -vector[i + 1],
        (2, _) => vector[i - 1],
        _ => 0.0,
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
