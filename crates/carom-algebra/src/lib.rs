//! Linear algebra of Carom: small tensors, sparse symmetric systems, finite-difference checks.

mod complementarity;
mod condensed;
mod coulomb;
mod coulomb_exact;
mod difference;
mod elimination;
mod forest;
mod front;
mod linear;
mod node_matrix;
mod pattern;
mod pivots;
mod precision;
mod projected;
mod saddle;
mod simd;
mod small;
mod substitution;
mod symbolic;
mod threads;

pub use complementarity::{complementarity, proximal};
pub use condensed::Condensed;
pub use coulomb::coulomb;
pub use coulomb_exact::Kind;
pub use difference::jacobian_error;
pub use elimination::Elimination;
pub use linear::LinearError;
pub use node_matrix::NodeMatrix;
pub use pattern::Pattern;
pub use precision::Precision;
pub use projected::{ConjugateGradients, ConstraintRows, DiagonalBlocks, Ended};
pub use saddle::Saddle;
pub use simd::wide;
pub use small::{Mat, Vector};
pub use threads::Threads;
