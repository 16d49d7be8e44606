//! Ring between two concentric circles, of circles with equally spaced nodes.
//!
//! Edges at radius r have length h = min(size, width, 2πr/12): where the inner circle is small the
//! cells grow outwards, as those of a disc do. Circles are √3/2 h apart, so that triangles are
//! nearly equilateral. Each has a multiple of four nodes, so that the ring is symmetric about both
//! axes. A strip between m and n edges of a quarter is triangulated by advancing on both circles.

use std::f64::consts::PI;

use super::elevate::{Circle, Side, Skeleton, elevate};
use super::{MeshError, triangles};
use crate::mesh::{Element, Mesh};

/// Ring with edges of about `size`, shorter where the ring is thinner or the inner circle needs
/// twelve; sides `inner` and `outer`, closed loops from their node right of the centre, `inner`
/// clockwise, `outer` counter-clockwise.
///
/// # Errors
/// If radii and size are not 0 < inner < outer and 0 < size, or the element is not a triangle.
///
/// ```
/// use carom_solid::{Element, generate};
/// let tube = generate::ring(Element::T6, 0.8, 1.0, [0.0, 0.0], 0.1)?;
/// assert!(tube.side_nodes("inner").is_some_and(|nodes| nodes.len().is_multiple_of(8)));
/// # Ok::<(), carom_solid::generate::MeshError>(())
/// ```
pub fn ring(
    element: Element,
    inner: f64,
    outer: f64,
    center: [f64; 2],
    size: f64,
) -> Result<Mesh, MeshError> {
    triangles(element)?;
    let in_range = inner > 0.0 && outer > inner && outer.is_finite() && size > 0.0 && size.is_finite();
    if !(in_range && center.iter().all(|c| c.is_finite())) {
        return Err(MeshError::Ring { inner, outer, size, center });
    }
    let circles = circles(inner, outer, size);
    let mut skeleton = Skeleton::default();
    let mut first = Vec::new();
    for &(radius, quarter) in &circles {
        first.push(skeleton.points.len());
        let node = |i: usize| {
            let [x, y] = on_circle(quarter, i);
            [center[0] + radius * x, center[1] + radius * y]
        };
        skeleton.points.extend((0..4 * quarter).map(node));
    }
    for k in 1..circles.len() {
        let m = circles[k - 1].1;
        let n = circles[k].1;
        let below = |i: usize| first[k - 1] + i % (4 * m);
        let above = |j: usize| first[k] + j % (4 * n);
        let strip = strip(m, n);
        for quadrant in 0..4 {
            // Every second quadrant is traversed backwards: it mirrors the previous one.
            let mirrored = quadrant % 2 == 1;
            let inner = |i: usize| below(if mirrored { (quadrant + 1) * m - i } else { quadrant * m + i });
            let outer = |j: usize| above(if mirrored { (quadrant + 1) * n - j } else { quadrant * n + j });
            skeleton.triangles.extend(strip.iter().map(|&(i, j, on_inner)| {
                let third = if on_inner { inner(i + 1) } else { outer(j + 1) };
                let [a, b] = [inner(i), outer(j)];
                if mirrored { [a, third, b] } else { [a, b, third] }
            }));
        }
    }
    let loops = |k: usize| {
        let count = 4 * circles[k].1;
        (0..count).map(move |i| [i, (i + 1) % count])
    };
    let last = circles.len() - 1;
    let inward = loops(0).rev().map(|[i, j]| [j, i]).collect();
    let outward = loops(last).map(|edge| edge.map(|i| first[last] + i)).collect();
    let mut side = |name: &str, edges, radius| {
        skeleton.sides.push(Side { name: name.into(), edges, circle: Some(Circle { center, radius }) });
    };
    side("inner", inward, inner);
    side("outer", outward, outer);
    Ok(elevate(skeleton, element))
}

/// Edge length at a radius.
fn edge(inner: f64, outer: f64, size: f64, radius: f64) -> f64 {
    size.min(outer - inner).min(PI * radius / 6.0)
}

/// Radii from the inner to the outer, each with its edges per quarter.
fn circles(inner: f64, outer: f64, size: f64) -> Vec<(f64, usize)> {
    let mut radii = vec![inner];
    let mut radius = inner;
    while radius < outer {
        radius += 0.75_f64.sqrt() * edge(inner, outer, size, radius);
        radii.push(radius);
    }
    // The last circle is the outer one: the widths are scaled uniformly.
    if radii.len() > 2 && radius - outer > outer - radii[radii.len() - 2] {
        radii.pop();
    }
    let last = radii.len() - 1;
    let stretch = (outer - inner) / (radii[last] - inner);
    let at = |(k, r): (usize, f64)| {
        let r = if k == last { outer } else { inner + stretch * (r - inner) };
        (r, (PI / 2.0 * r / edge(inner, outer, size, r)).round().max(3.0) as usize)
    };
    radii.into_iter().enumerate().map(at).collect()
}

/// Triangles between m edges of the inner and n of the outer quarter: each advances by one edge
/// from nodes i and j, on the circle that lags behind; `true`: on the inner one.
fn strip(m: usize, n: usize) -> Vec<(usize, usize, bool)> {
    let mut i = 0;
    let mut j = 0;
    let mut triangles = Vec::with_capacity(m + n);
    while i < m || j < n {
        let on_inner = (2 * i + 1) * n < (2 * j + 1) * m;
        triangles.push((i, j, on_inner));
        if on_inner { i += 1 } else { j += 1 }
    }
    triangles
}

/// The i-th of 4q equally spaced points of the unit circle counter-clockwise from (1, 0); the
/// quadrants mirror each other bitwise.
fn on_circle(q: usize, i: usize) -> [f64; 2] {
    let quadrant = i / q;
    let i = i % q;
    let at = |i: usize| {
        // From the nearer axis, so that x = y on the diagonal and the axes are exact.
        let (sin, cos) = (PI / 2.0 * i.min(q - i) as f64 / q as f64).sin_cos();
        if 2 * i <= q { [cos, sin] } else { [sin, cos] }
    };
    match quadrant {
        0 => at(i),
        1 => [-at(q - i)[0], at(q - i)[1]],
        2 => at(i).map(|c| -c),
        _ => [at(q - i)[0], -at(q - i)[1]],
    }
}
