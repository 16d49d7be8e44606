//! The part of a secondary facet that faces one facet of the primary, integrated once for all
//! multipliers: with the polynomial of each,
//!
//! ```text
//! ∫ B_j g dΓ,   ∫ B_j ∇g dΓ,   ∫ B_j ∇²g dΓ     over the nodes of both facets,
//! ```
//!
//! and the same of the slip, whose row stands in place of ∇g and its derivative in place of ∇²g.
//! The derivatives by the point x = Σ_a N_a(ξ) y_a and the nodes opposite become those by the nodes
//! of both facets by the chain rule, with the constant weights N_a.

use carom_algebra::{Vector, wide};
use carom_solid::LineShape;

use super::cut::Opposed;
use super::multipliers::MOST;
use super::opposite::PointGap;
use super::turned::{self, Turned};
use crate::pair::{ContactError, Pair};

/// Most nodes of a facet in the plane.
pub(super) const NODES: usize = 4;
/// Most nodes of two facets.
const BOTH: usize = 2 * NODES;
/// Most components of the vectors on which the gap of a point depends.
const OF_POINT: usize = 2 * turned::MOST;

/// A quantity that is integrated: the gap, whose rows are gradients, or the slip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Gap,
    Slip,
}

/// A point of quadrature with the gap there.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    pub(super) at: Opposed,
    pub(super) gap: PointGap,
    /// Weight of quadrature, over the reference surface, times that with which the point faces the
    /// primary; 1 at a border, which covers no area.
    pub(super) area: f64,
    /// Derivatives of the latter, where it is neither 0 nor 1.
    pub(super) turned: Option<Box<Turned>>,
    /// Weights of the nodes of the secondary facet in the point, N_a, and in its tangent.
    pub(super) shape: LineShape,
}

/// The points of a secondary facet that face one facet of the primary, with their integrals for
/// each polynomial.
#[derive(Debug)]
pub(super) struct Patch {
    /// Facet of the primary; 0 of an obstacle.
    pub(super) facet: usize,
    /// Number of nodes of the secondary facet.
    own: usize,
    pub(super) points: Vec<Measured>,
    /// Values of the polynomials at each point, with those that they carry.
    values: Vec<[f64; MOST]>,
    /// Initial depths that are kept, by which gaps are larger.
    kept: [f64; MOST],
    /// Integrals of rows and of their derivatives, of gaps and of slips, once they are asked for.
    rows: [Option<Box<[[Vector<2>; BOTH]; MOST]>>; 2],
    derivatives: [Option<Vec<[f64; MATRIX]>>; 2],
}

impl Measured {
    /// Whether it only adds to the derivatives.
    pub(super) fn is_border(&self) -> bool {
        matches!(self.gap, PointGap::Border(_))
    }

    /// The gap, larger by a depth; 0 at a border.
    fn distance(&self, kept: f64) -> f64 {
        if self.is_border() { 0.0 } else { self.gap.distance() + kept }
    }

    /// Calls a function with the row of the point, number 0, and those of the nodes opposite and
    /// of the tangent.
    fn row(&self, kind: Kind, kept: f64, mut of: impl FnMut(usize, Vector<2>)) {
        if kind == Kind::Slip {
            self.gap.slip(of);
            return;
        }
        self.gap.gradient(kept, &mut of);
        if let Some(turned) = &self.turned {
            turned.gradient(self.distance(kept), of);
        }
    }

    /// Derivative of the row by the same vectors, two components each, row-major. Returns their
    /// number.
    fn derivative_into(&self, kind: Kind, kept: f64, matrix: &mut [f64]) -> usize {
        match (kind, &self.turned) {
            (Kind::Slip, _) => self.gap.slip_derivative_into(matrix),
            (Kind::Gap, None) => self.gap.curvature_into(matrix),
            (Kind::Gap, Some(turned)) => {
                turned.curvature_into(self.distance(kept), &self.gap, matrix);
                return turned.count();
            }
        }
        self.gap.count()
    }

    /// Weights of the nodes of the secondary facet in number `p` of the vectors, if it is the
    /// point, number 0, or, last, the tangent; others are nodes opposite, from number 1 on.
    fn weights(&self, p: usize) -> Option<&[f64; NODES]> {
        if p == 0 {
            Some(&self.shape.values)
        } else if p == self.gap.count() {
            Some(&self.shape.first)
        } else {
            None
        }
    }
}

impl Patch {
    /// Without points; `own`: number of nodes of the secondary facet.
    pub(super) fn new(facet: usize, own: usize) -> Self {
        Self {
            facet,
            own,
            points: Vec::new(),
            values: Vec::new(),
            kept: [0.0; MOST],
            rows: [None, None],
            derivatives: [None, None],
        }
    }

    /// Sets the values of polynomials at the points, and depths that are kept.
    pub(super) fn weigh(&mut self, value: impl Fn(usize, f64) -> f64, kept: [f64; MOST]) {
        let of_point = |point: &Measured| std::array::from_fn(|number| value(number, point.at.xi));
        self.values = self.points.iter().map(of_point).collect();
        self.kept = kept;
    }

    /// Checks that the closest points are unique.
    ///
    /// # Errors
    /// If one is not; `pair` and the representative node of its multiplier are named.
    pub(super) fn unless_regular(&self, node: usize, pair: &Pair) -> Result<(), ContactError> {
        self.points.iter().try_for_each(|Measured { at, gap, .. }| {
            gap.unless_regular(node, &Pair { facet: at.facet, xi: at.eta, ..*pair })
        })
    }

    /// The points with their weights for a polynomial.
    pub(super) fn shares(&self, number: usize) -> impl Iterator<Item = (&Measured, f64)> {
        debug_assert_eq!(self.points.len(), self.values.len(), "weighed before it is integrated");
        let weighted = self.points.iter().zip(&self.values);
        weighted.map(move |(point, values)| (point, values[number] * point.area))
    }

    /// Integral of the gap with a polynomial.
    pub(super) fn gap(&self, number: usize) -> f64 {
        self.shares(number).map(|(point, share)| share * point.distance(self.kept[number])).sum()
    }

    /// Integral of the row with a polynomial, over the nodes of both facets.
    pub(super) fn row(&mut self, kind: Kind, number: usize) -> &[Vector<2>] {
        let Self { own, points, values, kept, rows, .. } = self;
        let integrate = || {
            let mut sums = Box::new([[Vector::ZERO; BOTH]; MOST]);
            for (point, values) in points.iter().zip(values) {
                // Only depths that are kept differ between the polynomials.
                let mut of_nodes = [Vector::ZERO; BOTH];
                for number in 0..MOST {
                    if number == 0 || kept[number] != kept[number - 1] {
                        of_nodes = [Vector::ZERO; BOTH];
                        point.row(kind, kept[number], |p, slope| match point.weights(p) {
                            Some(weights) => {
                                let weighted = of_nodes[..*own].iter_mut().zip(weights);
                                weighted.for_each(|(sum, weight)| *sum += slope * *weight);
                            }
                            None => of_nodes[*own + p - 1] += slope,
                        });
                    }
                    let share = values[number] * point.area;
                    let added = sums[number].iter_mut().zip(&of_nodes);
                    added.for_each(|(sum, slope)| *sum += *slope * share);
                }
            }
            sums
        };
        &rows[kind as usize].get_or_insert_with(integrate)[number]
    }

    /// Integral of the derivative of the row with a polynomial, over as many components as a patch
    /// has at most, row-major.
    pub(super) fn derivative(&mut self, kind: Kind, number: usize) -> &[f64] {
        let Self { own, points, values, kept, derivatives, .. } = self;
        let integrate = || {
            wide(
                #[inline(always)]
                || {
                    let mut sums = vec![[0.0; MATRIX]; MOST];
                    let mut of_nodes = [0.0; MATRIX];
                    for (point, values) in points.iter().zip(values) {
                        for number in 0..MOST {
                            if number == 0 || kept[number] != kept[number - 1] {
                                expand(point, kind, kept[number], *own, &mut of_nodes);
                            }
                            let share = values[number] * point.area;
                            for (sum, entry) in sums[number].iter_mut().zip(&of_nodes) {
                                *sum += share * entry;
                            }
                        }
                    }
                    sums
                },
            )
        };
        &derivatives[kind as usize].get_or_insert_with(integrate)[number]
    }
}

/// Components of the nodes of two facets, and entries of a matrix over them.
pub(super) const SIZE: usize = 2 * BOTH;
const MATRIX: usize = SIZE * SIZE;

/// Overwrites a matrix over the nodes of both facets with the derivative of the row of a point.
#[inline(always)]
fn expand(point: &Measured, kind: Kind, kept: f64, own: usize, matrix: &mut [f64; MATRIX]) {
    let mut of_point = [0.0; OF_POINT * OF_POINT];
    let count = point.derivative_into(kind, kept, &mut of_point);
    let opposite = point.gap.count() - 1;
    let n = 2 * count;
    matrix.fill(0.0);
    let rows = matrix.as_chunks_mut::<SIZE>().0;
    for (row, entries) in of_point[..n * n].chunks_exact(n).enumerate() {
        // The columns of the vectors become those of the nodes, then this row those of its nodes.
        let mut columns = [0.0; SIZE];
        columns[2 * own..2 * (own + opposite)].copy_from_slice(&entries[2..2 * (1 + opposite)]);
        for (q, entry) in entries.as_chunks::<2>().0.iter().enumerate() {
            let Some(weights) = point.weights(q) else { continue };
            for (column, weight) in columns.as_chunks_mut::<2>().0[..own].iter_mut().zip(weights) {
                column[0] += weight * entry[0];
                column[1] += weight * entry[1];
            }
        }
        match point.weights(row / 2) {
            Some(weights) => {
                for (place, weight) in weights[..own].iter().enumerate() {
                    let sums = rows[2 * place + row % 2].iter_mut().zip(&columns);
                    sums.for_each(|(sum, entry)| *sum += weight * entry);
                }
            }
            None => rows[2 * (own + row / 2 - 1) + row % 2] = columns,
        }
    }
}
