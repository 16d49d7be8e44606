//! "Key results": the metrics of a run by subject, without those that have no meaning in it.

use carom_record::Run;
use carom_record::metrics::{self, Metric};
use maud::{Markup, html};

use crate::asked::metrics_of;
use crate::labels::{instant_label, is_static, number};
use crate::noise::{has_contact, largest};
use crate::scientific::significant;
use crate::text::{Label, Prose};

const DATA: &str = "Values are computed from `history.csv`: times from `time` and `active`, forces from \
    `contact_force_…`, impulses from `contact_impulse_…`, energies from `dissipation`, `kinetic` and `strain`, \
    and motion from `center_…` and `velocity_…`; the direction of `restitution` is that of the normals in \
    `contact.csv`.";
/// Significant digits of a value.
const DIGITS: usize = 4;
/// A value below this share of the size of its quantity is round-off.
const ROUND_OFF: f64 = 1e-12;

/// The section of the page.
pub(crate) fn results(run: &Run) -> Markup {
    let mut known = metrics_of(run);
    known.retain(|metric| metric.value.is_some() && is_meaningful(run, metric));
    let groups = by_title(&known.iter().collect::<Vec<_>>());
    let is_noise = |metric: &Metric| metric.value.is_some_and(|x| is_round_off(run, x));
    html! {
        h2 { "Key results" }
        table.results {
            thead { tr { th { "Metric" } th.n { "Value" } th { "Unit" } th { "Definition" } } }
            @for (title, members) in groups {
                tr.group { th colspan="4" { (title) } }
                @for metric in members {
                    tr {
                        td { code { (metric.name) } }
                        td.n { @if is_noise(metric) { "≈ 0" } @else { (Label(&value(metric))) } }
                        td.unit { @if metric.unit.is_empty() { "–" } @else { (Label(&metric.unit)) } }
                        td { (definition(run, metric)) }
                    }
                }
            }
        }
        @if known.iter().any(is_noise) { p.small { "≈ 0: round-off." } }
        @if let Some(note) = unfinished(run) { p.small { (Label(&note)) } }
        @if let Some(body) = metrics::striker(&run.history).filter(|_| has_contact(run)) {
            p.small { "Striker: " (body) ". " (Prose(DATA)) }
        }
    }
}

/// The titles of groups with their metrics, where there are any.
pub(crate) fn by_title<'a>(all: &[&'a Metric]) -> Vec<(&'static str, Vec<&'a Metric>)> {
    let of = |title| all.iter().copied().filter(|m| metrics::group(&m.name) == title).collect::<Vec<_>>();
    let groups = metrics::TITLES.into_iter().map(|title| (title, of(title)));
    groups.filter(|(_, members)| !members.is_empty()).collect()
}

fn value(metric: &Metric) -> String {
    let x = metric.value.unwrap_or(f64::NAN);
    // Times of rows have few digits.
    let is_exact = metric.name.starts_with("contact_") || (metric.unit.is_empty() && x.fract() == 0.0);
    if is_exact { number(x) } else { significant(x, DIGITS) }
}

/// Whether a length, such as the result of an expectation, is round-off.
pub(crate) fn is_round_off(run: &Run, x: f64) -> bool {
    x != 0.0 && x.abs() < ROUND_OFF * size(run)
}

/// The size of positions and of shares of energy, compared with which values are round-off.
fn size(run: &Run) -> f64 {
    let centers = run.history.columns.iter().filter(|column| column.name.contains(".center_"));
    let most = largest(centers.filter_map(|column| run.column(&column.name)).flatten());
    if most > 0.0 { most } else { 1.0 }
}

/// Whether a metric says something about this run: those of contact need one, those of the
/// striker's flight need one that turned back.
fn is_meaningful(run: &Run, metric: &Metric) -> bool {
    let name: &str = &metric.name;
    let contacts = run.manifest.case.get("contacts").and_then(|list| list.as_array());
    let has_contacts = contacts.is_none_or(|list| !list.is_empty());
    let group = metrics::group(name);
    let of_contact = group.to_lowercase().contains("contact")
        || group == "Impulse and rebound"
        || name == "dissipated_contact";
    if !has_contacts && of_contact {
        return false;
    }
    // Without a release nodes have closed once, and did not chatter.
    let has_releases = run.column("releases").is_none_or(|column| column.iter().any(|x| *x > 0.0));
    if name == "chatter" && !has_releases {
        return false;
    }
    let has_ended = metrics::first_episode(&run.history).is_none_or(|episode| episode.end.is_some());
    let of_turning = ["turning_time", "apex", "apex_time"].contains(&name);
    let has_turned =
        || metrics::all(&run.history).iter().any(|m| m.name == "turning_time" && m.value.is_some());
    !of_turning || (has_ended && has_turned())
}

fn definition(run: &Run, metric: &Metric) -> String {
    match &*metric.name {
        // There is no integrator.
        "dissipated_integrator" if is_static(run) => {
            "error of the external work, which is summed over load steps, divided by the largest strain energy"
                .to_owned()
        }
        _ => metric.definition.to_owned(),
    }
}

/// What is missing where the first contact lasts to the end.
fn unfinished(run: &Run) -> Option<String> {
    let episode = metrics::first_episode(&run.history).filter(|episode| episode.end.is_none())?;
    let last = run.times().last().filter(|last| run.times()[episode.start] < **last)?;
    Some(format!(
        "The first contact lasts to the end of the record: its end, duration and rebound are not known, and impulses are \
         those up to {}.",
        instant_label(run, *last).replace(' ', "\u{a0}")
    ))
}
