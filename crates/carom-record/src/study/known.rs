//! Histories that a reference knows, with their uncertainties: groups of columns with one scale,
//! compared in the norm in which arms are compared with them.

use super::convergence::converged_by;
use super::digits::short;
use super::exact::Exact;
use super::groups::{Group, Kind};
use super::levels::Levels;
use super::trajectory::Trajectory;
use crate::Reason;
use crate::metrics::Distance;

/// Largest uncertainty of an established value, relative to the value; of a history, relative to
/// its norm.
pub(super) const RESOLVED: f64 = 0.5;
/// Why nothing is known from one mesh.
pub(super) const ONE_MESH: &str = "its mesh was not refined";
/// Ratio of successive distances below which a rough part converges.
const CONVERGES: f64 = 0.9;

/// Columns with one scale, of which the reference is known up to an uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// The columns.
    pub group: Group,
    /// Scale of the errors.
    pub scale: f64,
    /// Windows of the averages: w, w/2 and 2w for forces and stresses, none for motion.
    pub windows: Vec<f64>,
    /// Uncertainty of the average over each window, or why there is none.
    pub uncertainty: Result<Vec<f64>, Reason>,
    /// Uncertainty of the rough part, where that converges.
    pub noise: Option<f64>,
}

/// Distances of the runs of a reference.
struct Apart {
    /// Distances between successive levels.
    levels: Vec<Distance>,
    /// Largest distances of a member from the first, at the finest level, for all phases.
    members: Distance,
    /// Largest distances of another scheme and of a longer step.
    checks: Distance,
    /// Distance of motion between the rows of the finest run from the chords that stand for it.
    interpolated: f64,
}

impl Apart {
    /// Distances in a group of columns; none if a run lacks it.
    fn of(group: &Group, runs: &Levels, window: f64) -> Option<Self> {
        let finest = runs.finest()?;
        let between = |a: &Trajectory, b: &Trajectory| group.signal(a)?.distance(&group.signal(b)?, window);
        let levels = runs.all.windows(2);
        let levels = levels.map(|pair| between(pair[0].members.first()?, pair[1].members.first()?));
        let farthest = |runs: &[Trajectory]| {
            runs.iter().try_fold(Distance::default(), |most, run| {
                let next = between(run, finest)?;
                Some(Distance { smooth: most.smooth.max(next.smooth), rough: most.rough.max(next.rough) })
            })
        };
        let levels = levels.collect::<Option<Vec<Distance>>>()?;
        let last = runs.all.last()?;
        let members = farthest(last.members.get(1..)?)?.relative_to(1.0 / last.between_phases());
        let is_interpolated = runs.is_interpolated && group.kind == Kind::Motion;
        let interpolated = if is_interpolated { group.signal(finest)?.chords() } else { 0.0 };
        Some(Self { levels, members, checks: farthest(&runs.checks)?, interpolated })
    }

    /// Uncertainty of the average.
    fn smooth(&self, kind: Kind, sizes: &[f64]) -> Result<f64, Reason> {
        let distances = self.levels.iter().map(|level| level.smooth);
        let refined = converged_by(sizes, distances)?.uncertainty;
        let last = self.levels.last().filter(|_| kind != Kind::Motion);
        let least = last.map_or(0.0, |level| level.smooth);
        Ok(self.checks.smooth.max(refined).max(least) + self.members.smooth + self.interpolated)
    }

    /// Uncertainty of the rough part, where that converges.
    fn rough(&self) -> Option<f64> {
        let [.., before, last] = &self.levels[..] else { return None };
        let off = last.rough.max(self.checks.rough) + self.members.rough;
        (last.rough < CONVERGES * before.rough).then_some(off)
    }
}

impl Known {
    /// A group of columns, its scale and its uncertainty; none if it is zero. `window`: the time to
    /// average over, or why there is none.
    pub(super) fn of(group: Group, runs: &Levels, window: &Result<f64, Reason>) -> Option<Self> {
        let finest = runs.finest()?;
        let not_compared = |group, why| {
            let windows = Vec::new();
            Some(Self { group, scale: 1.0, windows, uncertainty: Err(why), noise: None })
        };
        if runs.exact.is_some()
            && let Some(why) = Exact::undefined(finest, &group.columns)
        {
            return not_compared(group, why);
        }
        let scale = group.scale(finest)?;
        let windows = match (group.kind, window) {
            (Kind::Motion, _) => vec![0.0],
            (_, Ok(window)) => vec![*window, window / 2.0, 2.0 * window],
            (_, Err(why)) => return not_compared(group, why.clone()),
        };
        if runs.exact.is_some() {
            let uncertainty = Ok(vec![0.0; windows.len()]);
            return Some(Self { group, scale, windows, uncertainty, noise: Some(0.0) });
        }
        let found: Option<Vec<Apart>> = windows.iter().map(|w| Apart::of(&group, runs, *w)).collect();
        let sizes = runs.sizes();
        let bound = |apart: &Apart| Ok(apart.smooth(group.kind, &sizes)? / scale);
        let uncertainty = match &found {
            _ if !runs.refines_mesh() => Err(ONE_MESH.into()),
            Some(found) => found.iter().map(bound).collect::<Result<_, _>>().and_then(is_resolved),
            None => Err("a run of the reference lacks it".into()),
        };
        let noise = found.as_ref().and_then(|found| Some(found.first()?.rough()? / scale));
        Some(Self { group, scale, windows, uncertainty, noise })
    }
}

/// Uncertainties, if the first one, that of the window itself, is small enough to be used.
fn is_resolved(bounds: Vec<f64>) -> Result<Vec<f64>, Reason> {
    match bounds.first() {
        Some(bound) if *bound > RESOLVED => {
            Err(format!("its uncertainty, {} of its norm, is more than half of it", short(*bound)).into())
        }
        _ => Ok(bounds),
    }
}
