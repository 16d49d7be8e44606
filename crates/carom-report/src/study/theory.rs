//! The figure of the spectral properties of the schemes, with the frequencies of the model.

use carom_record::study::{Study, step};

use crate::ordered::distinct;
use crate::plot::{Curve, Pane, Plot};
use crate::text::said_if;

/// Spectral radius, damping and period error of every scheme, from `theory.csv`; frequencies of the
/// model, from `frequencies.csv`.
pub(super) fn plot(study: &Study) -> Option<Plot> {
    let rows = |name: &str| -> Option<Vec<csv::StringRecord>> {
        csv::Reader::from_path(study.directory.join(name)).ok()?.records().collect::<Result<_, _>>().ok()
    };
    let table = rows("theory.csv")?;
    // The curves have no values below these.
    let least = table.iter().filter_map(|row| row[1].parse::<f64>().ok()).fold(f64::INFINITY, f64::min);
    let marks = marks(study, &rows("frequencies.csv").unwrap_or_default(), least);
    let names = distinct(table.iter().map(|row| &row[0]));
    let methods = study.manifest.methods();
    let curve = |column: usize, k: usize, name: &str| {
        let known = methods.iter().position(|method| *method == name);
        let of = table.iter().filter(|row| &row[0] == name);
        let points = of.filter_map(|r| Some((r[1].parse::<f64>().ok()?, r[column].parse::<f64>().ok()?)));
        let (x, y) = points.unzip();
        let style = known.unwrap_or(methods.len() + k);
        Curve { label: name.to_owned(), style, x, y, ..Curve::default() }
    };
    let pane = |title: &str, y_label: &str, column: usize, limits: (f64, f64)| Pane {
        title: title.into(),
        y_label: y_label.into(),
        curves: names.iter().enumerate().map(|(k, name)| curve(column, k, name)).collect(),
        marks: marks.clone(),
        limits: Some(limits),
        ..Pane::default()
    };
    let panes = vec![
        pane("spectral radius", "ρ", 2, (0.0, 1.1)),
        pane("numerical damping ratio", "ξ", 3, (0.0, 1.0)),
        pane("relative period error", "(T − T_{0})/T_{0}", 4, (-0.1, 1.0)),
    ];
    let is_marked = |symbol: &str| marks.iter().any(|(_, word)| word.starts_with(symbol));
    let extremes = [("ω_{1}", "lowest (ω_{1})"), ("ω_{max}", "highest (ω_{max})")];
    let marked: Vec<&str> =
        extremes.into_iter().filter(|(symbol, _)| is_marked(symbol)).map(|(_, words)| words).collect();
    let lines = match &marked[..] {
        [] => String::new(),
        marked => format!(
            " Vertical lines: {} frequency of the model of the first arm at the longest (labelled) and the shortest time \
             step.",
            marked.join(" and ")
        ),
    };
    let springs = said_if(is_marked("ω_{c}"), " ω_{c}: the stiffest penalty spring on its node alone.");
    let caption = format!(
        "Properties of the schemes for an undamped oscillator of angular frequency ω; methods with the scheme of another \
         one have its curve.{lines}{springs} For a node constrained by a multiplier ωΔt → ∞, and only ρ∞ matters."
    );
    Some(Plot {
        name: "theory".into(),
        caption,
        x_label: "ωΔt".into(),
        log: [true, false],
        across: 1,
        panes,
        ..Plot::default()
    })
}

/// Frequencies of the model times the longest step, with labels, and times the shortest.
fn marks(study: &Study, frequencies: &[csv::StringRecord], least: f64) -> Vec<(f64, String)> {
    let arms = study.manifest.arms.iter().filter(|arm| !arm.role.fine);
    let steps: Vec<f64> = arms.filter_map(|arm| step(arm, "time.step")).collect();
    let (short, long) = crate::axis::range(&steps);
    let mut marks: Vec<(f64, String)> = Vec::new();
    for row in frequencies {
        let Ok(omega) = row[1].parse::<f64>() else { continue };
        let symbol = match &row[0] {
            "1" => "ω_{1}Δt",
            "highest" => "ω_{max}Δt",
            "spring" => "ω_{c}Δt",
            _ => continue,
        };
        marks.push((omega * long, symbol.to_owned()));
        if short < 0.9 * long {
            marks.push((omega * short, String::new()));
        }
    }
    marks.retain(|(at, _)| *at >= least);
    marks
}
