//! Prescribed motions: y = X + u(X, t) with v = u̇ and a = ü from the formulas' own derivatives.
//! The scheme's relations between d, v and a are not used for these dofs, so they cannot ring, and
//! their inertia M a acts on their neighbours.

use carom_formula::Formula;

use super::formulas::{Arguments, NoValue, finite, points};

/// What moves prescribed dofs.
#[derive(Clone, Debug)]
pub enum Motion {
    /// A displacement by a formula of position and time, with its label in messages.
    Displacement {
        /// Label.
        label: String,
        /// Displacement along the axis of the dof.
        formula: Formula,
    },
    /// A rigid motion.
    Rigid(Turn),
}

/// A rigid motion: with the centre c, the displacement m of the centre and the rotation R by an
/// angle θ about an axis k,
///
/// ```text
/// u = m + R r − r,   u̇ = ṁ + θ̇ k × R r,   ü = m̈ + θ̈ k × R r + θ̇² k × (k × R r),   r = X − c
/// ```
#[derive(Clone, Debug)]
pub struct Turn {
    /// Label in messages.
    pub label: String,
    /// Displacements m by axis, formulas of time; those without are zero.
    pub moves: Vec<Option<Formula>>,
    /// θ in degrees, a formula of time.
    pub angle: Formula,
    /// c.
    pub centre: Vec<f64>,
    /// k, of length one; along the third axis in the plane.
    pub axis: [f64; 3],
}

/// A prescribed dof.
#[derive(Clone, Debug)]
struct Moved {
    dof: usize,
    /// Index into `motions`.
    motion: usize,
    place: Vec<f64>,
}

/// All prescribed motions of a model.
#[derive(Default)]
pub struct Motions {
    motions: Vec<Motion>,
    moved: Vec<Moved>,
}

/// A dof's displacement, velocity and acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prescribed {
    /// Global dof.
    pub dof: usize,
    /// u, u̇, ü.
    pub motion: [f64; 3],
}

impl Motions {
    /// Prescribed motions, and each prescribed dof once, ascending, with the index of its motion
    /// and its reference position.
    pub fn new(motions: Vec<Motion>, moved: impl IntoIterator<Item = (usize, usize, Vec<f64>)>) -> Self {
        let moved = moved.into_iter().map(|(dof, motion, place)| Moved { dof, motion, place }).collect();
        Self { motions, moved }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.moved.is_empty()
    }

    /// Prescribed dofs, ascending.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.moved.iter().map(|m| m.dof)
    }

    /// Displacements, velocities and accelerations at a time; `out` is reused.
    ///
    /// # Errors
    /// The first formula without a finite value or derivative.
    pub fn at(&self, time: f64, out: &mut Vec<Prescribed>) -> Result<(), NoValue> {
        out.clear();
        let now = (0..self.motions.len()).map(|k| self.now(k, time));
        let mut now: Vec<Now> = now.collect::<Result<_, _>>()?;
        for moved in &self.moved {
            let d = moved.place.len();
            let motion = match (&self.motions[moved.motion], &mut now[moved.motion]) {
                (Motion::Displacement { label, formula }, Now::Given(values)) => {
                    let motion = match formula.function() {
                        Some(_) => values.next().unwrap_or([f64::NAN; 3]),
                        None => formula.with_derivatives(Arguments::new(&moved.place, time).as_slice(), d),
                    };
                    for value in motion {
                        finite(value, formula, label, &moved.place, time)?;
                    }
                    motion
                }
                (Motion::Rigid(turn), Now::Turned(pose)) => turn.at(pose, &moved.place, moved.dof % d),
                _ => [0.0; 3],
            };
            out.push(Prescribed { dof: moved.dof, motion });
        }
        Ok(())
    }

    /// What is found once for all dofs of a motion.
    fn now(&self, k: usize, time: f64) -> Result<Now, NoValue> {
        match &self.motions[k] {
            Motion::Displacement { formula, .. } => Ok(Now::Given(self.given(k, formula, time).into_iter())),
            Motion::Rigid(turn) => Ok(Now::Turned(turn.pose(time)?)),
        }
    }

    /// Displacements of the dofs of motion `k` with their derivatives, if its formula is a function
    /// of a program, which is called once.
    fn given(&self, k: usize, formula: &Formula, time: f64) -> Vec<[f64; 3]> {
        let Some(function) = formula.function() else { return Vec::new() };
        let moved = self.moved.iter().filter(|moved| moved.motion == k);
        let places: Vec<&[f64]> = moved.map(|moved| moved.place.as_slice()).collect();
        let Some(width) = places.first().map(|place| place.len() + 1) else { return Vec::new() };
        function.with_derivatives(&points(&places, time), width)
    }
}

/// A motion at a time.
enum Now {
    /// Values of a function of a program.
    Given(std::vec::IntoIter<[f64; 3]>),
    Turned(Pose),
}

/// A rigid motion at a time: m by axis, and θ in radians, with their derivatives.
struct Pose {
    moves: Vec<[f64; 3]>,
    angle: [f64; 3],
}

impl Turn {
    fn pose(&self, time: f64) -> Result<Pose, NoValue> {
        let at = |formula: &Formula| -> Result<[f64; 3], NoValue> {
            let place = &self.centre;
            let values = match formula.function() {
                Some(function) => {
                    let found = function.with_derivatives(&points(&[place], time), place.len() + 1);
                    found.first().copied().unwrap_or([f64::NAN; 3])
                }
                None => formula.with_derivatives(Arguments::new(place, time).as_slice(), place.len()),
            };
            for value in values {
                finite(value, formula, &self.label, place, time)?;
            }
            Ok(values)
        };
        let moves = self.moves.iter().map(|formula| formula.as_ref().map_or(Ok([0.0; 3]), at));
        let moves = moves.collect::<Result<_, _>>()?;
        Ok(Pose { moves, angle: at(&self.angle)?.map(f64::to_radians) })
    }

    /// u, u̇ and ü of a place along an axis.
    fn at(&self, pose: &Pose, place: &[f64], i: usize) -> [f64; 3] {
        let k = self.axis;
        let r: [f64; 3] = std::array::from_fn(|i| place.get(i).map_or(0.0, |x| x - self.centre[i]));
        let [angle, rate, change] = pose.angle;
        let (sin, cos) = angle.sin_cos();
        // 1 − cos θ without cancellation.
        let half = (0.5 * angle).sin();
        let versine = 2.0 * half * half;
        let along = dot(k, r);
        let aside = cross(k, r);
        // R r − r and R r, by the formula of Rodrigues.
        let turned: [f64; 3] = std::array::from_fn(|i| sin * aside[i] + versine * (along * k[i] - r[i]));
        let now: [f64; 3] = std::array::from_fn(|i| cos * r[i] + sin * aside[i] + versine * along * k[i]);
        let swept = cross(k, now);
        let inwards = cross(k, swept);
        let [m, v, a] = pose.moves.get(i).copied().unwrap_or([0.0; 3]);
        [m + turned[i], v + rate * swept[i], a + change * swept[i] + rate * rate * inwards[i]]
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| {
        let [j, k] = [(i + 1) % 3, (i + 2) % 3];
        a[j] * b[k] - a[k] * b[j]
    })
}
