//! The table of schemes. A scheme is a file of this folder and its name in the list below: formula,
//! parameters, members with their published properties.

use crate::kind::KindInfo;

/// Declares the files and the table, in the order of `explain` and the schema.
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
