//! The point of a facet that is closest to a place: the least |x(ξ) − X|² over its reference
//! domain, by Gauss–Newton's method in the facet, and along its edges where that leaves it.

use crate::facet::FacetShape;

/// A point of a facet.
#[derive(Clone, Debug, PartialEq)]
pub struct FacetPoint {
    /// Shape functions of the facet's nodes there.
    pub values: Vec<f64>,
    /// Its position; components beyond the dimension are zero.
    pub position: [f64; 3],
    /// Distance from the place.
    pub distance: f64,
    /// Part of that distance along the facet: not zero where the place is beside it.
    pub beside: f64,
}

/// Most iterations; Gauss–Newton's method converges in a few where the place is near.
const ITERATIONS: usize = 50;
/// Change of ξ at convergence.
const SETTLED: f64 = 1e-14;
/// Margin by which ξ may leave its domain by round-off.
const MARGIN: f64 = 1e-12;

impl FacetShape {
    /// The point of a facet with nodes at `nodes` that is closest to `place`; components beyond the
    /// dimension are zero.
    pub fn closest(self, nodes: &[[f64; 3]], place: [f64; 3]) -> FacetPoint {
        let at = |xi: [f64; 2]| self.point(nodes, place, xi);
        let starts = match self.dimension() {
            1 => return at([0.0; 2]),
            2 => [-1.0, -0.5, 0.0, 0.5, 1.0].map(|xi| [xi, 0.0]).to_vec(),
            _ => self.samples().iter().map(|(xi, _)| *xi).collect(),
        };
        let near = |a: &[f64; 2], b: &[f64; 2]| at(*a).distance.total_cmp(&at(*b).distance);
        let start = starts.into_iter().min_by(near).unwrap_or_default();
        let axes: &[[f64; 2]] = if self.dimension() == 2 { &[[1.0, 0.0]] } else { &[[1.0, 0.0], [0.0, 1.0]] };
        if let Some(xi) = self.minimum(nodes, place, start, axes).filter(|xi| self.contains(*xi)) {
            return at(xi);
        }
        let corners = self.reference_corners();
        let mut candidates: Vec<[f64; 2]> = corners.to_vec();
        for (i, from) in corners.iter().enumerate().filter(|_| self.dimension() == 3) {
            let to = corners[(i + 1) % corners.len()];
            let along = [to[0] - from[0], to[1] - from[1]];
            let middle = [from[0] + 0.5 * along[0], from[1] + 0.5 * along[1]];
            candidates.extend(self.minimum(nodes, place, middle, &[along]));
        }
        candidates.retain(|xi| self.contains(*xi));
        at(candidates.into_iter().min_by(near).unwrap_or(start))
    }

    fn point(self, nodes: &[[f64; 3]], place: [f64; 3], xi: [f64; 2]) -> FacetPoint {
        let functions = self.functions(xi);
        let combined = |factors: &[f64]| {
            let sum = |i: usize| nodes.iter().zip(factors).map(|(x, factor)| factor * x[i]).sum::<f64>();
            std::array::from_fn::<f64, 3, _>(sum)
        };
        let position = combined(&functions.values);
        let apart: [f64; 3] = std::array::from_fn(|i| place[i] - position[i]);
        let tangents = functions.slopes.iter().map(|slopes| combined(slopes));
        let along = tangents.map(|tangent| {
            let length = dot(tangent, tangent).sqrt();
            if length > 0.0 { dot(apart, tangent).abs() / length } else { 0.0 }
        });
        FacetPoint {
            values: functions.values[..self.nodes()].to_vec(),
            position,
            distance: dot(apart, apart).sqrt(),
            beside: along.fold(0.0, f64::max),
        }
    }

    /// Where |x(ξ) − X|² is least over ξ = `start` + Σ s `axes`, in the facet or beyond it.
    fn minimum(
        self,
        nodes: &[[f64; 3]],
        place: [f64; 3],
        start: [f64; 2],
        axes: &[[f64; 2]],
    ) -> Option<[f64; 2]> {
        let mut xi = start;
        for _ in 0..ITERATIONS {
            let functions = self.functions(xi);
            let mut apart = place;
            let mut slopes = [[0.0; 3]; 2];
            for (a, x) in nodes.iter().enumerate() {
                for i in 0..3 {
                    apart[i] -= functions.values[a] * x[i];
                    for (slope, axis) in slopes.iter_mut().zip(axes) {
                        let along = axis[0] * functions.slopes[0][a] + axis[1] * functions.slopes[1][a];
                        slope[i] += along * x[i];
                    }
                }
            }
            let step = least_squares(slopes, apart, axes.len())?;
            for (axis, s) in axes.iter().zip(step) {
                (0..2).for_each(|i| xi[i] += s * axis[i]);
            }
            if xi.iter().any(|x| x.abs() > 4.0) {
                return None;
            }
            if step.iter().all(|s| s.abs() <= SETTLED) {
                return Some(xi);
            }
        }
        Some(xi)
    }

    fn contains(self, xi: [f64; 2]) -> bool {
        match self.corners() {
            3 => xi[0] >= -MARGIN && xi[1] >= -MARGIN && xi[0] + xi[1] <= 1.0 + MARGIN,
            _ => xi.iter().all(|x| x.abs() <= 1.0 + MARGIN),
        }
    }

    /// Reference coordinates of the corners, in the order of the nodes.
    fn reference_corners(self) -> &'static [[f64; 2]] {
        match self.corners() {
            1 => &[[0.0, 0.0]],
            2 => &[[-1.0, 0.0], [1.0, 0.0]],
            3 => &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            _ => &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]],
        }
    }
}

/// The s of least |r − Σ s t| for one or two tangents t; none if they are dependent.
fn least_squares(tangents: [[f64; 3]; 2], r: [f64; 3], count: usize) -> Option<[f64; 2]> {
    let [t, u] = tangents;
    if count == 1 {
        let square = dot(t, t);
        return (square > 0.0).then(|| [dot(t, r) / square, 0.0]);
    }
    let [tt, tu, uu] = [dot(t, t), dot(t, u), dot(u, u)];
    let det = tt * uu - tu * tu;
    let [tr, ur] = [dot(t, r), dot(u, r)];
    (det > 0.0).then(|| [(uu * tr - tu * ur) / det, (tt * ur - tu * tr) / det])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
