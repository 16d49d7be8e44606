//! Displacement and stress along the bars of a run in one dimension.

use carom_record::FieldSet;

use crate::chart::{Chart, Options, Panel, Series};
use crate::figure::Figure;
use crate::labels::{instant_label, with_unit};
use crate::palette::sequence;
use crate::recorded::Recorded;

/// At several instants.
pub(crate) fn figure(run: &Recorded, sets: &[(f64, FieldSet)], (during, files): (&str, &str)) -> Figure {
    // Positions and values of a component along the bars, with a gap after each bar.
    let along = |set: &FieldSet, array: &str, component: usize| -> Option<(Vec<f64>, Vec<f64>)> {
        let values = set.array(array).filter(|a| component < a.components)?;
        let mut x = Vec::new();
        let mut y = Vec::new();
        for block in &set.blocks {
            let mut nodes = block.connectivity.clone();
            nodes.sort_by(|&a, &b| set.points[a][0].total_cmp(&set.points[b][0]));
            nodes.dedup();
            x.extend(nodes.iter().map(|&k| set.points[k][0]));
            y.extend(nodes.iter().map(|&k| values.values[values.components * k + component]));
            x.push(set.points[*nodes.last()?][0]);
            y.push(f64::NAN);
        }
        Some((x, y))
    };
    let lines = |array: &str, component| -> Vec<_> {
        let line = |(t, set): &(f64, _)| along(set, array, component).map(|(x, y)| (*t, x, y));
        sets.iter().filter_map(line).collect()
    };
    let u = lines("displacement", 0);
    let stress = lines("stress", 0);
    let unit = |array: &str| sets.first().map_or("", |(_, set)| set.unit(array));
    let mut panels = Vec::new();
    for (label, array, lines) in [("u_{x}", "displacement", &u), ("σ_{xx}", "stress", &stress)] {
        let series = lines.iter().enumerate().map(|(i, (t, x, y))| Series {
            label: instant_label(run, *t),
            color: sequence(i, sets.len()),
            x,
            y: y.clone(),
            // Both panels share one legend.
            unlisted: !panels.is_empty(),
            ..Series::default()
        });
        let series: Vec<Series> = series.collect();
        if !series.is_empty() {
            panels.push(Panel { label: label.into(), unit: unit(array).into(), height: 200.0, series });
        }
    }
    let x_label = with_unit("reference position X", unit("displacement"));
    let chart =
        Chart { title: "Displacement and stress along the bars", x_label, shades: Vec::new(), panels };
    let caption = format!("Displacement and stress along the bars {during}. Data: {files}.");
    chart.figure("bodies", caption, &Options::default())
}
