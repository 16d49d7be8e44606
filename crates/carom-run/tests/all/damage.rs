//! Runs with a law that remembers: isotropic damage, Ψ = (1 − d) Ψ₀ with κ = max Ψ₀ so far and
//! d = 1 − exp(−(κ − κ₀)/c) for κ > κ₀, of linear elasticity.

use carom_algebra::{Mat, Vector};
use carom_run::{GridReport, Setup, Simulation};
use carom_solid::Past;
use carom_solid::material::{LinearElastic, Material, NotPositive, Thickness};

use super::common::{case, finish};

const THRESHOLD: f64 = 0.005;
const SCALE: f64 = 0.02;

/// E = 1 in dimension 1.
#[derive(Clone, Copy)]
struct Damage(LinearElastic);

const DAMAGE: Damage = Damage(LinearElastic { lambda: 0.0, mu: 0.5 });

fn intact(history: f64) -> f64 {
    (-(history - THRESHOLD).max(0.0) / SCALE).exp()
}

/// ∫ κ dd up to a κ.
fn lost(history: f64) -> f64 {
    if history > THRESHOLD { THRESHOLD + SCALE - (history + SCALE) * intact(history) } else { 0.0 }
}

struct Damaged<P> {
    of: P,
    energy: f64,
    history: [f64; 2],
}

impl<const D: usize> Material<D> for Damage {
    const ENERGY_DEGREE: usize = 2;
    const OBJECTIVE: bool = false;
    const MEMORY: usize = 1;
    type Point = Damaged<<LinearElastic as Material<D>>::Point>;

    fn after(&self, h: &Mat<D>, past: &Past) -> Result<Self::Point, NotPositive> {
        let of = self.0.at(h)?;
        let energy = Material::<D>::energy(&self.0, &of);
        let start = past.memory[0];
        Ok(Damaged { of, energy, history: [start, start.max(energy)] })
    }

    fn remember(&self, point: &Self::Point, memory: &mut [f64]) {
        memory[0] = point.history[1];
    }

    fn dissipated(&self, point: &Self::Point) -> f64 {
        lost(point.history[1]) - lost(point.history[0])
    }

    fn energy(&self, point: &Self::Point) -> f64 {
        intact(point.history[1]) * point.energy
    }

    fn stress(&self, point: &Self::Point) -> Mat<D> {
        self.0.stress(&point.of) * intact(point.history[1])
    }

    fn tangent(&self, point: &Self::Point, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        let intact = intact(point.history[1]);
        let elastic = self.0.tangent(&point.of, a, b) * intact;
        if point.history[1] > point.history[0].max(THRESHOLD) {
            let stress: Mat<D> = self.0.stress(&point.of);
            return elastic - stress.apply(a).outer(&stress.apply(b)) * (intact / SCALE);
        }
        elastic
    }

    fn lateral(&self, point: &Self::Point) -> f64 {
        Material::<D>::lateral(&self.0, &point.of) * intact(point.history[1])
    }
}

impl Thickness for Damage {}

/// A bar of length 1 with E = ρ = A = 1, fixed at its left end.
fn bar(mass: &str, rest: &str) -> String {
    format!(
        r#"
dimension = 1
material = [{{ name = "unit", law = "linear-elastic", density = 1.0, young = 1.0, poisson = 0.0 }}]
[[body]]
name = "bar"
material = "unit"
element = "L2"
mass = "{mass}"
mesh = {{ shape = "interval", min = 0.0, max = 1.0, cells = 6 }}
[[support]]
on = ["bar.left"]
fix = ["x"]
[[probe]]
name = "A"
body = "bar"
at = [0.4]
record = ["sigma_xx"]
{rest}"#
    )
}

fn start(text: &str) -> Simulation {
    Setup::new(&case(text, &[""; 0])).material("unit", DAMAGE).start().unwrap()
}

/// Load steps of a bar whose end moves to and fro: σ = (1 − d) ε. The energy that the ledger says
/// to be dissipated is ∫ κ dd, up to the error of the mean of the forces at both ends of a step.
#[test]
fn load_steps_have_the_exact_stress() {
    let text = bar(
        "consistent",
        "[[support]]\non = [\"bar.right\"]\nmove = { x = \"0.3*sin(5*t)\" }\n[time]\nend = 2.0\nstep = 0.005\nscheme = { kind = \"static\" }\nenergy_guard = false\n",
    );
    let mut run = start(&text);
    let mut largest = 0.0_f64;
    let mut before = 0.0;
    while !run.finished() {
        run.advance(&mut GridReport::default()).unwrap();
        let strain = 0.3 * (5.0 * run.state().time).sin();
        largest = largest.max(0.5 * strain * strain);
        let force = run.state().f_internal[6];
        assert!((force - intact(largest) * strain).abs() < 1e-9, "{}: {force}", run.state().time);
        let dissipated = run.state().materials.dissipated()[0];
        assert!(dissipated > before - 1e-9, "{dissipated} after {before}");
        assert!((dissipated - lost(largest)).abs() < 1e-5, "{dissipated} {}", lost(largest));
        before = dissipated;
        let mut values = Vec::new();
        let model = run.model();
        let state = run.state();
        let memory = state.materials.past(0.0).memory;
        model.probes[0].values(
            &model.parts,
            &model.reference,
            [&state.y, &state.v, &state.a],
            memory,
            &mut values,
        );
        assert!((values[0] - force).abs() < 1e-9);
    }
    assert!(before > 0.01);
}

fn pulled(scheme: &str, mass: &str, step: f64) -> String {
    let load = "[[load]]\non = [\"bar.right\"]\ntraction = [\"0.06*sin(4*t)\"]\n";
    bar(mass, &format!("{load}[time]\nend = 3.0\nstep = {step}\nscheme = {scheme}\nenergy_guard = false\n"))
}

/// What is not stored is dissipated by the material; nothing is left for the integrator but the
/// error of the stress in the middle of a step of this law, which is linear but for damage. It
/// falls faster than the step; the square is that of steps in which damage does not begin.
#[test]
fn energy_and_momentum_book_what_the_material_dissipates() {
    let left = [0.02, 0.01].map(|step| {
        let mut run = start(&pulled("{ kind = \"energy-momentum\" }", "consistent", step));
        let mut before = 0.0;
        let mut left: f64 = 0.0;
        while !run.finished() {
            run.advance(&mut GridReport::default()).unwrap();
            let ledger = &run.state().ledger;
            assert!(ledger.materials > before - 1e-15);
            before = ledger.materials;
            left = left.max(ledger.dissipation().abs());
        }
        assert!(before > 1e-3, "{before}");
        left
    });
    assert!(left[0] < 1e-6 && left[1] < 0.5 * left[0], "{left:?}");
}

/// Implicit and explicit runs approach the same motion, damage and dissipation. Waves that meet at
/// the fixed end decide where damage grows, so steps are short.
#[test]
fn explicit_and_implicit_runs_agree() {
    let of = |scheme: &str, step: f64| {
        let run = finish(start(&pulled(scheme, "lumped", step)));
        (run.state().ledger.materials, run.state().y.clone())
    };
    let (dissipated, y) = of("{ kind = \"energy-momentum\" }", 5e-4);
    for scheme in ["{ kind = \"central-difference\" }", "{ kind = \"newmark\", rho_inf = 1.0 }"] {
        let errors = [2e-3, 5e-4].map(|step| {
            let (other, moved) = of(scheme, step);
            let apart = y.iter().zip(&moved).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            [(other - dissipated).abs() / dissipated, apart]
        });
        assert!(errors[1][0] < 0.02 && errors[1][1] < 2e-3, "{scheme}: {errors:?}");
    }
}

/// A run that is continued from a checkpoint has the same bits, for every kind of stepper.
#[test]
fn a_resumed_run_remembers() {
    for (scheme, mass) in [
        ("{ kind = \"energy-momentum\" }", "consistent"),
        ("{ kind = \"chung-hulbert\", rho_inf = 0.5 }", "consistent"),
        ("{ kind = \"bathe\", rho_inf = 0.5 }", "consistent"),
        ("{ kind = \"bdf2\" }", "consistent"),
        ("{ kind = \"central-difference\" }", "lumped"),
        ("{ kind = \"moreau-jean\", theta = 0.5 }", "lumped"),
    ] {
        let case = case(&pulled(scheme, mass, 0.02), &[""; 0]);
        let mut whole = Setup::new(&case).material("unit", DAMAGE).start().unwrap();
        let mut checkpoint = None;
        while !whole.finished() {
            if whole.state().step == 60 {
                checkpoint = Some(postcard::to_stdvec(&whole.state()).unwrap());
            }
            whole.advance(&mut GridReport::default()).unwrap();
        }
        let state = postcard::from_bytes(&checkpoint.unwrap()).unwrap();
        let setup = Setup::new(&case).material("unit", DAMAGE).threads(2);
        let resumed = finish(setup.resume(state).unwrap());
        assert!(resumed.state() == whole.state(), "{scheme}");
        assert!(whole.state().ledger.materials > 1e-3, "{scheme}: {}", whole.state().ledger.materials);
    }
}

/// A rejected attempt leaves the memory of the last state: a run that bisects its steps has the
/// bits of one that resumes between them.
#[test]
fn rejected_steps_are_forgotten() {
    // So few iterations that steps in which damage grows are bisected.
    let text =
        pulled("{ kind = \"newmark\", rho_inf = 1.0 }", "consistent", 0.2) + "[newton]\nmax_iterations = 4\n";
    let case = case(&text, &[""; 0]);
    let mut whole = Setup::new(&case).material("unit", DAMAGE).start().unwrap();
    let mut rejected = 0;
    while !whole.finished() {
        let mut resumed = Setup::new(&case).material("unit", DAMAGE).resume(whole.state().clone()).unwrap();
        let mut report = GridReport::default();
        whole.advance(&mut report).unwrap();
        resumed.advance(&mut GridReport::default()).unwrap();
        assert!(whole.state() == resumed.state());
        rejected += report.rejected;
    }
    assert!(rejected > 0);
    assert!(whole.state().ledger.materials > 1e-4);
}
