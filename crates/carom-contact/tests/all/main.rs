//! Contact through its interface, in one binary, so that it is linked once.

#![allow(clippy::unwrap_used)]

mod derivatives;
mod discrete_gradient;
mod edges;
mod inf_sup;
mod joints;
mod kinks;
mod mortar;
mod near_obstacle;
mod obstacles;
mod obstacles_in_space;
mod slip;
mod slip_in_space;
mod space;
mod tips;
mod update_facets;
