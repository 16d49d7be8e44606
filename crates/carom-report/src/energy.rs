//! The energy balance over time: energies, and accumulated work and dissipation.

use carom_record::Run;

use crate::chart::Series;
use crate::figure::Figure;
use crate::labels::{is_static, listed};
use crate::measured::{Points, sources};
use crate::noise::largest;
use crate::over_time::{chart, curves, panel, shaded};

/// Columns of both panes, with their labels.
pub(crate) const ENERGIES: [(&str, &str); 4] =
    [("total", "total"), ("kinetic", "kinetic"), ("strain", "strain"), ("potential", "potential")];
pub(crate) const WORKS: [(&str, &str); 4] = [
    ("dissipation", "dissipation"),
    ("external_work", "external work"),
    ("contact_work", "contact work"),
    ("friction_work", "friction work"),
];

/// Energies and work below this share of the largest in their pane are not drawn.
const SHARE: f64 = 1e-6;

const NO_WORK: &str = " All work and dissipation are below 10^{-12} of the largest energy and omitted.";
const BALANCE: &str = " Top: energies. Bottom: accumulated work and dissipation. The dissipation is the sum of all \
    work less the change of the total energy.";
const DYNAMIC: &str = " It falls where the integrator creates energy, or where the work of a force that varies within \
    a step is inexact; the metric `energy_created` leaves out the latter.";
/// There is no integrator.
const STATIC: &str =
    " In a static analysis it is the error of the external work, which is summed over load steps.";

/// The figure.
pub(crate) fn figure(run: &Run) -> Option<Figure> {
    let (unit, points) = (run.history.unit("total"), Points::all(run));
    let size = largest(["total", "kinetic"].into_iter().filter_map(|name| run.column(name)).flatten());
    let energies = curves(run, &points, &ENERGIES, 1e9 * SHARE * size);
    let works = without_small(curves(run, &points, &WORKS, 1e-3 * size));
    let words = match (works.is_empty(), is_static(run)) {
        (true, _) => NO_WORK.to_owned(),
        (_, true) => [BALANCE, STATIC].concat(),
        (_, false) => [BALANCE, DYNAMIC].concat(),
    };
    let is_drawn = |label: &str| energies.iter().chain(&works).any(|series| series.label == label);
    let known = || ENERGIES.iter().chain(&WORKS).filter(|(column, _)| run.column(column).is_some());
    let shown: Vec<String> =
        known().filter(|(_, label)| is_drawn(label)).map(|(column, _)| format!("`{column}`")).collect();
    // That there is no work at all is said above.
    let without =
        |label: &str| !(is_drawn(label) || works.is_empty() && WORKS.iter().any(|(_, work)| *work == label));
    let omitted: Vec<&str> = known().map(|(_, label)| *label).filter(|label| without(label)).collect();
    let omitted = match listed(&omitted).as_str() {
        "" => String::new(),
        all => format!(" Omitted, as zero or below 10^{{-6}} of the largest in the pane: {all}."),
    };
    let names: Vec<&str> = ENERGIES.iter().chain(&WORKS).map(|(name, _)| *name).collect();
    let caption = format!(
        "Energy balance.{words}{}{omitted}{} Data: `history.csv`, columns {}.",
        shaded(run),
        sources(run, &points, &names),
        listed(&shown)
    );
    let panels = vec![panel("energy", unit, 200.0, energies), panel("work, dissipation", unit, 150.0, works)];
    chart(run, ("energy", "Energy balance"), caption, panels)
}

/// Work without that which would lie on the axis; the dissipation is always of interest.
fn without_small(works: Vec<Series>) -> Vec<Series> {
    let most = works.iter().map(|series| largest(&series.y)).fold(0.0, f64::max);
    let is_large =
        |series: &Series| series.dotted || series.label == "dissipation" || largest(&series.y) > SHARE * most;
    works.into_iter().filter(is_large).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_work_is_left_out_but_not_the_dissipation() {
        let series = |label: &str, y: f64| Series {
            label: label.to_owned(),
            color: "",
            x: &[0.0],
            y: vec![y],
            dotted: false,
            unlisted: false,
        };
        let works =
            [("dissipation", 1e-9), ("external work", -2.0), ("contact work", 1e-6), ("friction work", 1e-5)];
        let kept = without_small(works.map(|(label, y)| series(label, y)).into());
        let kept: Vec<&str> = kept.iter().map(|series| &*series.label).collect();
        assert_eq!(kept, ["dissipation", "external work", "friction work"]);
    }
}
