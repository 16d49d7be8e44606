//! "Why it stopped": reason, place, the last iterations, and what to try.

mod picture;

use carom_record::{Advice, Run, Stop, StopIteration, StopNode, StopPlace};
use maud::{Markup, html};

use crate::document::{file, joined, or_dash};
use crate::figure::Figure;
use crate::labels::{capitalised, number};
use crate::text::{Label, Prose, typeset};

const ITERATIONS: &str = "Newton's iterations of the last attempt, each before its correction. Residual: as \
    a fraction of the sum of the forces. Gap and correction: as fractions of the length of the model. \
    Damping: the fraction of the correction that was applied. Data: `stopped.json`.";

/// The picture of the place.
pub(crate) fn picture(run: &Run) -> Option<Figure> {
    picture::figure(run, run.stop.as_ref()?)
}

/// The section, with its figure.
pub(crate) fn section(run: &Run, picture: Option<Markup>) -> Markup {
    let Some(stop) = &run.stop else { return html! {} };
    let unit = run.history.unit("time");
    html! {
        h2 { "Why it stopped" }
        p.reason { (capitalised(&typeset(&stop.reason))) "." }
        @if let Some(place) = &stop.place { (where_table(place, length_unit(run))) }
        @if let Some(picture) = picture { (picture) }
        (advice(stop, unit))
        (iterations(&stop.iterations))
        p.small {
            "To reproduce it with a smaller case: " code { "carom reduce " (run.directory.file_name().unwrap_or_default().to_string_lossy()) } ". Data: "
            (joined(["stopped.json", "stopped.vtu"].map(file), ", ")) " (the state at t = " (number(stop.last))
            " " (Label(unit)) " with the rejected displacements)."
        }
    }
}

/// The unit of length of the case.
fn length_unit(run: &Run) -> &str {
    run.manifest.case.pointer("/units/length").and_then(|unit| unit.as_str()).unwrap_or_default()
}

fn where_table(place: &StopPlace, unit: &str) -> Markup {
    let at = |x: &[f64]| {
        let list = x.iter().map(|x| number(*x)).collect::<Vec<_>>().join(", ");
        format!("({list}) {unit}").trim_end().to_owned()
    };
    let node = |node: &StopNode| {
        html! {
            "node " (node.number) " of “" (node.body) "” at " (at(&node.at)) ", in the mesh at "
            (at(&node.reference))
        }
    };
    html! {
        table.place {
            @if let Some(n) = &place.node {
                tr {
                    th { "Node" }
                    td { (node(n)) @if let Some(found) = &place.found { " (" (found) ")" } }
                }
            }
            @if let Some(contact) = &place.contact { tr { th { "Contact" } td { (contact) } } }
            @if !place.facet_nodes.is_empty() {
                tr {
                    th { "Facet" }
                    td {
                        @if let Some(facet) = place.facet { "number " (facet) ": " }
                        @for (i, n) in place.facet_nodes.iter().enumerate() {
                            @if i > 0 { br; }
                            (node(n))
                        }
                    }
                }
            }
            @if let (Some(body), Some(cell)) = (&place.body, place.cell) {
                tr { th { "Cell" } td { "number " (cell) " of “" (body) "”" } }
            }
        }
    }
}

fn advice(stop: &Stop, unit: &str) -> Markup {
    let result = |advice: &Advice| {
        html! {
            @match &advice.trial {
                Some(trial) if trial.passed => {
                    td.pass { "gets past: t = " (number(trial.reached)) " " (Label(unit)) }
                }
                Some(trial) => {
                    td {
                        // A trial that fails earlier is inconclusive.
                        @if trial.reached < stop.last { "stops earlier, at t = " } @else { "stops at t = " }
                        (number(trial.reached)) " " (Label(unit))
                        @if let Some(why) = &trial.why { details { summary { "why" } (typeset(why)) } }
                    }
                }
                None => { td { "not tried" } }
            }
            td.n { (or_dash(advice.trial.as_ref().map(|trial| trial.from), number)) }
        }
    };
    html! {
        @if !stop.advice.is_empty() {
            h3 { "What to try" }
            div.scroll {
                table {
                    thead { tr { th { "Remedy" } th { "Option" } th { "Tried" } th.n { "From t (" (Label(unit)) ")" } } }
                    @for advice in &stop.advice {
                        tr {
                            td { (Prose(&advice.what)) }
                            td { @for set in &advice.sets { code { "--set '" (set) "'" } " " } }
                            (result(advice))
                        }
                    }
                }
            }
            @if let Some(trials) = &stop.trials { p.small { (trials) } }
        }
    }
}

fn iterations(iterations: &[StopIteration]) -> Markup {
    let or_none = |x: Option<f64>| x.map_or_else(|| "–".to_owned(), |x| format!("{x:.2e}").replace('-', "−"));
    html! {
        @if !iterations.is_empty() {
            h3 { "The last iterations" }
            div.scroll {
                table {
                    thead {
                        tr {
                            th.n { "Iteration" } th.n { "Residual" } th.n { "Gap" } th.n { "Correction" }
                            th.n { "Damping" } th.n { "Active pairs" } th { "Contacts" }
                        }
                    }
                    @for i in iterations {
                        tr {
                            td.n { (i.number) } td.n { (or_none(i.residual)) } td.n { (or_none(i.gap)) }
                            td.n { (or_none(i.correction)) } td.n { (number(i.length)) } td.n { (i.active) }
                            td { @if i.changed { "changed" } }
                        }
                    }
                }
            }
            p.small { (Prose(ITERATIONS)) }
        }
    }
}
