//! Counted cost of a run: how often each kernel was called, times its weight. Counts are the same
//! on every machine and for any number of threads, so that whatever is decided by cost is too.
//!
//! The unit is one evaluation of the internal forces of all elements. A weight is the median, over
//! the runs of the verification suite, of the processor time per call in that unit, rounded.

use std::collections::BTreeMap;

/// A kernel whose calls a run counts.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    /// Name of the counter in the manifest of a run.
    pub counter: &'static str,
    /// Cost of a call, in evaluations of the internal forces.
    pub weight: f64,
    /// Work that a call stands for.
    pub reason: &'static str,
}

/// The kernels with their weights, for all schemes.
pub const KERNELS: [Kernel; 4] = [
    Kernel {
        counter: "steps",
        weight: 5.0,
        reason: "search for contact, energy balance and state of a step, also of an explicit one (4 to 7)",
    },
    Kernel {
        counter: "newton",
        weight: 2.0,
        reason: "internal and contact forces, and a solution with a factorised matrix; each stage of a composite \
                 scheme and each rejected step counts its own (1.7 to 2.2)",
    },
    Kernel {
        counter: "factorisations",
        weight: 10.0,
        reason: "tangent of all elements and its factorisation (6 to 16; more on large meshes in space)",
    },
    Kernel {
        counter: "linear_iterations",
        weight: 1.0,
        reason: "product with the tangent and the preconditioner, where systems are solved iteratively",
    },
];

/// Counted cost from the counters of a run; none if it counted nothing.
pub fn cost(counters: &BTreeMap<String, u64>) -> Option<f64> {
    let calls = |kernel: &Kernel| counters.get(kernel.counter).map(|calls| kernel.weight * *calls as f64);
    let costs: Vec<f64> = KERNELS.iter().filter_map(calls).collect();
    (!costs.is_empty()).then(|| costs.iter().sum())
}
