//! Surfaces as facets: second derivatives by differences, and edges that are lines.

use carom_solid::{FacetShape, line_shape};

const SURFACES: [FacetShape; 5] =
    [FacetShape::T3, FacetShape::T6, FacetShape::T10, FacetShape::Q4, FacetShape::Q9];

#[test]
fn second_derivatives_are_differences_of_the_first() {
    let (xi, h) = ([0.23, 0.41], 1e-3);
    for shape in SURFACES {
        let found = shape.second(xi);
        for (k, (by, of)) in [(0, 0), (1, 0), (1, 1)].into_iter().enumerate() {
            let [low, high] = [-h, h].map(|step| {
                let mut moved = xi;
                moved[by] += step;
                shape.functions(moved).slopes[of]
            });
            for a in 0..found[k].len() {
                let expected = (high[a] - low[a]) / (2.0 * h);
                assert!((found[k][a] - expected).abs() < 1e-10, "{shape:?} {k} {a}");
            }
        }
    }
}

#[test]
fn an_edge_is_a_line() {
    let corners = |count| -> &[[f64; 2]] {
        match count {
            3 => &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            _ => &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]],
        }
    };
    for shape in SURFACES {
        let corners = corners(shape.corners());
        for edge in 0..corners.len() {
            let (from, to) = (corners[edge], corners[(edge + 1) % corners.len()]);
            let (nodes, count) = shape.edge(edge);
            for s in [0.0, 0.3, 0.8] {
                let at = std::array::from_fn(|i| from[i] + s * (to[i] - from[i]));
                let mut values = shape.functions(at).values;
                let line = line_shape(count, 2.0 * s - 1.0).values;
                nodes[..count].iter().zip(line).for_each(|(node, value)| values[*node] -= value);
                let error = values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                assert!(error < 1e-14, "{shape:?} {edge} {s}: {error:e}");
            }
        }
    }
}
