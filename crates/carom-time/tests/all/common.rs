//! Helpers of the tests of all kernels.

use carom_time::{ForceRule, Integrator, KINDS, Kernel, Member, Name, Nonsmooth, Oscillator, Stage};

/// Members with their kernels; those of the α family under both rules.
pub(crate) fn all() -> Vec<(&'static Member, String, Box<dyn Kernel>)> {
    let mut all = Vec::new();
    for kind in KINDS {
        for member in kind.members {
            let name = kind.named(member);
            for forces in [ForceRule::AverageForces, ForceRule::AverageState] {
                let kernel: Box<dyn Kernel> = match (Name { forces, ..name.clone() }).integrator().unwrap() {
                    Integrator::Nonsmooth(Nonsmooth::Impulse(scheme), _) => scheme,
                    Integrator::Nonsmooth(Nonsmooth::Explicit(_), _) => continue,
                    other => other.into_kernel().unwrap(),
                };
                if forces == ForceRule::AverageForces || kind.is_alpha() {
                    all.push((member, format!("{name} {forces:?}"), kernel));
                }
            }
        }
    }
    all
}

/// One run of a kernel: (u, v) after `steps`.
pub(crate) fn run(
    kernel: &dyn Kernel,
    oscillator: Oscillator,
    dt: f64,
    steps: u32,
    u: f64,
    v: f64,
) -> Vec<[f64; 3]> {
    let (mut motion, mut before, mut stage) = (oscillator.start(u, v), None, Stage::default());
    let mut path = vec![motion];
    for _ in 0..steps {
        let next = oscillator.step_after(kernel, dt, before, motion, &mut stage);
        before = kernel.two_step().then_some([next[0] - motion[0], motion[1]]);
        motion = next;
        path.push(motion);
    }
    path
}
