//! Comparison of an arm with the reference: deviations of columns in the smooth phases before and
//! after the first contact, and its delay.

use super::arm::{Arm, history_every, step};
use super::digits::short;
use super::exact::Exact;
use super::groups::is_trajectory;
use super::manifest::StudyManifest;
use super::reference::{Beside, Known, Reference, Trajectory};
use crate::Reason;
use crate::metrics::{self, Distance, phase_shift};
use crate::order::from_errors;

/// Longest row, over the time to average over: averages over less than two rows are not those of
/// the steps between them.
const ROWS: f64 = 0.5 * (1.0 + 1e-9);

/// Deviations of a column from that of the reference, relative to the range of the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviated {
    /// Name of the column.
    pub column: String,
    /// Root mean square of the deviations over the rows before the first contact of the reference.
    pub before: Option<f64>,
    /// Root mean square over the rows after the first contact of the reference.
    pub after: Option<f64>,
}

/// Error of an arm in a group of columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Norms of the error.
    pub distance: Distance,
    /// The error itself, sampled over time (`Signal::errors`).
    pub errors: Vec<f64>,
}

/// An arm compared with the reference.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Compared {
    /// Deviations of the columns of the arm.
    pub columns: Vec<Deviated>,
    /// Errors in the groups of the reference, in their order, each for its windows and relative to
    /// its scale; none if the arm lacks one of the columns.
    pub groups: Vec<Option<Vec<Deviation>>>,
    /// Why a quantity cannot be compared.
    pub undefined: Option<Reason>,
    /// Name of the column whose phase was compared, and its delay in the unit of time.
    pub late: Option<(String, f64)>,
}

impl Compared {
    /// Compares the run of an arm with a reference; `contact` is the interval of the first contact
    /// of the reference.
    pub fn of(arm: &Trajectory, of: &Arm, reference: &Reference, contact: Option<(f64, f64)>) -> Self {
        let Some(Beside { run: right, scales }) = reference.beside(&of.facts, &arm.times) else {
            return Self::default();
        };
        let known = |column: &str| Some((&right.times[..], &right.columns.get(column)?[..]));
        let deviated = |(column, values): (&String, &Vec<f64>)| {
            let known = known(column)?;
            let within = |from: f64, to: f64| {
                let rows = arm.times.partition_point(|t| *t < from)..arm.times.partition_point(|t| *t < to);
                metrics::deviation(&arm.times[rows.clone()], &values[rows], known)
            };
            Some(Deviated {
                column: column.clone(),
                before: contact.and_then(|(start, _)| within(f64::NEG_INFINITY, start)),
                after: contact.and_then(|(_, end)| within(end, f64::INFINITY)),
            })
        };
        let mut motions = arm.columns.iter().filter(|(column, _)| is_trajectory(column));
        let late = motions.find_map(|(column, values)| {
            let late = phase_shift(&arm.times, values, known(column)?)?;
            Some((column.clone(), late))
        });
        let row = arm.times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        let window = |known: &Known| known.windows.first().copied().filter(|window| *window > 0.0);
        let lacks_rows =
            |known: &Known| history_every(of) > 1.0 && window(known).is_some_and(|w| row > ROWS * w);
        let groups = reference.known.iter().map(|known| {
            if lacks_rows(known) {
                return None;
            }
            let scale = scales.as_ref().map_or(Some(known.scale), |own| known.group.scale(own))?;
            let own = known.group.signal(arm)?;
            let right = known.group.signal(&right)?;
            let far = |window: &f64| {
                let distance = own.distance(&right, *window)?.relative_to(scale);
                let errors = own.errors(&right, *window)?.into_iter().map(|x| x / scale);
                Some(Deviation { distance, errors: errors.collect() })
            };
            known.windows.iter().map(far).collect()
        });
        let compared = reference.known.iter().flat_map(|known| &known.group.columns);
        let undefined = Exact::undefined(&right, compared).filter(|_| reference.is_exact());
        let thin = reference.known.iter().find(|known| lacks_rows(known)).and_then(window);
        let thin = thin.map(|window| {
            let [row, window] = [row, window].map(short);
            let why =
                format!("`output.history_every` leaves rows {row} apart, too long to average over {window}");
            Reason::from(why)
        });
        let undefined = undefined.or(thin);
        let columns = arm.columns.iter().filter_map(deviated);
        Self { columns: columns.collect(), groups: groups.collect(), undefined, late }
    }

    /// Deviation of a column.
    pub fn column(&self, name: &str) -> Option<&Deviated> {
        self.columns.iter().find(|c| c.column == name)
    }
}

/// Orders of convergence of a method in a column at its two finest levels: in the smooth motion
/// before the first contact, and after it, across the impact.
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseOrders {
    /// Name of the method.
    pub method: String,
    /// Name of the column.
    pub column: String,
    /// Before the first contact.
    pub smooth: Result<f64, Reason>,
    /// After the first contact.
    pub across: Result<f64, Reason>,
}

/// Orders from errors with respect to the reference; there is none if the error is less than three
/// times the uncertainty of the reference.
pub fn phase_orders(
    method: &str,
    column: &str,
    arms: &[(f64, &Compared)],
    reference: &Reference,
) -> Option<PhaseOrders> {
    let [.., (h1, coarse), (h2, fine)] = arms else { return None };
    let uncertainty = reference.uncertainty(column);
    let order = |of: fn(&Deviated) -> Option<f64>| -> Result<f64, Reason> {
        let errors = [coarse, fine].map(|c| c.column(column).and_then(of));
        let [Some(before), Some(after)] = errors else {
            return Err("there are no rows in this phase".into());
        };
        let uncertainty = uncertainty.clone()?;
        if after <= 1e-9 {
            return Err("exact up to round-off".into());
        }
        if after <= 3.0 * uncertainty {
            return Err(format!(
                "its error, {after:.1e}, is less than three times the uncertainty of the reference, {uncertainty:.1e}"
            )
            .into());
        }
        from_errors([*h1, *h2], [before, after])
    };
    Some(PhaseOrders {
        method: method.to_owned(),
        column: column.to_owned(),
        smooth: order(|d| d.before),
        across: order(|d| d.after),
    })
}

/// Orders of every method of a design in the displacements and positions of centres.
pub(super) fn orders_by_phase(
    manifest: &StudyManifest,
    compared: &[Option<Compared>],
    reference: &Reference,
) -> Vec<PhaseOrders> {
    let mut found = Vec::new();
    for method in manifest.methods() {
        let arms =
            manifest.arms.iter().zip(compared).filter(|(a, _)| a.role.method.as_deref() == Some(method));
        let mut known: Vec<(f64, &Compared)> =
            arms.filter_map(|(a, c)| Some((step(a, "time.step")?, c.as_ref()?))).collect();
        known.sort_by(|a, b| b.0.total_cmp(&a.0));
        for column in reference.columns().into_iter().filter(|c| is_trajectory(c)) {
            found.extend(phase_orders(method, column, &known, reference));
        }
    }
    found
}
