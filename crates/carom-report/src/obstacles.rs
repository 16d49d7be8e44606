//! Rigid obstacles in figures: points of their surfaces with normals, at their recorded positions.

use carom_case::{Case, ContactSpec, ObstacleMotion, PrimarySpec};
use carom_formula::Formula;
use carom_record::Run;

use crate::pen::{NOTHING, Point, around};
use crate::recorded::Recorded;
use crate::symbols::{direction, plus};

/// Points with unit normals out of the rigid body.
pub(crate) type Walk = Vec<(Point, Point)>;

/// Points on a segment, on a circle and on an arc.
const STRAIGHT: usize = 96;
const ROUND: usize = 144;
const ARC: usize = 12;
/// Extent, relative to that of the bodies, up to which an obstacle is shown as a whole.
const WHOLE: f64 = 8.0;

/// An obstacle as given, and how it moves.
pub(crate) struct Obstacle {
    walk: Walk,
    /// Whether it is a plane: it does not count for the extent of a picture.
    pub(crate) is_plane: bool,
    /// Columns of its position, and where it is at first.
    center: [String; 2],
    about: Point,
    /// Degrees as a function of t.
    angle: Option<Formula>,
}

/// The obstacles of a run in the plane whose bodies fill a frame (left, right, bottom, top).
pub(crate) fn all(run: &Recorded, frame: [f64; 4]) -> Vec<Obstacle> {
    of_case(&run.case, frame)
}

/// The obstacles of a case, likewise.
pub(crate) fn of_case(case: &Case, frame: [f64; 4]) -> Vec<Obstacle> {
    case.contacts.iter().filter_map(|contact| one(contact, frame)).collect()
}

/// The first two components of a point or vector; those that are missing are zero.
fn flat(v: &[f64]) -> Point {
    [0, 1].map(|i| v.get(i).copied().unwrap_or(0.0))
}

fn one(contact: &ContactSpec, [x0, x1, y0, y1]: [f64; 4]) -> Option<Obstacle> {
    let far = 4.0 * (x1 - x0).hypot(y1 - y0);
    let mut is_plane = false;
    let (walk, first) = match &contact.primary {
        PrimarySpec::Plane { point, normal } => {
            is_plane = true;
            let p = flat(point);
            let n = direction([0.0; 2], flat(normal));
            let along = [n[1], -n[0]];
            // Around the point nearest to the bodies.
            let middle = [0.5 * (x0 + x1), 0.5 * (y0 + y1)];
            let foot = plus(p, (middle[0] - p[0]) * n[1] - (middle[1] - p[1]) * n[0], along);
            (straight(plus(foot, -far, along), plus(foot, far, along), n), p)
        }
        PrimarySpec::Circle { center, radius, inside } => {
            let side = if *inside { -1.0 } else { 1.0 };
            let around = [0.0, side * std::f64::consts::TAU];
            (arc(flat(center), *radius, around, side, ROUND), flat(center))
        }
        PrimarySpec::Polyline { points, radius } => (polyline(points, *radius, far), *points.first()?),
        PrimarySpec::Side(_) | PrimarySpec::Cylinder { .. } | PrimarySpec::Surface(_) => return None,
    };
    let rotate = match &contact.motion {
        ObstacleMotion::Prescribed { rotate, .. } => rotate.as_ref(),
        ObstacleMotion::Fixed | ObstacleMotion::Free { .. } => None,
    };
    let angle = rotate.and_then(|(angle, _)| angle.formula(&["t"]).ok());
    let about = rotate.map_or(first, |(_, about)| flat(about));
    let center = ["x", "y"].map(|axis| format!("{}.center_{axis}", contact.name));
    Some(Obstacle { walk, is_plane, center, about, angle })
}

/// The value of a column at a recorded time.
pub(crate) fn recorded(run: &Run, column: &str, time: f64) -> Option<f64> {
    let times = run.times();
    let row = times.partition_point(|t| *t < time - 1e-12 * time.abs()).min(times.len().saturating_sub(1));
    run.column(column)?.get(row).copied()
}

fn straight(a: Point, b: Point, normal: Point) -> Walk {
    let at = |k: usize| k as f64 / STRAIGHT as f64;
    (0..=STRAIGHT).map(|k| ([0, 1].map(|i| a[i] + at(k) * (b[i] - a[i])), normal)).collect()
}

/// An arc between two angles, with normals away from its centre or (`side` = −1) towards it.
fn arc(c: Point, r: f64, [from, to]: [f64; 2], side: f64, count: usize) -> Walk {
    let at = |k: usize| {
        let (sin, cos) = (from + (to - from) * k as f64 / count as f64).sin_cos();
        ([c[0] + r * cos, c[1] + r * sin], [side * cos, side * sin])
    };
    (0..=count).map(at).collect()
}

/// A chain with rounded corners; the ends of an open one are `far` away.
fn polyline(points: &[Point], radius: f64, far: f64) -> Walk {
    let count = points.len() - 1;
    let closed = count > 2 && points[0] == points[count];
    let tangents: Vec<Point> = points.windows(2).map(|p| direction(p[0], p[1])).collect();
    let turn = |a: Point, b: Point| (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
    let mut walk = Walk::new();
    for (k, t) in tangents.iter().enumerate() {
        let normal = [t[1], -t[0]];
        let before = (closed || k > 0).then(|| turn(tangents[(k + count - 1) % count], *t));
        let after = (closed || k + 1 < count).then(|| turn(*t, tangents[(k + 1) % count]));
        let cut = |angle: Option<f64>| angle.map_or(-far, |angle| radius * (0.5 * angle).tan().abs());
        let end = plus(points[k + 1], -cut(after), *t);
        walk.extend(straight(plus(points[k], cut(before), *t), end, normal));
        if let Some(angle) = after.filter(|_| radius > 0.0) {
            let side = angle.signum();
            let center = plus(end, -side * radius, normal);
            let from = (side * normal[1]).atan2(side * normal[0]);
            walk.extend(arc(center, radius, [from, from + angle], side, ARC));
        }
    }
    walk
}

impl Obstacle {
    /// Whether it has a recorded position.
    pub(crate) fn moves(&self, run: &Run) -> bool {
        run.column(&self.center[0]).is_some()
    }

    /// Surface of the obstacle as the case gives it.
    pub(crate) fn at_first(&self) -> &Walk {
        &self.walk
    }

    /// The point of a moving plane that is below the bodies at first, with the normal, at a
    /// recorded time: the plane itself looks the same wherever it is.
    pub(crate) fn mark(&self, run: &Run, time: f64) -> Option<(Point, Point)> {
        (self.is_plane && self.moves(run)).then(|| self.at(run, time)[STRAIGHT / 2])
    }

    /// Points and normals of an obstacle in one list, relative to the point about which it turns.
    pub(crate) fn base(&self) -> Vec<f64> {
        let rounded = |x: f64| format!("{x:.6e}").parse().unwrap_or(0.0);
        let [a, b] = self.about;
        self.walk.iter().flat_map(|(p, n)| [p[0] - a, p[1] - b, n[0], n[1]]).map(rounded).collect()
    }

    /// Position, and sine and cosine of the angle, at a recorded time.
    pub(crate) fn pose(&self, run: &Run, time: f64) -> [f64; 4] {
        let place = |i: usize| recorded(run, &self.center[i], time);
        let (sin, cos) = self.angle.as_ref().map_or(0.0, |f| f.value(&[time])).to_radians().sin_cos();
        [place(0).unwrap_or(self.about[0]), place(1).unwrap_or(self.about[1]), sin, cos]
    }

    /// Surface of the obstacle at a recorded time.
    pub(crate) fn at(&self, run: &Run, time: f64) -> Walk {
        let [x, y, sin, cos] = self.pose(run, time);
        let turned = |v: Point| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]];
        let point = |p: Point| {
            let arm = turned([p[0] - self.about[0], p[1] - self.about[1]]);
            [x + arm[0], y + arm[1]]
        };
        self.walk.iter().map(|&(p, n)| (point(p), turned(n))).collect()
    }

    /// A frame that shows its surface too: all of it up to a few sizes of the bodies, otherwise
    /// what is near them.
    pub(crate) fn shown_in(&self, walk: &Walk, frame: [f64; 4], bodies: [f64; 4]) -> [f64; 4] {
        if self.is_plane {
            return frame;
        }
        let size = (bodies[1] - bodies[0]).max(bodies[3] - bodies[2]);
        let [left, right, bottom, top] = around(NOTHING, walk.iter().map(|(p, _)| *p));
        let is_whole = (right - left).max(top - bottom) <= WHOLE * size;
        let size = if is_whole { f64::INFINITY } else { 1.5 * size };
        let near = |p: &Point, i: usize| p[i].clamp(bodies[2 * i] - size, bodies[2 * i + 1] + size);
        around(frame, walk.iter().map(|(p, _)| [near(p, 0), near(p, 1)]))
    }
}

/// The part of a segment inside a frame, between 0 and 1 from its start (Liang and Barsky 1984).
fn inside(a: Point, b: Point, frame: [f64; 4]) -> Option<[f64; 2]> {
    let mut from = 0.0_f64;
    let mut to = 1.0_f64;
    for i in 0..2 {
        let d = b[i] - a[i];
        let ends = [frame[2 * i] - a[i], frame[2 * i + 1] - a[i]];
        if d == 0.0 {
            if ends[0] > 0.0 || ends[1] < 0.0 {
                return None;
            }
            continue;
        }
        let [enter, leave] = if d > 0.0 { ends } else { [ends[1], ends[0]] };
        (from, to) = (from.max(enter / d), to.min(leave / d));
    }
    (from < to).then_some([from, to])
}

/// The parts of a surface inside a frame.
pub(crate) fn clipped(walk: &Walk, frame: [f64; 4]) -> Vec<Walk> {
    let mut parts: Vec<Walk> = Vec::new();
    let mut continues = false;
    for pair in walk.windows(2) {
        let [(a, n), (b, m)] = [pair[0], pair[1]];
        let Some([from, to]) = inside(a, b, frame) else {
            continues = false;
            continue;
        };
        let at = |s: f64| [0, 1].map(|i| a[i] + s * (b[i] - a[i]));
        if !continues || from > 0.0 {
            parts.push(vec![(at(from), n)]);
        }
        if let Some(part) = parts.last_mut() {
            part.push((at(to), m));
        }
        continues = to == 1.0;
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: y = x from −1 to 3 crosses the unit square at its corners; a line outside has no
    /// part.
    #[test]
    fn surfaces_end_at_the_frame() {
        let n = [0.0, 1.0];
        let walk = |points: &[Point]| points.iter().map(|p| (*p, n)).collect::<Walk>();
        let frame = [0.0, 1.0, 0.0, 1.0];
        let parts = clipped(&walk(&[[-1.0, -1.0], [0.5, 0.5], [3.0, 3.0]]), frame);
        assert_eq!(parts, [walk(&[[0.0, 0.0], [0.5, 0.5], [1.0, 1.0]])]);
        assert!(clipped(&walk(&[[-1.0, 2.0], [3.0, 2.0]]), frame).is_empty());
        let there_and_back = walk(&[[0.5, 0.5], [2.0, 0.5], [2.0, 0.25], [0.5, 0.25]]);
        assert_eq!(clipped(&there_and_back, frame).len(), 2);
    }
}
