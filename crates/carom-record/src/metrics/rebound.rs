//! The impact of the first episode: the striker and its own contact in it, what it strikes,
//! Newton's coefficient of restitution, and the time at which approach turns into separation.
//!
//! ```text
//! e = −(w⁺·n)/(w⁻·n)        w = v − v_other, before the contact of the striker and after it
//! n = Σ −λ n_c / |Σ −λ n_c| over the rows of contact.csv of the striker in the episode
//! turning_time              w(t)·n = 0
//! ```
//!
//! (I. Newton, *Principia*, 1687, scholium to the laws of motion.) n is the direction of the normal
//! contact impulse on the striker, without that of friction. A fixed obstacle has no velocity; one
//! that moves has that of its point at c + Σ λ (x − c)/Σ λ over those rows, with its centre c in
//! each of them; and a body has that of its centre of mass, but along an axis in which a support
//! holds or moves it, that of the support: what its centre does there is vibration.

use carom_formula::Formula;

use super::episode::{Episode, default_bridge, first_episode};
use super::given::{Given, vector};
use super::parties::{Party, own_episode, parties};
use super::striker::striker;
use crate::{History, Run};

/// Variables of the motion of a support.
const VARIABLES: [&str; 4] = ["X", "Y", "Z", "t"];

/// Velocity of approach, over the largest velocity of a party, that is round-off.
const AT_REST: f64 = 1e-9;
/// Change of the velocity of a support along the normal, over that of approach, that drives a body.
const DRIVEN: f64 = 1e-3;

/// The first episode of a run as the impact of its striker.
#[derive(Clone, Debug, PartialEq)]
pub struct Impact<'a> {
    /// Name of the striker.
    pub striker: &'a str,
    /// The contact of the striker in the first episode.
    episode: Episode,
    /// The body or obstacle that is struck; none: a fixed obstacle.
    pub others: Vec<Party<'a>>,
    /// Direction of the normal contact impulse on the striker, of length 1.
    pub normal: [f64; 3],
    /// Mean place of the contact relative to the centre of each of them, weighted with its impulse.
    pub arms: Vec<[f64; 3]>,
    /// −w⁻·n, > 0: with this velocity the striker approaches.
    pub approach: f64,
    /// w⁺·n; none if the episode has not ended.
    pub separation: Option<f64>,
}

/// Forces times places relative to the centre of a party.
struct Moment<'a> {
    /// Coordinates of the centre by row.
    center: Vec<&'a [f64]>,
    sum: [f64; 3],
    weight: f64,
}

impl<'a> Moment<'a> {
    fn about(run: &'a Run, party: Party) -> Self {
        let center = party.map_or(Vec::new(), |name| vector(&run.history, &format!("{name}.center")));
        Self { center, sum: [0.0; 3], weight: 0.0 }
    }

    fn add(&mut self, weight: f64, place: [f64; 3], row: usize) {
        for (i, x) in place.into_iter().enumerate() {
            let center = self.center.get(i).and_then(|center| center.get(row));
            self.sum[i] += weight * (x - center.unwrap_or(&0.0));
        }
        self.weight += weight;
    }

    /// Mean place relative to the centre; zero without forces.
    fn arm(&self) -> [f64; 3] {
        self.sum.map(|sum| if self.weight == 0.0 { 0.0 } else { sum / self.weight })
    }
}

impl<'a> Impact<'a> {
    /// The first impact of a run.
    ///
    /// # Errors
    /// The reason why there is none: no contact, a striker that did not approach before it, or
    /// strikes nothing but itself or several parties of different velocities, one that is tied to
    /// another body, with which it moves, or the unknown velocity of a support.
    pub fn first(run: &'a Run) -> Result<Self, &'static str> {
        if run.manifest.facts.is_static {
            return Err("load steps have no velocities");
        }
        let episode = first_episode(&run.history).ok_or("no contact closed")?;
        let striker = striker(run).ok_or("no body moves")?;
        let episode = own_episode(run, striker, episode, default_bridge(&run.history));
        let before = episode.start.checked_sub(1).ok_or("contact is closed at the start")?;
        if episode.is_within_a_step(&run.history) {
            return Err("contact begins and ends between two rows");
        }
        let mut impact =
            Self::of(striker, run, episode).ok_or("the fastest body strikes nothing but itself")?;
        let is_tied = |body: &str| run.manifest.facts.tied.iter().any(|tied| tied == body);
        if is_tied(striker) || impact.others.iter().flatten().any(|other| is_tied(other)) {
            return Err("a tied body moves with another one");
        }
        impact.approach = -impact
            .relative(run, before)
            .ok_or("several bodies of different velocities are struck, or that of a support is not known")?;
        let parties = impact.others.iter().copied().chain([Some(striker)]);
        let fastest = parties.filter_map(|party| impact.velocity(run, party, before)).flatten();
        let fastest = fastest.fold(0.0_f64, |most, v| most.max(v.abs()));
        let still = AT_REST * fastest;
        let separation = episode.end.and_then(|end| impact.relative(run, end));
        impact.separation = separation.map(|w| if w.abs() <= still { 0.0 } else { w });
        let is_approach = impact.approach > still;
        if is_approach { Ok(impact) } else { Err("the bodies did not approach each other before contact") }
    }

    /// The parties that a striker strikes in an episode, with direction and places of the normal
    /// impulse on it; none if it strikes nothing but itself.
    fn of(striker: &'a str, run: &'a Run, episode: Episode) -> Option<Self> {
        let times = run.times();
        let mut others = Vec::new();
        let mut impulse = [0.0; 3];
        let mut moments = Vec::<Moment>::new();
        for row in run.contact.iter().filter(|row| episode.contains(times, row.time)) {
            let Some([secondary, primary]) = parties(run, &row.contact) else { continue };
            let (other, sign) = match [secondary, primary].map(|party| party == Some(striker)) {
                [true, false] => (primary, -1.0),
                [false, true] => (secondary, 1.0),
                _ => continue,
            };
            let known = others.iter().position(|known| *known == other);
            let which = known.unwrap_or(others.len());
            if known.is_none() {
                others.push(other);
                moments.push(Moment::about(run, other));
            }
            let at = times.partition_point(|time| *time < row.time);
            moments[which].add(row.multiplier, row.point, at);
            (0..3).for_each(|i| impulse[i] += sign * row.multiplier * row.normal[i]);
        }
        let length = impulse.iter().fold(0.0, |length, x| f64::hypot(length, *x));
        (length > 0.0).then(|| Self {
            striker,
            episode,
            others,
            normal: impulse.map(|x| x / length),
            arms: moments.iter().map(Moment::arm).collect(),
            approach: 0.0,
            separation: None,
        })
    }

    /// Velocity of a party in a row, of an obstacle at the place of contact; none if it is that of
    /// supports which is not known.
    fn velocity(&self, run: &Run, party: Party, row: usize) -> Option<Vec<f64>> {
        let axes = vector(&run.history, "contact_force").len();
        let Some(name) = party else { return Some(vec![0.0; axes]) };
        let of_center = velocities(&run.history, name).into_iter().map(|v| v[row]);
        let which = self.others.iter().position(|other| *other == party);
        let arm = which.map_or([0.0; 3], |which| self.arms[which]);
        let turning = turning(run, name, arm, row)?;
        let prescribed = prescribed(run, name, run.times()[row])?;
        let held = of_center.zip(prescribed).map(|(v, held)| held.unwrap_or(v));
        Some(held.zip(turning).map(|(v, turning)| v + turning).collect())
    }

    /// Whether supports, or the motion of an obstacle, move a party along the normal with another
    /// velocity at the end of the contact than before it: the separation is then their work.
    fn is_driven(&self, run: &Run) -> bool {
        let Episode { start, end: Some(end) } = self.episode else { return false };
        let changes = |party: &str| {
            let rows = [start.saturating_sub(1), end].map(|row| self.driven(run, party, row));
            let [Some(before), Some(after)] = rows else { return false };
            let rates = before.into_iter().zip(after).map(|(before, after)| before.zip(after));
            let differences = rates.map(|rates| rates.map_or(0.0, |(before, after)| after - before));
            let along: f64 = differences.zip(self.normal).map(|(change, n)| change * n).sum();
            along.abs() > DRIVEN * self.approach
        };
        self.others.iter().copied().flatten().chain([self.striker]).any(changes)
    }

    /// Velocity that supports, or the motion of an obstacle, prescribe in a row, by axis; none
    /// along a free axis, and none for the whole if it is unknown.
    fn driven(&self, run: &Run, party: &str, row: usize) -> Option<[Option<f64>; 3]> {
        let is_obstacle = run.manifest.facts.contacts.iter().any(|spec| spec.name == party && spec.moves);
        let has_motion = run.history.column(&format!("{party}.reaction_x")).is_some();
        if !(is_obstacle && has_motion) {
            return prescribed(run, party, run.times()[row]);
        }
        let velocity = self.velocity(run, Some(party), row)?;
        Some(std::array::from_fn(|axis| velocity.get(axis).copied()))
    }

    /// w·n in a row; none if parties of different velocities are struck.
    fn relative(&self, run: &Run, row: usize) -> Option<f64> {
        let of_striker = self.velocity(run, Some(self.striker), row)?;
        let others = self.others.iter().map(|other| self.velocity(run, *other, row));
        let others = others.collect::<Option<Vec<_>>>()?;
        let first = others.first()?;
        let relative = of_striker.iter().zip(first).map(|(v, other)| v - other);
        let alike = others.iter().all(|other| other == first);
        alike.then(|| relative.zip(self.normal).map(|(w, n)| w * n).sum())
    }
}

/// Time in the first episode at which the striker ceases to approach what it strikes, linearly
/// interpolated between rows.
pub(super) fn turning_time(given: &Given) -> Option<f64> {
    let run = given.run?;
    let impact = Impact::first(run).ok()?;
    let rows = impact.episode.span(given.history);
    let mut before = (given.time(rows.start), -impact.approach);
    for row in rows.skip(1) {
        let (earlier, approaching) = before;
        let separating = impact.relative(run, row)?;
        if separating >= 0.0 {
            let share = approaching / (approaching - separating);
            return Some(earlier + (given.time(row) - earlier) * share);
        }
        before = (given.time(row), separating);
    }
    None
}

/// Newton's coefficient of restitution.
pub(super) fn restitution(run: &Run) -> Option<f64> {
    let impact = Impact::first(run).ok().filter(|impact| !impact.is_driven(run))?;
    impact.separation.filter(|separation| *separation >= 0.0).map(|separation| separation / impact.approach)
}

/// Why a run has no coefficient of restitution.
pub fn no_rebound(run: &Run) -> Option<&'static str> {
    match Impact::first(run) {
        Ok(impact) if impact.is_driven(run) => {
            Some("a support or the motion of an obstacle changes a velocity meanwhile")
        }
        Ok(Impact { separation: Some(separation), .. }) if separation >= 0.0 => None,
        Ok(Impact { separation: Some(_), .. }) => {
            Some("the bodies approach each other when the first contact ends")
        }
        Ok(_) => Some("the first contact lasts to the end of the run"),
        Err(why) => Some(why),
    }
}

fn velocities<'a>(history: &'a History, party: &str) -> Vec<&'a [f64]> {
    vector(history, &format!("{party}.velocity"))
}

/// Velocity, beyond that of its centre, of a point of an obstacle that turns: ω × arm, with the arm
/// from the centre to the point. None if the rate of its rotation is unknown.
fn turning(run: &Run, contact: &str, arm: [f64; 3], row: usize) -> Option<[f64; 3]> {
    let spec = run.manifest.facts.contacts.iter().find(|spec| spec.name == contact);
    let Some(turns) = spec.and_then(|spec| spec.turns.as_ref()) else { return Some([0.0; 3]) };
    let rate = rate(&turns.angle, run.times()[row])?.to_radians();
    let length = turns.axis.iter().fold(0.0, |length, x| f64::hypot(length, *x));
    Some(std::array::from_fn(|i| {
        let j = (i + 1) % 3;
        let k = (i + 2) % 3;
        rate * (turns.axis[j] * arm[k] - turns.axis[k] * arm[j]) / length
    }))
}

/// Velocity that the supports of a body prescribe, by axis; none along a free axis. None for the
/// whole if the axis or velocity of a support is unknown, or if two supports contradict each other.
fn prescribed(run: &Run, body: &str, time: f64) -> Option<[Option<f64>; 3]> {
    let mut rates = [None; 3];
    for held in run.manifest.facts.held.iter().filter(|held| held.body == body) {
        let rate = held.displacement.as_ref().map_or(Some(0.0), |text| rate(text, time))?;
        let known = rates.get_mut(held.axis?)?;
        if *known.get_or_insert(rate) != rate {
            return None;
        }
    }
    Some(rates)
}

/// Rate of a displacement; none if it depends on the place, or is a function of a program.
fn rate(displacement: &str, time: f64) -> Option<f64> {
    let formula = Formula::parse(displacement, &VARIABLES).ok()?;
    let is_uniform = !VARIABLES[..3].iter().any(|place| formula.depends_on(place));
    is_uniform.then(|| formula.with_derivatives(&[0.0, 0.0, 0.0, time], 3)[1])
}
