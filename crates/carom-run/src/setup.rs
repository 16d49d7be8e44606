//! Builds the simulation of a case: the model with a stepper, on the grid of times.

use std::ops::Range;

use carom_algebra::LinearError;
use carom_case::{
    Case, ContactLaw, ContactPoint, ContactSpec, Fallback, ObstacleMotion, Overlap, Problem, Problems,
    TangentRule,
};
use carom_mechanics::model::Model;
use carom_mechanics::stability::{SAFETY, cell_step, stable_step};
use carom_mechanics::{
    Explicit, Grid, Implicit, Impulsive, InitialState, Linear, Rejected, Settings, Simulation, State,
    Stepper, Tangent,
};
use carom_solid::{Configuration, Constitutive};
use carom_time::{Integrator, Kernel, Nonsmooth};

use crate::build::{Materials, build, overlaps};
use crate::initial::{before, given, on_the_grid, saved};
use crate::overlap;
use crate::quantity::{at_most, quantity};
use crate::thread_count::ThreadCount;

/// A case on its way to a simulation: with how many threads, and with laws and a time integrator of
/// your own in place of the case's.
///
/// ```
/// # extern crate carom_run as carom;
/// use carom::{Setup, case::Case};
/// let case = Case::from_text(
///     r#"
///     title = "A bar stretched from its end"
///     dimension = 1
///     material = [{ name = "steel", law = "linear-elastic", density = 1, young = 900, poisson = 0 }]
///     support = [{ on = ["bar.left"], fix = ["x"] }]
///     load = [{ on = ["bar.right"], traction = [9] }]
///     [[body]]
///     name = "bar"
///     material = "steel"
///     element = "L2"
///     mesh = { shape = "interval", min = 0, max = 10, cells = 20 }
///     [time]
///     end = 0.1
///     step = 0.01
///     scheme = { kind = "newmark", rho_inf = 1 }
///     "#,
///     &["time.scheme={ kind = \"static\" }"],
/// )?;
/// let mut run = Setup::new(&case).threads(2).start()?;
/// while !run.finished() {
///     run.step()?;
/// }
/// // Strain 9/900 of a length of 10.
/// assert!((run.state().y[20] - 10.1).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Setup<'a> {
    case: &'a Case,
    threads: ThreadCount,
    materials: Materials,
    kernel: Option<Box<dyn Kernel>>,
}

impl<'a> Setup<'a> {
    /// The case as it is, on one thread.
    pub fn new(case: &'a Case) -> Self {
        Self { case, threads: 1.into(), materials: Materials::new(), kernel: None }
    }

    /// Computes with this many threads; results are bitwise identical for any number.
    #[must_use]
    pub fn threads(self, threads: impl Into<ThreadCount>) -> Self {
        Self { threads: threads.into(), ..self }
    }

    /// Gives the bodies of a material another law. Density, and what `carom check` derives from
    /// Lamé's constants, remain the case's.
    #[must_use]
    pub fn material(mut self, name: &str, law: impl Constitutive + 'static) -> Self {
        self.materials.insert(name.to_owned(), Box::new(law));
        self
    }

    /// Integrates with another implicit kernel than the case's scheme, which must be implicit, too.
    #[must_use]
    pub fn kernel(self, kernel: impl Kernel + 'static) -> Self {
        Self { kernel: Some(Box::new(kernel)), ..self }
    }

    /// Builds the model.
    ///
    /// # Errors
    /// Everything wrong with the case that only its meshes show, and laws for materials that it
    /// does not have.
    pub fn build(&self) -> Result<Model, Problems> {
        self.case.fits_memory().map_err(|problem| vec![problem])?;
        let known = |name: &String| self.case.materials.iter().any(|m| m.name == *name);
        if let Some(name) = self.materials.keys().find(|name| !known(name)) {
            let why = "a law was given for a material that the case does not have";
            let help = "give it the name of one of the [[material]] tables";
            return Err(vec![Problem::new("material", format!("no material \"{name}\""), why, help)].into());
        }
        if let Some(problem) = self.kernel.as_deref().and_then(|kernel| unfit(kernel, self.case)) {
            return Err(vec![problem].into());
        }
        let mut model = build(self.case, &self.materials)?;
        overlap::keep(self.case, &mut model);
        Ok(model)
    }

    /// Builds the model and its state at t = 0.
    ///
    /// # Errors
    /// As [`Setup::build`]; also where bodies overlap, an explicit step is longer than is stable,
    /// or the start has no forces or accelerations.
    pub fn start(self) -> Result<Simulation, Problems> {
        if let Some(state) = saved(self.case.initial.as_ref())? {
            on_the_grid(&state, &grid(self.case, 0.0))?;
            return self.resume(state);
        }
        let case = self.case;
        let model = self.build()?;
        let placed = case.initial.is_some() || case.manufactured.is_some();
        // A body whose cells are inverted has its outside within.
        if let Some(rejected) = inverted(case, &model).filter(|_| !placed) {
            return Err(vec![no_start(case, placed, &[], &rejected)].into());
        }
        let threads = self.threads.of(model.reference.len());
        let overlaps =
            if placed { Vec::new() } else { overlaps(case, &model, |overlap| overlap != Overlap::Relax) };
        let problems =
            [overlaps, too_long(case, &model, &Configuration::at(&model.initial_position))].concat();
        if !problems.is_empty() {
            return Err(problems.into());
        }
        let before: Option<InitialState> = match (&case.initial, &model.loads.manufactured) {
            (Some(initial), _) => Some(before(initial, case, &model)?),
            (None, Some(motion)) => Some(given(motion, &model)?),
            (None, None) => overlap::relaxed(case, &model, &self.materials, threads)?,
        };
        let fallback = fallback(case, &model, self.kernel.as_deref());
        let stepper = stepper(case, &model, self.kernel)?;
        let inertia = !case.time.scheme.is_static();
        let grid = grid(case, overlap::floor(case, &model));
        let obstacles: Vec<_> =
            model.parts[case.bodies.len()..].iter().map(|part| (part.nodes(), part.name.clone())).collect();
        let simulation = Simulation::new(model, stepper, grid, inertia, before, threads)
            .map_err(|rejected| vec![no_start(case, placed, &obstacles, &rejected)])?;
        // The start may be that of another run, or one without overlaps.
        let model = simulation.model();
        let state = simulation.state();
        let is_moved = state.y != model.initial_position;
        let problems = if is_moved { too_long(case, model, &state.configuration()) } else { Vec::new() };
        if problems.is_empty() { Ok(simulation.with_fallback(fallback)) } else { Err(problems.into()) }
    }

    /// Builds the model and continues from a state of an earlier run of the same case. The run that
    /// its `[initial]` names is not needed any more.
    ///
    /// # Errors
    /// As [`Setup::build`].
    pub fn resume(self, state: State) -> Result<Simulation, Problems> {
        let model = self.build()?;
        let fallback = fallback(self.case, &model, self.kernel.as_deref());
        let stepper = stepper(self.case, &model, self.kernel)?;
        let grid = grid(self.case, overlap::floor(self.case, &model));
        let threads = self.threads.of(model.reference.len());
        let resumed = Simulation::resume(model, stepper, grid, state, threads);
        resumed.map(|simulation| simulation.with_fallback(fallback)).map_err(|other| {
            let why = "a run is resumed from a state of the same case";
            vec![Problem::new("", other.to_string(), why, "give a state of this case")].into()
        })
    }
}

/// Why a kernel cannot replace the scheme of a case: the model is built for the contact laws of the
/// scheme.
fn unfit(kernel: &dyn Kernel, case: &Case) -> Option<Problem> {
    let scheme = &case.time.scheme;
    let another = "give the case an implicit scheme such as chung-hulbert";
    if scheme.is_static() || scheme.nonsmooth().is_some() {
        let what = format!("a kernel cannot replace the scheme {}", scheme.kind);
        return Some(Problem::new(
            "time.scheme",
            what,
            "a kernel is a list of implicit stages with inertia",
            another,
        ));
    }
    if scheme.conserves() && !case.contacts.is_empty() {
        let what = format!("a kernel cannot replace the scheme {} in contact", scheme.kind);
        let why =
            "its contact forces do no work over the velocities of the midpoint rule, and would with others";
        return Some(Problem::new("time.scheme", what, why, another));
    }
    let first = |wrong: &dyn Fn(&ContactSpec) -> bool| case.contacts.iter().find(|contact| wrong(contact));
    if !kernel.has_predictor()
        && let Some(contact) = first(&|contact| contact.law == Some(ContactLaw::Predictor))
    {
        let what = "this kernel has no predictor";
        let why = "law = \"predictor\" replaces y + Δt v in Newmark's formula";
        return Some(Problem::new(contact.path("law"), what, why, "leave `law` out"));
    }
    if kernel.stages() > 1
        && let Some(contact) = first(&|contact| contact.xi == ContactPoint::Frozen)
    {
        let what = format!("this kernel has {} stages", kernel.stages());
        let why = "xi = \"frozen\" keeps ξ during the single solve of a step";
        return Some(Problem::new(contact.path("xi"), what, why, "give xi = \"closest\""));
    }
    None
}

/// The grid of times of a case; `floor`: energy that counts as none.
pub(crate) fn grid(case: &Case, floor: f64) -> Grid {
    // Load steps create no energy: the difference between works and energies is the error of a sum
    // over few steps.
    let guard = case.time.energy_guard.filter(|_| !case.time.scheme.is_static());
    Grid { dt: case.time.step, steps: case.time.steps() as u64, phase: case.time.phase, guard, floor }
}

/// Whether the formulas of an initial position invert a cell.
fn inverted(case: &Case, model: &Model) -> Option<Rejected> {
    case.bodies.iter().find(|body| body.position.is_some())?;
    let mut force = vec![0.0; model.dofs()];
    let (body, inverted) = model
        .internal_force(
            &Configuration::at(&model.initial_position),
            &mut force,
            &mut carom_mechanics::Materials::default(),
        )
        .err()?;
    Some(Rejected::Inverted { body, inverted })
}

/// Why a case has no initial state, with its key and a suggestion; `obstacles`: nodes and names of
/// those that move.
fn no_start(case: &Case, placed: bool, obstacles: &[(Range<usize>, String)], rejected: &Rejected) -> Problem {
    if let Rejected::Jump { node, distance } = rejected
        && let Some((_, name)) = obstacles.iter().find(|(nodes, _)| nodes.contains(node))
        && let Some(contact) = case.contacts.iter().find(|contact| contact.name == *name)
    {
        let what = format!("the obstacle of contact \"{name}\" would jump at the start");
        let only_turns =
            matches!(&contact.motion, ObstacleMotion::Prescribed { moves, .. } if moves.is_empty());
        let help = "subtract from each formula its value at t = 0, and place the obstacle where it begins";
        if only_turns {
            let path = contact.path("primary.motion.rotate");
            return Problem::new(path, what, "its angle is not zero at t = 0", help);
        }
        let why = case.in_units(&format!("its motion is {distance:.3e} [length] at t = 0"));
        return Problem::new(contact.path("primary.motion"), what, why, help);
    }
    let (path, what, help) = match rejected {
        Rejected::NoValue(value) => {
            let table = if value.what.starts_with("mu ") { "contact" } else { "load" };
            (table.into(), "a formula has no value at t = 0", "change it so that it has one")
        }
        Rejected::Jump { .. } => {
            ("support".into(), "a support would jump at the start", "let its `move` begin where the body is")
        }
        Rejected::Inverted { body, .. } if !placed => {
            let k = case.bodies.iter().position(|b| b.name == *body).unwrap_or_default();
            let help =
                "change the formulas so that the determinant of their derivatives is positive everywhere";
            (format!("body[{k}].position"), "the initial position inverts a cell", help)
        }
        Rejected::Linear(LinearError::Memory { .. }) => {
            let is_lowest = case.bodies.iter().all(|body| body.element.degree() == 1);
            let lower = if is_lowest { "" } else { " or elements of lower degree" };
            let help = format!("use a coarser mesh{lower}, or give the process more memory");
            let what = "there is not enough memory for the linear system";
            return Problem::new("body", what, case.in_units(&rejected.to_string()), help).of_system();
        }
        _ => ("body".into(), "the initial acceleration cannot be computed", "check masses and supports"),
    };
    Problem::new(path, what, case.in_units(&rejected.to_string()), help)
}

/// The stepper of a case.
fn stepper(
    case: &Case,
    model: &Model,
    kernel: Option<Box<dyn Kernel>>,
) -> Result<Box<dyn Stepper>, Vec<Problem>> {
    let settings = settings(case, model);
    if let Some(kernel) = kernel {
        return Ok(Box::new(Implicit::new(kernel, settings)));
    }
    let integrator = case.time.scheme.integrator().map_err(|error| {
        let path = format!("time.scheme.{}", error.key());
        vec![Problem::new(
            path,
            "the scheme cannot be used",
            error.to_string(),
            "list the schemes with carom explain",
        )]
    })?;
    Ok(match integrator {
        Integrator::Alpha(scheme, _) => Box::new(Implicit::new(Box::new(scheme), settings)),
        Integrator::Stages(kernel, _) => Box::new(Implicit::new(kernel, settings)),
        Integrator::Nonsmooth(Nonsmooth::Impulse(scheme), _) => Box::new(Impulsive::new(scheme, settings)),
        Integrator::Nonsmooth(Nonsmooth::Explicit(_), _) => Box::new(Explicit::new(model)),
    })
}

/// The stepper for steps that the stepper of a case cannot take; `kernel`: in place of its scheme.
fn fallback(case: &Case, model: &Model, kernel: Option<&dyn Kernel>) -> Option<Box<dyn Stepper>> {
    if case.time.fallback == Fallback::None {
        return None;
    }
    let of_scheme = case.time.scheme.kernel();
    let carried = kernel.or(of_scheme.as_deref()).map_or(0.0, Kernel::carried);
    Some(Box::new(Implicit::in_velocity(carried, settings(case, model))))
}

fn settings(case: &Case, model: &Model) -> Settings {
    let newton = &case.newton;
    let iterates =
        newton.linear.iterates(model.dimension, model.free.len() as f64, &case.time, case.contacts.iter());
    let tangent = match newton.tangent {
        TangentRule::Frozen => Tangent::Frozen,
        TangentRule::FrozenDouble => Tangent::FrozenDouble,
        TangentRule::Full => Tangent::Full,
    };
    Settings {
        tolerance: newton.tolerance,
        max_iterations: newton.max_iterations,
        tangent,
        linear: if iterates { Linear::Iterative } else { Linear::Direct },
        mixing: newton.mixing,
    }
}

/// The problem of a step longer than the stable one of an explicit scheme at a configuration.
fn too_long(case: &Case, model: &Model, at: &Configuration) -> Vec<Problem> {
    if !case.time.scheme.is_explicit() {
        return Vec::new();
    }
    let step = case.time.step;
    // The limit by power iteration is never shorter.
    if cell_step(model, at).is_some_and(|cell| step <= SAFETY * cell) {
        return Vec::new();
    }
    let Some(stable) = stable_step(model, at) else {
        let why = "a cell is inverted at the start, or a free node has no mass";
        return vec![Problem::new(
            "time.scheme",
            "the stable step cannot be computed",
            why,
            "check meshes and densities",
        )];
    };
    let longest = SAFETY * stable.power;
    if step <= longest {
        return Vec::new();
    }
    let unit = &case.units.time;
    let what = format!(
        "the step of {step} {unit} is too long for {}: at most {} is accepted",
        case.time.scheme.kind,
        at_most(longest, unit)
    );
    let why = format!(
        "the step of an explicit scheme must be less than 2/ω_max = {} (estimate from single cells: {}); at most {SAFETY} of it is accepted",
        quantity(stable.power, unit),
        quantity(stable.cell, unit)
    );
    let divided = case.time.end / (case.time.end / longest).ceil();
    vec![Problem::new(
        "time.step",
        what,
        why,
        format!(
            "use step = {divided:.6e}, which divides the end time, or an implicit scheme, which has no such limit"
        ),
    )]
}
