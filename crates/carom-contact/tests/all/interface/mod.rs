//! The response of a contact to its gap.

mod augmented;
mod conserving_penalty;
