//! Impact and contact of deformable solids by the positional finite element method.

pub mod case;
