//! The active pairs of a state and the rows of their gaps there.

use carom_contact::{Pair, Rows};

use crate::model::Model;
use crate::rejected::Rejected;
use crate::state::State;

/// Contact and pair of all active ones in a state.
pub(crate) fn pressing(state: &State) -> impl Iterator<Item = (usize, usize)> + '_ {
    let pairs = state.pairs.iter().enumerate();
    pairs.flat_map(|(k, pairs)| (0..pairs.len()).filter(|&p| pairs[p].active).map(move |p| (k, p)))
}

/// Rows of all active pairs at the state; those of inactive ones are open.
pub fn measure_all(model: &Model, state: &mut State) -> Result<Vec<Rows>, Rejected> {
    measure(model, state, |_, _, pair| pair.active)
}

/// Rows of these pairs (contact, index) at the state; those of others are open.
pub(crate) fn measure(
    model: &Model,
    state: &mut State,
    which: impl Fn(usize, usize, &Pair) -> bool,
) -> Result<Vec<Rows>, Rejected> {
    let mut all = Vec::with_capacity(model.contacts.len());
    for (k, (contact, pairs)) in model.contacts.iter().zip(&mut state.pairs).enumerate() {
        let mut rows = Rows::new(model.dimension);
        for (p, pair) in pairs.iter_mut().enumerate() {
            let measured = which(k, p, pair).then(|| contact.kinematics.measure(pair, &state.y, &mut rows));
            match measured {
                Some(Ok(())) => {}
                Some(Err(error)) if pair.active => {
                    return Err(Rejected::Contact { contact: contact.name.clone(), error });
                }
                _ => rows.push_open(),
            }
        }
        all.push(rows);
    }
    Ok(all)
}
