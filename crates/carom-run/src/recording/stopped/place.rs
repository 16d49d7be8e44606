//! The place of a stop: what the reason names, and otherwise what the last attempt shows.

use carom_contact::PairEvent;
use carom_contact::Rows;
use carom_mechanics::model::Model;
use carom_mechanics::{GridReport, LogEvent, Place, State, Stopped, Trace};
use carom_record::{StopNode, StopPlace};

use crate::build::side::owner;

/// The place; none if nothing points to one.
pub(super) fn place(
    model: &Model,
    state: &State,
    stopped: &Stopped,
    report: &GridReport,
    trace: &Trace,
) -> Option<StopPlace> {
    let named = match stopped {
        Stopped::NoStep { rejected, .. } => rejected.place(),
        Stopped::EnergyGuard { .. } | Stopped::Interrupted { .. } => Place::default(),
    };
    let mut place = StopPlace { contact: named.contact.map(Into::into), ..StopPlace::default() };
    let mut node = named.node;
    if let (Some(name), Some(cell)) = (named.body, named.cell)
        && let Some(part) = model.parts.iter().find(|part| part.name == name)
    {
        (place.body, place.cell) = (Some(name.into()), Some(cell));
        place.cell_nodes = part.body.mesh().cell(cell).iter().map(|n| n + part.first_node).collect();
        node = node.or(place.cell_nodes.first().copied());
    }
    if node.is_none() {
        let (found, how, contact) = elsewhere(model, state, report, trace)?;
        (node, place.found) = (Some(found), Some(how.into()));
        place.contact = place.contact.or(contact);
    }
    let node = node?;
    place.node = Some(described(model, state, node)?);
    let contact = model.contacts.iter().position(|c| place.contact.as_ref() == Some(&c.name));
    if let Some(k) = contact {
        let (facet, nodes) = facet(model, state, k, node);
        place.facet = named.facet.or(facet);
        place.facet_nodes = nodes.iter().filter_map(|&node| described(model, state, node)).collect();
    }
    Some(place)
}

/// A node that the reason does not name: of the largest residual, of the last change of contact, or
/// of the largest contact force.
fn elsewhere(
    model: &Model,
    state: &State,
    report: &GridReport,
    trace: &Trace,
) -> Option<(usize, &'static str, Option<String>)> {
    let contact = |k: usize| Some(model.contacts[k].name.clone());
    if let Some(dof) = trace.worst() {
        let node = dof / model.dimension;
        // The contact in which it, or a facet that has it, is active; a skin has all nodes of a
        // body.
        let mut rows = Rows::new(model.dimension);
        let mut touched = (0..model.contacts.len()).filter(|&k| {
            state.pairs[k].iter().filter(|pair| pair.active).any(|pair| {
                rows.clear();
                let found = model.contacts[k].kinematics.measure(&mut pair.clone(), &state.y, &mut rows);
                found.is_ok() && rows.row(0).nodes.contains(&node)
            })
        });
        return Some((node, "the node with the largest residual", touched.next().and_then(contact)));
    }
    let changed = report.events.iter().rev().find_map(|event| match event {
        LogEvent::ActiveSet { contact, node, .. }
        | LogEvent::Pair {
            contact,
            event: PairEvent::HandOver { node, .. } | PairEvent::SlidOff { node, .. },
            ..
        } => Some((*contact, *node)),
        _ => None,
    });
    if let Some((k, node)) = changed {
        return Some((node, "the node whose contact changed last", contact(k)));
    }
    let active =
        state.pairs.iter().enumerate().flat_map(|(k, pairs)| pairs.iter().map(move |pair| (k, pair)));
    let (k, pair) =
        active.filter(|(_, pair)| pair.active).min_by(|a, b| a.1.lambda.total_cmp(&b.1.lambda))?;
    let node = model.contacts[k].kinematics.secondary()[pair.node];
    Some((node, "the node with the largest contact force", contact(k)))
}

/// A node of a body; none of the carrier of an obstacle.
fn described(model: &Model, state: &State, node: usize) -> Option<StopNode> {
    let part = owner(&model.parts, node).filter(|part| !part.is_rigid())?;
    let range = node * model.dimension..(node + 1) * model.dimension;
    Some(StopNode {
        number: node,
        body: part.name.clone(),
        reference: model.reference[range.clone()].to_vec(),
        at: state.y[range].to_vec(),
    })
}

/// The facet that a node of a contact faces: that of its pair, or else the nearest one of the other
/// side; its nodes from end to end.
fn facet(model: &Model, state: &State, k: usize, node: usize) -> (Option<usize>, Vec<usize>) {
    let contact = &model.contacts[k];
    let ordered = |nodes: &[usize]| {
        let (ends, inner) = nodes.split_at(nodes.len().min(2));
        ends.iter().take(1).chain(inner).chain(ends.iter().skip(1)).copied().collect::<Vec<_>>()
    };
    let mut pairs = state.pairs[k].iter().filter(|pair| contact.kinematics.secondary()[pair.node] == node);
    let mut rows = Rows::new(model.dimension);
    if let Some(pair) = pairs.next()
        && contact.kinematics.measure(&mut pair.clone(), &state.y, &mut rows).is_ok()
        && rows.row(0).nodes.len() > rows.row(0).own
    {
        // The row of a mean, or of a pressure field, has nodes of several facets.
        return (Some(pair.facet), ordered(contact.kinematics.facet_nodes(pair)));
    }
    let own = contact.facets.iter().position(|(_, facets)| facets.iter().any(|nodes| nodes.contains(&node)));
    let Some((_, facets)) = own.and_then(|own| contact.facets.get(1 - own.min(1))) else {
        return (None, Vec::new());
    };
    let d = model.dimension;
    let at = |n: usize, i: usize| state.y[n * d + i];
    let distance = |nodes: &Vec<usize>| {
        let middle = |i: usize| nodes.iter().map(|&n| at(n, i)).sum::<f64>() / nodes.len() as f64;
        (0..d).map(|i| (middle(i) - at(node, i)).powi(2)).sum::<f64>()
    };
    let nearest = facets.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    (None, nearest.map_or_else(Vec::new, |nodes| ordered(nodes)))
}
