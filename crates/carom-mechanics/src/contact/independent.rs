//! Rows that are linearly independent on the free dofs.

use std::collections::BTreeMap;

use carom_algebra::{Independent, Plane, SparseRow};
use carom_contact::{Along, Pairing, Row, Rows};

use crate::model::Model;

/// Remainder after elimination (gradients are of order one) below which a row depends on the
/// others.
pub(crate) const DEPENDENT: f64 = 1e-8;

/// Remainder below which rows whose multipliers are found from G M⁻¹Gᵀ, which contains its square,
/// depend on each other.
const NEARLY: f64 = 1e-5;

/// Remainder below which a row stands for the same contact as others, as where a corner is beside a
/// node: velocities are projected without it, its gap keeps this share of a rate, and a field of
/// pressure presses without the bounds of its nodes. The impulses of all would be the difference of
/// their rates over the remainder, with opposite signs, and each would rub.
pub(crate) const SAME: f64 = 1e-2;

/// The remainder below which a row stands for the same contact as others. What supports leave of a
/// row may be small by itself.
pub(crate) fn same_contact(model: &Model, row: Row) -> f64 {
    let largest = on_free_dofs(model, row).iter().fold(0.0_f64, |most, (_, slope)| most.max(slope.abs()));
    (SAME * largest).max(DEPENDENT)
}

/// Remainder below which the slip of a pair whose nodes supports constrain along a tangent depends
/// on other rows.
pub(crate) const HELD: f64 = 1e-3;

/// The places whose rows stand for contacts of their own.
pub(crate) fn independent_rows(
    model: &Model,
    places: impl Iterator<Item = (usize, usize)>,
    rows: &[Rows],
) -> Vec<(usize, usize)> {
    independent_above(
        model,
        places.map(|(k, p)| ((k, p), rows[k].row(p), same_contact(model, rows[k].row(p)))),
    )
}

/// Remainder of the row of a slip below which it depends on the others. In space supports may
/// constrain a node and its facet along one tangent, and the row then has only what turns the
/// facet, times the gap.
pub(crate) fn slip_remainder(model: &Model) -> f64 {
    if model.dimension == 3 { HELD } else { DEPENDENT }
}

/// Whether a row depends on the others so nearly that G M⁻¹Gᵀ, which contains the square of its
/// remainder, is singular in floating point.
pub(crate) fn is_dependent<'a>(model: &Model, rows: impl Iterator<Item = Row<'a>>) -> bool {
    let mut count = 0;
    let counted = rows.inspect(|_| count += 1).map(|row| ((), row, NEARLY));
    independent_above(model, counted).len() < count
}

/// The closed gaps, by contact and pair, that depend on those of other contacts at the same place,
/// one of which rubs: which of them presses, and rubs by its law, is arbitrary.
pub(crate) fn dependent_on_others<'a>(
    model: &Model,
    gaps: impl Iterator<Item = ((usize, usize), Row<'a>)>,
) -> Vec<(usize, usize)> {
    let mut all = Independent::default();
    let mut of_contacts: BTreeMap<usize, Independent> = BTreeMap::new();
    let mut seen: Vec<(usize, SparseRow)> = Vec::new();
    let rubs = |contact: usize| model.contacts[contact].friction.is_some();
    let mut found = Vec::new();
    for (place, row) in gaps {
        let row = on_free_dofs(model, row);
        let is_new_there = of_contacts.entry(place.0).or_default().accept(row.clone(), NEARLY);
        let is_new = all.accept(row.clone(), NEARLY);
        let shares = |other: &SparseRow| other.iter().any(|(dof, _)| row.iter().any(|(own, _)| own == dof));
        let meets = |(contact, other): &(usize, SparseRow)| {
            *contact != place.0 && (rubs(*contact) || rubs(place.0)) && shares(other)
        };
        if is_new_there && !is_new && seen.iter().any(meets) {
            found.push(place);
        }
        seen.push((place.0, row));
    }
    found
}

/// Whether some node presses with several pairs, as in a corner: only there slips in the plane can
/// depend on each other.
pub(crate) fn share_nodes(model: &Model, pairings: &[Pairing], places: &[(usize, usize)]) -> bool {
    let mut nodes: Vec<usize> =
        places.iter().map(|&(k, p)| model.contacts[k].node(&pairings[k].pairs[p])).collect();
    nodes.sort_unstable();
    nodes.windows(2).any(|two| two[0] == two[1])
}

/// The names of those rows that are linearly independent of the earlier ones on the free dofs, each
/// with the remainder below which it depends on them.
pub(crate) fn independent_above<'a, T>(
    model: &Model,
    rows: impl Iterator<Item = (T, Row<'a>, f64)>,
) -> Vec<T> {
    let mut set = Independent::default();
    rows.filter_map(|(name, row, least)| set.accept(on_free_dofs(model, row), least).then_some(name))
        .collect()
}

/// Adds the rows of a slip that is prevented, of `rows` from `first` on, to independent ones: one
/// per tangent of a stick, or the one across a slip. Returns how many of them were added, from the
/// first on. Where others leave only one direction to it, as the gaps of a node in a groove do, the
/// rows, and their components `along` the tangents, are turned to that direction and the one across
/// it.
pub(crate) fn accept_stick(
    model: &Model,
    set: &mut Independent,
    rows: &mut Rows,
    first: usize,
    least: f64,
    along: &mut [Along],
) -> usize {
    let free = |row: usize| on_free_dofs(model, rows.row(row));
    if along.len() < 2 {
        return usize::from(set.accept(free(first), least));
    }
    match set.accept_plane([free(first), free(first + 1)], least) {
        Plane::Nothing => 0,
        Plane::All => 2,
        Plane::Line([i, j]) => {
            rows.turn(first, [i, j]);
            along.copy_from_slice(&[[i, j], [-j, i]]);
            1
        }
    }
}

/// Entries of a row on the free dofs, an entry each; those of mortar contact extend over nodes on
/// which they do not act.
pub(crate) fn on_free_dofs(model: &Model, row: Row) -> SparseRow {
    let is_free = |(dof, slope): &(usize, f64)| *slope != 0.0 && !model.fixed[*dof];
    if model.points.is_empty() {
        let mut free = SparseRow::with_capacity(row.gradient.len());
        free.extend(row.entries().filter(is_free));
        return free;
    }
    let mut sums = SparseRow::new();
    for (dof, slope) in model.points.pulled(row.entries()).filter(is_free) {
        match sums.iter_mut().find(|(other, _)| *other == dof) {
            Some((_, sum)) => *sum += slope,
            None => sums.push((dof, slope)),
        }
    }
    sums
}
