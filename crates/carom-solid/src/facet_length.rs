//! The length of a facet, in which tolerances and permitted depths are measured: the distance of
//! the two neighbouring corners that are closest to each other. It does not depend on which corner
//! is the first one.

/// Length of a facet with these nodes, corners first, or of an edge of two; 0 for a point. Positions are node by node.
///
/// ```
/// // A rectangle of 3 × 1, whichever corner comes first.
/// let y = [0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 3.0, 1.0, 0.0, 0.0, 1.0, 0.0];
/// assert_eq!(carom_solid::facet_length(&[0, 1, 2, 3], &y, 3), 1.0);
/// assert_eq!(carom_solid::facet_length(&[1, 2, 3, 0], &y, 3), 1.0);
/// ```
pub fn facet_length(nodes: &[usize], positions: &[f64], dimension: usize) -> f64 {
    let apart = |a: usize, b: usize| {
        let [a, b] = [a, b].map(|node| &positions[dimension * node..dimension * (node + 1)]);
        a.iter().zip(b).map(|(a, b)| (b - a) * (b - a)).sum::<f64>().sqrt()
    };
    match (dimension, nodes.len()) {
        (_, 0 | 1) => 0.0,
        (1 | 2, _) | (_, 2) => apart(nodes[0], nodes[1]),
        (_, count) => {
            let corners = if count == 4 || count == 9 { 4 } else { 3 };
            let edges = (0..corners).map(|corner| apart(nodes[corner], nodes[(corner + 1) % corners]));
            edges.fold(f64::INFINITY, f64::min)
        }
    }
}
