//! What meets in a contact: bodies, and obstacles that move.

use super::episode::Episode;
use crate::{Run, body_of};

/// A body, or an obstacle that moves; none: an obstacle that is fixed.
pub(super) type Party<'a> = Option<&'a str>;

/// The bodies that meet something but themselves in an episode.
pub(super) fn taking_part(run: &Run, episode: Episode) -> Vec<&str> {
    let rows = run.contact.iter().filter(|row| episode.contains(run.times(), row.time));
    let mut names: Vec<&str> = rows.map(|row| &*row.contact).collect();
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
