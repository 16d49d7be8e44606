//! Lengths of a facet: of its shortest edge, in which permitted depths are measured, and of its
//! longest one, for tolerances and stiffnesses. Neither depends on which corner is the first one.

/// Distances of neighbouring corners of a facet with these nodes, corners first, or of the ends of
/// an edge of two nodes; none of a point.
fn edges<'a>(nodes: &'a [usize], positions: &'a [f64], dimension: usize) -> impl Iterator<Item = f64> + 'a {
    let corners = match (dimension, nodes.len()) {
        (_, 0 | 1) => 0,
        (1 | 2, _) | (_, 2) => 2,
        (_, 4 | 9) => 4,
        _ => 3,
    };
    (0..corners).map(move |corner| {
        let [a, b] = [nodes[corner], nodes[(corner + 1) % corners]]
            .map(|node| &positions[dimension * node..dimension * (node + 1)]);
        a.iter().zip(b).map(|(a, b)| (b - a) * (b - a)).sum::<f64>().sqrt()
    })
}

/// Length of the shortest edge of a facet with these nodes, corners first; 0 for a point. Positions
/// are node by node.
///
/// ```
/// // A rectangle of 3 × 1, whichever corner comes first.
/// let y = [0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 3.0, 1.0, 0.0, 0.0, 1.0, 0.0];
/// assert_eq!(carom_solid::shortest_edge(&[0, 1, 2, 3], &y, 3), 1.0);
/// assert_eq!(carom_solid::shortest_edge(&[1, 2, 3, 0], &y, 3), 1.0);
/// ```
pub fn shortest_edge(nodes: &[usize], positions: &[f64], dimension: usize) -> f64 {
    edges(nodes, positions, dimension).reduce(f64::min).unwrap_or(0.0)
}

/// Length of the longest edge of a facet with these nodes, corners first; 0 for a point. Positions
/// are node by node.
///
/// ```
/// let y = [0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 3.0, 1.0, 0.0, 0.0, 1.0, 0.0];
/// assert_eq!(carom_solid::longest_edge(&[1, 2, 3, 0], &y, 3), 3.0);
/// ```
pub fn longest_edge(nodes: &[usize], positions: &[f64], dimension: usize) -> f64 {
    edges(nodes, positions, dimension).reduce(f64::max).unwrap_or(0.0)
}
