//! The report of a study: its tables, its page and, for every probe column, figures with the curves
//! of all arms.

use std::path::Path;

use carom_record::study::Study;

use crate::collected::{Column, Origin, collect, named};
use crate::labels::{capitalised, file_name, with_unit};
use crate::plot::{Curve, Pane, Plot};
use crate::publish::{ReportError, ReportSummary, publish, write};
use crate::{laboratory, setup, study_page};

/// Curves in one figure; more arms need more figures.
const MOST: usize = 8;

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
    let study = Study::open(directory, &mut |arm, run| {
        run.history.unit("time").clone_into(&mut time);
        picture = picture.take().or_else(|| setup::figure(run, &run.field(run.fields.first()?).ok()?));
        collect(&mut columns, arm, run);
        origins.push(Origin::of(arm, run));
    })?;
    study.write_tables()?;
    let mut plots = laboratory::plots(&study, &columns, &time);
    plots.extend(columns.iter().flat_map(|column| overlays(column, &study, &time)));
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

/// A column of all arms, with up to eight curves in a figure.
fn overlays(column: &Column, study: &Study, time: &str) -> Vec<Plot> {
    let (label, what) = named(&column.name);
    let arms = &study.manifest.arms;
    // Arms of the same case are grouped.
    let groups: Vec<Vec<usize>> = arms
        .iter()
        .enumerate()
        .collect::<Vec<_>>()
        .chunk_by(|a, b| a.1.case_path == b.1.case_path)
        .flat_map(|same| same.chunks(MOST).map(|few| few.iter().map(|(i, _)| *i).collect()))
        .collect();
    let figure = |group: usize| {
        let members = &groups[group];
        let mine = column.curves.iter().filter(|(arm, ..)| members.contains(arm));
        let curves = mine.map(|(arm, x, y)| Curve {
            label: study.rows[*arm].name.clone(),
            style: *arm,
            x: x.clone(),
            y: y.clone(),
            marked: false,
            apart: study.rows[*arm].is_unsound(),
        });
        let curves: Vec<Curve> = curves.collect();
        if curves.is_empty() {
            return None;
        }
        let apart = if curves.iter().any(|curve| curve.apart) {
            " Dashed grey: arms that failed, up to where they stopped, and arms that created more energy \
             than the default guard allows; they do not affect the axes."
        } else {
            ""
        };
        let file = file_name(&column.name);
        let (name, part) = match (groups.len(), &members[..]) {
            (2.., [first, .., last]) => {
                (format!("{file}-{}", group + 1), format!(", arms {} to {}", first + 1, last + 1))
            }
            (2.., [only]) => (format!("{file}-{}", group + 1), format!(", arm {}", only + 1)),
            _ => (file, String::new()),
        };
        Some(Plot {
            name,
            caption: format!("{}{part}.{apart}", capitalised(&what)),
            x_label: with_unit("time t", time),
            log: [false, false],
            across: 1,
            same: false,
            panes: vec![Pane { y_label: with_unit(&label, &column.unit), curves, ..Pane::default() }],
        })
    };
    (0..groups.len()).filter_map(figure).collect()
}
