//! Load steps with friction by continuation in the coefficient: where the sets of open, sticking
//! and slipping pairs do not converge, as at first touch, a step with more friction, in which fewer
//! pairs slip, leads to them. The coefficient falls from there to its value, each solution the
//! guess of the next; only a solution with the value itself is accepted.

use carom_contact::{Law, Pairing};

use crate::rejected::Rejected;
use crate::settings::Settings;
use crate::stage::equations::Equations;
use crate::stage::evaluation::{Evaluation, Iterate};
use crate::stage::newton::{Effort, solve_stage};
use crate::stage::renewal::FrozenTangent;
use crate::workspace::Workspace;

/// Factors of the coefficients of friction, one after another. One that does not converge is left
/// out.
const FACTORS: [f64; 9] = [16.0, 8.0, 4.0, 2.0, 1.5, 1.2, 1.1, 1.05, 1.0];

/// Solves a stage from the guess from which it did not converge; `frozen` and `before` as in
/// [`solve_stage`].
///
/// # Errors
/// If it does not converge from its neighbours either.
pub(crate) fn solve_by_grip(
    equations: &mut Equations,
    frozen: &FrozenTangent,
    before: &[f64],
    settings: &Settings,
    mut guess: Iterate,
    work: &mut Workspace,
) -> Result<(Evaluation, Effort), Rejected> {
    let laws = equations.laws.clone();
    let mut frozen = frozen.clone();
    let mut spent = 0;
    for factor in FACTORS {
        let scaled = |law: &Law| Law { stick: factor * law.stick, slip: factor * law.slip, ..*law };
        equations.laws = laws.iter().map(|of| of.iter().map(scaled).collect()).collect();
        let solved = solve_stage(equations, &frozen, before, settings, guess.clone(), work);
        if factor == 1.0 {
            return solved.map(|(reached, effort)| {
                let iterations = effort.iterations + spent;
                (reached, Effort { iterations, ..effort })
            });
        }
        if let Ok((reached, effort)) = solved {
            spent += effort.iterations;
            frozen = effort.frozen;
            guess = work.spare.copy(&reached.at);
            guess.pairings.iter_mut().for_each(Pairing::restart);
            work.spare.put(reached);
        }
    }
    Err(Rejected::NoFrictionBalance)
}
