//! The active pairs of a state and the rows of their gaps there.

use carom_contact::{Pair, Rows};

use crate::model::{Contact, Model};
use crate::rejected::Rejected;
use crate::state::State;

/// Contact and pair of all active ones in a state.
pub(crate) fn pressing(state: &State) -> impl Iterator<Item = (usize, usize)> + '_ {
    let pairs = state.pairs.iter().enumerate();
    pairs.flat_map(|(k, pairs)| (0..pairs.len()).filter(|&p| pairs[p].active).map(move |p| (k, p)))
}

/// Pairs that a thread measures.
const SHARE: usize = 64;

/// For each contact, a row for each pair at a state; that of a pair that is inactive, or cannot be
/// measured, is open.
pub fn active_rows(model: &Model, state: &State) -> Vec<Rows> {
    let of_contact = |(contact, pairs): (&Contact, &Vec<Pair>)| {
        let mut blocks = vec![Rows::new(model.dimension); pairs.len().div_ceil(SHARE)];
        let shares = blocks.iter_mut().zip(pairs.chunks(SHARE));
        model.threads.for_each(shares, |_, (rows, pairs)| {
            for pair in pairs {
                let is_measured =
                    pair.active && contact.kinematics.measure(&mut pair.clone(), &state.y, rows).is_ok();
                if !is_measured {
                    rows.push_open();
                }
            }
        });
        let mut all = Rows::new(model.dimension);
        blocks.iter().flat_map(Rows::iter).for_each(|row| all.push_row(row));
        all
    };
    model.contacts.iter().zip(&state.pairs).map(of_contact).collect()
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
