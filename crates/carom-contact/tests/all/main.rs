//! Contact through its interface, in one binary, so that it is linked once.

#![allow(clippy::unwrap_used)]

mod active_set;
mod constants;
mod derivatives;
mod discrete_gradient;
mod edge_points;
mod edges;
mod friction;
mod inf_sup;
mod inside_itself;
mod interface;
mod joints;
mod kinematics;
mod kinks;
mod mortar;
mod near_obstacle;
mod obstacles;
mod obstacles_in_space;
mod rows;
mod skin;
mod slip;
mod slip_in_space;
mod space;
mod swept;
mod swept_edges;
mod swept_patches;
mod tips;
mod update_facets;
