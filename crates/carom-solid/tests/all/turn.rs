//! The rotation and the strain of cells that are stretched and turned.

use carom_algebra::Mat;
use carom_solid::{Element, Law, body, generate};

/// Angle and strain of every cell of a mesh of an element under y = F x.
fn turns(element: Element, f: &[Vec<f64>]) -> Vec<[f64; 2]> {
    let mesh = match f.len() {
        1 => generate::interval(element, 0.0, 1.0, 2),
        2 => generate::rectangle(element, [0.0; 2], [1.0; 2], [1, 2]),
        _ => generate::cuboid(element, [0.0; 3], [1.0; 3], [1, 2, 1]),
    };
    let body = body(mesh.unwrap(), Law::NeoHookean { lambda: 2.0, mu: 1.5 }, 1.0, 1.0).unwrap();
    let y: Vec<f64> = body
        .mesh()
        .nodes
        .iter()
        .flat_map(|x| f.iter().map(move |row| row.iter().zip(x).map(|(f, x)| f * x).sum::<f64>()))
        .collect();
    (0..body.mesh().cell_count()).map(|cell| body.cell_turn(cell, &y)).collect()
}

fn rows<const D: usize>(f: Mat<D>) -> Vec<Vec<f64>> {
    f.0.map(Vec::from).to_vec()
}

/// ‖UᵀU − 1‖/2.
fn strain<const D: usize>(stretch: &Mat<D>) -> f64 {
    let e = (stretch.transposed() * *stretch - Mat::identity()) * 0.5;
    e.double_dot(&e).sqrt()
}

/// A stretch that is turned by a known angle about an axis.
#[test]
fn stretch_does_not_turn() {
    for theta in [0.0_f64, 1e-3, 0.3, 2.0, 3.1] {
        let (s, c) = theta.sin_cos();
        let stretch = Mat([[1.5, 0.2], [0.2, 0.7]]);
        let turned = rows(Mat([[c, -s], [s, c]]) * stretch);
        for element in [Element::T3, Element::Q9] {
            for [angle, size] in turns(element, &turned) {
                assert!((angle - theta).abs() < 1e-12, "{theta} {angle}");
                assert!((size - strain(&stretch)).abs() < 1e-14, "{theta} {size}");
            }
        }
        let stretch = Mat([[1.5, 0.2, 0.1], [0.2, 0.7, 0.0], [0.1, 0.0, 1.1]]);
        // About (1, 2, 2)/3: R = c 1 + s [n]× + (1 − c) n nᵀ.
        let n = [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];
        let cross = [[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]];
        let space = Mat(std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                c * f64::from(u8::from(i == j)) + s * cross[i][j] + (1.0 - c) * n[i] * n[j]
            })
        }));
        let turned = rows(space * stretch);
        for element in [Element::Tet4, Element::Hex8] {
            for [angle, size] in turns(element, &turned) {
                assert!((angle - theta).abs() < 1e-9, "{theta} {angle}");
                assert!((size - strain(&stretch)).abs() < 1e-14, "{theta} {size}");
            }
        }
    }
    assert!(turns(Element::L2, &[vec![1.5]]).iter().all(|[angle, _]| *angle == 0.0));
}
