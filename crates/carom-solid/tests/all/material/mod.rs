//! Parts of the laws of materials.

mod hardening;
mod kinematics;
