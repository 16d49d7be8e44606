//! Warning about limited tractions (`shear`) that act on another area than that of the contact. The
//! limit of a node is that of its whole area, in every row that it has. In a mortar contact the
//! coefficients of the pressure have all of the area, and nodes that bear alone have none.

use std::collections::BTreeMap;

use carom_case::{Case, ContactSpec, Method};
use carom_mechanics::model::Model;
use carom_record::{ContactRow, Run};

use super::found::{Found, short};

/// Share of the nodes or of the force from which it is told.
const SHARE: f64 = 0.02;

pub(super) fn shear_area(case: &Case, _: &Model, run: &Run) -> Vec<Found> {
    let limited = case.contacts.iter().filter(|contact| contact.friction.shear.is_some());
    limited.filter_map(|contact| of_contact(contact, run)).collect()
}

fn of_contact(contact: &ContactSpec, run: &Run) -> Option<Found> {
    let mut steps: BTreeMap<u64, Vec<&ContactRow>> = BTreeMap::new();
    for row in run.contact.iter().filter(|row| row.contact == contact.name && row.multiplier < 0.0) {
        steps.entry(row.step).or_default().push(row);
    }
    let is_mortar = contact.method == Method::Mortar;
    let share = |rows: &Vec<&ContactRow>| if is_mortar { alone(rows) } else { repeated(rows) };
    let rows = steps.values().max_by(|a, b| share(a).total_cmp(&share(b)))?;
    let share = share(rows);
    if share < SHARE {
        return None;
    }
    let percent = short(100.0 * share);
    let time = short(rows[0].time);
    let what = if is_mortar {
        format!(
            "nodes that bear {percent} % of the contact force at t = {time} have no area, and no friction"
        )
    } else {
        format!(
            "nodes over joints of the primary side have {percent} % more rows than there are nodes at t = {time}, each with the friction of the whole node"
        )
    };
    Some(Found::of_contact(&contact.name, what))
}

/// Rows beyond one for each node, over the number of nodes.
fn repeated(rows: &[&ContactRow]) -> f64 {
    let rubs = rows.iter().filter(|row| row.traction != 0.0);
    let mut nodes: Vec<u64> = rubs.map(|row| row.node).collect();
    let count = nodes.len() as f64;
    nodes.sort_unstable();
    nodes.dedup();
    if nodes.is_empty() { 0.0 } else { count / nodes.len() as f64 - 1.0 }
}

/// Share of the force of rows that are no coefficients of the pressure.
fn alone(rows: &[&ContactRow]) -> f64 {
    let force = |row: &&&ContactRow| -row.multiplier;
    let all: f64 = rows.iter().map(|row| force(&row)).sum();
    let of_nodes = rows.iter().filter(|row| row.nominal == 0.0);
    of_nodes.map(|row| force(&row)).sum::<f64>() / all
}
