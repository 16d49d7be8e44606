//! Surfaces, their parts and paths, one at a time.

mod apart;
mod folds;
mod mirror;
mod node_to_obstacle;
mod passed;
mod projection;
mod recent;
mod rounding;
mod space;
mod surface;
mod trajectory;
mod way;
