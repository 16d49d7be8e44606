//! Rigid planes in the drawing of a case.

use serde_json::Value;

use super::drawing::{BAR, PRIMARY, Setup};
use crate::obstacles::Walk;
use crate::pen::{Pen, Point};
use crate::symbols::{direction, plus, wall};
use crate::values::{list, place, vector};

/// The drawn part of a rigid plane in 2D.
pub(super) struct RigidPlane {
    pub(super) ends: [Point; 2],
    /// Unit normal out of the rigid body.
    normal: Point,
}

/// The rigid planes of a case along the bounding box of the bodies: from left to right where they
/// are closer to horizontal, from bottom to top otherwise.
pub(super) fn rigid(case: &Value, [x0, x1, y0, y1]: [f64; 4]) -> Vec<RigidPlane> {
    let planes = list(case, "contacts").iter().filter_map(|c| c.pointer("/primary/plane"));
    let one = |plane: &Value| {
        let [px, py]: Point = place(plane.get("point"))?;
        let normal = direction([0.0; 2], place(plane.get("normal"))?);
        let [nx, ny] = normal;
        let ends = if ny.abs() >= nx.abs() {
            [x0, x1].map(|x| [x, py - (x - px) * nx / ny])
        } else {
            [y0, y1].map(|y| [px - (y - py) * ny / nx, y])
        };
        (normal != [0.0; 2]).then_some(RigidPlane { ends, normal })
    };
    planes.filter_map(one).collect()
}

impl Setup<'_> {
    /// Draws a rigid surface, hatched on the rigid side.
    pub(super) fn obstacle(&self, out: &mut String, walk: &Walk) {
        let line: Vec<_> = walk.iter().map(|&(p, n)| (self.to(p), [-n[0], n[1]])).collect();
        wall(out, &line, 0.0);
        let mut pen = Pen::default();
        for (k, (p, _)) in line.iter().enumerate() {
            if k == 0 { pen.go(*p) } else { pen.draw(&[*p]) }
        }
        Self::stroke(out, &pen, PRIMARY);
    }

    /// Draws the rigid planes, hatched on the rigid side: walls in 1D, lines that extend `air`
    /// pixels beyond the bodies in 2D.
    pub(super) fn planes(&self, out: &mut String, planes: &[RigidPlane], air: f64) {
        let mut draw = |ends: [Point; 2], outward: Point| {
            wall(out, &ends.map(|p| (p, outward)), 0.0);
            let mut pen = Pen::default();
            pen.go(ends[0]);
            pen.draw(&[ends[1]]);
            Self::stroke(out, &pen, PRIMARY);
        };
        for plane in planes {
            let [a, b] = plane.ends.map(|p| self.to(p));
            let along = direction(a, b);
            draw([plus(a, -air, along), plus(b, air, along)], [-plane.normal[0], plane.normal[1]]);
        }
        let walls = list(self.case(), "contacts").iter().filter_map(|c| c.pointer("/primary/plane"));
        for wall in walls.filter(|_| self.flat) {
            let [x, y] = self.to([vector(wall.get("point")).first().copied().unwrap_or(0.0), 0.0]);
            let inward = vector(wall.get("normal")).first().copied().unwrap_or(1.0);
            let half = BAR + 8.0;
            draw([[x, y - half], [x, y + half]], [-inward.signum(), 0.0]);
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// Bodies in 0 ≤ x ≤ 2, 1 ≤ y ≤ 4, the floor y = 0, a slope x + 3y = 0 and a wall x = −1.
    #[test]
    fn planes_reach_along_the_bodies() {
        let plane = |point: [f64; 2], normal: [f64; 2]| json!({ "point": point, "normal": normal });
        let contact = |point, normal| json!({ "primary": { "plane": plane(point, normal) } });
        let case = json!({ "contacts": [
            contact([9.0, 0.0], [0.0, 1.0]), contact([3.0, -1.0], [1.0, 3.0]),
            contact([-1.0, 0.0], [2.0, 0.0]), { "primary": { "side": "a.top" } },
        ] });
        let planes = rigid(&case, [0.0, 2.0, 1.0, 4.0]);
        let close = |ends: [Point; 2], right: [Point; 2]| {
            ends.iter().flatten().zip(right.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        assert_eq!(planes.len(), 3);
        assert!(close(planes[0].ends, [[0.0, 0.0], [2.0, 0.0]]));
        assert!(close(planes[1].ends, [[0.0, 0.0], [2.0, -2.0 / 3.0]]));
        assert!(close(planes[2].ends, [[-1.0, 1.0], [-1.0, 4.0]]) && planes[2].normal == [1.0, 0.0]);
    }
}
