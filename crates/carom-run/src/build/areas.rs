//! Areas of the nodes of a surface.

use std::collections::HashMap;

use carom_solid::FacetShape;

/// ∫φᴺ ds over the sides of each node at positions `y`, times the thickness.
pub(super) fn consistent_weights<'a>(
    secondary: &[usize],
    facets: impl Iterator<Item = (FacetShape, &'a Vec<Vec<usize>>)>,
    y: &[f64],
    thickness: f64,
) -> Vec<f64> {
    let mut weights: HashMap<usize, f64> = secondary.iter().map(|&node| (node, 0.0)).collect();
    for (shape, facets) in facets {
        let d = shape.dimension();
        // Exact for constant |y'| and φ of degree 3.
        let rule = shape.rule(5);
        for facet in facets {
            for &(xi, w) in &rule {
                let functions = shape.functions(xi);
                let tangents = functions.slopes.map(|slopes| {
                    let mut tangent = [0.0; 3];
                    for (&n, slope) in facet.iter().zip(slopes) {
                        (0..d).for_each(|i| tangent[i] += slope * y[n * d + i]);
                    }
                    tangent
                });
                let [x, y, z] = shape.area_vector(tangents, 1.0);
                let measure = x.hypot(y).hypot(z);
                for (n, value) in facet.iter().zip(&functions.values) {
                    if let Some(weight) = weights.get_mut(n) {
                        *weight += w * value * measure * thickness;
                    }
                }
            }
        }
    }
    secondary.iter().map(|node| weights[node]).collect()
}
