//! Derivatives of friction in a stage by the positions at its end (`friction.rs`).

use carom_contact::{Rows, length};

use crate::equations::Equations;
use crate::evaluation::Evaluation;
use crate::friction::{Counted, Rubbing, rows_of};

impl Equations<'_> {
    /// ∂H/∂y of a tangent of a pair at y_½ halved, the derivative of its row by the end of the
    /// step, row-major; and ∂S/∂y.
    pub(crate) fn slip_derivatives(
        &self,
        evaluation: &Evaluation,
        (contact, p): (usize, usize),
        tangent: usize,
        rows: &mut Rows,
    ) -> (Vec<f64>, Vec<f64>) {
        let kinematics = &self.model.contacts[contact].kinematics;
        let (slips, pair) = (&evaluation.slips[contact], &evaluation.at.pairings[contact].pairs[p]);
        let row = slips.row(rows_of(slips, p).start + tangent);
        let mut matrix = vec![0.0; row.gradient.len().pow(2)];
        rows.clear();
        let part = self.part(contact, pair, evaluation.rows[contact].row(p).gap, rows);
        let share = if let Counted::Share(share) = part { share } else { 1.0 };
        let mut gradient: Vec<f64> = row.gradient.iter().map(|h| share * h).collect();
        let mut at_middle = *pair;
        // It was measured in the evaluation.
        if kinematics.measure(&mut at_middle, &evaluation.middle, rows).is_err() {
            return (matrix, gradient);
        }
        kinematics.slip_derivative_into(&at_middle, &evaluation.middle, tangent, &mut matrix);
        matrix.iter_mut().for_each(|entry| *entry *= 0.5);
        let counted = row.entries().map(|(dof, _)| self.counted(dof, part, &evaluation.at.increment));
        for (turned, moved) in matrix.chunks_exact(gradient.len()).zip(counted) {
            gradient.iter_mut().zip(turned).for_each(|(slope, h)| *slope += h * moved);
        }
        (matrix, gradient)
    }

    /// Adds the derivative of the force r Σ d_α H_α of a slipping pair, beyond those of r by λ and
    /// of an unknown d, over the nodes of its row.
    pub(crate) fn slip_curvature_into(
        &self,
        evaluation: &Evaluation,
        (contact, p): (usize, usize),
        rows: &mut Rows,
        curvature: &mut [f64],
    ) {
        let slip = evaluation.slip_of((contact, p));
        let mut pair = evaluation.at.pairings[contact].pairs[p];
        let part = self.part(contact, &pair, evaluation.rows[contact].row(p).gap, rows);
        let Rubbing { direction, radius, rate, across } = self.rub(contact, &mut pair, slip, part);
        if direction == [0.0; 2] {
            return;
        }
        let derivatives: Vec<_> = (1..self.model.dimension)
            .map(|tangent| self.slip_derivatives(evaluation, (contact, p), tangent - 1, rows))
            .collect();
        let size = length(slip);
        // Of a slip that begins, any will do.
        let unit = if size > 0.0 { slip.map(|s| s / size) } else { [slip[0].signum(), 0.0] };
        let aside = [-direction[1], direction[0]];
        for (a, row) in evaluation.slip_rows((contact, p)).enumerate() {
            let n = row.gradient.len();
            for (i, entries) in curvature.chunks_exact_mut(n).enumerate() {
                for (j, entry) in entries.iter_mut().enumerate() {
                    let mut change = direction[a] * radius.value * derivatives[a].0[i * n + j];
                    for (b, (_, gradient)) in derivatives.iter().enumerate() {
                        let by_slip =
                            radius.by_rate * rate * unit[b] * direction[a] + across * aside[a] * aside[b];
                        change += by_slip * row.gradient[i] * gradient[j];
                    }
                    *entry += change;
                }
            }
        }
    }
}
