//! Cells that are checked at the ends of a step and on the way between them.

use carom_mechanics::Rejected;
use carom_mechanics::check::valid_cells::{ValidCells, is_within};
use carom_mechanics::model::{Loads, Motions};
use carom_solid::{Element, Law, generate};

use crate::models::{model, parts};

#[test]
fn motion_of_the_whole_body_counts_as_none() {
    let before: Vec<f64> = (0..14).map(f64::from).collect();
    let mut now: Vec<f64> = before.iter().enumerate().map(|(i, x)| x + [8.0, -4.0][i % 2]).collect();
    assert!(is_within(&before, &now, 2, 1e-12));
    now[13] += 0.5;
    assert!(is_within(&before, &now, 2, 0.5) && !is_within(&before, &now, 2, 0.4));
    now[13] = f64::NAN;
    assert!(!is_within(&before, &now, 2, f64::INFINITY) && !is_within(&[], &now, 2, 1.0));
}

/// The positions of a mesh turned about its first node.
fn turned(y: &[f64], dimension: usize, angle: f64) -> Vec<f64> {
    let (s, c) = angle.sin_cos();
    let nodes = y.chunks_exact(dimension).flat_map(|x| {
        let [a, b] = [x[0] - y[0], x[1] - y[1]];
        [y[0] + c * a - s * b, y[1] + s * a + c * b].into_iter().chain(x[2..].iter().copied())
    });
    nodes.collect()
}

#[test]
fn a_body_that_is_valid_at_both_ends_of_a_step_may_be_inverted_within_it() {
    let flat = generate::rectangle(Element::T6, [1.0, 2.0], [2.0, 3.0], [3, 2]).unwrap();
    let mut layers = Vec::new();
    for element in [Element::Hex8, Element::Tet10] {
        layers.push(generate::cuboid(element, [1.0, 2.0, 0.0], [2.0, 3.0, 1.0], [2, 1, 1]).unwrap());
    }
    let law = Law::NeoHookean { lambda: 1.0, mu: 1.0 };
    for mesh in std::iter::once(flat).chain(layers) {
        let model = model(parts([mesh], law, 1.0), &[], Motions::default(), Loads::default(), Vec::new());
        let d = model.dimension;
        let start = &model.reference;
        let mut cells = ValidCells::default();
        let mut step = |times: [f64; 2], from: &[f64], to: &[f64]| {
            cells.check(&model, to).and_then(|()| cells.check_paths(&model, times, [from, to]))
        };
        // Turned by φ, straight paths have the determinant (1 + cos φ)/2 in their middle.
        let [little, much, most] = [0.01, 3.0, std::f64::consts::PI].map(|angle| turned(start, d, angle));
        assert_eq!(step([0.0, 1.0], start, &little), Ok(()));
        assert_eq!(step([0.0, 1.0], start, &much), Ok(()));
        for _ in 0..2 {
            let found = step([0.0, 1.0], start, &most);
            let Err(Rejected::InvertedOnTheWay { theta, .. }) = found else { panic!("{found:?}") };
            assert!(theta <= 0.5 && theta > 0.49, "{theta}");
        }
        // From where it was accepted, and from where it was not.
        assert_eq!(step([1.0, 2.0], &much, &most), Ok(()));
        assert!(step([0.0, 2.0], start, &most).is_err());
    }
}
