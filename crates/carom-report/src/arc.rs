//! Arc lengths of the nodes of a contact along its secondary side.

use std::collections::{BTreeMap, BTreeSet};

use carom_case::Method;
use carom_record::ContactRow;

use crate::recorded::Recorded;

/// Where a node of a contact lies.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// Number of the node along its side.
    pub(crate) number: usize,
    /// Arc length of the node, and of the ends of its part of the side, half-way to its neighbours.
    pub(crate) at: f64,
    pub(crate) part: [f64; 2],
    /// Whether it is a node of the secondary side.
    pub(crate) is_secondary: bool,
}

/// The places of the nodes in contact along the secondary side in the reference configuration, and
/// whether they are lengths: without field files, which have the positions, nodes are counted. A
/// closed side is cut where no node is in contact for longest.
pub(crate) fn places(run: &Recorded, name: &str, rows: &[&ContactRow]) -> (BTreeMap<u64, Place>, bool) {
    let contact = run.case.contacts.iter().find(|contact| contact.name == name);
    let is_field = contact.is_some_and(|contact| contact.method == Method::Mortar);
    let chains = contact
        .map(|contact| &contact.secondary)
        .and_then(|side| run.manifest.sides.get(side))
        .map_or(&[][..], Vec::as_slice);
    let first = run.fields.first().and_then(|entry| run.field(entry).ok());
    let rubbing: BTreeSet<u64> = rows.iter().map(|row| row.node).collect();
    let mut found = BTreeMap::new();
    let mut end = 0.0;
    let mut before = 0;
    let mut gaps = 0;
    for chain in chains {
        let point = |node: &usize| match &first {
            Some(set) => set.points.get(*node).copied(),
            None => Some([0.0; 3]),
        };
        let points: Vec<(u64, [f64; 3])> =
            chain.iter().filter_map(|n| Some((*n as u64, point(n)?))).collect();
        let length = |a: [f64; 3], b: [f64; 3]| match &first {
            Some(_) => (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt(),
            None => 1.0,
        };
        let mut order: Vec<usize> = (0..points.len()).collect();
        let is_closed = points.len() > 2 && points[0].0 == points[points.len() - 1].0;
        if is_closed {
            order.pop();
            let rubs: Vec<bool> = order.iter().map(|&i| rubbing.contains(&points[i].0)).collect();
            order.rotate_left(cut(&rubs));
        }
        let mut places = Vec::new();
        for (i, &k) in order.iter().enumerate() {
            end += if i == 0 { 0.0 } else { length(points[order[i - 1]].1, points[k].1) };
            places.push(end);
        }
        let rubs: Vec<bool> = order.iter().map(|&k| rubbing.contains(&points[k].0)).collect();
        for (i, &k) in order.iter().enumerate().filter(|(i, _)| rubs[*i]) {
            // Only nodes that stand for coefficients of a pressure field have rows.
            let previous = (0..i).rev().find(|&j| is_field && rubs[j]).or(i.checked_sub(1));
            let next = (i + 1..places.len()).find(|&j| is_field && rubs[j]).or(Some(i + 1));
            let half_way = |other: Option<usize>| {
                let other = other.and_then(|j| places.get(j)).unwrap_or(&places[i]);
                0.5 * (places[i] + other)
            };
            let [below, above] = [previous, next].map(half_way);
            let place = Place { number: before + i, at: places[i], part: [below, above], is_secondary: true };
            found.entry(points[k].0).or_insert(place);
        }
        before += order.len() + 1;
        gaps += order.len().saturating_sub(1);
    }
    // Corners of the primary side, in the order in which they touch, each as wide as a node of the
    // secondary side.
    let wide = if gaps > 0 { end / gaps as f64 } else { 1.0 };
    for row in rows {
        found.entry(row.node).or_insert_with(|| {
            end += wide;
            before += 2;
            Place { number: before, at: end - 0.5 * wide, part: [end - wide, end], is_secondary: false }
        });
    }
    (found, first.is_some())
}

/// Quantity and unit of the places.
pub(crate) fn label(is_length: bool, unit: &str) -> (&'static str, &str) {
    if is_length { ("arc length s", unit) } else { ("node along the side", "") }
}

/// Where to cut a cycle: in the middle of the longest run without a rubbing node.
fn cut(rubs: &[bool]) -> usize {
    let n = rubs.len();
    let run = |start: usize| (0..n).take_while(|k| !rubs[(start + k) % n]).count();
    let longest = (0..n).max_by_key(|&start| (run(start), n - start)).unwrap_or(0);
    (longest + run(longest) / 2) % n.max(1)
}

#[cfg(test)]
mod tests {
    use super::cut;

    #[test]
    fn a_cycle_is_cut_away_from_contact() {
        assert_eq!(cut(&[true, false, false, false, false, true]), 3);
        assert_eq!(cut(&[false, false, true, true, false, false]), 0);
        assert_eq!(cut(&[true, true]), 0);
    }
}
