//! Rigid obstacles in space as lines on their surfaces, near the bodies: a grid on a plane, circles
//! on a sphere, circles and lines on a cylinder, edges of a triangulated surface.

use carom_case::{ContactSpec, ObstacleMotion, PrimarySpec};
use carom_formula::Formula;
use carom_record::Run;

use super::skin::Place;
use super::view::{cross, dot, length, minus};
use crate::obstacles::recorded;
use crate::recorded::Recorded;

/// Points on a line, and lines in each of both directions.
const POINTS: usize = 96;
const LINES: usize = 8;
/// How far beyond the box of the bodies obstacles are drawn, over its diagonal.
const MARGIN: f64 = 0.15;
/// Extent of a triangulated surface, over the same diagonal, up to which all of it is drawn.
const WHOLE: f64 = 8.0;

/// The lines of an obstacle, and how it moves.
pub(crate) struct Wire {
    segments: Vec<[Place; 2]>,
    /// Columns of its position, and where it is at first.
    center: [String; 3],
    origin: Place,
    /// How it turns about that place.
    turn: Option<Turn>,
}

/// The rotation of an obstacle.
struct Turn {
    /// Angle in degrees over time.
    angle: Formula,
    axis: Place,
}

/// The obstacles of a run whose bodies fill a box.
pub(crate) fn wires(run: &Recorded, [low, high]: [Place; 2]) -> Vec<Wire> {
    let of = |contact: &ContactSpec| {
        let surface = run.manifest.surfaces.get(&contact.name);
        let surface = surface.map_or(&[][..], Vec::as_slice);
        let ObstacleMotion::Prescribed { rotate: Some((angle, about)), axis: Some(axis), .. } =
            &contact.motion
        else {
            return one(&contact.name, &contact.primary, surface, [low, high], MARGIN);
        };
        // An obstacle that is away from the bodies at first may turn towards them.
        let wire = one(&contact.name, &contact.primary, surface, [low, high], WHOLE)?;
        let turn = Turn { angle: angle.formula(&["t"]).ok()?, axis: unit(place(axis)?) };
        Some(Wire { origin: place(about)?, turn: Some(turn), ..wire })
    };
    run.case.contacts.iter().filter_map(of).collect()
}

/// A point or vector in space.
fn place(v: &[f64]) -> Option<Place> {
    v.try_into().ok()
}

fn plus(a: Place, factor: f64, b: Place) -> Place {
    [0, 1, 2].map(|i| a[i] + factor * b[i])
}

fn unit(v: Place) -> Place {
    v.map(|x| x / length(v))
}

/// Two directions across a third one, along axes of coordinates where they can be.
fn across(n: Place) -> [Place; 2] {
    let least = (1..3).fold(0, |least, i| if n[i].abs() < n[least].abs() { i } else { least });
    let axis = [0, 1, 2].map(|i| if i == least { 1.0 } else { 0.0 });
    let first = unit(plus(axis, -dot(axis, n), n));
    [first, cross(n, first)]
}

/// The lines of one obstacle near bodies, within a margin over the diagonal of their box; `surface`
/// is the edges of a triangulated one.
fn one(
    name: &str,
    primary: &PrimarySpec,
    surface: &[[Place; 2]],
    [low, high]: [Place; 2],
    margin: f64,
) -> Option<Wire> {
    let diagonal = length(minus(high, low));
    let middle = plus(low, 0.5, minus(high, low));
    let reach = (0.5 + MARGIN) * diagonal;
    let share = |k: usize, n: usize| k as f64 / n as f64;
    let angle = |k: usize, n: usize| (std::f64::consts::TAU * share(k, n)).sin_cos();
    let (lines, origin): (Vec<Vec<Place>>, Place) = match primary {
        PrimarySpec::Plane { point, normal } => {
            let normal = unit(place(normal)?);
            let point = place(point)?;
            let foot = plus(middle, -dot(minus(middle, point), normal), normal);
            let line = |[along, beside]: [Place; 2], k: usize| {
                let start = plus(foot, reach * (2.0 * share(k, LINES) - 1.0), beside);
                (0..=POINTS).map(|i| plus(start, reach * (2.0 * share(i, POINTS) - 1.0), along)).collect()
            };
            let [a, b] = across(normal);
            ((0..=LINES).flat_map(|k| [line([a, b], k), line([b, a], k)]).collect(), point)
        }
        PrimarySpec::Cylinder { point, axis, radius, .. } => {
            let axis = unit(place(axis)?);
            let point = place(point)?;
            let foot = plus(point, dot(minus(middle, point), axis), axis);
            let [a, b] = across(axis);
            let at = |along: f64, (sin, cos): (f64, f64)| {
                plus(plus(plus(foot, reach * (2.0 * along - 1.0), axis), radius * cos, a), radius * sin, b)
            };
            let circle = |k: usize| (0..=POINTS).map(|i| at(share(k, LINES), angle(i, POINTS))).collect();
            let line = |k: usize| (0..=POINTS).map(|i| at(share(i, POINTS), angle(k, 2 * LINES))).collect();
            ((0..=LINES).map(circle).chain((0..2 * LINES).map(line)).collect(), point)
        }
        PrimarySpec::Surface(_) => {
            // In pieces, of which those that are near are drawn.
            let pieces = |&[a, b]: &[Place; 2]| -> Vec<Place> {
                let along = minus(b, a);
                let count = (20.0 * length(along) / diagonal).ceil().clamp(1.0, POINTS as f64) as usize;
                (0..=count).map(|k| plus(a, share(k, count), along)).collect()
            };
            (surface.iter().map(pieces).collect(), [0.0; 3])
        }
        PrimarySpec::Circle { center, radius, .. } => {
            let center = place(center)?;
            let at = |(sin, cos): (f64, f64), (up, out): (f64, f64)| {
                plus(center, *radius, [out * cos, out * sin, up])
            };
            let meridian =
                |k: usize| (0..=POINTS).map(|i| at(angle(k, 2 * LINES), angle(i, POINTS))).collect();
            let parallel = |k: usize| {
                let height = std::f64::consts::PI * (share(k, LINES) - 0.5);
                (0..=POINTS).map(|i| at(angle(i, POINTS), height.sin_cos())).collect()
            };
            ((0..LINES).map(meridian).chain((1..LINES).map(parallel)).collect(), center)
        }
        PrimarySpec::Side(_) | PrimarySpec::Polyline { .. } => return None,
    };
    let is_near =
        |p: &Place| (0..3).all(|i| p[i] >= low[i] - margin * diagonal && p[i] <= high[i] + margin * diagonal);
    let extent = |i: usize| {
        let along = surface.iter().flatten().map(|p| p[i]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    };
    let is_whole = !surface.is_empty() && (0..3).all(|i| extent(i) <= WHOLE * diagonal);
    let pieces = lines.iter().flat_map(|line: &Vec<Place>| line.windows(2)).map(|w| [w[0], w[1]]);
    let segments: Vec<[Place; 2]> = pieces.filter(|piece| is_whole || piece.iter().all(is_near)).collect();
    let center = ["x", "y", "z"].map(|axis| format!("{name}.center_{axis}"));
    (!segments.is_empty()).then_some(Wire { segments, center, origin, turn: None })
}

impl Wire {
    /// Lines of the obstacle where it is at first.
    pub(crate) fn at_first(&self) -> &[[Place; 2]] {
        &self.segments
    }

    /// The rotation of its points, and what is added to them then, by rows, at a recorded time.
    pub(crate) fn pose(&self, run: &Run, time: f64) -> [[f64; 4]; 3] {
        let center = [0, 1, 2].map(|i| recorded(run, &self.center[i], time).unwrap_or(self.origin[i]));
        let turned = |v: Place| match &self.turn {
            None => v,
            Some(Turn { angle, axis }) => {
                let (sin, cos) = angle.value(&[time]).to_radians().sin_cos();
                let along = dot(*axis, v);
                let aside = cross(*axis, v);
                [0, 1, 2].map(|i| cos * v[i] + sin * aside[i] + (1.0 - cos) * along * axis[i])
            }
        };
        let columns = [0, 1, 2].map(|k| turned([0, 1, 2].map(|i| if i == k { 1.0 } else { 0.0 })));
        let origin = turned(self.origin);
        [0, 1, 2].map(|i| [columns[0][i], columns[1][i], columns[2][i], center[i] - origin[i]])
    }

    /// Lines of the obstacle at a recorded time.
    pub(crate) fn at(&self, run: &Run, time: f64) -> Vec<[Place; 2]> {
        let pose = self.pose(run, time);
        let placed = |p: Place| pose.map(|[a, b, c, shift]| a * p[0] + b * p[1] + c * p[2] + shift);
        self.segments.iter().map(|piece| piece.map(placed)).collect()
    }
}

#[cfg(test)]
mod tests {
    use carom_case::SurfaceSpec;

    use super::*;

    #[test]
    fn lines_lie_on_their_surface_near_the_bodies() {
        let plane = PrimarySpec::Plane { point: vec![0.0, 0.0, -0.1], normal: vec![0.0, 1.0, 2.0] };
        let circle = PrimarySpec::Circle { center: vec![0.0, 0.0, -2.0], radius: 2.0, inside: false };
        let point = vec![0.0, 9.0, 0.5];
        let cylinder = PrimarySpec::Cylinder { point, axis: vec![0.0, 3.0, 0.0], radius: 0.7, inside: false };
        let primaries = [(plane, 0.0), (circle, 2.0), (cylinder, 0.7)];
        for (k, (primary, radius)) in primaries.into_iter().enumerate() {
            let box_of = [[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]];
            let wire = one("strike", &primary, &[], box_of, MARGIN).unwrap();
            assert!(wire.at_first().len() > 100, "{k}");
            for p in wire.at_first().iter().flatten() {
                let distance = match k {
                    0 => p[1] + 2.0 * (p[2] + 0.1),
                    1 => dot(minus(*p, wire.origin), minus(*p, wire.origin)).sqrt(),
                    _ => p[0].hypot(p[2] - 0.5),
                };
                assert!((distance - radius).abs() < 1e-12, "{k}: {p:?}");
                assert!(p.iter().all(|x| x.abs() < 1.5), "{k}: {p:?}");
            }
        }
        let of =
            |primary: &PrimarySpec, surface: &[_]| one("a", primary, surface, [[0.0; 3], [1.0; 3]], MARGIN);
        assert!(of(&PrimarySpec::Side("b.top".into()), &[]).is_none());
        let surface = PrimarySpec::Surface(SurfaceSpec {
            file: "a.stl".into(),
            group: None,
            scale: 1.0,
            reverse: false,
            hash: String::new(),
            triangles: 0,
            rim: 0,
            inner: 0,
        });
        let wire = of(&surface, &[[[0.0; 3], [99.0, 0.0, 0.0]]]).unwrap();
        let reach = |wire: &Wire| wire.at_first().iter().flatten().map(|p| p[0]).fold(0.0, f64::max);
        assert!(reach(&wire) > 1.0 && reach(&wire) < 1.3, "{}", reach(&wire));
        let wire = of(&surface, &[[[0.0; 3], [9.0, 0.0, 0.0]]]).unwrap();
        assert_eq!(reach(&wire), 9.0);
    }
}
