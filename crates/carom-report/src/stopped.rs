//! "Why it stopped": reason, place, the last iterations, and what to try.

mod picture;

use carom_record::{Run, Stop, StopIteration, StopNode, StopPlace};
use maud::{Markup, html};

use crate::document::{file, joined, or_dash};
use crate::labels::{capitalised, number};
use crate::scientific::{powers, significant};
use crate::text::{Label, Prose, typeset};
use crate::values;
pub(crate) use picture::figure;

const ITERATIONS: &str = "Newton's iterations of the last attempt, each before its correction. Residual: as \
    a fraction of the sum of the forces.";
const DAMPING: &str = " Damping: the fraction of the correction that was applied.";

/// The section, with its figure.
pub(crate) fn section(run: &Run, picture: Option<Markup>) -> Markup {
    let Some(stop) = &run.stop else { return html! {} };
    let unit = run.history.unit("time");
    html! {
        h2 { "Why it stopped" }
        p.reason { (Label(&powers(&capitalised(&typeset(&stop.reason))))) "." }
        p.small {
            "The last accepted state is at t = " (number(stop.last)) "\u{a0}" (Label(unit)) "; the last attempt began at t = "
            (number(stop.time)) "\u{a0}" (Label(unit)) ". t and Δt are in " (Label(unit)) "; L is the length of the model."
        }
        @if let Some(place) = &stop.place { (where_table(place, values::unit(&run.manifest.case, "length"))) }
        @if let Some(picture) = picture { (picture) }
        (advice(stop))
        (iterations(&stop.iterations))
        p.small {
            "To reproduce it with a smaller case: " code { "carom reduce " (run.directory.file_name().unwrap_or_default().to_string_lossy()) } ". Data: "
            (joined(["stopped.json", "stopped.vtu"].map(file), ", ")) " (the state at t = " (number(stop.last))
            " " (Label(unit)) " with the rejected displacements)."
        }
    }
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

fn advice(stop: &Stop) -> Markup {
    html! {
        @if !stop.advice.is_empty() {
            h3 { "What to try" }
            div.scroll {
                table.advice {
                    thead { tr { th { "Remedy" } th { "Option" } } }
                    @for advice in &stop.advice {
                        tr {
                            td { (Prose(&advice.what)) }
                            td { @for set in &advice.sets { code { span.option { "--set" } " '" (breakable(set)) "'" } " " } }
                        }
                    }
                }
            }
        }
    }
}

/// An option that is broken before its value rather than within a word.
fn breakable(set: &str) -> Markup {
    let (key, value) = set.split_once('=').unwrap_or((set, ""));
    html! { (key) @if !value.is_empty() { "=" wbr; (value) } }
}

/// A fraction of a correction: it is halved, so a power of two.
fn fraction(x: f64) -> String {
    let halvings = -x.log2();
    if halvings > 9.0 && halvings.fract() == 0.0 { format!("2^{{−{halvings}}}") } else { number(x) }
}

fn iterations(iterations: &[StopIteration]) -> Markup {
    let or_none = |x: Option<f64>| or_dash(x, |x| significant(x, 3));
    let gaps = iterations.iter().any(|i| i.gap.is_some_and(|gap| gap != 0.0));
    let pairs = iterations.iter().any(|i| i.active > 0);
    let changes = iterations.iter().any(|i| i.changed);
    html! {
        @if !iterations.is_empty() {
            h3 { "The last iterations" }
            div.scroll {
                table.iterations {
                    thead {
                        tr {
                            th.n { "Iteration" } th.n { "Residual" }
                            @if gaps { th.n { "Gap" } }
                            th.n { "Correction" } th.n { "Damping" }
                            @if pairs { th.n { "Active pairs" } }
                            @if changes { th { "Contacts" } }
                        }
                    }
                    @for i in iterations {
                        tr {
                            td.n { (i.number) } td.n { (Label(&or_none(i.residual))) }
                            @if gaps { td.n { (Label(&or_none(i.gap))) } }
                            td.n { (Label(&or_none(i.correction))) } td.n { (Label(&fraction(i.length))) }
                            @if pairs { td.n { (i.active) } }
                            @if changes { td { @if i.changed { "changed" } } }
                        }
                    }
                }
            }
            p.small {
                (ITERATIONS)
                @if gaps { " Gap and correction: as fractions" } @else { " Correction: as a fraction" }
                " of the length of the model." (DAMPING)
                @if !pairs { " No pair was in contact." }
                (Prose(" Data: `stopped.json`."))
            }
        }
    }
}
