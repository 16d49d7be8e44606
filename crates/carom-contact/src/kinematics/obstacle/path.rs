//! The straight path of a point through a rigid shape.

use carom_algebra::Vector;

use super::Obstacle;
use super::near::{Near, Point, distance};

/// Smallest step, relative to the length of a path, between two points at which the distance is
/// evaluated.
const SHORTEST: f64 = 1.0 / 1024.0;

/// A straight path of a point through an obstacle.
pub(in super::super) struct Through {
    /// Largest depth on the path.
    pub(in super::super) depth: f64,
    /// Normals of the obstacle where the point enters and where it leaves.
    pub(in super::super) normals: [Vector<3>; 2],
}

impl Obstacle {
    /// The largest depth on a straight path between two points that are no deeper than `limit`,
    /// with the normals where the point enters and leaves; none if it is not deeper than `limit`.
    ///
    /// The signed distance changes by at most s over a path of length s: from a point where it is
    /// g, no depth greater than the largest so far is nearer than g plus that depth. No depth is
    /// missed by more than the shortest step, the limit or 1/1024 of the path.
    pub(in super::super) fn deepest_between(&self, from: Point, to: Point, limit: f64) -> Option<Through> {
        let seen = |at: Point| self.near(self.nearest(at, None), at);
        let [start, end] = [from, to].map(|at| seen(at).map_or(f64::NEG_INFINITY, |near| near.gap));
        let length = distance(from, to);
        // No point of the way is further inside than the ends allow.
        if start.min(end) < -limit || 0.5 * (start + end - length) >= -limit {
            return None;
        }
        let shortest = limit.max(SHORTEST * length);
        let mut done = 0.0;
        let mut deepest = limit;
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
        normals.filter(|_| deepest > limit).map(|normals| Through { depth: deepest, normals })
    }
}
