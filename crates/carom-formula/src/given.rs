//! Functions of a program in the place of formulas.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// A function of place and time, evaluated at many points in one call. A point is given by the
/// values of its variables, `width` of them, time last. A value that cannot be computed is NaN.
pub trait Function: Send + Sync + fmt::Debug {
    /// One value per point.
    fn values(&self, points: &[f64], width: usize) -> Vec<f64>;

    /// Value, first and second derivative in time, per point.
    fn with_derivatives(&self, points: &[f64], width: usize) -> Vec<[f64; 3]>;
}

/// Functions by name.
#[derive(Clone, Debug, Default)]
pub struct Functions(pub BTreeMap<String, Arc<dyn Function>>);

/// Equal if the names are.
impl PartialEq for Functions {
    fn eq(&self, other: &Self) -> bool {
        self.0.keys().eq(other.0.keys())
    }
}
