//! Warnings that only the record of a run shows.

use std::collections::BTreeMap;

use carom_case::Case;
use carom_record::Run;
use carom_record::metrics::MUCH_CREATED;

use super::found::{Found, short};

/// A contact in the plane in which at most one of several nodes was active at a time.
pub(super) fn one_node(case: &Case, run: &Run) -> Vec<Found> {
    let mut active: BTreeMap<(&str, u64), usize> = BTreeMap::new();
    for row in &run.contact {
        *active.entry((row.contact.as_ref(), row.step)).or_default() += 1;
    }
    let mut found = Vec::new();
    for contact in case.contacts.iter().filter(|_| case.dimension == 2) {
        let nodes = run.manifest.sides.get(&contact.secondary);
        let nodes = nodes.map_or(0, |chains| chains.iter().map(Vec::len).sum::<usize>());
        let most = active.iter().filter(|((name, _), _)| *name == contact.name).map(|(_, n)| *n).max();
        if most == Some(1) && nodes > 1 {
            let what =
                format!("never more than one of the {nodes} nodes of its secondary side was in contact");
            found.push(Found::of_contact(&contact.name, what));
        }
    }
    found
}

/// Bodies that overlapped without a contact between them.
pub(super) fn undeclared_contact(_: &Case, run: &Run) -> Vec<Found> {
    let overlaps = run.log.iter().filter(|event| event.kind == "overlap");
    let found = overlaps.filter_map(|event| {
        let place = event.data.get("place")?.as_str()?.to_owned();
        let one = place.starts_with("body ");
        let verb = if one { "crosses itself" } else { "overlap" };
        Some(Found { place, what: format!("{verb} from t = {} on", short(event.time)) })
    });
    found.collect()
}

/// More energy created than the default of `time.energy_guard` allows, in a run without it.
pub(super) fn energy_created(_: &Case, run: &Run) -> Vec<Found> {
    let last = |name: &str| run.column(name)?.last().copied();
    let share = last("energy_created").zip(last("energy_scale")).map(|(created, scale)| created / scale);
    let what = |share: f64| format!("it created {} % of its largest energy", short(100.0 * share));
    let share = share.filter(|share| *share > MUCH_CREATED);
    share.map(|share| Found { place: "the run".into(), what: what(share) }).into_iter().collect()
}
