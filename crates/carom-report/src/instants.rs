//! The figure of the deformed bodies at several instants, coloured by stress.

use carom_record::{Cell, FieldEntry, FieldSet, Stop, metrics};

use crate::bodies::{self, Instant};
use crate::figure::Figure;
use crate::labels::instant_label;
use crate::noise::floor;
use crate::obstacles;
use crate::recorded::Recorded;
use crate::sheet::Legend;
use crate::{bars, space};

/// The field files nearest to five instants of the whole run: its start and end, and the start,
/// middle and end of the first contact; equidistant ones without contact or after a stop. With
/// words for them.
fn five(run: &Recorded) -> (Vec<&FieldEntry>, &'static str) {
    let times = run.times();
    let start = times[0];
    let end = times[times.len() - 1];
    let all: Vec<&FieldEntry> = run.fields.iter().collect();
    let contact = metrics::first_episode(&run.history).filter(|_| run.stop.is_none()).map(|episode| {
        let first = times[episode.start];
        let last = times[episode.end.unwrap_or(times.len()) - 1];
        let during: Vec<&FieldEntry> =
            all.iter().copied().filter(|entry| (first..=last).contains(&entry.time)).collect();
        let mut list = nearest(&all, &[start]);
        list.extend(nearest(&during, &[first, 0.5 * (first + last), last]));
        list.extend(nearest(&all, &[end]));
        list.dedup();
        list
    });
    if let Some(list) = contact.filter(|list| list.len() > 3) {
        return (
            list,
            "from the start of the run to its end, with start, middle and end of the first contact",
        );
    }
    let equidistant: [f64; 5] = std::array::from_fn(|k| start + (end - start) * k as f64 / 4.0);
    (nearest(&all, &equidistant), "during the run")
}

/// The entries nearest to some instants, each once.
fn nearest<'a>(entries: &[&'a FieldEntry], instants: &[f64]) -> Vec<&'a FieldEntry> {
    let near =
        |at: &f64| entries.iter().copied().min_by(|p, q| (p.time - at).abs().total_cmp(&(q.time - at).abs()));
    let mut list: Vec<&FieldEntry> = instants.iter().filter_map(near).collect();
    list.dedup();
    list
}

/// The deformed bodies at several instants, coloured by stress.
pub(crate) fn instants(run: &Recorded, notes: &mut Vec<String>) -> Option<Figure> {
    let (entries, during) = five(run);
    if entries.is_empty() {
        notes.push("No field files were written (output.fields_every = 0): bodies and contact pressure are not drawn.".into());
    }
    let mut sets = Vec::new();
    for entry in entries {
        match run.field(entry) {
            Ok(set) => sets.push((entry.time, set)),
            Err(error) => notes.push(error.to_string()),
        }
    }
    // The state at which a run failed is in a file of its own.
    let mut files = "field files";
    if let Some(stop) = &run.stop
        && let Ok(Some(set)) = Stop::fields(&run.directory, &run.manifest)
        && sets.last().is_some_and(|(time, last)| stop.last > *time && last.points.len() == set.points.len())
    {
        sets.truncate(4);
        sets.push((stop.last, set));
        files = "field files, `stopped.vtu`";
    }
    let first = &sets.first()?.1;
    let mut figure = if first.blocks.iter().all(|b| b.cell == Cell::Curve) {
        bars::figure(run, &sets, (during, files))
    } else if bodies::fill_space(first) {
        let pictures = space::instants(run, &sets)?;
        let caption =
            format!("Deformed bodies with von Mises stress {during}.{} Data: {files}.", run.projected());
        Figure::new("bodies", caption, pictures)
    } else {
        let (pictures, is_zero) = in_plane(run, &sets)?;
        let colours = if is_zero { "zero to round-off" } else { "blue: compression, red: tension" };
        let projected = run.projected();
        let caption =
            format!("Deformed bodies with vertical stress {during}; {colours}.{projected} Data: {files}.");
        Figure::new("bodies", caption, pictures)
    };
    "Instants".clone_into(&mut figure.title);
    Some(figure)
}

/// Plane bodies with obstacles, all at one scale, and whether their stress is round-off.
fn in_plane(run: &Recorded, sets: &[(f64, FieldSet)]) -> Option<([String; 2], bool)> {
    let first = &sets.first()?.1;
    let stress = first.unit("stress");
    let length = first.unit("displacement");
    let instant = |(time, set): &_| Instant::new(set, "stress", 1, instant_label(run, *time));
    let list: Vec<Instant> = sets.iter().filter_map(instant).collect();
    let (bands, cut) = bodies::colors(&list, floor(run, first, "stress"));
    let frame = bodies::frame(&list);
    let obstacles = obstacles::all(run, frame);
    let times = sets.iter().map(|(time, _)| *time);
    let walks: Vec<Vec<_>> =
        times.clone().map(|time| obstacles.iter().map(|o| o.at(run, time)).collect()).collect();
    let marks: Vec<Vec<_>> =
        times.map(|time| obstacles.iter().filter_map(|o| o.mark(run, time)).collect()).collect();
    let mut wide = frame;
    for (obstacle, walk) in walks.iter().flat_map(|walks| obstacles.iter().zip(walks)) {
        wide = obstacle.shown_in(walk, wide, frame);
    }
    // The hatching of a plane that touches the bodies needs room.
    let room = if obstacles.is_empty() { 0.0 } else { 0.04 * (wide[1] - wide[0]).max(wide[3] - wide[2]) };
    let wide = [wide[0] - room, wide[1] + room, wide[2] - room, wide[3] + room];
    let inside = |walks: &Vec<_>| walks.iter().flat_map(|walk| obstacles::clipped(walk, wide)).collect();
    let walks: Vec<Vec<_>> = walks.iter().map(inside).collect();
    let legend = Legend { bands: &bands, cut, label: "σ_{yy}", unit: stress };
    let title = "Deformed bodies with vertical Cauchy stress";
    Some((bodies::figure(&list, (&walks, &marks, wide), title, &legend, length), bands.is_zero()))
}
