//! What may overlap, with or without a contact.

use serde::{Deserialize, Serialize};

/// Bodies or sides that overlap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Overlap {
    /// Two bodies, or a body and itself: their indices.
    Bodies(usize, usize),
    /// A body and the rigid obstacle of one of its contacts, with nodes beside the contact's side.
    Obstacle {
        /// Index of the body.
        body: usize,
        /// Index of the contact.
        contact: usize,
    },
    /// A body and a convex part of the rigid obstacle of one of its contacts, such as a sharp edge,
    /// that lies between nodes and that the contact does not hold.
    Between {
        /// Index of the body.
        body: usize,
        /// Index of the contact.
        contact: usize,
    },
    /// The sides of a contact: a node is deeper than a tenth of the facet that it entered, in a
    /// side that meets itself a tenth.
    Sides {
        /// Index of the contact.
        contact: usize,
    },
}
