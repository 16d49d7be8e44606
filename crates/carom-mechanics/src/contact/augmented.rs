//! Springs and multipliers of augmented Lagrangians (`carom_contact::Augmented`; J. C. Simo, T. A.
//! Laursen, Comput. Struct. 42 (1992) 97–116):
//!
//! ```text
//! λ = λ̂ + r g,   q = q̂ + k S in stick            λ̂ ← λ,   q̂ ← q in rounds (`rounds.rs`)
//! ```
//!
//! with r, k multiples of the diagonal of the step's tangent at the node. A round reduces gaps by a
//! factor of about K/(K + r) with the stiffness K of the bodies; where that is too little, the
//! springs become stiffer. Slipping nodes have q = −μλd and nothing to augment.

use carom_contact::Pair;
use carom_time::Stage;

use crate::model::{Contact, Model};
use crate::stage::balance::contact_weights;
use crate::stage::evaluation::Iterate;

/// Stiffnesses of the springs of every secondary node, normal and tangential; none for contacts
/// without.
pub(crate) fn springs(model: &Model, stage: &Stage, [mass, stiffness]: [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let of = |contact: &Contact| {
        let Some(augmentation) = &contact.augmentation else { return Vec::new() };
        let weight = contact_weights(stage, contact.at_the_end).0;
        let nodes = contact.kinematics.secondary().iter().zip(&augmentation.stiffness);
        let diagonal = nodes.map(|(&node, k)| {
            let own = model.mass.row(node).find(|(other, _)| *other == node).map_or(0.0, |(_, m)| m);
            (mass * own + stiffness * k) / weight
        });
        diagonal.map(|d| augmentation.factors.map(|factor| factor * d)).collect()
    };
    model.contacts.iter().map(of).collect()
}

/// The multipliers of the first round are the forces of a guess.
pub(crate) fn start(model: &Model, guess: &mut Iterate) {
    guess.stiffer = 0;
    for (contact, pairing) in model.contacts.iter().zip(&mut guess.pairings) {
        if contact.augmentation.is_some() {
            pairing.pairs.iter_mut().for_each(take);
        }
    }
}

/// The multipliers of a pair are its forces.
pub(crate) fn take(pair: &mut Pair) {
    pair.multiplier = pair.lambda;
    pair.tangential.before = pair.tangential.traction;
}
