//! Counted cost of a run: how often each kernel was called, times its weight. Counts are the same
//! on every machine and for any number of threads, so that whatever is decided by cost is too.
//!
//! The unit is one evaluation of the internal forces of all elements. A weight is the median, over
//! runs of laws, elements and dimensions, of the processor time per call in that unit, rounded.

use std::collections::BTreeMap;

use crate::facts::Stepping;

/// A kernel whose calls a run counts.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    /// Name of the counter in the manifest of a run.
    pub counter: &'static str,
    /// Cost of a call in an implicit scheme, in evaluations of the internal forces.
    pub implicit: f64,
    /// Cost of a call in the energy–momentum scheme.
    pub energy_momentum: f64,
    /// Cost of a call in an explicit scheme.
    pub explicit: f64,
    /// Work that a call stands for.
    pub reason: &'static str,
}

/// The kernels with their weights, for all schemes.
pub const KERNELS: [Kernel; 4] = [
    Kernel {
        counter: "steps",
        implicit: 5.0,
        energy_momentum: 5.0,
        explicit: 1.5,
        reason: "search for contact, energy balance and state of a step; of an explicit one the forces too",
    },
    Kernel {
        counter: "newton",
        implicit: 2.0,
        energy_momentum: 5.0,
        explicit: 0.0,
        reason: "internal and contact forces, and a solution with a factorised matrix; each stage of a composite \
                 scheme and each rejected step counts its own; a discrete gradient evaluates the law at four strains",
    },
    Kernel {
        counter: "factorisations",
        implicit: 10.0,
        energy_momentum: 10.0,
        explicit: 10.0,
        reason: "tangent of all elements and its factorisation; more on large meshes in space",
    },
    Kernel {
        counter: "linear_iterations",
        implicit: 1.0,
        energy_momentum: 1.0,
        explicit: 1.0,
        reason: "product with the tangent and the preconditioner, where systems are solved iteratively",
    },
];

/// Counted cost from the counters of a run; none if it counted nothing.
pub fn cost(counters: &BTreeMap<String, u64>, stepping: Stepping) -> Option<f64> {
    let calls = |kernel: &Kernel| {
        let weight = match stepping {
            Stepping::Implicit => kernel.implicit,
            Stepping::EnergyMomentum => kernel.energy_momentum,
            Stepping::Explicit => kernel.explicit,
        };
        counters.get(kernel.counter).map(|calls| weight * *calls as f64)
    };
    let costs: Vec<f64> = KERNELS.iter().filter_map(calls).collect();
    (!costs.is_empty()).then(|| costs.iter().sum())
}
