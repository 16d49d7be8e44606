//! Linear algebra of Carom: small tensors, sparse symmetric systems, finite-difference checks.

mod condensed;
#[doc(hidden)]
pub mod cone;
mod difference;
mod elimination;
#[doc(hidden)]
pub mod forest;
mod front;
mod independent;
mod linear;
#[doc(hidden)]
pub mod mixing;
mod node_matrix;
mod pattern;
mod pivots;
mod precision;
mod principal;
mod projected;
mod real;
mod saddle;
mod simd;
mod small;
mod substitution;
pub mod sums;
#[doc(hidden)]
pub mod symbolic;
mod threads;

pub use condensed::Condensed;
pub use cone::{Cone, Couplings, Kind};
pub use difference::jacobian_error;
pub use elimination::Elimination;
pub use independent::{Independent, Plane, SparseRow};
pub use linear::LinearError;
pub use mixing::Mixing;
pub use node_matrix::NodeMatrix;
pub use pattern::Pattern;
pub use precision::Precision;
pub use principal::{PrincipalAxes, principal, principal_axes};
pub use projected::{
    ConjugateGradients, ConstraintPreconditioner, ConstraintRows, DiagonalBlocks, Ended, Goal,
};
pub use real::{Four, Real};
pub use saddle::Saddle;
pub use simd::wide;
pub use small::{Mat, Vector};
pub use threads::Threads;
