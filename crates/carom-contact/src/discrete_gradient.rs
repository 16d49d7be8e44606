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
//! A node and the point of an obstacle on which it rests may have no distance: nothing but
//! round-off is left of d and of m = ΔG − ∇G·Δy then, and their quotient would be any direction.
//! With the round-off ν of m, m − ν²/m takes its place, and zero where |m| ≤ ν.
//!
//! Both gaps refer to one facet. A closed pair that is handed over had a gap J to the extension of
//! its new facet; its force does the work −λJ. With G_n = 0 instead, the correction would have to
//! account for J too, which it can only by turning the force by any angle where J is not small
//! against d.
//!
//! With the rotations G_i about the axes, J = [0 −1; 1 0] alone in the plane, x = y_½ − ȳ_½,
//! r_i = G_i x, c = Δy − t, M_ij = r_i·r_j and C the removal of the mean over the nodes:
//!
//! ```text
//! ω = M⁻¹ (r_i·c),   d = c − Σ ω_i r_i,   ∂d/∂y_{n+1} = C − Σ r_i ⊗ Cω_i' − ½ Σ ω_i G_i C
//! ω' = M⁻¹ (r_i − ½ G_i d + ½ Σ_j ω_j G_j r_i)
//! ```
//!
//! Where all nodes lie on a line, M⁻¹ leaves out the rotation about it, which moves none.

use crate::rows::Row;

/// Regularisation ε of the discrete gradient, relative to the size of the stencil.
const ROUND_OFF: f64 = 1e-7;

/// Round-off ν of ΔG − ∇G·Δy, relative to Σ |∂G/∂y| (|y| + |Δy|).
const NOISE: f64 = 16.0 * f64::EPSILON;

/// The discrete gradient of one gap, and buffers. All vectors are over the dofs of the gap's row.
#[derive(Clone, Debug, Default)]
pub struct DiscreteGradient {
    dimension: usize,
    /// Gradient ∇G(y_½) of the gap at the midpoint.
    middle: Vec<f64>,
    gradient: Vec<f64>,
    /// Increment Δy of the nodes of the gap.
    moved: Vec<f64>,
    /// Increment without its mean, Δy − t.
    centred: Vec<f64>,
    /// Midpoint positions x of the nodes relative to their mean.
    arms: Vec<f64>,
    /// Arms turned by each rotation, r_i = G_i x, one vector after the other.
    turned: Vec<f64>,
    /// Increment without its rigid part, d.
    deforming: Vec<f64>,
    /// Rigid rotation ω in the increment, by components.
    rotation: [f64; 3],
    /// Inverse M⁻¹ of the matrix of the arms' scalar products.
    inverse: [[f64; 3]; 3],
    /// Derivatives ω' of the rotation by the end positions, one vector per component.
    spins: Vec<f64>,
    /// Factor α of the correction along d.
    factor: f64,
    /// Denominator |d|² + ε² of the factor α.
    size: f64,
    /// Derivative of the numerator of α by m = ΔG − ∇G·Δy.
    share: f64,
    /// Gradient of the factor α by the end positions.
    slope: Vec<f64>,
}

impl DiscreteGradient {
    /// Evaluates the discrete gradient from the row of the gap at the midpoint y_½ and the change
    /// ΔG of the gap over the step, with y_½ and Δy flat over all dofs.
    pub fn evaluate(&mut self, middle: Row, change: f64, y: &[f64], increment: &[f64]) {
        let d = middle.dimension();
        self.dimension = d;
        self.middle.clear();
        self.middle.extend_from_slice(middle.gradient);
        gather(middle, y, &mut self.arms);
        gather(middle, increment, &mut self.moved);
        let sizes = self.arms.iter().zip(&self.moved).map(|(y, moved)| y.abs() + moved.abs());
        let terms: f64 = self.middle.iter().zip(sizes).map(|(slope, size)| slope.abs() * size).sum();
        self.centred.clone_from(&self.moved);
        remove_mean(&mut self.arms, d);
        remove_mean(&mut self.centred, d);
        self.rotate();
        // The stencil at the step's start: ε is constant over the iterations.
        let start = self.arms.iter().zip(&self.centred).map(|(x, c)| x - 0.5 * c);
        let stencil: f64 = start.map(|x| x * x).sum();
        let deformed = dot(&self.deforming, &self.deforming);
        self.size = deformed + ROUND_OFF * ROUND_OFF * stencil;
        let missing = change - dot(&self.middle, &self.moved);
        let noise = (NOISE * terms / missing).abs();
        let is_noise = missing == 0.0 || noise >= 1.0;
        self.share = if is_noise { 0.0 } else { 1.0 + noise * noise };
        let counted = if is_noise { 0.0 } else { missing * (1.0 - noise * noise) };
        // In one dimension the gap is linear.
        self.factor = if d > 1 && self.size > 0.0 { counted / self.size } else { 0.0 };
        self.gradient.clear();
        let corrected = |(g, d): (&f64, &f64)| g + self.factor * d;
        self.gradient.extend(self.middle.iter().zip(&self.deforming).map(corrected));
    }

    /// Determines the rotation ω of the increment, and d, the increment without it.
    fn rotate(&mut self) {
        let Self { dimension, arms, turned, centred, deforming, rotation, inverse, .. } = self;
        let count = rotations(*dimension);
        let n = arms.len();
        turned.clear();
        for i in 0..count {
            turned.extend((0..n).map(|q| turned_entry(arms, *dimension, i, q)));
        }
        let r = |i: usize| &turned[i * n..(i + 1) * n];
        let mut moments = [[0.0; 3]; 3];
        for (i, k) in (0..count).flat_map(|i| (0..count).map(move |k| (i, k))) {
            moments[i][k] = dot(r(i), r(k));
        }
        *inverse = inverted(moments, count);
        let driven: [f64; 3] = std::array::from_fn(|i| if i < count { dot(r(i), centred) } else { 0.0 });
        *rotation = std::array::from_fn(|i| (0..count).map(|k| inverse[i][k] * driven[k]).sum());
        deforming.clone_from(centred);
        for i in 0..count {
            deforming.iter_mut().zip(r(i)).for_each(|(d, r)| *d -= rotation[i] * r);
        }
    }

    /// The discrete gradient ∇̄G, node-major as the gradient of a row.
    pub fn gradient(&self) -> &[f64] {
        &self.gradient
    }

    /// Replaces the second derivative ∇²G(y_½) of the gap, row-major in `matrix`, by the derivative
    /// ∂∇̄G/∂y_{n+1} of its discrete gradient, which is not symmetric; `end`: the row at y_{n+1}.
    pub fn derivative_into(&mut self, end: Row, matrix: &mut [f64]) {
        let n = self.middle.len();
        let d = self.dimension;
        let Self { turned, deforming, middle, moved, slope, spins, rotation, inverse, .. } = self;
        let count = rotations(d);
        let factor = self.factor;
        let size = self.size;
        let share = self.share;
        // Σ ω_j G_j of a vector.
        let spun = |vector: &[f64], q: usize| -> f64 {
            (0..count).map(|j| rotation[j] * turned_entry(vector, d, j, q)).sum()
        };
        let r = |i: usize| &turned[i * n..(i + 1) * n];
        spins.clear();
        spins.resize(count * n, 0.0);
        for k in 0..count {
            for q in 0..n {
                let slope = r(k)[q] - 0.5 * turned_entry(deforming, d, k, q) + 0.5 * spun(r(k), q);
                (0..count).for_each(|i| spins[i * n + q] += inverse[i][k] * slope);
            }
        }
        slope.clear();
        slope.resize(n, 0.0);
        for (q, slope) in slope.iter_mut().enumerate().filter(|_| factor != 0.0) {
            let bent = 0.5 * dot(&matrix[q * n..(q + 1) * n], moved);
            let longer = deforming[q] + 0.5 * spun(deforming, q);
            let numerator = share * (end.gradient[q] - middle[q] - bent);
            *slope = (numerator - 2.0 * factor * longer) / size;
        }
        let nodes = (n / d.max(1)) as f64;
        // Σ ω_j G_j of the unit vector of component q, at component p of the same node.
        let turning =
            |p: usize, q: usize| -> f64 { (0..count).map(|j| rotation[j] * generator(d, j, p, q)).sum() };
        for p in 0..n {
            for q in 0..n {
                let same = f64::from(u8::from(p / d == q / d)) - nodes.recip();
                let centring = if p % d == q % d { same } else { 0.0 };
                let rotating: f64 = (0..count).map(|i| r(i)[p] * spins[i * n + q]).sum();
                let deformation = centring - rotating - 0.5 * same * turning(p % d, q % d);
                let entry = &mut matrix[p * n + q];
                *entry = 0.5 * *entry + deforming[p] * slope[q] + factor * deformation;
            }
        }
    }
}

/// Number of independent rotations in a space of `d` dimensions.
fn rotations(d: usize) -> usize {
    [0, 0, 1, 3][d.min(3)]
}

/// Entry of the i-th generator of rotations, a d × d matrix, at row `p` and column `q`.
fn generator(d: usize, i: usize, p: usize, q: usize) -> f64 {
    // About the i-th axis; in the plane about the third one.
    let axis = if d == 2 { 2 } else { i };
    match ((p + 3 - axis) % 3, (q + 3 - axis) % 3) {
        (1, 2) => -1.0,
        (2, 1) => 1.0,
        _ => 0.0,
    }
}

/// Entry `q` of a nodal vector to whose nodes the i-th generator of rotations is applied.
fn turned_entry(vector: &[f64], d: usize, i: usize, q: usize) -> f64 {
    let first = q - q % d;
    (0..d).map(|k| generator(d, i, q % d, k) * vector[first + k]).sum()
}

/// Inverse of a symmetric matrix of `count` rows without its null space, by elimination: a pivot of
/// round-off leaves its row out.
fn inverted(mut matrix: [[f64; 3]; 3], count: usize) -> [[f64; 3]; 3] {
    let mut inverse = [[0.0; 3]; 3];
    let trace: f64 = (0..count).map(|i| matrix[i][i]).sum();
    let mut order: Vec<usize> = (0..count).collect();
    let mut kept = Vec::new();
    while let Some(place) = (0..order.len())
        .max_by(|&a, &b| matrix[order[a]][order[a]].total_cmp(&matrix[order[b]][order[b]]))
        .filter(|&place| matrix[order[place]][order[place]] > 1e-12 * trace)
    {
        let pivot = order.swap_remove(place);
        for &row in &order {
            let factor = matrix[row][pivot] / matrix[pivot][pivot];
            (0..count).for_each(|k| matrix[row][k] -= factor * matrix[pivot][k]);
            (0..count).for_each(|k| inverse[row][k] -= factor * inverse[pivot][k]);
            inverse[row][pivot] -= factor;
        }
        inverse[pivot][pivot] += 1.0;
        kept.push(pivot);
    }
    // Rows that were left out have no rotation.
    for &row in &order {
        inverse[row] = [0.0; 3];
        (0..count).for_each(|k| inverse[k][row] = 0.0);
    }
    for at in (0..kept.len()).rev() {
        let row = kept[at];
        for &later in &kept[at + 1..] {
            let factor = matrix[row][later];
            (0..count).for_each(|k| inverse[row][k] -= factor * inverse[later][k]);
        }
        let pivot = matrix[row][row];
        (0..count).for_each(|k| inverse[row][k] /= pivot);
    }
    inverse
}

/// Collects the entries of a vector over all dofs at the nodes of a row.
fn gather(row: Row, all: &[f64], part: &mut Vec<f64>) {
    part.clear();
    part.extend(row.entries().map(|(dof, _)| all[dof]));
}

/// Subtracts the mean over the nodes from a nodal vector with `d` components per node.
fn remove_mean(vector: &mut [f64], d: usize) {
    let nodes = (vector.len() / d.max(1)) as f64;
    for i in 0..d {
        let mean = vector.iter().skip(i).step_by(d).sum::<f64>() / nodes;
        vector.iter_mut().skip(i).step_by(d).for_each(|x| *x -= mean);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
