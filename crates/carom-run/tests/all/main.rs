//! The stepper in whole runs, in one binary, so that common helpers are written and linked once.

#![allow(clippy::unwrap_used)]

mod audit;
mod augmented;
mod bar;
mod common;
mod conserving_contact;
mod edges;
mod energy_momentum;
mod explicit_energy;
mod faces;
mod fallback;
mod fields;
mod frequencies;
mod friction;
mod friction_springs;
mod impact;
mod kernels;
mod ledger;
mod linear;
mod loads;
mod meeting;
mod memory;
mod momentum;
mod nonsmooth;
mod obstacles;
mod overlap;
mod own;
mod placed;
mod prisms;
mod probe;
mod restart;
mod reversal;
mod self_contact;
mod self_contact_space;
mod slabs;
mod space;
mod space_contact;
mod space_friction;
mod space_friction_springs;
mod space_obstacles;
mod statics;
mod substeps;
mod tangent;
mod undeclared;
mod warnings;
