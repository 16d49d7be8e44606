//! Vectors and matrices of the body's space: `D` is 1, 2 or 3 and known at compile time.
//!
//! Entries of matrices are numbers, or four in lanes (`real.rs`). Global nodal arrays are flat
//! `Vec<f64>`, viewed per node as `&[[f64; D]]` (`slice::as_chunks`). A [`Vector`] is the copy of
//! one node with arithmetic.

use std::ops::{Add, AddAssign, Index, IndexMut, Mul, Neg, Sub, SubAssign};

use crate::real::Real;

/// A vector of `D` components.
///
/// ```
/// use carom_algebra::Vector;
/// assert_eq!(Vector([3.0, 4.0]).norm(), 5.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<const D: usize>(pub [f64; D]);

/// A `D × D` matrix, row by row.
///
/// ```
/// use carom_algebra::Mat;
/// assert_eq!(Mat([[2.0, 1.0], [4.0, 5.0]]).det(), 6.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mat<const D: usize, T = f64>(pub [[T; D]; D]);

/// Sum Σ aᵢ b(i) in ascending order.
#[inline(always)]
fn product<const D: usize, T: Real>(a: &[T; D], b: impl Fn(usize) -> T) -> T {
    let mut sum = T::ZERO;
    for i in 0..D {
        sum = sum + a[i] * b(i);
    }
    sum
}

impl<const D: usize> Vector<D> {
    /// The zero vector.
    pub const ZERO: Self = Self([0.0; D]);

    /// A vector from its components. A loop, because `std::array::from_fn` is not always inlined,
    /// and this arithmetic runs in the innermost loops.
    #[inline(always)]
    fn of(component: impl Fn(usize) -> f64) -> Self {
        let mut vector = Self::ZERO;
        for i in 0..D {
            vector.0[i] = component(i);
        }
        vector
    }

    /// Scalar product of two vectors.
    #[inline(always)]
    pub fn dot(&self, other: &Self) -> f64 {
        product(&self.0, |i| other.0[i])
    }

    /// Euclidean length of the vector.
    #[inline(always)]
    pub fn norm(&self) -> f64 {
        self.dot(self).sqrt()
    }

    /// Dyadic product `self ⊗ other`.
    #[inline(always)]
    pub fn outer(&self, other: &Self) -> Mat<D> {
        Mat::of(|i, j| self.0[i] * other.0[j])
    }
}

impl Vector<2> {
    /// The vector rotated by −90°: the outward normal of a boundary traversed with the body on its
    /// left.
    #[inline(always)]
    pub fn turned_right(&self) -> Self {
        Self([self.0[1], -self.0[0]])
    }
}

impl<const D: usize, T: Real> Mat<D, T> {
    /// The zero matrix.
    pub const ZERO: Self = Self([[T::ZERO; D]; D]);

    /// A matrix from its components.
    #[inline(always)]
    fn of(component: impl Fn(usize, usize) -> T) -> Self {
        let mut mat = Self::ZERO;
        for i in 0..D {
            for j in 0..D {
                mat.0[i][j] = component(i, j);
            }
        }
        mat
    }

    /// The identity matrix.
    #[inline(always)]
    pub fn identity() -> Self {
        Self::of(|i, j| T::of(f64::from(u8::from(i == j))))
    }

    /// Transposed matrix.
    #[inline(always)]
    pub fn transposed(&self) -> Self {
        Self::of(|i, j| self.0[j][i])
    }

    /// Trace: the sum of the diagonal entries.
    #[inline(always)]
    pub fn trace(&self) -> T {
        let mut sum = self.0[0][0];
        for i in 1..D {
            sum = sum + self.0[i][i];
        }
        sum
    }

    /// Double contraction `A : B` = Σ A_ij B_ij of two matrices.
    #[inline(always)]
    pub fn double_dot(&self, other: &Self) -> T {
        let mut sum = T::ZERO;
        for i in 0..D {
            sum = sum + product(&self.0[i], |j| other.0[i][j]);
        }
        sum
    }

    /// Matrix of cofactors, `det(A) A⁻ᵀ`; also defined for singular matrices.
    #[inline(always)]
    pub fn cofactor(&self) -> Self {
        let a = &self.0;
        let mut c = Self::ZERO;
        match D {
            1 => c.0[0][0] = T::of(1.0),
            2 => {
                c.0[0][0] = a[1][1];
                c.0[0][1] = -a[1][0];
                c.0[1][0] = -a[0][1];
                c.0[1][1] = a[0][0];
            }
            _ => {
                for i in 0..D {
                    for j in 0..D {
                        let i1 = (i + 1) % D;
                        let i2 = (i + 2) % D;
                        let j1 = (j + 1) % D;
                        let j2 = (j + 2) % D;
                        c.0[i][j] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
                    }
                }
            }
        }
        c
    }

    /// Inverse matrix; its entries are not finite if the determinant is zero.
    #[inline(always)]
    #[must_use]
    pub fn inverse(&self) -> Self {
        self.cofactor().transposed() * (T::of(1.0) / self.det())
    }

    /// Determinant of the matrix.
    #[inline(always)]
    pub fn det(&self) -> T {
        let c = self.cofactor();
        product(&self.0[0], |j| c.0[0][j])
    }
}

impl<const D: usize> Mat<D> {
    /// Product of the matrix with a vector.
    #[inline(always)]
    pub fn apply(&self, v: &Vector<D>) -> Vector<D> {
        Vector::of(|i| product(&self.0[i], |j| v.0[j]))
    }
}

impl<const D: usize> Index<usize> for Vector<D> {
    type Output = f64;
    #[inline(always)]
    fn index(&self, i: usize) -> &f64 {
        &self.0[i]
    }
}

impl<const D: usize> IndexMut<usize> for Vector<D> {
    #[inline(always)]
    fn index_mut(&mut self, i: usize) -> &mut f64 {
        &mut self.0[i]
    }
}

impl<const D: usize> Add for Vector<D> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::of(|i| self.0[i] + other.0[i])
    }
}

impl<const D: usize> Sub for Vector<D> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::of(|i| self.0[i] - other.0[i])
    }
}

impl<const D: usize> Neg for Vector<D> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::of(|i| -self.0[i])
    }
}

impl<const D: usize> Mul<f64> for Vector<D> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self::of(|i| self.0[i] * factor)
    }
}

impl<const D: usize> AddAssign for Vector<D> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const D: usize> SubAssign for Vector<D> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const D: usize, T: Real> Add for Mat<D, T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::of(|i, j| self.0[i][j] + other.0[i][j])
    }
}

impl<const D: usize, T: Real> Sub for Mat<D, T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::of(|i, j| self.0[i][j] - other.0[i][j])
    }
}

impl<const D: usize, T: Real> Mul<T> for Mat<D, T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Self::of(|i, j| self.0[i][j] * factor)
    }
}

impl<const D: usize, T: Real> Mul for Mat<D, T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::of(|i, j| product(&self.0[i], |k| other.0[k][j]))
    }
}

impl<const D: usize, T: Real> AddAssign for Mat<D, T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
