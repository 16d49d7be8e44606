//! Rows that are linearly independent on the free dofs, by Gaussian elimination of the sparse rows.

use std::collections::BTreeMap;

use carom_contact::{Along, Row, Rows};

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

/// The names of those rows that are linearly independent of the earlier ones on the free dofs, each
/// with the remainder below which it depends on them.
pub(crate) fn independent_above<'a, T>(
    model: &Model,
    rows: impl Iterator<Item = (T, Row<'a>, f64)>,
) -> Vec<T> {
    let mut set = Independent::new(model);
    rows.filter_map(|(name, row, least)| set.accept(row, least).then_some(name)).collect()
}

/// Entries of a row on free dofs, an entry each.
type Entries = Vec<(usize, f64)>;

/// Rows that are linearly independent on the free dofs.
pub(crate) struct Independent<'a> {
    model: &'a Model,
    accepted: Vec<Entries>,
    /// The accepted row whose pivot is this dof.
    pivots: BTreeMap<usize, usize>,
}

impl<'a> Independent<'a> {
    /// No rows.
    pub(crate) fn new(model: &'a Model) -> Self {
        Self { model, accepted: Vec::new(), pivots: BTreeMap::new() }
    }

    /// Adds a row unless it depends on those accepted before; returns whether it was added.
    /// `least`: the remainder below which it depends on them.
    pub(crate) fn accept(&mut self, row: Row, least: f64) -> bool {
        let rest = self.rest(on_free_dofs(self.model, row), 0);
        self.add(rest, least)
    }

    /// Adds the rows of a stick, of which `rows` has as many as there are tangents from `first` on;
    /// returns how many were added, the first ones. Where others leave only one direction to it, as
    /// the gaps of a node in a groove do, the rows, and their components `along` the tangents, are
    /// turned to that direction and the one across it.
    pub(crate) fn accept_stick(
        &mut self,
        rows: &mut Rows,
        first: usize,
        least: f64,
        along: &mut [Along],
    ) -> usize {
        let rests: Vec<Entries> = (first..first + along.len())
            .map(|row| self.rest(on_free_dofs(self.model, rows.row(row)), 0))
            .collect();
        let before = self.accepted.len();
        let mut added = Vec::new();
        for rest in &rests {
            let rest = self.rest(rest.clone(), before);
            added.push(self.add(rest, least));
        }
        let [is_first, is_second] = added[..] else { return usize::from(added[0]) };
        if is_first == is_second {
            return 2 * usize::from(is_first);
        }
        // Both rests are parallel.
        let [i, j] = if is_first { [1.0, ratio(&rests[1], &rests[0])] } else { [ratio(&rests[0], &rests[1]), 1.0] };
        let [i, j] = [i, j].map(|part| part / i.hypot(j));
        rows.turn(first, [i, j]);
        along.copy_from_slice(&[[i, j], [-j, i]]);
        1
    }

    /// What the accepted rows, from the one with this index on, leave of a row.
    fn rest(&self, mut row: Entries, mut from: usize) -> Entries {
        // An accepted row contains pivots of later ones only: in ascending order each occurs once.
        while let Some((r, factor)) = row
            .iter()
            .filter_map(|(dof, value)| Some((*self.pivots.get(dof)?, *value)))
            .filter(|(r, value)| *r >= from && *value != 0.0)
            .min_by_key(|(r, _)| *r)
        {
            for &(dof, value) in &self.accepted[r] {
                match row.iter_mut().find(|(d, _)| *d == dof) {
                    Some((_, x)) => *x -= factor * value,
                    None => row.push((dof, -factor * value)),
                }
            }
            from = r + 1;
        }
        row
    }

    fn add(&mut self, mut rest: Entries, least: f64) -> bool {
        let largest = rest
            .iter()
            .fold((0, 0.0_f64), |most, &(dof, x)| if x.abs() > most.1.abs() { (dof, x) } else { most });
        if largest.1.abs() <= least {
            return false;
        }
        rest.iter_mut().for_each(|(_, x)| *x /= largest.1);
        self.pivots.insert(largest.0, self.accepted.len());
        self.accepted.push(rest);
        true
    }
}

/// Factor c for which c times a row, `of`, is nearest to another one.
fn ratio(row: &Entries, of: &Entries) -> f64 {
    let at = |dof: usize| row.iter().find(|entry| entry.0 == dof).map_or(0.0, |entry| entry.1);
    let common: f64 = of.iter().map(|&(dof, value)| value * at(dof)).sum();
    common / of.iter().map(|(_, value)| value * value).sum::<f64>()
}

/// Entries of a row on the free dofs, an entry each.
pub(crate) fn on_free_dofs(model: &Model, row: Row) -> Entries {
    let is_free = |(dof, _): &(usize, f64)| !model.fixed[*dof];
    if model.points.is_empty() {
        return row.entries().filter(is_free).collect();
    }
    let mut sums = Entries::new();
    for (dof, slope) in model.points.pulled(row.entries()).filter(is_free) {
        match sums.iter_mut().find(|(other, _)| *other == dof) {
            Some((_, sum)) => *sum += slope,
            None => sums.push((dof, slope)),
        }
    }
    sums
}
