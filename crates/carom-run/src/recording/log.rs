//! Events of a step as lines of `log.jsonl`, with the names of the case.

use carom_case::{BodySpec, Case, ContactSpec, MeshSpec, Overlap};
use carom_contact::PairEvent;
use carom_mechanics::model::Model;
use carom_mechanics::{LogEvent, Overlap as Undeclared};
use carom_record::Event;

use crate::build::side::owner;
use crate::quantity::quantity;

/// Repairs of meshes that were read from files.
pub(super) fn repairs(case: &Case) -> Vec<Event> {
    let of_body = |body: &BodySpec| match body.mesh.source() {
        MeshSpec::File(file) => file.repairs.clone(),
        _ => Vec::new(),
    };
    let event = |name: &str, repair: &str| {
        Event::new(0, 0.0, "repair", format!("mesh of \"{name}\": {repair}")).with("body", name)
    };
    case.bodies.iter().flat_map(|b| of_body(b).into_iter().map(move |r| event(&b.name, &r))).collect()
}

/// The relaxation of an initial overlap; `strain`: the energy that the bodies store after it.
pub(super) fn relaxed(case: &Case, strain: f64) -> Vec<Event> {
    let relaxes = |contact: &&ContactSpec| contact.overlap == Overlap::Relax && case.initial.is_none();
    let event = |contact: &ContactSpec| {
        let message = format!(
            "contact \"{}\": its overlap was closed before the start; the bodies then store {}",
            contact.name,
            quantity(strain, &case.labels().energy)
        );
        Event::new(0, 0.0, "relaxed", message).with("contact", contact.name.as_str()).with("strain", strain)
    };
    case.contacts.iter().filter(relaxes).map(event).collect()
}

/// An event with the units of the case.
pub(super) fn in_units(case: &Case, event: Event) -> Event {
    Event { message: case.in_units(&event.message), ..event }
}

/// An event of the step being computed; quantities have their dimension in brackets.
pub(super) fn entry(model: &Model, step: u64, event: &LogEvent) -> Event {
    let contact_name = |k: usize| model.contacts[k].name.as_str();
    let body_of = |node: usize| owner(&model.parts, node).map_or("?", |part| part.name.as_str());
    match event {
        LogEvent::Rejected { time, dt, rejected } => {
            Event::new(step, *time, "rejected", format!("step of {dt:.6e} [time] rejected: {rejected}"))
                .with("dt", *dt)
                .with("reason", rejected.kind())
        }
        LogEvent::Faded { time, end } => {
            let message = format!(
                "no load step converges from the start, which is not in balance: what is lacking fades until t = {end:?} [time]"
            );
            Event::new(step, *time, "faded", message).with("end", *end)
        }
        LogEvent::Fallback { time, dt, reason } => {
            let message = format!(
                "step of {dt:.6e} [time] taken by the fallback, backward Euler with contact implicit in velocity; without it: {reason}"
            );
            Event::new(step, *time, "fallback", message).with("dt", *dt)
        }
        LogEvent::ActiveSet { time, contact, node, active, met } => {
            let verb = if *active { "becomes active in" } else { "leaves" };
            let met_at =
                met.map_or_else(String::new, |met| format!("; paths crossed at t = {met:.9e} [time]"));
            let message = format!(
                "node {node} of \"{}\" {verb} contact \"{}\"{met_at}",
                body_of(*node),
                contact_name(*contact)
            );
            let event = Event::new(step, *time, if *active { "activation" } else { "release" }, message)
                .with("contact", contact_name(*contact))
                .with("node", *node);
            if let Some(met) = met { event.with("met", *met) } else { event }
        }
        LogEvent::Pair { time, contact, event } => {
            let name = contact_name(*contact);
            let (kind, message, node) = match event {
                PairEvent::HandOver { node, from, to } => (
                    "hand-over",
                    format!("contact \"{name}\": node {node} slides from facet {from} to {to}"),
                    node,
                ),
                PairEvent::SlidOff { node, facet } => (
                    "slid-off",
                    format!("contact \"{name}\": node {node} slides off facet {facet}, the end of the side"),
                    node,
                ),
            };
            Event::new(step, *time, kind, message).with("contact", name).with("node", *node)
        }
        LogEvent::Overlap { time, overlap: Undeclared::Bodies(a, b) } => {
            let [first, second] = [a, b].map(|k| model.parts[*k].name.as_str());
            let place = if a == b {
                format!("body \"{first}\"")
            } else {
                format!("bodies \"{first}\" and \"{second}\"")
            };
            let what = if a == b {
                "crosses itself"
            } else {
                "overlap: no contact between them covers the nodes that are inside"
            };
            Event::new(step, *time, "overlap", format!("{place} {what}")).with("place", place)
        }
        LogEvent::Overlap { time, overlap: Undeclared::Obstacle { body, contact } } => {
            let place = format!("body \"{}\"", model.parts[*body].name);
            let name = contact_name(*contact);
            let message = format!(
                "{place} lies in the obstacle of contact \"{name}\" with nodes beside the side of the contact"
            );
            Event::new(step, *time, "overlap", message).with("place", place).with("obstacle", name)
        }
        LogEvent::Overlap { time, overlap: Undeclared::Between { body, contact } } => {
            let place = format!("body \"{}\"", model.parts[*body].name);
            let name = contact_name(*contact);
            let message =
                format!("a part of the obstacle of contact \"{name}\" lies between nodes of {place}");
            Event::new(step, *time, "between-nodes", message).with("place", place).with("contact", name)
        }
        LogEvent::Overlap { time, overlap: Undeclared::Sides { contact } } => {
            let name = contact_name(*contact);
            let message = format!("contact \"{name}\": a node lies deep in the other side");
            Event::new(step, *time, "deep", message).with("contact", name)
        }
        LogEvent::Ambiguous { time, regularity } => {
            let message = format!(
                "friction so large that stick and slip are not unique: the matrix of the contacts has the smallest singular value {:.3e}, \
                 relative to that without friction{}",
                regularity.abs(),
                if *regularity < 0.0 { ", and a negative determinant" } else { "" }
            );
            Event::new(step, *time, "ambiguous", message).with("regularity", *regularity)
        }
        LogEvent::Unstable { time } => {
            let message = "the equilibrium is unstable: the tangent stiffness is not positive definite";
            Event::new(step, *time, "unstable", message.to_owned())
        }
        LogEvent::Dependent { time, gaps } => {
            let places =
                gaps.iter().map(|(contact, node)| format!("node {node} of \"{}\"", contact_name(*contact)));
            let places = places.collect::<Vec<_>>().join(", ");
            let message = format!(
                "closed without a force of its own: {places}: other gaps, supports or ties determine this"
            );
            Event::new(step, *time, "dependent", message).with("places", places)
        }
        LogEvent::Projection { time, jump } => {
            let message = format!(
                "velocities projected where contact or stick begins: kinetic energy changes by {jump:.6e} [energy]"
            );
            Event::new(step, *time, "projection", message).with("kinetic_jump", *jump)
        }
        LogEvent::Begun { time, jump } => {
            let message = format!(
                "an explicit step of another length is begun in contact: the contact force of the half step before it \
                 changes the kinetic energy by {jump:.6e} [energy], booked as its work"
            );
            Event::new(step, *time, "step-begun", message).with("kinetic_jump", *jump)
        }
        LogEvent::Restitution { time, jump } => {
            let message =
                format!("restitution where contact ends: kinetic energy changes by {jump:.6e} [energy]");
            Event::new(step, *time, "restitution", message).with("kinetic_jump", *jump)
        }
    }
}
