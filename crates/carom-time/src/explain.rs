//! The output of `carom explain` for a scheme: its parameters in every convention, its accuracy,
//! and its behaviour in contact.
use std::f64::consts::TAU;

use serde::Serialize;

use crate::analysis::Principal;
use crate::catalogue::info;
use crate::map;
use crate::name::{Name, short};
use crate::names::{Elsewhere, elsewhere, names};
use crate::oscillator::Oscillator;
use crate::scheme::{ForceRule, Scheme};
use crate::stage::{Kernel, Stage};

/// A root below this counts as zero, and one this close to 1 as one.
const NOTHING: f64 = 1e-9;

/// The scheme under one convention for its parameters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Convention {
    /// Source of the convention.
    pub name: &'static str,
    /// Symbols and values.
    pub values: Vec<(&'static str, f64)>,
}

/// Accuracy at one resolution of a period.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Accuracy {
    /// T/Δt.
    pub steps_per_period: u32,
    /// Largest modulus of all roots.
    pub spectral_radius: f64,
    /// ξ of the oscillating pair; none if nothing oscillates.
    pub damping_ratio: Option<f64>,
    /// PE of the oscillating pair.
    pub period_error: Option<f64>,
    /// Error of the phase velocity of a wave, relative to c, in a bar of linear elements with as
    /// many elements per wavelength as steps per period, so that c Δt = h. Masses are lumped with
    /// explicit schemes, and consistent with the others.
    pub dispersion: Option<f64>,
}

/// Largest values in the first steps of a stiff mode that is released from rest, Ω = 10: they are 1
/// in the exact motion (H. M. Hilber and T. J. R. Hughes 1978).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Overshoot {
    /// Largest |u|/u₀.
    pub displacement: f64,
    /// Largest |v|/(ω u₀).
    pub velocity: f64,
}

/// Velocity and acceleration of a dof whose position is constrained by contact.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Constrained {
    /// Largest modulus of the roots that govern it.
    pub radius: f64,
    /// Steps until the transient is below 1 % of v₀/Δt; none if it does not decay.
    pub steps: Option<u32>,
    /// In words.
    pub text: String,
}

/// Everything known of a scheme.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// The four parameters and the force rule, for a member of the α family.
    pub scheme: Option<Scheme>,
    /// Ways to request it.
    pub names: Vec<Name>,
    /// Publications.
    pub references: Vec<&'static str>,
    /// Parameters in every convention.
    pub conventions: Vec<Convention>,
    /// Order on smooth motion.
    pub order: u8,
    /// Whether it is stable for any step on linear motion.
    pub a_stable: bool,
    /// Spectral radius at infinity.
    pub rho_inf: f64,
    /// At 5, 10, 20, 50 and 100 steps per period.
    pub accuracy: Vec<Accuracy>,
    /// Overshoot of a stiff mode.
    pub overshoot: Overshoot,
    /// What is conserved and what is not.
    pub conserves: Vec<&'static str>,
    /// Behaviour in contact.
    pub constrained: Constrained,
    /// Further properties of its parameters.
    pub remarks: Vec<String>,
    /// Names in other codes.
    pub elsewhere: Vec<Elsewhere>,
}

/// Explains a scheme.
///
/// ```
/// let hulbert = carom_time::explain(&carom_time::Scheme::chung_hulbert(0.1)?);
/// assert_eq!((hulbert.order, hulbert.constrained.steps), (2, Some(6)));
/// assert!(hulbert.to_string().contains("chung-hulbert"));
/// # Ok::<(), carom_time::SchemeError>(())
/// ```
pub fn explain(scheme: &Scheme) -> Explanation {
    explained(scheme, names(scheme))
}

/// The same for a scheme requested by this name.
pub(crate) fn explain_alpha(scheme: &Scheme, requested: &Name) -> Explanation {
    let mut names = names(scheme);
    if names.iter().all(|name| name.kind != requested.kind) {
        names.insert(0, requested.clone());
    }
    explained(scheme, names)
}

fn explained(scheme: &Scheme, names: Vec<Name>) -> Explanation {
    let mut references: Vec<_> = names.iter().filter_map(|name| Some(info(name.kind)?.reference)).collect();
    references.dedup();
    // The raw parameters are another way to state it, not another source.
    if references.len() > 1 {
        references.pop();
    }
    Explanation {
        conventions: conventions(scheme, &names),
        order: scheme.order(),
        a_stable: scheme.is_a_stable(),
        rho_inf: scheme.spectral_radius_at_infinity(),
        accuracy: [5, 10, 20, 50, 100].map(|steps| accuracy(scheme, steps)).into(),
        overshoot: overshoot(scheme),
        conserves: conserves(scheme),
        constrained: constrained(scheme),
        remarks: scheme.remarks(),
        elsewhere: elsewhere(scheme, &names),
        scheme: Some(*scheme),
        names,
        references,
    }
}

/// Explains any other kernel from its numeric map.
pub(crate) fn explain_kernel(kernel: &dyn Kernel, name: &Name) -> Explanation {
    let rho_inf = map::spectral_radius_at_infinity(kernel);
    let sweep = || (-20..40).map(|k| map::spectral_radius(kernel, 1.3_f64.powi(k)));
    let lossless = sweep().all(|rho| (rho - 1.0).abs() < 1e-6);
    let energy = if lossless {
        "energy: no mode of linear motion is damped"
    } else {
        "energy: dissipated, most strongly at high frequencies (damping ratio above)"
    };
    Explanation {
        scheme: None,
        names: vec![name.clone()],
        references: info(name.kind).map(|info| info.reference).into_iter().collect(),
        conventions: vec![Convention {
            name: "spectral radius at infinite frequency",
            values: vec![("ρ∞", rho_inf)],
        }],
        order: map::order(kernel),
        a_stable: sweep().all(|rho| rho <= 1.0 + 1e-7),
        rho_inf,
        accuracy: [5, 10, 20, 50, 100].map(|steps| accuracy_of(kernel, steps)).into(),
        overshoot: overshoot(kernel),
        conserves: vec!["momentum: conserved exactly", energy],
        constrained: constrained_of(kernel),
        remarks: kernel.notes().iter().map(ToString::to_string).collect(),
        elsewhere: Vec::new(),
    }
}

pub(crate) fn accuracy_of(kernel: &dyn Kernel, steps_per_period: u32) -> Accuracy {
    let omega_dt = TAU / f64::from(steps_per_period);
    let pair = map::principal(kernel, omega_dt);
    Accuracy {
        steps_per_period,
        spectral_radius: map::spectral_radius(kernel, omega_dt),
        damping_ratio: pair.map(|pair| pair.damping_ratio),
        period_error: pair.map(|pair| pair.period_error),
        dispersion: dispersion(steps_per_period, |omega_dt| map::principal(kernel, omega_dt)),
    }
}

/// Error of the phase velocity of a wave with n linear elements of consistent mass per wavelength,
/// at c Δt = h: k h = ω Δt = 2π/n in the exact motion.
fn dispersion(n: u32, principal: impl Fn(f64) -> Option<Principal>) -> Option<f64> {
    let exact = TAU / f64::from(n);
    let semi_discrete = with_consistent_mass(exact);
    let angle = semi_discrete / (1.0 + principal(semi_discrete)?.period_error);
    Some(angle / exact - 1.0)
}

/// ωΔt of linear elements with consistent mass for a wave whose exact one is given, at c Δt = h.
pub(crate) fn with_consistent_mass(exact: f64) -> f64 {
    2.0 * (exact / 2.0).sin() * (3.0 / (2.0 + exact.cos())).sqrt()
}

/// Steps in which overshoot is looked for, and Ω of its mode.
const RELEASED: u32 = 10;
const STIFF: f64 = 10.0;

fn overshoot(kernel: &dyn Kernel) -> Overshoot {
    let oscillator = Oscillator { mass: 1.0, stiffness: STIFF * STIFF, force: 0.0 };
    let mut motion = oscillator.start(1.0, 0.0);
    let mut before = None;
    let mut most = Overshoot { displacement: 1.0, velocity: 0.0 };
    for _ in 0..RELEASED {
        let next = oscillator.step_after(kernel, 1.0, before, motion, &mut Stage::default());
        before = kernel.two_step().then_some([next[0] - motion[0], motion[1]]);
        most.displacement = most.displacement.max(next[0].abs());
        most.velocity = most.velocity.max(next[1].abs() / STIFF);
        motion = next;
    }
    most
}

/// The behaviour of a constrained dof, by the map with its position constrained: v₀ = 1 at the
/// start, Δt = 1, λ = −m a.
pub(crate) fn constrained_of(kernel: &dyn Kernel) -> Constrained {
    let radius = map::spectral_radius_at_infinity(kernel);
    if radius >= 1.0 - NOTHING {
        let text = "its velocity and acceleration keep oscillating: use persistency = \"project\", law = \"predictor\" or a penalty";
        return Constrained { radius, steps: None, text: text.to_owned() };
    }
    let share = if radius < NOTHING { NOTHING } else { 0.01 };
    let free = Oscillator { mass: 1.0, stiffness: 0.0, force: 0.0 };
    let (mut motion, mut before, mut last) = ([0.0, 1.0, 0.0], None, 0);
    for n in 1..=10_000 {
        let next = free.constrained_step_after(kernel, 1.0, before, motion, &mut Stage::default(), 0.0);
        before = kernel.two_step().then_some([next[0] - motion[0], motion[1]]);
        if next[2].abs() >= share {
            last = n;
        }
        motion = next;
    }
    let steps = last + 1;
    let text = if radius < NOTHING {
        format!("the transient of its acceleration and contact force ends after {steps} steps")
    } else {
        format!(
            "after an impact at speed v₀, its acceleration and contact force decrease by a factor of {radius:.3} per step, \
             to below 1 % of v₀/Δt after {steps} steps"
        )
    };
    Constrained { radius, steps: Some(steps), text }
}

pub(crate) fn accuracy(scheme: &Scheme, steps_per_period: u32) -> Accuracy {
    let omega_dt = TAU / f64::from(steps_per_period);
    let pair = scheme.principal(omega_dt);
    Accuracy {
        steps_per_period,
        spectral_radius: scheme.spectral_radius(omega_dt),
        damping_ratio: pair.map(|pair| pair.damping_ratio),
        period_error: pair.map(|pair| pair.period_error),
        dispersion: dispersion(steps_per_period, |omega_dt| scheme.principal(omega_dt)),
    }
}

fn conventions(scheme: &Scheme, names: &[Name]) -> Vec<Convention> {
    let Scheme { alpha_m, alpha_f, beta, gamma, .. } = *scheme;
    let is = |kind: &str| names.iter().any(|name| name.kind == kind);
    let mut list = vec![
        Convention {
            name: "index n + 1 − α: weights of the terms at the start of the step (Carom, Chung and Hulbert)",
            values: vec![("α_m", alpha_m), ("α_f", alpha_f), ("β", beta), ("γ", gamma)],
        },
        Convention {
            name: "index n + α: weights of the terms at the end of the step",
            values: vec![("α_m", 1.0 - alpha_m), ("α_f", 1.0 - alpha_f), ("β", beta), ("γ", gamma)],
        },
    ];
    if is("hht") {
        list.push(Convention {
            name: "notation of Hilber, Hughes and Taylor",
            values: vec![("α", 0.0 - alpha_f)],
        });
    }
    if is("wbz") {
        list.push(Convention {
            name: "notation of Wood, Bossak and Zienkiewicz",
            values: vec![("α_B = α_m", alpha_m)],
        });
    }
    list.push(Convention {
        name: "spectral radius at infinite frequency",
        values: vec![("ρ∞", scheme.spectral_radius_at_infinity())],
    });
    list
}

fn conserves(scheme: &Scheme) -> Vec<&'static str> {
    let mut list = vec!["momentum: conserved exactly"];
    let lossless = scheme.order() == 2 && scheme.rho_is_one_everywhere();
    let midpoint = lossless
        && scheme.alpha_m == 0.5
        && scheme.alpha_f == 0.5
        && scheme.forces == ForceRule::AverageState;
    list.push(if midpoint {
        "angular momentum: conserved exactly, except in contact (this is the midpoint rule)"
    } else {
        "angular momentum: conserved to the order of the scheme"
    });
    list.push(if lossless {
        "energy: no mode of linear motion is damped; not conserved exactly with nonlinear forces or contact"
    } else {
        "energy: dissipated, most strongly at high frequencies (damping ratio above)"
    });
    if !scheme.is_a_stable() {
        list.pop();
        list.push("energy: may grow, because the scheme is not unconditionally stable");
    }
    list
}

/// The map of a constrained dof in words (theory: a constrained dof sees the limit Ω → ∞ for any
/// step).
pub(crate) fn constrained(scheme: &Scheme) -> Constrained {
    let roots = scheme.constrained_roots();
    let multiplier = (scheme.alpha_f / (1.0 - scheme.alpha_f)).abs();
    let own = roots[0].modulus().max(roots[1].modulus());
    let radius = own.max(multiplier);
    // Two equal roots give n ρⁿ; with the multiplier's root equal too, n² ρⁿ.
    let double = (roots[0].re - roots[1].re).hypot(roots[0].im - roots[1].im) < NOTHING;
    let power = usize::from(double) + usize::from((multiplier - own).abs() < NOTHING);
    let (steps, text) = if radius < NOTHING {
        let steps = ringing(scheme, NOTHING);
        (Some(steps), format!("the transient of its acceleration and contact force ends after {steps} steps"))
    } else if radius < 1.0 - NOTHING {
        let steps = ringing(scheme, 0.01);
        let text = format!(
            "after an impact at speed v₀, its acceleration, and its contact force divided by its mass, oscillate like \
             {}({})ⁿ v₀/Δt after n steps and fall below 1 % of v₀/Δt after {steps} steps; with a smaller Δt the transient lasts the \
             same number of steps, thus less time, and its amplitude is larger",
            ["", "n ", "n² "][power],
            short(-radius)
        );
        (Some(steps), text)
    } else if (scheme.beta - 0.25).abs() < NOTHING && (scheme.gamma - 0.5).abs() < NOTHING {
        let text = "its velocity changes sign at every step indefinitely, and its acceleration grows by 4 v₀/Δt per step: use \
                    persistency = \"project\"";
        (None, text.to_owned())
    } else {
        (
            None,
            format!(
                "its velocity and acceleration keep oscillating (largest root {radius:.3} in modulus): use persistency = \"project\""
            ),
        )
    };
    Constrained { radius, steps, text }
}

/// Steps until |Δt a| and |Δt λ/m| of a mass stopped at v₀ remain below `share` of v₀. Eq. (15)
/// gives λ with the constraint active from the step's start.
fn ringing(scheme: &Scheme, share: f64) -> u32 {
    let [[vv, va], [av, aa]] = scheme.constrained_map();
    let Scheme { alpha_m, alpha_f, .. } = *scheme;
    let (mut v, mut a, mut force) = (1.0, 0.0, 0.0f64);
    let mut last = 0;
    for n in 1..=100_000 {
        let new = av * v + aa * a;
        force = -((1.0 - alpha_m) * new + alpha_m * a + alpha_f * force) / (1.0 - alpha_f);
        (v, a) = (vv * v + va * a, new);
        if new.abs().max(force.abs()) >= share {
            last = n;
        }
    }
    last + 1
}

impl Scheme {
    fn rho_is_one_everywhere(&self) -> bool {
        [0.1, 1.0, 3.0, 30.0].iter().all(|&omega_dt| (self.spectral_radius(omega_dt) - 1.0).abs() < 1e-6)
            && self.principal(0.1).is_some_and(|pair| pair.damping_ratio.abs() < NOTHING)
    }

    /// Further consequences of the parameters: loss of order, instability, overshoot, a useless α.
    ///
    /// ```
    /// assert!(carom_time::Scheme::hht(0.4)?.remarks().iter().any(|remark| remark.contains("ρ∞ rises")));
    /// # Ok::<(), carom_time::SchemeError>(())
    /// ```
    pub fn remarks(&self) -> Vec<String> {
        let Self { alpha_m, alpha_f, gamma, .. } = *self;
        let mut list = Vec::new();
        if self.order() == 0 {
            list.push(format!(
                "α_m = {alpha_m} > ½: errors of the acceleration grow from step to step, and the scheme does not converge"
            ));
        } else if self.order() == 1 {
            let needed = 0.5 - alpha_m + alpha_f;
            list.push(format!(
                "first order: second order requires γ = ½ − α_m + α_f = {}, not {}",
                short(needed),
                short(gamma)
            ));
        }
        if *self == (Self { forces: self.forces, ..Self::hu() }) {
            list.push(
                "γ and β are those of Chung and Hulbert at ρ∞ = 0; α_m = −1 would make it second order"
                    .to_owned(),
            );
        }
        if !self.is_a_stable() {
            list.push("not unconditionally stable: modes with some values of Ω = ωΔt grow".to_owned());
        }
        let constrained = self.constrained_roots().iter().map(|root| root.modulus()).fold(0.0, f64::max);
        let averaged = alpha_f / (1.0 - alpha_f);
        if averaged > constrained + NOTHING {
            list.push(format!(
                "α_f/(1 − α_f) = {averaged:.3} exceeds the other roots at infinite frequency ({constrained:.3}): ρ∞ rises again with α_f"
            ));
        }
        let overshoot = self.velocity_overshoot();
        if overshoot > NOTHING {
            list.push(format!("overshoot: after one step, a stiff mode of frequency ω released from rest at displacement u₀ has the velocity {overshoot:.3} Ω ω u₀, with Ω = ωΔt ≫ 1; its displacement remains bounded"));
        }
        if self.forces == ForceRule::AverageState && alpha_f != 0.0 {
            list.push("averaging the state differs from averaging the forces where forces are nonlinear; the linear analysis above is the same for both".to_owned());
        }
        list
    }
}
