//! Derivatives of friction in a stage by the positions at its end (`friction.rs`).

use carom_contact::length;

use crate::contact::friction::{Counted, Rubbing, rows_of};
use crate::contact::slip_derivatives::SlipDerivatives;
use crate::stage::equations::Equations;
use crate::stage::evaluation::{Evaluation, Iterate};

impl Equations<'_> {
    /// Computes the derivatives of a pair, if they are not there yet.
    pub(crate) fn slip_derivatives_into(
        &self,
        evaluation: &Evaluation,
        (contact, p): (usize, usize),
        derivatives: &mut SlipDerivatives,
    ) {
        let SlipDerivatives { of, turned, slopes, rows } = derivatives;
        if of.replace((contact, p)) == Some((contact, p)) {
            return;
        }
        let kinematics = &self.model.contacts[contact].kinematics;
        let slips = &evaluation.slips[contact];
        let pair = &evaluation.at.pairings[contact].pairs[p];
        rows.clear();
        let part = self.part(contact, pair, evaluation.rows[contact].row(p).gap, rows);
        let share = if let Counted::Share(share) = part { share } else { 1.0 };
        let Evaluation { middle, at: Iterate { increment, .. }, .. } = evaluation;
        // The evaluation has measured it.
        let at = self.measured_for_slip(contact, pair, middle, increment, rows).ok();
        for (tangent, row) in rows_of(slips, p).map(|row| slips.row(row)).enumerate() {
            let turned = &mut turned[tangent];
            let slope = &mut slopes[tangent];
            slope.clear();
            slope.extend(row.gradient.iter().map(|h| share * h));
            turned.clear();
            turned.resize(slope.len().pow(2), 0.0);
            let Some(at) = &at else { continue };
            let y = at.end.as_ref().unwrap_or(middle);
            kinematics.slip_derivative_into(&at.pair, y, increment, tangent, turned);
            let factor = if at.end.is_some() { 1.0 } else { 0.5 };
            turned.iter_mut().for_each(|entry| *entry *= factor);
            let counted = row.entries().map(|(dof, _)| self.counted(dof, part, increment));
            for (turned, moved) in turned.chunks_exact(slope.len()).zip(counted) {
                slope.iter_mut().zip(turned).for_each(|(slope, h)| *slope += h * moved);
            }
        }
    }

    /// Adds the derivative of the force r Σ d_α H_α of a slipping pair, beyond those of r by λ and
    /// of an unknown d, over the nodes of its row.
    pub(crate) fn slip_curvature_into(
        &self,
        evaluation: &Evaluation,
        (contact, p): (usize, usize),
        derivatives: &mut SlipDerivatives,
        curvature: &mut [f64],
    ) {
        let slip = evaluation.slip_of((contact, p));
        let mut pair = evaluation.at.pairings[contact].pairs[p];
        let gap = evaluation.rows[contact].row(p).gap;
        let part = self.part(contact, &pair, gap, &mut derivatives.rows);
        let Rubbing { direction, radius, rate } = self.rub(contact, &mut pair, slip, part);
        if direction == [0.0; 2] {
            return;
        }
        self.slip_derivatives_into(evaluation, (contact, p), derivatives);
        let size = length(slip);
        // Of a slip that begins, any will do.
        let unit = if size > 0.0 { slip.map(|s| s / size) } else { [slip[0].signum(), 0.0] };
        for (a, row) in evaluation.slip_rows((contact, p)).enumerate() {
            let n = row.gradient.len();
            for (i, entries) in curvature.chunks_exact_mut(n).enumerate() {
                for (j, entry) in entries.iter_mut().enumerate() {
                    let mut change = direction[a] * radius.value * derivatives.turned[a][i * n + j];
                    for (b, slopes) in derivatives.slopes[..self.model.dimension - 1].iter().enumerate() {
                        let by_slip = radius.by_rate * rate * unit[b] * direction[a];
                        change += by_slip * row.gradient[i] * slopes[j];
                    }
                    *entry += change;
                }
            }
        }
    }
}
