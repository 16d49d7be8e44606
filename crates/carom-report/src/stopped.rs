//! "Why it stopped": reason, place, the last iterations, and what to try.

mod picture;

use carom_record::{Stop, StopIteration, StopNode, StopPlace, Warning};
use maud::{Markup, html};

use crate::document::or_dash;
use crate::labels::{capitalised, number};
use crate::made::command;
use crate::recorded::Recorded;
use crate::scientific::{powers, significant};
use crate::text::{Label, Prose, typeset};
pub(crate) use picture::figure;

/// Warnings about what can make a run stop, the most likely first.
const CAUSES: [&str; 8] = [
    "fast-impact",
    "velocity-jump",
    "undeclared-contact",
    "flat-cell",
    "wave-speed",
    "unconnected-bodies",
    "coarse-secondary",
    "long-step",
];

/// How likely a warning is the cause of a stop: 0 is the most likely; none of other warnings.
pub(crate) fn cause(warning: &Warning) -> Option<usize> {
    CAUSES.iter().position(|id| *id == warning.id)
}

const ITERATIONS: &str = "Iterations of the last attempt. Residual: over the sum of the forces; gap, correction: over \
    the length of the model; damping: applied fraction of the correction. Data: `stopped.json`.";

/// The section, with its figure: the cause, what to try, the place, the last iterations.
pub(crate) fn section(run: &Recorded, picture: Option<Markup>) -> Markup {
    let Some(stop) = &run.stop else { return html! {} };
    let unit = run.history.unit("time");
    html! {
        (causes(run, stop))
        p.reason { (Label(&powers(&capitalised(&typeset(&stop.reason))))) "." }
        (advice(stop))
        p { "For a smaller case that stops in the same way: " code { "carom reduce " (run.directory.display()) } }
        h3 { "Where" }
        p {
            "Last accepted state: t = " (number(stop.last)) "\u{a0}" (Label(unit)) "; last attempt: from t = "
            (number(stop.time)) "\u{a0}" (Label(unit)) "."
        }
        @if let Some(place) = &stop.place { (where_table(place, &run.case.units.length)) }
        @if let Some(picture) = picture { (picture) }
        (iterations(&stop.iterations))
    }
}

/// Warnings of a run that stopped are likely causes, those of the body or contact at the place
/// first.
fn causes(run: &Recorded, stop: &Stop) -> Markup {
    let place = stop.place.as_ref();
    let names = place
        .into_iter()
        .flat_map(|p| p.contact.iter().chain(&p.body).chain(p.node.as_ref().map(|n| &n.body)));
    let names: Vec<String> = names.map(|name| format!("\"{name}\"")).collect();
    let is_far = |warning: &&Warning| !names.iter().any(|name| warning.place.contains(name));
    let mut warnings: Vec<&Warning> = run.manifest.warnings.iter().filter(|w| cause(w).is_some()).collect();
    warnings.sort_by_key(|warning| (is_far(warning), cause(warning)));
    html! {
        @if !warnings.is_empty() {
            h3 { "Likely cause" }
            ul.causes {
                @for warning in warnings {
                    li {
                        b { (typeset(&warning.place)) } ": " (Label(&powers(&typeset(&warning.what)))) ". Try "
                        (Prose(&typeset(&warning.advice))) "."
                    }
                }
            }
            h3 { "What happened" }
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
    let has_commands = stop.advice.iter().any(|advice| !advice.sets.is_empty());
    html! {
        @if !stop.advice.is_empty() {
            h3 { "What to try" }
            div.scroll {
                table.advice {
                    thead { tr {
                            th { "Remedy" }
                            @if has_commands { th { "Command, with the case file as " code { "case.toml" } } }
                        } }
                    @for advice in &stop.advice {
                        tr {
                            td { (Prose(&advice.what)) }
                            @if has_commands {
                                td { @if !advice.sets.is_empty() { code { (command(&advice.sets)) } } }
                            }
                        }
                    }
                }
            }
        }
    }
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
            p.small { (Prose(ITERATIONS)) }
        }
    }
}
