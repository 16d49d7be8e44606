//! Warning about loads that vary within steps. A step knows a load f at few instants: with most
//! schemes at its ends, with energy–momentum in its middle, with composite ones at an instant
//! between, too. Of a blow that lies elsewhere the body feels nothing. Compared are, whatever the
//! scheme,
//!
//! ```text
//! Σ_n |∫f dt − h (f_n + f_{n+1})/2|,      Σ_n ∫|f| dt
//! ```
//!
//! For f = sin ωt the quotient of the two is (ωh)²/12.

use carom_case::{Case, FormulaSpec, LoadKind, LoadSpec, TableSpec};
use carom_formula::Formula;
use carom_mechanics::Grid;
use carom_mechanics::model::Model;

use super::found::{Found, short};
use crate::setup;

/// Share of a load's impulse by which the impulses of the steps may be wrong.
const ALLOWED: f64 = 0.1;
/// Parts of a step at whose ends a load is known, in short runs.
const PARTS: u64 = 32;
/// Instants at which a load is asked for; steps have two parts at least, and where there are too
/// many for that, some are left out.
const INSTANTS: u64 = 400_000;

const TIME: &str = "t";

pub(super) fn unresolved_load(case: &Case, _: &Model) -> Vec<Found> {
    if case.time.scheme.is_static() {
        return Vec::new();
    }
    let grid = setup::grid(case, 0.0);
    let time = case.labels().time;
    let mut found = Vec::new();
    let mut examine = |place: String, course: &Course| {
        if let Some(missed) = course.missed(&grid).filter(|missed| missed.share > ALLOWED) {
            let what = format!(
                "the impulses of the steps differ from those of the load by {} % in total, most in the step that ends at t = {} {time}",
                short(100.0 * missed.share),
                short(missed.time),
            );
            found.push(Found::at(place, what));
        }
    };
    for load in &case.loads {
        examine(format!("load \"{}\"", load.label()), &Course::of(load));
    }
    for body in &case.bodies {
        let course = Course { components: in_time(&body.gravity), table: None };
        examine(format!("gravity of body \"{}\"", body.name), &course);
    }
    found
}

/// A load over time: its components and their factor.
struct Course<'a> {
    components: Vec<Formula>,
    table: Option<&'a TableSpec>,
}

/// Difference between the impulses that the steps of a run take from a load and its own.
struct Missed {
    /// Sum of the differences over the steps, relative to ∫|f| dt.
    share: f64,
    /// End of the step with the largest difference.
    time: f64,
}

impl<'a> Course<'a> {
    fn of(load: &'a LoadSpec) -> Self {
        let components = match &load.kind {
            LoadKind::Traction { value, .. } | LoadKind::BodyForce { value, .. } => in_time(value),
            LoadKind::Pressure { value, .. } => in_time(std::slice::from_ref(value)),
        };
        Self { components, table: load.table.as_ref() }
    }

    /// Difference between the impulses that the trapezoidal rule takes from the load over the steps
    /// of a run and its own; none of a load that does not vary in time.
    fn missed(&self, grid: &Grid) -> Option<Missed> {
        if self.table.is_none() && !self.components.iter().any(|formula| formula.depends_on(TIME)) {
            return None;
        }
        let parts = (INSTANTS / grid.steps.max(1)).clamp(2, PARTS);
        let examined_in = (grid.steps * parts).div_ceil(INSTANTS).max(1) as usize;
        let mut whole = 0.0;
        let mut missed = 0.0;
        let mut most = 0.0;
        let mut time = 0.0;
        for step in (1..=grid.steps).step_by(examined_in) {
            let [from, to] = [step - 1, step].map(|step| grid.time(step));
            let within = (0..=parts).map(|k| from + (to - from) * k as f64 / parts as f64);
            let mut instants: Vec<f64> = within.chain(self.rows_between(from, to)).collect();
            instants.sort_unstable_by(f64::total_cmp);
            for component in &self.components {
                let values: Vec<f64> = instants.iter().map(|&time| self.value(component, time)).collect();
                let ends = [values[0], values[values.len() - 1]];
                let apart = (integral(&instants, &values) - integral(&[from, to], &ends)).abs();
                whole += integral(&instants, &values.iter().map(|value| value.abs()).collect::<Vec<f64>>());
                missed += apart;
                if apart > most {
                    most = apart;
                    time = to;
                }
            }
        }
        (missed > 0.0 && whole.is_finite()).then(|| Missed { share: missed / whole, time })
    }

    fn value(&self, component: &Formula, time: f64) -> f64 {
        self.table.map_or(1.0, |table| table.value(time)) * component.value(&[time])
    }

    /// Times of the rows of the table between two times.
    fn rows_between(&self, from: f64, to: f64) -> impl Iterator<Item = f64> {
        let times = self.table.map_or(&[][..], |table| &table.times);
        let first = times.partition_point(|time| *time <= from);
        times[first..].iter().copied().take_while(move |time| *time < to)
    }
}

/// Components that depend on time alone; one that depends on places, or is a function of the
/// program, counts as 1.
fn in_time(components: &[FormulaSpec]) -> Vec<Formula> {
    let formula = |spec: &FormulaSpec| spec.formula(&[TIME]).unwrap_or_else(|_| Formula::constant(1.0));
    components.iter().map(formula).collect()
}

/// Integral of a quantity that is linear between instants.
fn integral(times: &[f64], values: &[f64]) -> f64 {
    let pieces = times.windows(2).zip(values.windows(2));
    pieces.map(|(t, f)| 0.5 * (t[1] - t[0]) * (f[0] + f[1])).sum()
}
