//! All metrics of a run by subject, without those that have no meaning in it.

use carom_record::Sizes;
use carom_record::metrics::{self, Metric};
use maud::{Markup, html};

use crate::labels::{instant_label, number};
use crate::recorded::Recorded;
use crate::scientific::significant;
use crate::text::Label;

/// Significant digits of a value.
const DIGITS: usize = 4;

/// The table of all metrics.
pub(crate) fn results(run: &Recorded) -> Markup {
    let mut known = metrics::of_run(run);
    known.retain(|metric| metric.value.is_some() && !metric.is_work() && is_meaningful(run, metric));
    let sizes = Sizes::of(run);
    let groups = by_title(&known.iter().collect::<Vec<_>>());
    html! {
        table.results {
            thead { tr { th { "Metric" } th.n { "Value" } th { "Unit" } th { "Definition" } } }
            @for (title, members) in groups {
                tr.group { th colspan="4" { (title) } }
                @for metric in members {
                    tr {
                        td { code { (metric.name) } }
                        td.n {
                            @if metric.value.is_some_and(|x| sizes.is_round_off(x, &metric.unit)) { "≈ 0" } @else { (Label(&value(metric))) }
                        }
                        td.unit { @if metric.unit.is_empty() { "–" } @else { (Label(&metric.unit)) } }
                        td { (metric.definition) }
                    }
                }
            }
        }
        @if let Some(note) = unfinished(run) { p.small { (Label(&note)) } }
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

/// Whether a metric says something about this run: those of contact need one, those of the
/// striker's flight need one that turned back.
fn is_meaningful(run: &Recorded, metric: &Metric) -> bool {
    let name: &str = &metric.name;
    let group = metrics::group(name);
    let of_contact = group.to_lowercase().contains("contact")
        || group == "Impulse and rebound"
        || name == "dissipated_contact";
    if run.case.contacts.is_empty() && of_contact {
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
        || metrics::of_rebound(run).iter().any(|m| m.name == "turning_time" && m.value.is_some());
    !of_turning || (has_ended && has_turned())
}

/// The sentence about a first contact that lasts to the end, if it does.
fn unfinished(run: &Recorded) -> Option<String> {
    let episode = metrics::first_episode(&run.history).filter(|episode| episode.end.is_none())?;
    let last = run.times().last().filter(|last| run.times()[episode.start] < **last)?;
    let until = instant_label(run, *last).replace(' ', "\u{a0}");
    Some(format!("The first contact lasts to the end: impulses are those up to {until}."))
}
