//! The straight path of a point through a rigid shape.

use carom_algebra::Vector;

use super::Obstacle;
use super::near::{Near, Point, distance};

/// Smallest part of a path between two points at which the distance is taken.
const SHORTEST: f64 = 1.0 / 1024.0;

impl Obstacle {
    /// The largest depth on the way between two points that are no deeper than `limit`, if it is
    /// deeper, and the normals where the point enters and leaves.
    ///
    /// At a distance s the signed distance is less by s at most: where it is g, a greater depth
    /// than the largest so far is not nearer than g plus that. No depth is missed by more than the
    /// shortest step, the limit or 1/1024 of the path.
    pub(in super::super) fn deepest_between(
        &self,
        from: Point,
        to: Point,
        limit: f64,
    ) -> Option<(f64, [Vector<3>; 2])> {
        let seen = |at: Point| self.near(self.nearest(at, None), at);
        let [start, end] = [from, to].map(|at| seen(at).map_or(f64::NEG_INFINITY, |near| near.gap));
        let length = distance(from, to);
        // No point of the way is further inside than the ends allow.
        if start.min(end) < -limit || 0.5 * (start + end - length) >= -limit {
            return None;
        }
        let shortest = limit.max(SHORTEST * length);
        let (mut done, mut deepest) = (0.0, limit);
        let mut normals: Option<[Vector<3>; 2]> = None;
        while done < length {
            let at = std::array::from_fn(|i| from[i] + done / length * (to[i] - from[i]));
            // At the centre of a circle there is no direction.
            let Some(Near { gap, normal, .. }) = seen(at) else {
                done += shortest;
                continue;
            };
            if gap < 0.0 {
                let here = Vector(normal);
                normals = Some([normals.map_or(here, |[first, _]| first), here]);
            }
            deepest = f64::max(deepest, -gap);
            done += (gap + deepest).max(shortest);
        }
        normals.filter(|_| deepest > limit).map(|normals| (deepest, normals))
    }
}
