//! Ball: a rounded cube of cells around the centre, and on each of its faces a block of cells that
//! reaches to the sphere.
//!
//! A point of the lattice has coordinates q in the cube −1 … 1, and a height t from the cube's
//! surface to the sphere. With the direction d ∝ tan(πq/4), which divides the angles of a face
//! equally, and
//!
//! ```text
//! X = r ((1 − t) c(q) + t d(q)),    c = (q + b(q))/4,    bᵢ = qᵢ √(1 − qⱼ²/2 − q_k²/2 + qⱼ²q_k²/3)
//! ```
//!
//! where b maps the cube onto the ball. The mean of both opens the right angles of the cube's
//! edges, where three blocks meet.

use std::f64::consts::FRAC_PI_4;

use super::MeshError;
use super::lattice::{Flat, HEXAHEDRON, Key, Lattice, divisions, on};
use crate::mesh::{Element, Mesh};

/// Ball of tetrahedra with edges of about `size` around it; side `sphere`. `symmetry` along x, y
/// and z leaves the half with larger coordinates than the centre, with the sides `plane_x`,
/// `plane_y`, `plane_z`.
///
/// # Errors
/// If radius or size is not positive, or the element is not a tetrahedron.
///
/// ```
/// use carom_solid::{Element, generate};
/// let eighth = generate::ball(Element::Tet10, 1.0, [0.0; 3], 0.5, [true; 3])?;
/// let cut = eighth.side_nodes("plane_z").unwrap();
/// assert!(cut.iter().all(|&n| eighth.nodes[n][2] == 0.0));
/// # Ok::<(), carom_solid::generate::MeshError>(())
/// ```
pub fn ball(
    element: Element,
    radius: f64,
    center: [f64; 3],
    size: f64,
    symmetry: [bool; 3],
) -> Result<Mesh, MeshError> {
    let positive = |x: f64| x.is_finite() && x > 0.0;
    if !(positive(radius) && positive(size) && center.iter().all(|c| c.is_finite())) {
        return Err(MeshError::Ball { radius, size, center });
    }
    let (half, layers) = counts(radius, size);
    let k = element.degree() as i64;
    let cube = (k * half) as f64;
    let height = (k * layers) as f64;
    let place = |key: Key| {
        let q = [0, 1, 2].map(|i| key[i] as f64 / cube);
        let t = key[3] as f64 / height;
        let c = rounded(q);
        let d = direction(q);
        [0, 1, 2].map(|i| center[i] + radius * ((1.0 - t) * c[i] + t * d[i]))
    };
    let mut lattice = Lattice::new(element, place)?;
    let range = |axis: usize| if symmetry[axis] { 0..half } else { -half..half };
    let local = |at: [usize; 3]| at.map(|x| x as i64);
    for x in range(0) {
        for y in range(1) {
            for z in range(2) {
                lattice.add(&HEXAHEDRON, |at| {
                    let [a, b, c] = local(at);
                    [k * x + a, k * y + b, k * z + c, 0]
                });
            }
        }
    }
    for axis in 0..3 {
        let [first, second] = [(axis + 1) % 3, (axis + 2) % 3];
        for face in [-half, half].into_iter().filter(|face| *face > 0 || !symmetry[axis]) {
            for p in range(first) {
                for q in range(second) {
                    for layer in 0..layers {
                        lattice.add(&HEXAHEDRON, |at| {
                            let [a, b, c] = local(at);
                            let mut key = [0, 0, 0, k * layer + c];
                            key[axis] = k * face;
                            key[first] = k * p + a;
                            key[second] = k * q + b;
                            key
                        });
                    }
                }
            }
        }
    }
    let mut sides = vec![Flat("sphere".into(), 3, k * layers)];
    let cuts = (0..3).filter(|&i| symmetry[i]);
    sides.extend(cuts.map(|i| Flat(format!("plane_{}", ["x", "y", "z"][i]), i, 0)));
    Ok(lattice.into_mesh(|corners| on(&sides, corners)))
}

/// Number of hexahedra of a ball, each of which becomes six tetrahedra.
pub fn ball_hexahedra(radius: f64, size: f64, symmetry: [bool; 3]) -> f64 {
    let (half, layers) = counts(radius, size);
    let edge = 2.0 * half as f64;
    let cuts = symmetry.iter().filter(|cut| **cut).count() as i32;
    edge * edge * (edge + 6.0 * layers as f64) / 2.0_f64.powi(cuts)
}

/// Cells on half an edge of the cube, which faces an eighth of a great circle, and as long ones
/// between the cube and the sphere, which are 0.42 radii apart on average.
pub(super) fn counts(radius: f64, size: f64) -> (i64, i64) {
    let half = divisions(FRAC_PI_4 * radius, size);
    (half, divisions(0.42 / FRAC_PI_4 * half as f64, 1.0))
}

/// From the cube to the rounded cube.
fn rounded(q: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = q.map(|x| x * x);
    let stretch = |a: f64, b: f64| (1.0 - 0.5 * (a + b) + a * b / 3.0).sqrt();
    let s = [stretch(y, z), stretch(z, x), stretch(x, y)];
    [0, 1, 2].map(|i| 0.25 * q[i] * (1.0 + s[i]))
}

/// From the cube's surface to the sphere; 0 at the centre.
fn direction(q: [f64; 3]) -> [f64; 3] {
    let t = q.map(|x| (FRAC_PI_4 * x).tan());
    let length = t.iter().map(|x| x * x).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
    t.map(|x| x / length)
}
