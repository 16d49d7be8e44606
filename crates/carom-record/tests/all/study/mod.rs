//! Tables of studies as functions of the records.

mod arm;
mod claim;
mod compared;
mod convergence;
mod ensemble;
mod groups;
mod latex;
mod measure;
mod orders;
mod ranking;
mod reference;
mod roles;
