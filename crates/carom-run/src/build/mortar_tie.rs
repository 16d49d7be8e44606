//! Mortar ties in the plane: a secondary node is a mean of points of the primary side, such that
//! both sides have the same place on average. With the dual functions Φ of the shape functions N of
//! the secondary side, ∫ Φ_b N_c dΓ = 0 for b ≠ c on every facet,
//!
//! ```text
//! ∫ Φ_b x dΓ = ∫ Φ_b x̂ dΓ,   x = Σ N_c x_c,   x̂ = Σ N̂_l y_l the nearest point of the primary
//! Φ = A N,   A = diag(∫ N dΓ) (∫ N Nᵀ dΓ)⁻¹,   Σ Φ_b = 1
//! x_b = [Σ_l (∫ Φ_b N̂_l dΓ) y_l − Σ_a (∫ Φ_b N_a dΓ) x_a] / ∫ Φ_b N_b dΓ
//! ```
//!
//! over the reference configuration, cut at the ends of the primary facets. A constant traction
//! passes. Ends a of a side are points of the primary themselves:
//! supports and other ties may hold them. Their Φ_a is added to that of the next node of the facet,
//! so that the Φ_b that remain still sum to one. On curves ∫ N_b is positive for all degrees.

use std::collections::BTreeMap;

use carom_solid::FacetShape;
use faer::Mat;
use faer::prelude::Solve;

use super::tie_side::TieSide;

/// Weights of nodes of the primary side, by node.
type Weights = BTreeMap<usize, f64>;

/// Weight that is round-off.
const ROUND_OFF: f64 = 1e-12;

/// Distance in ξ below which two cuts are one.
const CLOSE: f64 = 1e-9;

/// The weights of all nodes of a side from those of its points; only those of its ends are kept.
pub(super) fn weights(
    own: &TieSide,
    target: &TieSide,
    points: BTreeMap<usize, Vec<(usize, f64)>>,
) -> BTreeMap<usize, Vec<(usize, f64)>> {
    let ends = ends(own);
    let mut means: BTreeMap<usize, Mean> = BTreeMap::new();
    for facet in 0..own.facets.len() {
        let nodes = &own.facets[facet];
        let carrier = |place: usize| {
            if ends.contains(&nodes[place]) { next_to(place, nodes.len()) } else { place }
        };
        let Integrals { areas, mixed } = Integrals::over(own, facet, target);
        for (place, of_dual) in mixed.iter().enumerate() {
            let mean = means.entry(nodes[carrier(place)]).or_default();
            for (&node, weight) in of_dual {
                *mean.other.entry(node).or_default() += weight;
            }
            let own = if carrier(place) == place {
                &mut mean.own
            } else {
                mean.ends.entry(nodes[place]).or_default()
            };
            *own += areas[place];
        }
    }
    let mut all: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
    for (node, mean) in means {
        let mut weights = mean.other;
        for (&end, area) in &mean.ends {
            // The end of a slit belongs to both sides, and carries itself.
            let itself = vec![(end, 1.0)];
            for &(carrier, weight) in points.get(&end).unwrap_or(&itself) {
                *weights.entry(carrier).or_default() -= area * weight;
            }
        }
        weights.values_mut().for_each(|weight| *weight /= mean.own);
        weights.retain(|_, weight| weight.abs() > ROUND_OFF);
        let sum: f64 = weights.values().sum();
        weights.values_mut().for_each(|weight| *weight /= sum);
        all.insert(node, weights.into_iter().collect());
    }
    let of_ends = points.into_iter().filter(|(node, _)| ends.contains(node));
    all.extend(of_ends);
    all
}

/// Integrals from which the position of a secondary node follows.
#[derive(Default)]
struct Mean {
    /// ∫ Φ_b N_b.
    own: f64,
    /// ∫ Φ_b N_a, by end a.
    ends: BTreeMap<usize, f64>,
    /// ∫ Φ_b N̂_l, by node l of the primary.
    other: Weights,
}

/// The nodes at which one facet ends and no other one begins.
fn ends(side: &TieSide) -> Vec<usize> {
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    for nodes in &side.facets {
        nodes.iter().take(2).for_each(|&node| *counts.entry(node).or_default() += 1);
    }
    counts.into_iter().filter(|(_, count)| *count == 1).map(|(node, _)| node).collect()
}

/// The node of a facet that follows one of its ends: the nearest one inside, or the other end.
fn next_to(end: usize, nodes: usize) -> usize {
    match (nodes, end) {
        (2, _) => 1 - end,
        (_, 0) => 2,
        _ => nodes - 1,
    }
}

/// Integrals over a facet of the secondary side.
struct Integrals {
    /// ∫ N_c of each node.
    areas: Vec<f64>,
    /// ∫ Φ_b N̂_l of each node b.
    mixed: Vec<Weights>,
}

impl Integrals {
    fn over(own: &TieSide, facet: usize, target: &TieSide) -> Self {
        let shape = own.shape;
        let places = &own.places[facet];
        let count = places.len();
        let degree = 2 * shape.degree().max(target.shape.degree()) + 3;
        let mut areas = vec![0.0; count];
        let mut mass = Mat::<f64>::zeros(count, count);
        let mut direct = vec![Weights::new(); count];
        for piece in cuts(own, facet, target).windows(2) {
            let half = 0.5 * (piece[1] - piece[0]);
            for (at, weight) in shape.rule(degree) {
                let xi = 0.5 * (piece[0] + piece[1]) + half * at[0];
                let values = shape.functions([xi, 0.0]).values;
                let area = half * weight * measure(shape, places, xi);
                for b in 0..count {
                    areas[b] += area * values[b];
                    (0..count).for_each(|c| mass[(b, c)] += area * values[b] * values[c]);
                }
                let place = position(shape, places, xi);
                let Some((other, point)) = target.nearest(place) else { continue };
                for (&node, value) in target.facets[other].iter().zip(&point.values) {
                    for b in 0..count {
                        *direct[b].entry(node).or_default() += area * values[b] * value;
                    }
                }
            }
        }
        // A = diag(∫ N) M⁻¹, M symmetric: its rows are the columns of M⁻¹, scaled.
        let inverse = mass.partial_piv_lu().solve(Mat::identity(count, count));
        let dual = |b: usize| {
            let mut sum = Weights::new();
            for (c, of) in direct.iter().enumerate() {
                for (&node, weight) in of {
                    *sum.entry(node).or_default() += areas[b] * inverse[(b, c)] * weight;
                }
            }
            sum
        };
        let mixed = (0..count).map(dual).collect();
        Self { areas, mixed }
    }
}

/// The ends of a facet, in ξ, and the places on it where facets of the primary end.
fn cuts(own: &TieSide, facet: usize, target: &TieSide) -> Vec<f64> {
    let places = &own.places[facet];
    let mut cuts = vec![-1.0, 1.0];
    let length = own.length(facet);
    for nodes in &target.places {
        for place in nodes.iter().take(2) {
            let point = own.shape.closest(places, *place);
            if point.distance < length {
                cuts.push(coordinate(own.shape, places, point.position));
            }
        }
    }
    cuts.sort_unstable_by(f64::total_cmp);
    cuts.dedup_by(|b, a| *b - *a < CLOSE);
    cuts
}

/// Coordinate ξ of a point of a facet, by bisection of the place along its chord.
fn coordinate(shape: FacetShape, places: &[[f64; 3]], point: [f64; 3]) -> f64 {
    let chord: [f64; 3] = std::array::from_fn(|i| places[1][i] - places[0][i]);
    let along = |at: [f64; 3]| (0..3).map(|i| (at[i] - places[0][i]) * chord[i]).sum::<f64>();
    let sought = along(point);
    let mut low = -1.0;
    let mut high = 1.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if along(position(shape, places, middle)) < sought { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

fn position(shape: FacetShape, places: &[[f64; 3]], xi: f64) -> [f64; 3] {
    let values = shape.functions([xi, 0.0]).values;
    std::array::from_fn(|i| places.iter().zip(values).map(|(place, value)| place[i] * value).sum())
}

/// Length per ξ.
fn measure(shape: FacetShape, places: &[[f64; 3]], xi: f64) -> f64 {
    let slopes = shape.functions([xi, 0.0]).slopes[0];
    let along = |i: usize| places.iter().zip(slopes).map(|(place, slope)| place[i] * slope).sum::<f64>();
    along(0).hypot(along(1))
}
