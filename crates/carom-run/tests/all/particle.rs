//! A particle of unit mass on which the loads of a body act, without gravity. Its scheme is linear,
//! so that it has the part of the loads in the body's sums of M v and M a.

use carom_time::{Kernel, Memory, PreviousStep, Stage};

/// A particle under the loads of a body.
pub(super) struct Particle {
    /// Velocity and acceleration.
    pub v: [f64; 3],
    pub a: [f64; 3],
    /// The load at the state, and its time.
    pub load: [f64; 3],
    pub time: f64,
    /// The increment of the last step and the velocity at its start.
    last: [[f64; 3]; 2],
}

impl Particle {
    pub(super) fn new(load: [f64; 3], time: f64) -> Self {
        Self { v: [0.0; 3], a: load, load, time, last: [[0.0; 3]; 2] }
    }

    /// One step; without a kernel, by the trapezoidal rule. `load_at`: the load at a time.
    pub(super) fn advance(
        &mut self,
        kernel: Option<&dyn Kernel>,
        dt: f64,
        has_previous: bool,
        load_at: impl Fn(f64) -> [f64; 3],
    ) {
        let end = load_at(self.time + dt);
        let mut ends = vec![([0.0; 3], self.v, self.a)];
        let [increment, velocity] = &self.last;
        let before = has_previous.then_some(PreviousStep { increment, velocity });
        let mut stage = Stage::default();
        for k in 0..kernel.map_or(0, Kernel::stages) {
            let states: Vec<_> = ends.iter().map(|(y, v, a)| (&y[..], &v[..], &a[..])).collect();
            kernel.unwrap().stage_into(k, dt, &Memory { states: &states, before }, &mut stage);
            let Stage { weights: w, before: b, .. } = &stage;
            let at = stage.end * (1.0 - stage.average);
            let now = if at == 1.0 { end } else { load_at(self.time + at * dt) };
            let a: [f64; 3] = std::array::from_fn(|i| {
                (w.external * now[i] + b.external * self.load[i] - b.mass * self.a[i]) / w.mass
            });
            let d: [f64; 3] =
                std::array::from_fn(|i| (a[i] - stage.acceleration.at_start[i]) / stage.acceleration.slope);
            let mut v = [0.0; 3];
            stage.velocity.value_into(&d, &mut v);
            ends.push((d, v, a));
        }
        let (d, v, a) = match ends[..] {
            [_] => {
                let v = std::array::from_fn(|i| self.v[i] + 0.5 * dt * (self.load[i] + end[i]));
                ([0.0; 3], v, end)
            }
            [.., last] => last,
            [] => unreachable!(),
        };
        self.last = [d, self.v];
        (self.v, self.a, self.load, self.time) = (v, a, end, self.time + dt);
    }

    /// A projection replaces the acceleration by that of the balance; a two-step scheme goes on
    /// from a step with it (`carom-time/src/schemes/bdf2.rs`).
    pub(super) fn project(&mut self, dt: f64) {
        self.a = self.load;
        for i in 0..3 {
            self.last[0][i] = dt * (self.v[i] - 0.5 * dt * self.a[i]);
            self.last[1][i] = self.v[i] - dt * self.a[i];
        }
    }
}
