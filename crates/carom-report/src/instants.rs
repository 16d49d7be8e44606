//! The figure of the deformed bodies at several instants, coloured by stress.

use carom_record::{Cell, FieldEntry, Run, Stop, metrics};

use crate::bands::Bands;
use crate::bodies::{self, Instant};
use crate::figure::Figure;
use crate::labels::{instant_label, with_unit};
use crate::meshes::Pane;
use crate::obstacles;
use crate::quantity::stresses;
use crate::sheet::{Legend, arrowheads};
use crate::text::said_if;
use crate::{animation, bars, contours, meshes, space};

/// The field files nearest to five instants of the whole run: its start and end, and the start,
/// middle and end of the first contact; equidistant ones without contact or after a stop. With
/// words for them.
fn five(run: &Run) -> (Vec<&FieldEntry>, &'static str) {
    let times = run.times();
    let start = times[0];
    let end = times[times.len() - 1];
    let nearest = |instants: [f64; 5]| {
        let near =
            |at: f64| run.fields.iter().min_by(|p, q| (p.time - at).abs().total_cmp(&(q.time - at).abs()));
        let mut list: Vec<&FieldEntry> = instants.into_iter().filter_map(near).collect();
        list.dedup();
        list
    };
    let contact = metrics::first_episode(&run.history).filter(|_| run.stop.is_none()).map(|episode| {
        let first = times[episode.start];
        let last = times[episode.end.unwrap_or(times.len()) - 1];
        nearest([start, first, 0.5 * (first + last), last, end])
    });
    if let Some(list) = contact.filter(|list| list.len() > 3) {
        return (
            list,
            "from the start of the run to its end, with start, middle and end of the first contact",
        );
    }
    let equidistant = std::array::from_fn(|k| start + (end - start) * k as f64 / 4.0);
    (nearest(equidistant), "of the run")
}

/// The deformed bodies at several instants, coloured by stress, and its bands in the plane.
pub(crate) fn instants(run: &Run, notes: &mut Vec<String>) -> Option<(Figure, Bands)> {
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
    let mut files = "the field files";
    if let Some(stop) = &run.stop
        && let Ok(Some(set)) = Stop::fields(&run.directory, &run.manifest)
        && sets.last().is_some_and(|(time, last)| stop.last > *time && last.points.len() == set.points.len())
    {
        sets.truncate(4);
        sets.push((stop.last, set));
        files = "the field files and, of the last instant, in `stopped.vtu`";
    }
    let first = &sets.first()?.1;
    let unit = run.history.unit("time");
    if first.blocks.iter().all(|b| b.cell == Cell::Curve) {
        let strips: Vec<Instant> =
            sets.iter().filter_map(|(_, set)| animation::instant(set, String::new())).collect();
        return Some((bars::figure(run, &sets, (during, files)), bodies::colors(&strips).0));
    }
    if bodies::fill_space(first) {
        let length = first.unit("displacement");
        let (pictures, caption, bands) = space::instants(run, &sets, length, (during, files))?;
        let panes: Vec<Pane> = sets
            .iter()
            .filter_map(|(time, set)| {
                let [values, _] = stresses(set)?;
                Some(Pane { title: instant_label(run, *time), points: bodies::places(set), values })
            })
            .collect();
        let value = with_unit("σ_{vM}", first.unit("stress"));
        let figure = Figure::new("bodies", caption, pictures);
        return Some((meshes::with_files(figure, first, &panes, length, value), bands));
    }
    let (stress, length) = (first.array("stress")?.unit.as_str(), first.unit("displacement"));
    let instant = |(time, set): &_| Instant::new(set, "stress", 1, instant_label(run, *time));
    let list: Vec<Instant> = sets.iter().filter_map(instant).collect();
    let (bands, cut) = bodies::colors(&list);
    let title = "Deformed bodies with vertical Cauchy stress";
    let frame = bodies::frame(&list);
    let obstacles = obstacles::all(run, frame);
    let times: Vec<f64> = sets.iter().map(|(time, _)| *time).collect();
    let walks: Vec<Vec<_>> =
        times.iter().map(|time| obstacles.iter().map(|o| o.at(run, *time)).collect()).collect();
    let of_time = |time: &f64| obstacles.iter().filter_map(|o| o.mark(run, *time)).collect();
    let marks: Vec<Vec<_>> = times.iter().map(of_time).collect();
    let mut wide = frame;
    for (obstacle, walk) in walks.iter().flat_map(|walks| obstacles.iter().zip(walks)) {
        wide = obstacle.shown_in(walk, wide, frame);
    }
    // The hatching of a plane that touches the bodies needs room.
    let room = if obstacles.is_empty() { 0.0 } else { 0.04 * (wide[1] - wide[0]).max(wide[3] - wide[2]) };
    let wide = [wide[0] - room, wide[1] + room, wide[2] - room, wide[3] + room];
    let walks: Vec<Vec<_>> = walks
        .iter()
        .map(|walks| walks.iter().flat_map(|walk| obstacles::clipped(walk, wide)).collect())
        .collect();
    let legend = Legend { bands: &bands, cut, label: "σ_{yy}", unit: stress };
    let pictures = bodies::figure(&list, (&walks, &marks, wide), title, &legend, length);
    let arrow = arrowheads([(cut, String::new())]);
    let mark =
        said_if(marks.iter().any(|marks| !marks.is_empty()), " Triangle: a point of the plane that moves.");
    // Without either sign the outer half of the band around zero ends the bar.
    let step = (bands.high - bands.low) / bands.count as f64;
    let compression = said_if(bands.low < -0.75 * step, " Blue: compression.");
    let tension = said_if(bands.high > 0.75 * step, " Red: tension.");
    let caption = format!(
        "Deformed bodies with vertical Cauchy stress σ_{{yy}} (nodal averages) at instants {during}. All at \
         the same scale; displacements are not magnified.{compression}{tension}{mark}{arrow} Data: stress and displacement in {files}."
    );
    let figure = Figure::new("bodies", caption, pictures);
    let figure = contours::with_files(figure, &times, &list, [unit, length, stress]);
    Some((figure, bands))
}
