//! The figure of the spectral properties of the schemes, with the frequencies of the model.

use carom_record::study::{Arm, Study, step};

use crate::curves;
use crate::ordered::{distinct, grouped};
use crate::plot::{Curve, Pane, Plot};
use crate::text::said_if;

/// Spectral radius, damping and period error of every scheme, from `theory.csv`; frequencies of the
/// model, from `frequencies.csv`.
pub(crate) fn plot(study: &Study) -> Option<Plot> {
    let rows = |name: &str| -> Option<Vec<csv::StringRecord>> {
        csv::Reader::from_path(study.directory.join(name)).ok()?.records().collect::<Result<_, _>>().ok()
    };
    let table = rows("theory.csv")?;
    let steps = study.manifest.arms.iter().filter(|a| !a.role.fine).filter_map(|a| step(a, "time.step"));
    let (short, long) = steps.fold((f64::INFINITY, 0.0_f64), |(a, b), h| (a.min(h), b.max(h)));
    let mut marks: Vec<(f64, String)> = Vec::new();
    for row in rows("frequencies.csv").unwrap_or_default() {
        let (word, Ok(omega)) = (&row[0], row[1].parse::<f64>()) else { continue };
        let symbol = match word {
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
    // The curves have no values below these.
    let least = table.iter().filter_map(|row| row[1].parse::<f64>().ok()).fold(f64::INFINITY, f64::min);
    marks.retain(|(at, _)| *at >= least);
    let springs = " ω_{c}: the stiffest penalty spring on its node alone, with the other side at rest.";
    let springs = said_if(marks.iter().any(|m| m.1.starts_with("ω_{c}")), springs);
    let names = distinct(table.iter().map(|row| &row[0]));
    let methods = study.manifest.methods();
    let curve = |column: usize| {
        let (names, table, methods) = (&names, &table, &methods);
        names.iter().enumerate().map(move |(k, name)| {
            let known = methods.iter().position(|method| method == name);
            let style = known.unwrap_or(methods.len() + k);
            let of = table.iter().filter(|r| &r[0] == *name);
            let points = of.filter_map(|r| Some((r[1].parse::<f64>().ok()?, r[column].parse::<f64>().ok()?)));
            let (x, y) = points.unzip();
            Curve { label: (*name).to_owned(), style, x, y, ..Curve::default() }
        })
    };
    let mut once: Vec<(String, String)> = Vec::new();
    let mut pane = |title: &str, y_label: &str, column: usize, limits: (f64, f64)| {
        let found = curves::merged(curve(column).filter(|c| !c.x.is_empty()).collect());
        for (curve, others) in &found {
            once.extend(others.iter().map(|other| (curve.label.clone(), other.clone())));
        }
        Pane {
            title: title.into(),
            y_label: y_label.into(),
            curves: found.into_iter().map(|(curve, _)| curve).collect(),
            marks: marks.clone(),
            limits: Some(limits),
            ..Pane::default()
        }
    };
    let panes = vec![
        pane("spectral radius", "ρ", 2, (0.0, 1.1)),
        pane("numerical damping ratio", "ξ", 3, (0.0, 1.0)),
        pane("relative period error", "(T − T_{0})/T_{0}", 4, (-0.1, 1.0)),
    ];
    Some(Plot {
        name: "theory".into(),
        caption: format!(
            "Properties of the schemes for an undamped oscillator of angular frequency ω. Vertical lines: the \
             lowest (ω_{{1}}) and the highest (ω_{{max}}) frequency of the model of the first arm within the \
             range of the curves, at the longest time step (labelled) and at the shortest.{springs} For a node constrained by a \
             multiplier, ωΔt → ∞ and only ρ∞ matters.{}{}",
            same_scheme(study, &names),
            curves::drawn_once(grouped(distinct(once)).iter().map(|(name, others)| (name, others)))
        ),
        x_label: "ωΔt".into(),
        log: [true, false],
        across: 1,
        direct: true,
        panes,
        ..Plot::default()
    })
}

/// Which methods have no curve of their own, since they have the scheme of another one.
fn same_scheme(study: &Study, names: &[&str]) -> String {
    let arms = || study.manifest.arms.iter().filter(|arm| !arm.role.fine);
    let alike = |arm: &Arm| {
        let scheme = arm.case.pointer("/time/scheme")?;
        let is_same = |other: &&Arm| {
            names.contains(&other.method()) && other.case.pointer("/time/scheme") == Some(scheme)
        };
        arms().find(is_same).map(Arm::method)
    };
    let others = arms().filter(|arm| !names.contains(&arm.method()));
    let found = grouped(others.filter_map(|arm| Some((arm.method(), alike(arm)?))));
    if found.is_empty() {
        return String::new();
    }
    let words: Vec<String> =
        found.iter().map(|(one, others)| format!("“{one}” that of “{}”", others[0])).collect();
    format!(" Methods with the scheme of another one have its curve: {}.", words.join("; "))
}
