//! Areas of the nodes of a surface.

use std::collections::HashMap;

use carom_solid::FacetShape;

use super::side::Side;

/// ∫φᴺ ds over the sides of each node at positions `y`, times the thickness.
pub(super) fn consistent_weights<'a>(
    secondary: &[usize],
    facets: impl Iterator<Item = (FacetShape, &'a Vec<Vec<usize>>)>,
    y: &[f64],
    thickness: f64,
) -> Vec<f64> {
    let mut weights: HashMap<usize, f64> = secondary.iter().map(|&node| (node, 0.0)).collect();
    for (shape, facets) in facets {
        // Exact for constant |y'| and φ of degree 3.
        let rule = shape.rule(5);
        for facet in facets {
            for &(xi, w) in &rule {
                let [a, b, c] = area_vector(shape, facet, xi, y);
                let measure = a.hypot(b).hypot(c);
                for (n, value) in facet.iter().zip(&shape.functions(xi).values) {
                    if let Some(weight) = weights.get_mut(n) {
                        *weight += w * value * measure * thickness;
                    }
                }
            }
        }
    }
    secondary.iter().map(|node| weights[node]).collect()
}

/// Area vector of a facet per area of its reference coordinates.
fn area_vector(shape: FacetShape, facet: &[usize], xi: [f64; 2], y: &[f64]) -> [f64; 3] {
    let d = shape.dimension();
    let tangents = shape.functions(xi).slopes.map(|slopes| {
        let mut tangent = [0.0; 3];
        for (&n, slope) in facet.iter().zip(slopes) {
            (0..d).for_each(|i| tangent[i] += slope * y[n * d + i]);
        }
        tangent
    });
    shape.area_vector(tangents, 1.0)
}

/// Cosine of the largest angle between the normals of two facets with a common node on a side
/// without edges.
const EDGE: f64 = 0.49;

/// Whether facets of a side meet at an edge or a corner.
pub(super) fn has_edge(side: &Side, y: &[f64]) -> bool {
    let mut at_nodes: HashMap<usize, Vec<[f64; 3]>> = HashMap::new();
    for (facet, orientation) in side.facets.iter().zip(&side.orientations) {
        let normal = mean_normal(side.shape, facet, y).map(|component| orientation * component);
        facet.iter().for_each(|node| at_nodes.entry(*node).or_default().push(normal));
    }
    let meet = |[a, b]: [&[f64; 3]; 2]| (0..3).map(|i| a[i] * b[i]).sum::<f64>() < EDGE;
    at_nodes.values().any(|normals| normals.iter().any(|a| normals.iter().any(|b| meet([a, b]))))
}

/// Unit normal of a facet, on average over it.
fn mean_normal(shape: FacetShape, facet: &[usize], y: &[f64]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (xi, w) in shape.rule(5) {
        let normal = area_vector(shape, facet, xi, y);
        (0..3).for_each(|i| sum[i] += w * normal[i]);
    }
    let [a, b, c] = sum;
    sum.map(|component| component / a.hypot(b).hypot(c))
}
