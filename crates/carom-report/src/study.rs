//! The report of a study: its tables, its page and, for every probe column, figures with the curves
//! of all arms and the data measured.

use std::path::Path;

use carom_record::study::{Arm, Row, Study, StudyManifest};
use carom_record::{Status, metrics};

use crate::collected::{Column, Measured, Origin, collect, common_time, named};
use crate::curves::Keys;
use crate::figure::Figure;
use crate::labels::{capitalised, file_name, listed, with_unit};
use crate::ordered::grouped;
use crate::plot::{Curve, Pane, Plot};
use crate::publish::{ReportError, ReportSummary, publish};
use crate::recorded::Recorded;
use crate::systems::Systems;
use crate::text::said_if;
use crate::{curves, laboratory, multiples, setup, study_page, theory, trend};

/// Figures of one column that are shown; more of them are folded away, and with a goal, for which
/// there are figures of all methods, more than `FEW_MORE`.
const FEW: usize = 3;
const FEW_MORE: usize = 2;

/// Writes the figures, tables and page of a study directory, from the records alone. Arms are read
/// one by one to limit the memory that long histories need.
///
/// # Errors
/// A file cannot be read or written.
pub fn study(directory: &Path) -> Result<ReportSummary, ReportError> {
    let mut columns: Vec<Column> = Vec::new();
    let mut time = String::new();
    let mut origins = Vec::new();
    let mut picture = None;
    let manifest = StudyManifest::read(directory)?;
    let mut systems = Systems::of(&manifest);
    let mut measured = Measured(manifest.overlays);
    let mut study = Study::open(directory, &mut |arm, run| {
        picture = picture.take().or_else(|| {
            let fields = run.field(run.fields.first()?).ok()?;
            let pictures = setup::figure(&Recorded::new(run.clone()).ok()?, &fields)?;
            Some(Figure::new("setup", "", pictures))
        });
        if systems.is_own(arm) {
            run.history.unit("time").clone_into(&mut time);
            measured.add(metrics::overlays(run));
        }
        collect(&mut columns, &measured, &mut systems, arm, run);
        origins.push(Origin::of(arm, run));
    })?;
    study.write_tables()?;
    systems.convert(&mut study);
    let mut plots = laboratory::plots(&study);
    plots.extend(multiples::plots(&study, &columns, &measured, &time));
    plots.extend(theory::plot(&study).filter(|_| study.manifest.goal.is_some()));
    plots.extend(columns.iter().flat_map(|column| overlays(column, &study, &measured, &time)));
    plots.extend(trend::plots(&study));
    // Figures that are folded away come last, so that those shown have successive numbers.
    plots.sort_by_key(|plot| !plot.group.is_empty());
    let figures: Vec<(&str, Figure)> =
        plots.iter().map(|plot| (plot.group.as_str(), plot.figure())).collect();
    let page = study_page::page(&study, picture.as_ref(), &figures, &origins, &systems);
    let all = picture.iter().chain(figures.iter().map(|(_, figure)| figure));
    publish(directory, "study.html", &page, all, Vec::new())
}

/// A column of all arms, with up to eight curves in a figure, and enlarged where there is contact.
/// Curves that hide each other have panes of their own.
fn overlays(column: &Column, study: &Study, measured: &Measured, time: &str) -> Vec<Plot> {
    let (label, what) = named(&column.name);
    let groups = groups(study);
    let few = if study.manifest.goal.is_some() { FEW_MORE } else { FEW };
    let keys = Keys::of(study.rows.iter().map(|row| row.name.as_str()), common_time(study));
    let chosen = study.recommended();
    let figure = |group: usize| {
        let members = &groups[group];
        let mine = column.curves.iter().filter(|(arm, ..)| members.contains(arm));
        let curves = mine.map(|(arm, x, y)| Curve {
            label: keys.label(&study.rows[*arm].name),
            style: laboratory::style_of(study, *arm),
            x: x.clone(),
            y: y.clone(),
            apart: study.rows[*arm].is_unsound(),
            chosen: chosen == Some(*arm),
            ..Curve::default()
        });
        let found = curves::merged(curves.collect());
        let drawn_once = curves::drawn_once(found.iter().map(|(curve, others)| (&curve.label, others)));
        let curves: Vec<Curve> =
            found.into_iter().map(|(curve, others)| curves::with(curve, &others)).collect();
        if curves.is_empty() {
            return None;
        }
        let file = file_name(&column.name);
        let (name, part) = match groups.len() {
            2.. => (format!("{file}-{}", group + 1), numbers(members)),
            _ => (file, String::new()),
        };
        let end = curves.iter().filter_map(|curve| curve.x.last()).copied().fold(0.0, f64::max);
        let contact = curves::contact(study, end);
        let y_label = with_unit(&label, &column.unit);
        // A rough curve of a failed arm would cover the others.
        let (aside, curves): (Vec<Curve>, Vec<Curve>) =
            curves.into_iter().partition(|curve| curve.apart && curves::is_rough(curve));
        let (is_aside, is_all_aside) = (!aside.is_empty(), curves.iter().all(|curve| curve.apart));
        let rough = curves.iter().filter(|curve| curves::is_rough(curve)).count() > 1;
        let (panes, across, enlarged) = if rough {
            let part = said_if(contact.is_some(), " during the first contact");
            (multiples(curves, &y_label, contact), 3, part)
        } else {
            let whole = Pane {
                name: "whole time".into(),
                y_label: y_label.clone(),
                curves: curves.clone(),
                ..Pane::default()
            };
            let part = contact.map(|span| Pane {
                title: "during the first contact".into(),
                y_label,
                curves,
                span: Some(span),
                ..Pane::default()
            });
            let whole = (!whole.curves.is_empty()).then_some(whole);
            (whole.into_iter().chain(part).collect::<Vec<_>>(), 1, "")
        };
        let aside = aside.into_iter().map(|curve| alone(curve, with_unit(&label, &column.unit)));
        let points = measured.points(&column.name, end, rough);
        let with_points = |mut pane: Pane| {
            pane.curves.extend(points.iter().cloned());
            pane
        };
        let panes: Vec<Pane> = panes.into_iter().chain(aside).map(with_points).collect();
        let mut plot = Plot {
            group: if groups.len() > few { capitalised(&what) } else { String::new() },
            name,
            x_label: with_unit("time t", time),
            across,
            same: rough,
            direct: !rough,
            panes,
            ..Plot::default()
        };
        let axes = if is_all_aside {
            String::new()
        } else {
            let tip = said_if(plot.has_arrowheads(), "; an arrowhead is where one leaves them");
            let own = said_if(is_aside, "; rough ones have panes of their own");
            format!(" They do not affect the axes of other arms{tip}{own}.")
        };
        let apart = apart_words(study, members, &axes);
        plot.caption = format!(
            "{}{enlarged}{part}.{}{apart}{}",
            capitalised(&what),
            drawn_once,
            measured.words(&column.name)
        );
        Some(plot)
    };
    (0..groups.len()).filter_map(figure).collect()
}

/// Arms of the same case and level, by which a colour means a method, in figures that are not too
/// full; those of the reference are by themselves.
fn groups(study: &Study) -> Vec<Vec<usize>> {
    let arms = &study.manifest.arms;
    let kind = |(i, arm): (usize, &Arm)| ((arm.case_path.clone(), arm.role.fine, arm.role.level), i);
    let few = |(_, same): (_, Vec<usize>)| {
        same.chunks(laboratory::each(same.len())).map(<[usize]>::to_vec).collect::<Vec<_>>()
    };
    grouped(arms.iter().enumerate().map(kind)).into_iter().flat_map(few).collect()
}

/// What is said of grey curves, for arms that failed or created energy.
fn apart_words(study: &Study, members: &[usize], axes: &str) -> String {
    let unsound = || members.iter().map(|arm| &study.rows[*arm]).filter(|row| row.is_unsound());
    let fails = |row: &&Row| row.status == Some(Status::Failed);
    let (failed, created) = (unsound().any(|row| fails(&row)), unsound().any(|row| !fails(&row)));
    let which = match (failed, created) {
        (false, false) => return String::new(),
        (true, false) => "arms that failed (cross: where they stopped)",
        (false, true) => "arms that created more energy than the default guard allows",
        (true, true) => {
            "arms that failed (cross: where they stopped) or created more energy than the default guard allows"
        }
    };
    format!(" Grey: {which}.{axes}")
}

/// What distinguishes a group: the numbers of its arms.
fn numbers(members: &[usize]) -> String {
    let every = members.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap_or(1);
    match members {
        [only] => format!(", arm {}", only + 1),
        [first, .., last] if every == 1 => format!(", arms {} to {}", first + 1, last + 1),
        _ => {
            let all: Vec<String> = members.iter().map(|arm| (arm + 1).to_string()).collect();
            format!(", arms {}", listed(&all))
        }
    }
}

/// Panes at the same scale with a curve each, its label as the title.
fn multiples(curves: Vec<Curve>, y_label: &str, span: Option<(f64, f64)>) -> Vec<Pane> {
    let pane = |(k, curve): (usize, Curve)| Pane {
        span,
        ..alone(curve, if k % 3 == 0 { y_label.to_owned() } else { String::new() })
    };
    curves.into_iter().enumerate().map(pane).collect()
}

/// A pane with a curve, its label as the title.
fn alone(curve: Curve, y_label: String) -> Pane {
    let title = curve.label.clone();
    Pane { title, y_label, curves: vec![Curve { unlisted: true, ..curve }], ..Pane::default() }
}

#[cfg(test)]
mod tests {
    use super::numbers;
    use crate::laboratory::each;

    #[test]
    fn arms_are_split_evenly() {
        let sizes = [1, 8, 9, 10, 11, 12, 15, 19].map(|arms| (arms, each(arms)));
        assert_eq!(sizes, [(1, 1), (8, 8), (9, 3), (10, 5), (11, 6), (12, 6), (15, 5), (19, 7)]);
        assert_eq!(numbers(&[3, 4, 5]), ", arms 4 to 6");
        assert_eq!((numbers(&[0, 2, 4]), numbers(&[7])), (", arms 1, 3 and 5".into(), ", arm 8".into()));
    }
}
