//! Derivatives of a slip by the positions at the end of the step, with their buffers.

use carom_contact::Rows;

/// Derivatives of the slip of a pair, per tangent, over the nodes of its rows.
pub(crate) struct SlipDerivatives {
    /// Contact and pair.
    pub of: Option<(usize, usize)>,
    /// Half of ∂H/∂y at y_½, the derivative of the row by the end of the step, row-major.
    pub turned: [Vec<f64>; 2],
    /// ∂S/∂y.
    pub slopes: [Vec<f64>; 2],
    /// A buffer.
    pub rows: Rows,
}

impl SlipDerivatives {
    /// Of no pair yet.
    pub(crate) fn new(dimension: usize) -> Self {
        Self { of: None, turned: Default::default(), slopes: Default::default(), rows: Rows::new(dimension) }
    }
}
