//! Cylinder and tube: a plane section of quadrangles times the height.
//!
//! The section of a cylinder is a rounded square around the axis, and on each of its edges a block
//! of cells that reaches to the circle, in the manner of the [ball](super::ball()); that of a tube
//! is a product of angle and radius.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use super::ball::counts;
use super::frame::Frame;
use super::lattice::{Flat, HEXAHEDRON, Key, Lattice, divisions, on};
use super::{MeshError, positive};
use crate::mesh::{Element, Mesh};

/// Cylinder of tetrahedra with edges of about `size` around it, from the centre of its bottom along
/// the axis; sides `side`, `bottom`, `top`. `symmetry` along x, y and z leaves the half with larger
/// coordinates than the middle, with the sides `plane_x`, `plane_y`, `plane_z`.
///
/// # Errors
/// If a length is not positive, the axis is zero, symmetry is asked for and the axis is not a
/// direction of the coordinates, or the element is not a tetrahedron.
pub fn cylinder(
    element: Element,
    radius: f64,
    height: f64,
    frame: &Frame,
    size: f64,
    symmetry: [bool; 3],
) -> Result<Mesh, MeshError> {
    positive(&[("radius", radius), ("height", height), ("size", size)])?;
    let cuts = frame.cuts(symmetry)?;
    let (half, layers) = counts(radius, size);
    let (low, tall, up) = levels(height, size, cuts[2]);
    let k = element.degree() as i64;
    let square = (k * half) as f64;
    let ring = (k * layers) as f64;
    let rise = (k * up) as f64;
    let place = |key: Key| {
        let q = [0, 1].map(|i| key[i] as f64 / square);
        let t = key[3] as f64 / ring;
        let c = rounded(q);
        let d = direction(q);
        let [x, y] = [0, 1].map(|i| radius * ((1.0 - t) * c[i] + t * d[i]));
        frame.place([x, y, low + tall * (key[2] as f64 / rise)])
    };
    let mut lattice = Lattice::new(element, place)?;
    let range = |axis: usize| if cuts[axis] { 0..half } else { -half..half };
    let local = |at: [usize; 3]| at.map(|x| x as i64);
    for z in 0..up {
        for x in range(0) {
            for y in range(1) {
                lattice.add(&HEXAHEDRON, |at| {
                    let [a, b, c] = local(at);
                    [k * x + a, k * y + b, k * z + c, 0]
                });
            }
        }
        for axis in 0..2 {
            for edge in [-half, half].into_iter().filter(|edge| *edge > 0 || !cuts[axis]) {
                for p in range(1 - axis) {
                    for layer in 0..layers {
                        lattice.add(&HEXAHEDRON, |at| {
                            let [a, b, c] = local(at);
                            let mut key = [0, 0, k * z + c, k * layer + b];
                            key[axis] = k * edge;
                            key[1 - axis] = k * p + a;
                            key
                        });
                    }
                }
            }
        }
    }
    let mut sides = vec![Flat("side".into(), 3, k * layers), Flat("top".into(), 2, k * up)];
    sides.push(Flat(if cuts[2] { frame.plane(2) } else { "bottom".into() }, 2, 0));
    sides.extend((0..2).filter(|&i| cuts[i]).map(|i| Flat(frame.plane(i), i, 0)));
    Ok(lattice.into_mesh(|corners| on(&sides, corners)))
}

/// Tube of tetrahedra with edges of about `size`, from the centre of its bottom along the axis;
/// sides `inner`, `outer`, `bottom`, `top`, and those of `symmetry` as for the [`cylinder`].
///
/// # Errors
/// As the [`cylinder`], and if `inner` is not less than `outer`.
pub fn tube(
    element: Element,
    [inner, outer]: [f64; 2],
    height: f64,
    frame: &Frame,
    size: f64,
    symmetry: [bool; 3],
) -> Result<Mesh, MeshError> {
    positive(&[("inner", inner), ("outer", outer), ("height", height), ("size", size)])?;
    if inner >= outer {
        return Err(MeshError::Tube { inner, outer });
    }
    let cuts = frame.cuts(symmetry)?;
    let k = element.degree() as i64;
    let (quarter, layers) = tube_counts(inner, outer, size);
    let (low, tall, up) = levels(height, size, cuts[2]);
    let turn = k * quarter;
    let thick = (k * layers) as f64;
    let rise = (k * up) as f64;
    let place = |key: Key| {
        let radius = super::lerp(inner, outer, key[1] as f64 / thick);
        let [cos, sin] = on_circle(key[0], turn);
        frame.place([radius * cos, radius * sin, low + tall * (key[2] as f64 / rise)])
    };
    let mut lattice = Lattice::new(element, place)?;
    // Quarters of a turn that are left.
    let quarters = match (cuts[0], cuts[1]) {
        (false, false) => 0..4,
        (true, false) => 3..5,
        (false, true) => 0..2,
        (true, true) => 0..1,
    };
    for angle in quarters.start * quarter..quarters.end * quarter {
        for layer in 0..layers {
            for z in 0..up {
                lattice.add(&HEXAHEDRON, |at| {
                    let [a, b, c] = at.map(|x| x as i64);
                    [(k * angle + a).rem_euclid(4 * turn), k * layer + b, k * z + c, 0]
                });
            }
        }
    }
    let mut sides = vec![Flat("inner".into(), 1, 0), Flat("outer".into(), 1, k * layers)];
    sides.push(Flat("top".into(), 2, k * up));
    sides.push(Flat(if cuts[2] { frame.plane(2) } else { "bottom".into() }, 2, 0));
    // The plane of x is met at odd quarters of a turn, that of y at even ones.
    for (i, at) in [(0, 1), (0, 3), (1, 0), (1, 2)].into_iter().filter(|(i, _)| cuts[*i]) {
        sides.push(Flat(frame.plane(i), 0, at * turn));
    }
    Ok(lattice.into_mesh(|corners| on(&sides, corners)))
}

/// Number of hexahedra of a cylinder, each of which becomes six tetrahedra.
pub fn cylinder_hexahedra(radius: f64, height: f64, size: f64, symmetry: [bool; 3]) -> f64 {
    let (half, layers) = counts(radius, size);
    let edge = 2.0 * half as f64;
    cut(edge * (edge + 4.0 * layers as f64) * divisions(height, size) as f64, symmetry)
}

/// Number of hexahedra of a tube, each of which becomes six tetrahedra.
pub fn tube_hexahedra([inner, outer]: [f64; 2], height: f64, size: f64, symmetry: [bool; 3]) -> f64 {
    let (quarter, layers) = tube_counts(inner, outer, size);
    cut((4 * quarter * layers) as f64 * divisions(height, size) as f64, symmetry)
}

fn cut(whole: f64, symmetry: [bool; 3]) -> f64 {
    whole / 2.0_f64.powi(symmetry.iter().filter(|cut| **cut).count() as i32)
}

/// Cells on a quarter of the outer circle, and between the circles.
fn tube_counts(inner: f64, outer: f64, size: f64) -> (i64, i64) {
    (divisions(FRAC_PI_2 * outer, size), divisions(outer - inner, size))
}

/// Lower end, height and cells along the axis; the upper half if cut.
fn levels(height: f64, size: f64, cut: bool) -> (f64, f64, i64) {
    let (low, tall) = if cut { (0.5 * height, 0.5 * height) } else { (0.0, height) };
    (low, tall, divisions(tall, size))
}

/// From the square to the rounded square.
fn rounded([x, y]: [f64; 2]) -> [f64; 2] {
    let stretch = |a: f64| (1.0 - 0.5 * a * a).sqrt();
    [0.25 * x * (1.0 + stretch(y)), 0.25 * y * (1.0 + stretch(x))]
}

/// From the square's edge to the circle; 0 at the centre.
fn direction(q: [f64; 2]) -> [f64; 2] {
    let t = q.map(|x| (FRAC_PI_4 * x).tan());
    let length = t[0].hypot(t[1]).max(f64::MIN_POSITIVE);
    t.map(|x| x / length)
}

/// The point of the unit circle at `at` of four times `quarter` equal steps, mirrored bitwise at
/// both axes and the diagonals.
fn on_circle(at: i64, quarter: i64) -> [f64; 2] {
    let turns = at.div_euclid(quarter);
    let rest = at.rem_euclid(quarter);
    let angle = |steps: i64| FRAC_PI_2 * steps as f64 / quarter as f64;
    let [cos, sin] = if 2 * rest <= quarter {
        [angle(rest).cos(), angle(rest).sin()]
    } else {
        [angle(quarter - rest).sin(), angle(quarter - rest).cos()]
    };
    match turns.rem_euclid(4) {
        0 => [cos, sin],
        1 => [-sin, cos],
        2 => [-cos, -sin],
        _ => [sin, -cos],
    }
}
