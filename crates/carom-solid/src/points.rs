//! Quadrature points in lanes: sums over the nodes of a cell, for the four points of a register.
//!
//! Each lane is a point; lanes are added at the end, (0 + 1) + (2 + 3). The order of every sum is
//! fixed, so results are bitwise equal on every machine.

use carom_algebra::{Four, Mat, Vector, wide};

/// Number of lanes: doubles in a register of 256 bits.
pub const LANES: usize = 4;

/// A number at each of the points.
pub(crate) type Lanes = [f64; LANES];

/// A matrix at each of the points: `[i][j][point]`.
pub(crate) type Mats<const D: usize> = [[Lanes; D]; D];

/// The blocks Kᵐⁿ, m ≤ n, of a tangent as `[n][m]`, before the sum over lanes.
pub(crate) type Blocks<const D: usize, const N: usize> = [[Mats<D>; N]; N];

/// The maps (∂X/∂ξ)⁻¹ and weights of four consecutive cells with one point each.
pub(crate) struct Packed<const D: usize> {
    pub(crate) maps: Mats<D>,
    pub(crate) weights: Lanes,
}

/// Up to four quadrature points of one cell, or of all cells that share them up to an affine map.
pub(crate) struct Points<const D: usize, const N: usize> {
    /// Gradients of φᵃ as `[a][j][point]`; zero in unused lanes.
    pub(crate) gradients: [[Lanes; D]; N],
    /// Weights, including the volume factor.
    pub(crate) weights: Lanes,
    /// Number of points.
    pub(crate) count: usize,
}

impl<const D: usize, const N: usize> Points<D, N> {
    /// From the gradients and weights of one to four points.
    pub(crate) fn new(points: &[([Vector<D>; N], f64)]) -> Self {
        let mut packed =
            Self { gradients: [[[0.0; LANES]; D]; N], weights: [0.0; LANES], count: points.len() };
        for (l, (gradients, weight)) in points.iter().enumerate() {
            for a in 0..N {
                for j in 0..D {
                    packed.gradients[a][j][l] = gradients[a][j];
                }
            }
            packed.weights[l] = *weight;
        }
        packed
    }

    /// H = Σ uᵃ ⊗ ∇₀φᵃ with ∇₀φᵃ = Aᵀ∇φᵃ. This and the following sums are compiled once for a
    /// shape, for wide registers, not wherever they are called.
    #[inline(never)]
    pub(crate) fn gradient(&self, u: &[Vector<D>; N], a: &Mat<D>) -> Mats<D> {
        wide(
            #[inline(always)]
            || {
                let mut h = [[[0.0; LANES]; D]; D];
                for n in 0..N {
                    for i in 0..D {
                        for j in 0..D {
                            add_product(&mut h[i][j], &[u[n][i]; LANES], &self.gradients[n][j]);
                        }
                    }
                }
                times(&h, a)
            },
        )
    }

    /// fᵃ += P Aᵀ∇φᵃ, with stresses multiplied by the weight.
    #[inline(never)]
    pub(crate) fn add_force(&self, stress: &Mats<D>, a: &Mat<D>, force: &mut [[Lanes; D]; N]) {
        wide(
            #[inline(always)]
            || {
                let stress = times(stress, &a.transposed());
                for n in 0..N {
                    for i in 0..D {
                        for j in 0..D {
                            add_product(&mut force[n][i], &stress[i][j], &self.gradients[n][j]);
                        }
                    }
                }
            },
        );
    }

    /// Kᵐⁿ += ∂P/∂F : Aᵀ∇φᵐ Aᵀ∇φⁿ, with moduli multiplied by the weight. K is bilinear in the
    /// gradients: the law is evaluated for unit vectors only.
    #[inline(never)]
    pub(crate) fn add_tangent(&self, moduli: &[[Mats<D>; D]; D], a: &Mat<D>, blocks: &mut Blocks<D, N>) {
        wide(
            #[inline(always)]
            || {
                let moduli = pulled_back(moduli, a);
                for n in 0..N {
                    let mut half = [[[[0.0; LANES]; D]; D]; D];
                    for j in 0..D {
                        for l in 0..D {
                            add_products(&mut half[j], &moduli[j][l], &self.gradients[n][l]);
                        }
                    }
                    for m in 0..=n {
                        let mut block = blocks[n][m];
                        for j in 0..D {
                            add_products(&mut block, &half[j], &self.gradients[m][j]);
                        }
                        blocks[n][m] = block;
                    }
                }
            },
        );
    }
}

/// Stores the matrix of one point.
#[inline(always)]
pub(crate) fn set<const D: usize>(mats: &mut Mats<D>, point: usize, of: &Mat<D>) {
    for i in 0..D {
        for j in 0..D {
            mats[i][j][point] = of.0[i][j];
        }
    }
}

/// The matrix of one point.
#[inline(always)]
pub(crate) fn get<const D: usize>(mats: &Mats<D>, point: usize) -> Mat<D> {
    let mut mat = Mat::ZERO;
    for i in 0..D {
        for j in 0..D {
            mat.0[i][j] = mats[i][j][point];
        }
    }
    mat
}

/// A matrix of lanes.
#[inline(always)]
pub(crate) fn four<const D: usize>(mats: &Mats<D>) -> Mat<D, Four> {
    let mut mat = Mat::ZERO;
    for i in 0..D {
        for j in 0..D {
            mat.0[i][j] = Four(mats[i][j]);
        }
    }
    mat
}

/// The lanes of a matrix.
#[inline(always)]
pub(crate) fn lanes<const D: usize>(mat: &Mat<D, Four>) -> Mats<D> {
    let mut mats = [[[0.0; LANES]; D]; D];
    for i in 0..D {
        for j in 0..D {
            mats[i][j] = mat.0[i][j].0;
        }
    }
    mats
}

/// Sum over the points.
#[inline(always)]
pub(crate) fn sum(lanes: &Lanes) -> f64 {
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3])
}

/// B A at each of the points.
#[inline(always)]
fn times<const D: usize>(b: &Mats<D>, a: &Mat<D>) -> Mats<D> {
    let mut product = [[[0.0; LANES]; D]; D];
    for i in 0..D {
        for j in 0..D {
            for k in 0..D {
                add_product(&mut product[i][j], &b[i][k], &[a.0[k][j]; LANES]);
            }
        }
    }
    product
}

/// Applies A to the gradient indices of the moduli: Σ A(m, j) A(n, l) moduli(j, l).
#[inline(always)]
fn pulled_back<const D: usize>(moduli: &[[Mats<D>; D]; D], a: &Mat<D>) -> [[Mats<D>; D]; D] {
    let zero = [[[[[0.0; LANES]; D]; D]; D]; D];
    let mut half = zero;
    let mut whole = zero;
    for m in 0..D {
        for j in 0..D {
            for l in 0..D {
                add_products(&mut half[m][l], &moduli[j][l], &[a.0[m][j]; LANES]);
            }
        }
        for n in 0..D {
            for l in 0..D {
                add_products(&mut whole[m][n], &half[m][l], &[a.0[n][l]; LANES]);
            }
        }
    }
    whole
}

#[inline(always)]
fn add_products<const D: usize>(sum: &mut Mats<D>, a: &Mats<D>, b: &Lanes) {
    for i in 0..D {
        for j in 0..D {
            add_product(&mut sum[i][j], &a[i][j], b);
        }
    }
}

#[inline(always)]
fn add_product(sum: &mut Lanes, a: &Lanes, b: &Lanes) {
    for l in 0..LANES {
        sum[l] += a[l] * b[l];
    }
}
