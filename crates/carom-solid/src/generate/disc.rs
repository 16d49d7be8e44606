//! Disc and half-disc of n = radius/size (rounded) concentric rings around a node.
//!
//! Ring k has 6k (half: 3k) equal edges, so that edges are about `size` long everywhere. Each sixth
//! of a ring consists of k outward and k − 1 inward triangles. A cell has at most one edge on the
//! arc. The half-disc is the right half of the disc, node for node, and the disc is symmetric.

use std::f64::consts::PI;

use super::elevate::{Circle, Side, Skeleton, elevate};
use super::{MeshError, triangles};
use crate::mesh::{Element, Mesh};

/// Disc with edges of about `size`; side `arc`, a closed loop counter-clockwise from its lowest
/// node.
///
/// # Errors
/// If radius or size is not positive, or the element is not a triangle.
pub fn disc(element: Element, radius: f64, center: [f64; 2], size: f64) -> Result<Mesh, MeshError> {
    let n = check(element, radius, center, size)?;
    Ok(elevate(Rings { n, sixths: 6 }.skeleton(radius, center), element))
}

/// The half x ≥ center x of a disc; sides `arc`, from bottom to top, and `axis`, from top to
/// bottom.
///
/// # Errors
/// If radius or size is not positive, or the element is not a triangle.
///
/// ```
/// use carom_solid::{Element, generate};
/// let cylinder = generate::half_disc(Element::T10, 0.5, [0.0, 1.0], 0.1)?;
/// let axis = cylinder.side_nodes("axis").unwrap();
/// assert!(axis.iter().all(|&n| cylinder.nodes[n][0] == 0.0));
/// # Ok::<(), carom_solid::generate::MeshError>(())
/// ```
pub fn half_disc(element: Element, radius: f64, center: [f64; 2], size: f64) -> Result<Mesh, MeshError> {
    let n = check(element, radius, center, size)?;
    Ok(elevate(Rings { n, sixths: 3 }.skeleton(radius, center), element))
}

/// Number of rings. A half is rounded up whatever its last digit, which depends on the unit.
fn rings(radius: f64, size: f64) -> usize {
    (radius / size + 1e-9).round().max(1.0) as usize
}

fn check(element: Element, radius: f64, center: [f64; 2], size: f64) -> Result<usize, MeshError> {
    triangles(element)?;
    let positive = |x: f64| x.is_finite() && x > 0.0;
    if !(positive(radius) && positive(size) && center.iter().all(|c| c.is_finite())) {
        return Err(MeshError::Disc { radius, size, center });
    }
    Ok(rings(radius, size))
}

/// `n` rings over 6 or 3 sixths of a circle.
struct Rings {
    n: usize,
    sixths: usize,
}

impl Rings {
    /// Nodes on ring k ≥ 1.
    fn count(&self, k: usize) -> usize {
        self.sixths * k + usize::from(self.sixths == 3)
    }

    /// Number of the i-th node of ring k.
    fn node(&self, k: usize, i: usize) -> usize {
        if k == 0 {
            return 0;
        }
        let before = self.sixths * k * (k - 1) / 2 + (k - 1) * usize::from(self.sixths == 3);
        1 + before + i % self.count(k)
    }

    fn skeleton(&self, radius: f64, center: [f64; 2]) -> Skeleton {
        let mut skeleton = Skeleton { points: vec![center], ..Skeleton::default() };
        for k in 1..=self.n {
            let r = radius * (k as f64 / self.n as f64);
            let ring = (0..self.count(k)).map(|i| {
                let [x, y] = on_circle(k, i);
                [center[0] + r * x, center[1] + r * y]
            });
            skeleton.points.extend(ring);
            for sixth in 0..self.sixths {
                let outer = |i: usize| self.node(k, sixth * k + i);
                let inner = |i: usize| self.node(k - 1, sixth * (k - 1) + i);
                skeleton.triangles.extend((0..k).map(|i| [inner(i), outer(i), outer(i + 1)]));
                skeleton.triangles.extend((0..k - 1).map(|i| [inner(i), outer(i + 1), inner(i + 1)]));
            }
        }
        let n = self.n;
        let edges = (0..self.sixths * n).map(|i| [self.node(n, i), self.node(n, i + 1)]).collect();
        skeleton.sides.push(Side { name: "arc".into(), edges, circle: Some(Circle { center, radius }) });
        if self.sixths == 3 {
            let down = (1..=n).rev().map(|k| [self.node(k, 3 * k), self.node(k - 1, 3 * (k - 1))]);
            let on = (1..=n).map(|k| [self.node(k - 1, 0), self.node(k, 0)]);
            skeleton.sides.push(Side { name: "axis".into(), edges: down.chain(on).collect(), circle: None });
        }
        skeleton
    }
}

/// The i-th of 6k equally spaced points of the unit circle counter-clockwise from (0, −1); the left
/// half mirrors the right bitwise.
fn on_circle(k: usize, i: usize) -> [f64; 2] {
    if i > 3 * k {
        let [x, y] = on_circle(k, 6 * k - i);
        return [-x, y];
    }
    if i == 3 * k {
        return [0.0, 1.0];
    }
    let (sin, cos) = (PI * i as f64 / (3 * k) as f64).sin_cos();
    [sin, -cos]
}
