//! The report of a study: its tables, its page and, for every probe column, figures with the curves
//! of all arms and the data measured.

use std::path::Path;

use carom_record::metrics;
use carom_record::study::{Study, StudyManifest};

use crate::collected::{Column, Measured, Origin, collect, named};
use crate::curves::Keys;
use crate::labels::{capitalised, file_name, with_unit};
use crate::plot::{Curve, Pane, Plot};
use crate::publish::{ReportError, ReportSummary, publish, write};
use crate::{curves, laboratory, setup, study_page, trend};

/// Curves in one figure; more arms need more figures.
const MOST: usize = 8;
/// Figures of one column that are shown; more of them are folded away.
const FEW: usize = 2;

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
    let mut measured = Measured(StudyManifest::read(directory)?.overlays);
    let study = Study::open(directory, &mut |arm, run| {
        run.history.unit("time").clone_into(&mut time);
        picture = picture.take().or_else(|| setup::figure(run, &run.field(run.fields.first()?).ok()?));
        measured.add(metrics::overlays(run));
        collect(&mut columns, &measured, arm, run);
        origins.push(Origin::of(arm, run));
    })?;
    study.write_tables()?;
    let mut plots = laboratory::plots(&study, &columns, &measured, &time);
    // What small multiples show already is not drawn again, unless they leave something out.
    let drawn = |column: &&Column| laboratory::shows(&plots, &column.name);
    let overlaid: Vec<Plot> = columns
        .iter()
        .flat_map(|column| {
            overlays(column, &study, &measured, &time)
                .into_iter()
                .filter(move |plot| plot.direct || !drawn(&column))
        })
        .collect();
    plots.extend(overlaid);
    plots.extend(trend::plots(&study));
    let page = study_page::page(&study, picture.as_deref(), &plots, &origins);
    let drawn = plots.iter().map(|p| (p.name.clone(), p.svg()));
    let all: Vec<(String, String)> =
        picture.into_iter().map(|svg| ("setup".to_owned(), svg)).chain(drawn).collect();
    let summary = publish(
        directory,
        "study.html",
        &page,
        all.iter().map(|(n, s)| (n.as_str(), s.as_str())),
        Vec::new(),
    )?;
    // Beside each figure its table and the script that redraws it.
    for plot in &plots {
        let beside = |ending: &str| directory.join("figures").join(format!("{}.{ending}", plot.name));
        write(beside("csv"), &plot.csv())?;
        write(beside("py"), &plot.script())?;
    }
    Ok(summary)
}

/// A column of all arms, with up to eight curves in a figure, and enlarged where there is contact.
/// Curves that hide each other have panes of their own.
fn overlays(column: &Column, study: &Study, measured: &Measured, time: &str) -> Vec<Plot> {
    let (label, what) = named(&column.name);
    let arms = &study.manifest.arms;
    // Arms of the same case are grouped.
    let groups: Vec<Vec<usize>> = arms
        .iter()
        .enumerate()
        .collect::<Vec<_>>()
        .chunk_by(|a, b| a.1.case_path == b.1.case_path)
        .flat_map(|same| {
            // Nine arms are five and four, not eight and one.
            let each = same.len().div_ceil(same.len().div_ceil(MOST));
            same.chunks(each).map(|few| few.iter().map(|(i, _)| *i).collect())
        })
        .collect();
    let keys = Keys::of(study.rows.iter().map(|row| row.name.as_str()));
    let chosen = study.ranking.as_ref().and_then(|ranking| Some(ranking.verdict.as_ref().ok()?.arm));
    let figure = |group: usize| {
        let members = &groups[group];
        let mine = column.curves.iter().filter(|(arm, ..)| members.contains(arm));
        let curves = mine.map(|(arm, x, y)| Curve {
            label: keys.label(&study.rows[*arm].name),
            style: *arm % MOST,
            x: x.clone(),
            y: y.clone(),
            apart: study.rows[*arm].is_unsound(),
            chosen: chosen == Some(*arm),
            ..Curve::default()
        });
        let found = curves::merged(curves.collect());
        let names: Vec<_> =
            found.iter().map(|(curve, others)| (curve.label.clone(), others.clone())).collect();
        let curves: Vec<Curve> = found.into_iter().map(|(curve, _)| curve).collect();
        if curves.is_empty() {
            return None;
        }
        let file = file_name(&column.name);
        let (name, part) = match (groups.len(), &members[..]) {
            (2.., [first, .., last]) => {
                (format!("{file}-{}", group + 1), format!(", arms {} to {}", first + 1, last + 1))
            }
            (2.., [only]) => (format!("{file}-{}", group + 1), format!(", arm {}", only + 1)),
            _ => (file, String::new()),
        };
        let end = curves.iter().filter_map(|curve| curve.x.last()).copied().fold(0.0, f64::max);
        let contact = curves::contact(study, end);
        let y_label = with_unit(&label, &column.unit);
        // A rough curve of a failed arm would cover the others.
        let (aside, curves): (Vec<Curve>, Vec<Curve>) =
            curves.into_iter().partition(|curve| curve.apart && curves::is_rough(curve));
        let apart = match (curves.iter().any(|curve| curve.apart), aside.is_empty()) {
            (false, true) => String::new(),
            (_, none_is_rough) => format!(
                " Dashed grey: arms that failed, up to the cross where they stopped, and arms that created \
                 more energy than the default guard allows. They do not affect the axes{}.",
                if none_is_rough { "" } else { ", and rough ones have panes of their own" }
            ),
        };
        let rough = curves.iter().filter(|curve| curves::is_rough(curve)).count() > 1;
        let (panes, across, enlarged) = if rough {
            (
                multiples(curves, &y_label, contact),
                3,
                if contact.is_some() { " during the first contact" } else { "" },
            )
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
        let aside = aside.into_iter().map(|curve| Pane {
            title: curve.label.clone(),
            y_label: with_unit(&label, &column.unit),
            curves: vec![Curve { unlisted: true, ..curve }],
            ..Pane::default()
        });
        let points = measured.points(&column.name, end, rough);
        let with_points = |mut pane: Pane| {
            pane.curves.extend(points.iter().cloned());
            pane
        };
        let panes: Vec<Pane> = panes.into_iter().chain(aside).map(with_points).collect();
        Some(Plot {
            group: if groups.len() > FEW { capitalised(&what) } else { String::new() },
            name,
            caption: format!(
                "{}{enlarged}{part}.{}{apart}{}",
                capitalised(&what),
                curves::drawn_once(&names),
                measured.words(&column.name)
            ),
            x_label: with_unit("time t", time),
            log: [false, false],
            across,
            same: rough,
            direct: !rough,
            panes,
        })
    };
    (0..groups.len()).filter_map(figure).collect()
}

/// Panes at the same scale with a curve each, its label as the title.
fn multiples(curves: Vec<Curve>, y_label: &str, span: Option<(f64, f64)>) -> Vec<Pane> {
    let pane = |(k, curve): (usize, Curve)| Pane {
        title: curve.label.clone(),
        y_label: if k % 3 == 0 { y_label.to_owned() } else { String::new() },
        curves: vec![Curve { unlisted: true, style: 1, ..curve }],
        span,
        ..Pane::default()
    };
    curves.into_iter().enumerate().map(pane).collect()
}
