//! The parties of a contact: bodies, and obstacles that move.

use super::episode::Episode;
use crate::{ContactRow, Run, body_of};

/// A body, or an obstacle that moves; none: an obstacle that is fixed.
pub(super) type Party<'a> = Option<&'a str>;

/// The parties that meet something but themselves in an episode; none if it is not known which met
/// first, because pairs opened again before the row was written.
pub(super) fn taking_part(run: &Run, episode: Episode) -> Vec<&str> {
    let times = run.times();
    let rows = || run.contact.iter().filter(|row| episode.contains(times, row.time));
    if rows().next().is_none_or(|row| row.time > times[episode.start]) {
        return Vec::new();
    }
    let mut names: Vec<&str> = rows().map(|row| &*row.contact).collect();
    names.dedup();
    let met = names.into_iter().filter_map(|name| parties(run, name)).filter(|[one, other]| one != other);
    met.flatten().flatten().collect()
}

/// The parties of all contacts of a case.
pub(super) fn in_contacts(run: &Run) -> Vec<&str> {
    let contacts = run.manifest.facts.contacts.iter();
    contacts.filter_map(|spec| parties(run, &spec.name)).flatten().flatten().collect()
}

/// The part of an episode in which a body itself is in contact with something else, where the
/// episode consists of contacts of other bodies, too: from its first row to the row that ends its
/// contact, interruptions shorter than `bridge` included.
pub(super) fn own_episode(run: &Run, body: &str, episode: Episode, bridge: f64) -> Episode {
    let times = run.times();
    let row_at = |time: f64| times.partition_point(|other| *other < time);
    let is_own = |contact: &str| {
        parties(run, contact).is_some_and(|[one, other]| one != other && [one, other].contains(&Some(body)))
    };
    // The record of a run that was killed may end with rows of contact.csv alone, or without them.
    let known = run.contact.iter().map(|row| row_at(row.time)).filter(|row| *row < times.len()).max();
    let in_episode =
        run.contact.iter().filter(|row| episode.contains(times, row.time) && row_at(row.time) < times.len());
    let (own, others): (Vec<&ContactRow>, Vec<&ContactRow>) =
        in_episode.partition(|row| is_own(&row.contact));
    let mut rows: Vec<usize> = own.iter().map(|row| row_at(row.time)).collect();
    rows.sort_unstable();
    rows.dedup();
    let Some(&start) = rows.first().filter(|_| !others.is_empty()) else { return episode };
    let goes_on = |two: &&[usize]| times[two[1]] - times[two[0] + 1] < bridge;
    let last = rows[rows.windows(2).take_while(goes_on).count()];
    let is_open = episode.end.is_none() && Some(last) == known;
    Episode { start, end: (!is_open && last + 1 < times.len()).then_some(last + 1) }
}

/// The parties of a contact, that of the secondary side first.
pub(super) fn parties<'a>(run: &'a Run, contact: &str) -> Option<[Party<'a>; 2]> {
    let spec = run.manifest.facts.contacts.iter().find(|spec| spec.name == contact)?;
    let obstacle = spec.moves.then_some(spec.name.as_str());
    let primary = spec.primary.as_deref().map_or(obstacle, |side| Some(body_of(side)));
    Some([Some(body_of(&spec.secondary)), primary])
}
