//! A law of your own that remembers: isotropic damage of a neo-Hookean material, in a bar that is
//! pulled to and fro (`cargo run --release -p carom --example damage`). With κ the largest energy
//! so far, at least κ₀, the share κ₀/κ of the stiffness is left, and κ₀ ln κ₁/κ₀ is dissipated.

use carom::algebra::{Mat, Vector};
use carom::solid::Past;
use carom::solid::material::{Material, NeoHookean, NotPositive, Thickness};
use carom::{GridReport, Setup, case::Case};

// ANCHOR: law
#[derive(Clone)]
struct Damage {
    of: NeoHookean,
    threshold: f64,
}

/// A point without damage, and κ at the start and at the end of a step.
struct Damaged<P> {
    of: P,
    kappa: [f64; 2],
}

impl<const D: usize> Material<D> for Damage {
    const MEMORY: usize = 1;
    type Point = Damaged<<NeoHookean as Material<D>>::Point>;

    fn after(&self, h: &Mat<D>, past: &Past) -> Result<Self::Point, NotPositive> {
        let of = self.of.at(h)?;
        let start = past.memory[0].max(self.threshold);
        Ok(Damaged { kappa: [start, start.max(Material::<D>::energy(&self.of, &of))], of })
    }

    fn remember(&self, point: &Self::Point, memory: &mut [f64]) {
        memory[0] = point.kappa[1];
    }

    fn dissipated(&self, point: &Self::Point) -> f64 {
        self.threshold * (point.kappa[1] / point.kappa[0]).ln()
    }

    fn energy(&self, point: &Self::Point) -> f64 {
        Material::<D>::energy(&self.of, &point.of) * self.threshold / point.kappa[1]
    }

    fn stress(&self, point: &Self::Point) -> Mat<D> {
        self.of.stress(&point.of) * (self.threshold / point.kappa[1])
    }

    fn tangent(&self, point: &Self::Point, a: &Vector<D>, b: &Vector<D>) -> Mat<D> {
        let intact = self.of.tangent(&point.of, a, b);
        let stress: Mat<D> = self.of.stress(&point.of);
        let grows = if point.kappa[1] > point.kappa[0] { 1.0 / point.kappa[1] } else { 0.0 };
        (intact - stress.apply(a).outer(&stress.apply(b)) * grows) * (self.threshold / point.kappa[1])
    }

    fn lateral(&self, point: &Self::Point) -> f64 {
        Material::<D>::lateral(&self.of, &point.of) * self.threshold / point.kappa[1]
    }
}

impl Thickness for Damage {}
// ANCHOR_END: law

const BAR: &str = r#"
title = "A bar that is damaged"
dimension = 1
material = [{ name = "rubber", law = "neo-hookean", density = 1.0, lambda = 0.5, mu = 1.0 }]
support = [{ on = ["bar.left"], fix = ["x"] }, { on = ["bar.right"], move = { x = "0.4*sin(3*t)" } }]
[[body]]
name = "bar"
material = "rubber"
element = "L2"
mesh = { shape = "interval", min = 0.0, max = 1.0, cells = 2 }
[time]
end = 2.0
step = 0.02
scheme = { kind = "static" }
energy_guard = false
"#;

#[allow(clippy::print_stdout)]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let case = Case::from_text(BAR, &[""; 0])?;
    let law = Damage { of: NeoHookean { lambda: 0.5, mu: 1.0 }, threshold: 0.02 };
    let mut run = Setup::new(&case).material("rubber", law).start()?;
    let mut history: f64 = 0.02;
    println!("stretch    force");
    while !run.finished() {
        run.advance(&mut GridReport::default())?;
        let stretch = 1.0 + 0.4 * (3.0 * run.state().time).sin();
        let log = stretch.ln();
        history = history.max(0.5 * (stretch * stretch - 1.0) - log + 0.25 * log * log);
        let force = run.state().f_internal[2];
        let exact = 0.02 / history * (stretch - 1.0 / stretch + 0.5 * log / stretch);
        println!("{stretch:7.4}  {force:7.4}");
        assert!((force - exact).abs() < 1e-9);
    }
    Ok(())
}
