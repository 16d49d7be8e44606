//! Warnings that only the record of a run shows.

use std::collections::{BTreeMap, BTreeSet};

use carom_case::{Case, ContactSpec, Enforcement, Method};
use carom_mechanics::model::Model;
use carom_record::metrics::{self, Episode, MUCH_CREATED, default_bridge, episodes, first_episode};
use carom_record::{Event, Run};

use super::found::{Found, covered_by, short};

/// Rotation in rad from which a body of linear elasticity is warned about: it makes strains of half
/// a per cent.
pub(crate) const LARGE_ROTATION: f64 = 0.1;
/// Strain beyond which linear elasticity is doubtful.
pub(crate) const LARGE_STRAIN: f64 = 0.05;

fn events<'a>(run: &'a Run, kind: &'static str) -> impl Iterator<Item = &'a Event> {
    run.log.iter().filter(move |event| event.kind == kind)
}

/// Events of bodies, with the name of the body and a number.
fn of_bodies<'a>(
    run: &'a Run,
    kind: &'static str,
    number: &'static str,
) -> impl Iterator<Item = (&'a Event, &'a str, f64)> {
    events(run, kind).filter_map(move |event| {
        Some((event, event.data.get("body")?.as_str()?, event.data.get(number)?.as_f64()?))
    })
}

/// A contact in the plane in which no row has more than one active node, of several. A node in a
/// concave corner has several pairs; a corner of the primary side is a node, too.
pub(super) fn one_node(case: &Case, _: &Model, run: &Run) -> Vec<Found> {
    let mut active: BTreeMap<(&str, u64), BTreeSet<u64>> = BTreeMap::new();
    for row in &run.contact {
        active.entry((row.contact.as_ref(), row.step)).or_default().insert(row.node);
    }
    let mut found = Vec::new();
    for contact in case.contacts.iter().filter(|_| case.dimension == 2) {
        let nodes = run.manifest.sides.get(&contact.secondary);
        let nodes = nodes.map_or(0, |chains| chains.iter().flatten().collect::<BTreeSet<_>>().len());
        let of_contact = active.iter().filter(|((name, _), _)| *name == contact.name);
        if of_contact.map(|(_, nodes)| nodes.len()).max() == Some(1) && nodes > 1 {
            let what = format!(
                "in no recorded row was more than one node in contact; its secondary side has {nodes}"
            );
            found.push(Found::of_contact(&contact.name, what));
        }
    }
    found
}

/// Interruptions within the first episode that last longer than any contact in it that has ended.
pub(super) fn merged_impacts(case: &Case, _: &Model, run: &Run) -> Vec<Found> {
    let times = run.times();
    let Some(first) = first_episode(&run.history).filter(|_| !case.time.scheme.is_static()) else {
        return Vec::new();
    };
    let mut spans = episodes(&run.history, 0.0);
    spans.retain(|span| first.end.is_none_or(|end| span.start < end));
    let closed = |of: &Episode| Some(times[of.end?] - times[of.start]);
    let longest = spans.iter().filter_map(closed).fold(0.0, f64::max);
    let open = spans.windows(2).filter_map(|pair| Some(times[pair[1].start] - times[pair[0].end?]));
    let parts: Vec<f64> = open.filter(|open| *open > longest).collect();
    let Some(opening) = parts.iter().copied().reduce(f64::max) else { return Vec::new() };
    let what = format!(
        "{} impacts count as one episode: between them contact is open for up to {} {}, longer than it is closed",
        parts.len() + 1,
        short(opening),
        case.labels().time
    );
    vec![Found::of_the_run(what)]
}

/// Contact that closes again soon after the first episode, compared with its length.
pub(super) fn split_impact(case: &Case, _: &Model, run: &Run) -> Vec<Found> {
    let times = run.times();
    let episodes = episodes(&run.history, default_bridge(&run.history));
    let [first, second, ..] = episodes[..] else { return Vec::new() };
    let Some(end) = first.end.filter(|_| !case.time.scheme.is_static()) else { return Vec::new() };
    let closes = |episode: Episode| -> BTreeSet<&str> {
        let from = times[episode.start];
        let to = episode.end.map_or(f64::INFINITY, |end| times[end]);
        let rows = run.contact.iter().filter(|row| (from..to).contains(&row.time));
        rows.map(|row| row.contact.as_ref()).collect()
    };
    // A body that rests on another one has had no impact yet; another contact is another impact.
    if first.start == 0 || closes(first).is_disjoint(&closes(second)) {
        return Vec::new();
    }
    let length = times[end] - times[first.start];
    let open = times[second.start] - times[end];
    if open >= length {
        return Vec::new();
    }
    let what = format!(
        "the first episode of contact lasts {} {unit}, and the next one begins {} {unit} after it",
        short(length),
        short(open),
        unit = case.labels().time
    );
    vec![Found::of_the_run(what)]
}

/// Most contacts that one warning names.
const NAMED: usize = 4;
/// Share of the energy scale that the integrator may dissipate without a warning.
const MUCH_DISSIPATED: f64 = 0.1;

/// Contacts in which no node was ever active: of those of one table of the case, none.
pub(super) fn open_contact(case: &Case, _: &Model, run: &Run) -> Vec<Found> {
    // Between rows a contact may have closed and opened.
    let activated = events(run, "activation").filter_map(|event| event.data.get("contact")?.as_str());
    let closed: BTreeSet<&str> =
        run.contact.iter().map(|row| row.contact.as_ref()).chain(activated).collect();
    let mut tables: BTreeMap<usize, Vec<&ContactSpec>> = BTreeMap::new();
    case.contacts.iter().for_each(|contact| tables.entry(contact.entry).or_default().push(contact));
    let open = tables.into_values().filter(|all| all.iter().all(|c| !closed.contains(c.name.as_str())));
    let names: Vec<String> = open.map(|all| format!("\"{}\"", all[0].name)).collect();
    let place = match &names[..] {
        [] => return Vec::new(),
        [one] => format!("contact {one}"),
        [front @ .., last] if names.len() <= NAMED => format!("contacts {} and {last}", front.join(", ")),
        _ => format!("contacts {} and {} others", names[..NAMED].join(", "), names.len() - NAMED),
    };
    vec![Found::at(place, "no node was in contact at any time".to_owned())]
}

/// Bodies between whose nodes an edge or a narrow sphere of a rigid obstacle lay.
pub(super) fn edge_between_nodes(_: &Case, _: &Model, run: &Run) -> Vec<Found> {
    let entered = events(run, "between-nodes").filter_map(|event| {
        let text = |key: &str| event.data.get(key)?.as_str();
        let what = format!(
            "a part of the obstacle lies in {}, between its nodes, by more than 1 % of a facet from t = {} on",
            text("place")?,
            short(event.time)
        );
        Some(Found::of_contact(text("contact")?, what))
    });
    entered.collect()
}

/// Contacts of which a node was deeper in the other side than a tenth of the facet that it entered.
pub(super) fn deep_penetration(case: &Case, _: &Model, run: &Run) -> Vec<Found> {
    let deep = events(run, "deep").filter_map(|event| {
        let name = event.data.get("contact")?.as_str()?;
        let contact = case.contacts.iter().find(|contact| contact.name == name)?;
        let what = format!(
            "from t = {} on a node lay deeper in the other side than a tenth of the facet that it entered",
            short(event.time)
        );
        let advice = match (contact.enforcement, contact.method) {
            (Enforcement::Penalty | Enforcement::Augmented, _) => {
                "a larger stiffness, or enforcement = \"multiplier\""
            }
            (_, Method::Mortar) => "a finer mesh at the contact, or method = \"node-to-segment\"",
            _ => "a shorter step, a finer mesh at the contact, or a scheme whose contact acts on positions",
        };
        Some(Found::of_contact(name, what).with_advice(advice.to_owned()))
    });
    deep.collect()
}

/// Bodies that overlapped, or lay in a rigid obstacle, where no contact between them acts.
pub(super) fn undeclared_contact(case: &Case, _: &Model, run: &Run) -> Vec<Found> {
    let overlaps = events(run, "overlap");
    let found = overlaps.filter_map(|event| {
        let text = |key: &str| event.data.get(key)?.as_str();
        let place = text("place")?.to_owned();
        let from = format!("from t = {} on", short(event.time));
        let what = if let Some(name) = text("obstacle") {
            let contact = case.contacts.iter().find(|contact| contact.name == name)?;
            format!("lies in the obstacle of contact \"{name}\" {from}{}", covered_by(&[contact]))
        } else if place.starts_with("body ") {
            let is_own = |contact: &&ContactSpec| {
                let bodies: Vec<&str> = contact.bodies().collect();
                matches!(bodies[..], [first, second] if first == second && place == format!("body \"{first}\""))
            };
            let contacts: Vec<&ContactSpec> = case.contacts.iter().filter(is_own).collect();
            format!("crosses itself {from}{}", covered_by(&contacts))
        } else {
            let is_between = |contact: &&ContactSpec| {
                let [first, second] = &contact.bodies().collect::<Vec<_>>()[..] else { return false };
                let in_order = |a, b| place == format!("bodies \"{a}\" and \"{b}\"");
                in_order(first, second) || in_order(second, first)
            };
            let contacts: Vec<&ContactSpec> = case.contacts.iter().filter(is_between).collect();
            format!("overlap {from}{}", covered_by(&contacts))
        };
        Some(Found::at(place, what))
    });
    found.collect()
}

/// Bodies of linear elasticity that have turned by more than [`LARGE_ROTATION`].
pub(super) fn large_rotation(_: &Case, _: &Model, run: &Run) -> Vec<Found> {
    let found = of_bodies(run, "rotation", "angle").map(|(event, name, angle)| {
        let what = format!(
            "a point turned by {} rad at t = {}, which alone makes strains of cos θ − 1 = {}",
            short(angle),
            short(event.time),
            short(angle.cos() - 1.0)
        );
        Found::of_body(name, what)
    });
    found.collect()
}

/// Bodies of linear elasticity that are strained by more than [`LARGE_STRAIN`].
pub(super) fn large_strain(_: &Case, _: &Model, run: &Run) -> Vec<Found> {
    let found = of_bodies(run, "strain", "strain").map(|(event, name, strain)| {
        let what = format!("the strain reached {} at t = {}", short(strain), short(event.time));
        Found::of_body(name, what)
    });
    found.collect()
}

/// A finding about the run from the first event of a kind and the number of such events.
fn first_of(run: &Run, kind: &'static str, words: impl Fn(&str, usize) -> String) -> Vec<Found> {
    let mut events = events(run, kind);
    let first = events.next().map(|first| words(&short(first.time), 1 + events.count()));
    first.map(Found::of_the_run).into_iter().collect()
}

/// Friction so large that stick and slip were not unique in some step.
pub(super) fn ambiguous_friction(_: &Case, _: &Model, run: &Run) -> Vec<Found> {
    first_of(run, "ambiguous", |time, count| {
        format!("stick and slip were not unique from t = {time} on, {count} times")
    })
}

/// Load steps that end in an unstable equilibrium.
pub(super) fn unstable_equilibrium(_: &Case, _: &Model, run: &Run) -> Vec<Found> {
    first_of(run, "unstable", |time, count| {
        format!(
            "load steps end in unstable equilibria, {count} of them, from t = {time} on: the load at which they become so \
             lies in that step"
        )
    })
}

/// Most nodes that a warning names.
const NODES: usize = 3;

/// Closed gaps that depended on others in a load step, or in two steps: in the step in which faces
/// meet, the corners of both may close.
pub(super) fn dependent_gaps(case: &Case, _: &Model, run: &Run) -> Vec<Found> {
    let least = if case.time.scheme.is_static() { 1 } else { 2 };
    let mut steps: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for event in events(run, "dependent") {
        let places = event.data.get("places").and_then(|places| places.as_str()).unwrap_or_default();
        places.split(", ").for_each(|place| steps.entry(place).or_default().push(event.time));
    }
    steps.values_mut().for_each(Vec::dedup);
    steps.retain(|_, times| times.len() >= least);
    let Some(first) = steps.values().flatten().copied().reduce(f64::min) else { return Vec::new() };
    let mut named: Vec<&str> = steps.keys().copied().take(NODES).collect();
    if steps.len() > NODES {
        named.push("others");
    }
    let what = format!(
        "other gaps, supports or ties keep nodes closed that have no force of their own, from t = {} on: {}",
        short(first),
        named.join(", ")
    );
    vec![Found::of_the_run(what)]
}

/// A start of load steps from which what it lacked of balance had to fade.
pub(super) fn faded_start(_: &Case, _: &Model, run: &Run) -> Vec<Found> {
    first_of(run, "faded", |time, _| {
        format!(
            "no load step converged from t = {time}, where forces are not in balance; what is lacking fades"
        )
    })
}

/// Grid steps that the fallback took.
pub(super) fn fallback_steps(_: &Case, _: &Model, run: &Run) -> Vec<Found> {
    first_of(run, "fallback", |time, count| match count {
        1 => format!("the fallback took the grid step that begins at t = {time}"),
        _ => format!("the fallback took {count} grid steps, the first at t = {time}"),
    })
}

/// Energy that the time integrator took, but of backward Euler, which is chosen for that.
pub(super) fn numerical_dissipation(case: &Case, _: &Model, run: &Run) -> Vec<Found> {
    let scheme = &case.time.scheme;
    let last = |name: &str| run.column(name)?.last().copied();
    let share = last("dissipation").zip(last("energy_scale")).map_or(0.0, |(taken, scale)| taken / scale);
    if scheme.is_static() || scheme.kind == "backward-euler" || share.is_nan() || share <= MUCH_DISSIPATED {
        return Vec::new();
    }
    let what = format!("the time integrator took {} % of the energy scale by the end", short(100.0 * share));
    vec![Found::of_the_run(what)]
}

/// More energy created than the default of `time.energy_guard` allows. Load steps create none: the
/// difference of their works and energies is the error of a sum over few steps.
pub(super) fn energy_created(case: &Case, _: &Model, run: &Run) -> Vec<Found> {
    if case.time.scheme.is_static() {
        return Vec::new();
    }
    let metric = metrics::all(&run.history).into_iter().find(|metric| metric.name == "energy_created");
    let share = metric.and_then(|metric| metric.value).filter(|share| *share > MUCH_CREATED);
    let what = |share: f64| {
        format!("the total energy rose by {} % of its scale beyond the work of loads", short(100.0 * share))
    };
    share.map(|share| Found::of_the_run(what(share))).into_iter().collect()
}

/// Energy that is created while friction or plastic flow takes as much: the rise of total −
/// external_work − friction_work − plastic_work above its running minimum, judged against the
/// energy scale, or what they took if that is more. Not given where the energy as a whole shows it.
pub(super) fn hidden_energy(case: &Case, model: &Model, run: &Run) -> Vec<Found> {
    let history = &run.history;
    let columns = ["total", "external_work", "energy_scale"].map(|name| history.column(name));
    let [Some(total), Some(work), Some(scale)] = columns else { return Vec::new() };
    if case.time.scheme.is_static() || !energy_created(case, model, run).is_empty() {
        return Vec::new();
    }
    let [friction, flow] = ["friction_work", "plastic_work"]
        .map(|name| history.column(name).map_or_else(|| vec![0.0; total.len()], <[f64]>::to_vec));
    let mut lowest = f64::INFINITY;
    let mut most = 0.0;
    let mut at = 0;
    for row in 0..total.len() {
        let energy = total[row] - work[row] - friction[row] - flow[row];
        lowest = lowest.min(energy);
        if energy - lowest > most {
            (most, at) = (energy - lowest, row);
        }
    }
    let taken = |row: usize| -(friction[row] + flow[row]);
    let largest = (0..total.len()).map(taken).chain(scale.last().copied()).fold(0.0, f64::max);
    // Without them there is nothing to hide it: means of steps miss work.
    if most <= MUCH_CREATED * largest || taken(at) <= 0.0 {
        return Vec::new();
    }
    let by = match [friction[at] < 0.0, flow[at] < 0.0] {
        [true, true] => "friction and plastic flow",
        [true, false] => "friction",
        _ => "plastic flow",
    };
    let [made, taken] = [most, taken(at)].map(|energy| short(100.0 * energy / largest));
    let what = format!(
        "scheme and contact created {made} % of its energy scale until t = {}, where {by} took {taken} %",
        short(history.times()[at])
    );
    vec![Found::of_the_run(what)]
}
