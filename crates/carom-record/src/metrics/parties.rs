//! The parties of a contact: bodies, and obstacles that move.

use super::episode::Episode;
use crate::{Run, body_of};

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

/// The parties of a contact, that of the secondary side first.
pub(super) fn parties<'a>(run: &'a Run, contact: &str) -> Option<[Party<'a>; 2]> {
    let spec = run.manifest.facts.contacts.iter().find(|spec| spec.name == contact)?;
    let obstacle = spec.moves.then_some(spec.name.as_str());
    let primary = spec.primary.as_deref().map_or(obstacle, |side| Some(body_of(side)));
    Some([Some(body_of(&spec.secondary)), primary])
}
