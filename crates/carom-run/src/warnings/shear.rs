//! Warning about limited tractions (`shear`) that act on another area than that of the contact. The
//! limit of a node of the secondary side is that of its whole area, in every row that it has; nodes
//! of the primary side have none. In a mortar contact the coefficients of the pressure have all of
//! the area, and nodes that bear alone have none.

use std::collections::{BTreeMap, BTreeSet};

use carom_case::{Case, ContactSpec, Method};
use carom_mechanics::model::Model;
use carom_record::{ContactRow, Run};

use super::found::{Found, short};

/// Share of the rows or of the force from which it is told.
const SHARE: f64 = 0.02;

pub(super) fn shear_area(case: &Case, _: &Model, run: &Run) -> Vec<Found> {
    let limited = case.contacts.iter().filter(|contact| contact.friction.shear.is_some());
    limited.flat_map(|contact| of_contact(contact, run)).collect()
}

fn of_contact(contact: &ContactSpec, run: &Run) -> Vec<Found> {
    let rows = || run.contact.iter().filter(|row| row.contact == contact.name && row.multiplier < 0.0);
    let side: BTreeSet<u64> = run
        .manifest
        .sides
        .get(&contact.secondary)
        .map_or_else(BTreeSet::new, |chains| chains.iter().flatten().map(|node| *node as u64).collect());
    let is_mortar = contact.method == Method::Mortar;
    let has_area = |row: &&ContactRow| if is_mortar { row.nominal > 0.0 } else { side.contains(&row.node) };
    let force = |row: &ContactRow| -row.multiplier;
    let all: f64 = rows().map(force).sum();
    let without: f64 = rows().filter(|row| !has_area(row)).map(force).sum();
    let mut found = Vec::new();
    if without > SHARE * all {
        let percent = short(100.0 * without / all);
        found.push(format!("{percent} % of the contact force acts at nodes that have no area"));
    }
    let repeated = if is_mortar { 0.0 } else { repeated(rows().filter(has_area)) };
    if repeated > SHARE {
        let percent = short(100.0 * repeated);
        found.push(format!(
            "nodes over joints of the primary side have several rows, each with the friction of the whole node: \
             {percent} % more rows than nodes"
        ));
    }
    found.into_iter().map(|what| Found::of_contact(&contact.name, what)).collect()
}

/// Rows with friction beyond one for each node and step, over the number of these.
fn repeated<'a>(rows: impl Iterator<Item = &'a ContactRow<'static>>) -> f64 {
    let mut counts: BTreeMap<(u64, u64), u32> = BTreeMap::new();
    for row in rows.filter(|row| row.traction != 0.0) {
        *counts.entry((row.step, row.node)).or_default() += 1;
    }
    let all = counts.values().sum::<u32>();
    if counts.is_empty() { 0.0 } else { f64::from(all) / counts.len() as f64 - 1.0 }
}
