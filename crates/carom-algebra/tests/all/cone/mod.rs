//! Unilateral contact with Coulomb's law over a few rows, and the methods that solve it.

mod pivoting;
mod problems;
mod sweeps;
