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

/// Bernstein polynomials are positive inside, sum to one and all have the same integral; those of a
/// line at its nodes by hand.
#[test]
fn bernstein_polynomials() {
    let lines = [FacetShape::Point, FacetShape::L2, FacetShape::L3, FacetShape::L4];
    for shape in SURFACES.into_iter().chain(lines) {
        let at_nodes = shape.bernstein_at_nodes();
        let n = shape.nodes();
        let mut integrals = vec![0.0; n];
        let mut whole = 0.0;
        for (xi, weight) in shape.rule(6) {
            let phi = shape.functions(xi).values;
            let value = |i: usize| (0..n).map(|j| at_nodes[j][i] * phi[j]).sum::<f64>();
            let values: Vec<f64> = (0..n).map(value).collect();
            assert!(values.iter().all(|value| *value > 0.0), "{shape:?} at {xi:?}: {values:?}");
            assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-14, "{shape:?} at {xi:?}");
            integrals.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
            whole += weight;
        }
        for integral in integrals {
            assert!((integral * n as f64 / whole - 1.0).abs() < 1e-13, "{shape:?}: {integral}");
        }
    }
    let cubic = FacetShape::L4.bernstein_at_nodes();
    let by_hand = [8.0, 1.0, 12.0, 6.0].map(|x: f64| x / 27.0);
    assert!(cubic[2].iter().zip(by_hand).all(|(a, b)| (a - b).abs() < 1e-15), "{:?}", cubic[2]);
}
