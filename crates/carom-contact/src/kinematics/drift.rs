//! Mean motion of the facets of a side in a step. Boxes of paths are those in the frame that moves
//! with it: bodies that fly together stay near what they are near, and which facets are near a node
//! does not depend on the frame in which all of them are seen.

use carom_solid::Bounds;

/// The mean motion of a side in a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Drift {
    motion: [f64; 3],
}

impl Drift {
    /// The mean over nodes in `dimension` dimensions, each as often as it is given, between
    /// positions flat over all nodes.
    pub(crate) fn of(
        nodes: impl Iterator<Item = usize>,
        dimension: usize,
        [before, now]: [&[f64]; 2],
    ) -> Self {
        let mut sum = [0.0; 3];
        let mut count = 0.0;
        for node in nodes {
            (0..dimension).for_each(|i| sum[i] += now[node * dimension + i] - before[node * dimension + i]);
            count += 1.0;
        }
        let motion = sum.map(|sum| sum / count);
        // Without nodes, or with positions that are not finite, the frame is at rest.
        Self { motion: motion.map(|x| if x.is_finite() { x } else { 0.0 }) }
    }

    /// The box, in the moving frame, of what one box contains at the start and another at the end.
    pub(crate) fn path(&self, before: Bounds, now: Bounds) -> Bounds {
        before.union(&now.moved(self.motion.map(|x| -x)))
    }

    /// A point, given by one to three coordinates at the instant θ of the step, in the moving
    /// frame.
    pub(crate) fn seen(&self, theta: f64, point: &[f64]) -> [f64; 3] {
        let at = |i: usize| point.get(i).map_or(0.0, |x| x - theta * self.motion[i]);
        std::array::from_fn(at)
    }
}
