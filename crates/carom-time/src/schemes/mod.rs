//! The table of schemes. A scheme is a file of this folder and its name in the list below: formula, parameters, members with what is published of them.

use std::ops::Bound::{Excluded, Included, Unbounded};

use crate::kind::{KindInfo, Parameter};

/// Declares the files and, in the order of `explain` and the schema, the table.
macro_rules! schemes {
    ($($file:ident),+ $(,)?) => {
        $(pub mod $file;)+

        /// All kinds.
        pub const KINDS: &[KindInfo] = &[$($file::KIND),+];
    };
}

schemes! {
    newmark,
    hu,
    hht,
    wbz,
    chung_hulbert,
    generalized_alpha,
    backward_euler,
    bdf2,
    tr_bdf2,
    bathe,
    energy_momentum,
    central_difference,
    paoli_schatzman,
    moreau_jean,
    nonsmooth_generalized_alpha,
    statics,
}

/// ρ∞, the parameter of most.
const RHO_INF: Parameter = Parameter {
    key: "rho_inf",
    range: (Included(0.0), Included(1.0)),
    meaning: "Spectral radius at infinite frequency: 0 damps it within steps, 1 not at all.",
    example: "0.8",
};
const BETA: Parameter =
    Parameter { key: "beta", range: (Excluded(0.0), Unbounded), meaning: "Newmark's β.", example: "0.25" };
const GAMMA: Parameter =
    Parameter { key: "gamma", range: (Excluded(0.0), Unbounded), meaning: "Newmark's γ.", example: "0.5" };
