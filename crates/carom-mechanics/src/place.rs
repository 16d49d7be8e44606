//! Where a rejected step failed.

use carom_contact::ContactError;

use crate::rejected::Rejected;

/// The place that a rejection names; what it does not name is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place<'a> {
    /// Body of the cell, or body that was entered.
    pub body: Option<&'a str>,
    /// A cell of that body.
    pub cell: Option<usize>,
    /// Contact.
    pub contact: Option<&'a str>,
    /// Global number of a node.
    pub node: Option<usize>,
    /// Primary facet of the contact.
    pub facet: Option<usize>,
}

impl Rejected {
    /// The place that it names.
    pub fn place(&self) -> Place<'_> {
        match self {
            Self::Inverted { body, inverted } => {
                Place { body: Some(body), cell: Some(inverted.cell), ..Place::default() }
            }
            Self::InvertedOnTheWay { body, cell, .. } => {
                Place { body: Some(body), cell: Some(*cell), ..Place::default() }
            }
            Self::Contact { contact, error } => {
                let (node, facet) = match *error {
                    ContactError::Focal { node, facet, .. }
                    | ContactError::Lost { node, facet, .. }
                    | ContactError::Tip { node, facet, .. }
                    | ContactError::Edges { node, facet } => (node, Some(facet)),
                    ContactError::Center { node } => (node, None),
                };
                Place { contact: Some(contact), node: Some(node), facet, ..Place::default() }
            }
            Self::Cycle { contact, nodes } | Self::StickSlipCycle { contact, nodes, .. } => {
                Place { contact: Some(contact), node: nodes.first().copied(), ..Place::default() }
            }
            Self::Overconstrained { contact, node, .. } | Self::Passed { contact, node, .. } => {
                Place { contact: Some(contact), node: Some(*node), ..Place::default() }
            }
            Self::Penetration { contact, node, body, .. } => {
                Place { contact: Some(contact), node: Some(*node), body: Some(body), ..Place::default() }
            }
            Self::Jump { node, .. } => Place { node: Some(*node), ..Place::default() },
            Self::NoConvergence { .. }
            | Self::NoMultipliers { .. }
            | Self::Linear(_)
            | Self::NegativeMass
            | Self::NoFrictionBalance
            | Self::NoValue(_)
            | Self::Unconstrained(_)
            | Self::Unsettled { .. }
            | Self::Deep { .. }
            | Self::Energy { .. }
            | Self::Unstable { .. }
            | Self::NotFinite { .. } => Place::default(),
        }
    }
}
