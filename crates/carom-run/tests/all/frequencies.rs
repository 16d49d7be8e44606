//! Natural frequencies of bars, and of a spring on a node, against closed forms.

use std::f64::consts::PI;

use carom_run::Setup;
use carom_run::frequencies::{Frequencies, frequencies, spring};
use carom_run::model::Model;

use super::common::case;

const BAR: &str = include_str!("../../../../cases/bar/single.toml");

fn model(sets: &[&str]) -> Model {
    carom_run::Setup::new(&case(BAR, sets)).build().unwrap()
}

/// Frequencies at the start of a case.
fn at_start(text: &str) -> Frequencies {
    let simulation = Setup::new(&case(text, &[""; 0])).start().unwrap();
    frequencies(simulation.model(), &simulation.state().configuration()).unwrap()
}

/// The end of a bar of linear cells with lumped mass ρAh/2, on a spring of `stiffness` times its
/// tangent EA/h: ω² = 2 s c²/h².
#[test]
fn a_spring_on_half_a_cell() {
    let penalty =
        ["contact.wall.enforcement=\"penalty\"", "contact.wall.stiffness=8.0", "body.bar.mass=\"lumped\""];
    let omega = spring(&model(&penalty)).unwrap();
    assert!((omega / (4.0 * 30.0 / 0.1) - 1.0).abs() < 1e-12, "{omega}");
    assert_eq!(spring(&model(&[])), None);
}

/// A free bar of n linear cells with consistent mass: ω_k² = (6c²/h²)(1 − cos θ)/(2 + cos θ), θ =
/// kπ/n; the highest, k = n, is √12 c/h (Hughes, "The finite element method", §7.3.1). c = 30, h =
/// 0.1.
#[test]
fn a_free_bar() {
    let found = at_start(BAR);
    let exact = |k: f64| {
        let cos = (k * PI / 100.0).cos();
        30.0 / 0.1 * (6.0 * (1.0 - cos) / (2.0 + cos)).sqrt()
    };
    for (k, omega) in found.lowest.iter().enumerate() {
        let right = exact(k as f64 + 1.0);
        assert!((omega / right - 1.0).abs() < 1e-6, "{omega} instead of {right}");
    }
    assert_eq!(found.lowest.len(), 3);
    let highest = found.highest.unwrap();
    assert!((highest / exact(100.0) - 1.0).abs() < 2e-2 && highest <= exact(100.0), "{highest}");
}

/// Bodies of the frequencies below: a material, a mesh, and how it starts.
const SLENDER: &str = r#"
dimension = 2
plane = "stress"
[[material]]
name = "m"
law = "linear-elastic"
density = 1.0
young = 1.0
poisson = 0.0
[[body]]
name = "beam"
material = "m"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [100.0, 1.0], cells = [100, 1] }
[[support]]
name = "wall"
on = ["beam.left"]
fix = ["x", "y"]
[time]
end = 1.0
step = 1.0
scheme = { kind = "newmark", beta = 0.25, gamma = 0.5 }
"#;

/// ω = (βL)² √(EI/ρA)/L² with cos βL cosh βL = −1, βL = 1.8751, 4.6941, 7.8548 (L. Euler, D.
/// Bernoulli); shear and rotatory inertia, which lower them, are below (h/L)². ω₁² is 1e-10 of the
/// highest.
#[test]
fn a_slender_cantilever() {
    let lowest = at_start(SLENDER).lowest;
    for (omega, of_length) in lowest.iter().zip([1.875104, 4.694091, 7.854757_f64]) {
        let right = of_length.powi(2) / 12.0_f64.sqrt() / 1e4;
        assert!((omega / right - 1.0).abs() < 3e-3, "{omega} instead of {right}");
    }
    assert_eq!(lowest.len(), 3);
}

/// A bar of rubber, fixed at one end, beside a free one of steel, in which waves are 158 times as
/// fast: the lowest frequencies are those of the rubber, ω_k = (k − ½) π c/L.
#[test]
fn a_soft_body_beside_a_stiff_one() {
    let text = r#"
dimension = 1
[[material]]
name = "rubber"
law = "linear-elastic"
density = 1000.0
young = 1e6
poisson = 0.0
[[material]]
name = "steel"
law = "linear-elastic"
density = 8000.0
young = 2e11
poisson = 0.0
[[body]]
name = "soft"
material = "rubber"
element = "L2"
mesh = { shape = "interval", min = 0.0, max = 0.1, cells = 120 }
[[body]]
name = "stiff"
material = "steel"
element = "L2"
mesh = { shape = "interval", min = 0.2, max = 0.3, cells = 120 }
[[support]]
name = "wall"
on = ["soft.left"]
fix = ["x"]
[time]
end = 1e-3
step = 1e-3
scheme = { kind = "newmark", beta = 0.25, gamma = 0.5 }
"#;
    let lowest = at_start(text).lowest;
    for (k, omega) in lowest.iter().enumerate() {
        let right = (k as f64 + 0.5) * PI * (1e6_f64 / 1e3).sqrt() / 0.1;
        assert!((omega / right - 1.0).abs() < 1e-3, "{omega} instead of {right}");
    }
    assert_eq!(lowest.len(), 3);
}

/// Two free boxes in space have twelve rigid motions, and a stretched bar the tangent of the
/// stretch: P = μ (F − 1/F), so that ω = π √(μ (1 + F⁻²)/ρ)/L at F = 2.
#[test]
fn rigid_motions_and_a_stretch() {
    let body = |name: &str, x: f64| {
        let mesh = format!(
            "{{ shape = \"box\", min = [{x}, 0.0, 0.0], max = [{}, 1.0, 1.0], cells = [2, 2, 2] }}",
            x + 2.0
        );
        format!("[[body]]\nname = \"{name}\"\nmaterial = \"m\"\nelement = \"Hex8\"\nmesh = {mesh}\n")
    };
    let (of_beam, rest) = SLENDER.split_once("[[body]]").unwrap();
    let (_, time) = rest.split_once("[time]").unwrap();
    let material = of_beam.replace("dimension = 2\nplane = \"stress\"", "dimension = 3");
    let found = at_start(&format!("{material}{}{}[time]{time}", body("a", 0.0), body("b", 5.0)));
    assert_eq!(found.lowest.len(), 3);
    assert!((found.lowest[1] / found.lowest[0] - 1.0).abs() < 1e-6, "{found:?}");
    let alone = at_start(&format!("{material}{}[time]{time}", body("a", 0.0)));
    assert!((found.lowest[0] / alone.lowest[0] - 1.0).abs() < 1e-6, "{found:?} {alone:?}");

    let stretched = r#"
dimension = 1
[[material]]
name = "m"
law = "neo-hookean"
density = 1.0
young = 1.0
poisson = 0.0
[[body]]
name = "bar"
material = "m"
element = "L2"
mesh = { shape = "interval", min = 0.0, max = 1.0, cells = 100 }
position = ["2*X"]
[[support]]
name = "walls"
on = ["bar.left", "bar.right"]
fix = ["x"]
[time]
end = 1.0
step = 1.0
scheme = { kind = "newmark", beta = 0.25, gamma = 0.5 }
"#;
    let right = PI * (0.5_f64 * 1.25).sqrt();
    let lowest = at_start(stretched).lowest[0];
    assert!((lowest / right - 1.0).abs() < 1e-3, "{lowest} instead of {right}");
}

/// Two bars of nearly the same length have close modes, ω_k = kπc/L of each.
#[test]
fn close_modes() {
    let bar = |name: &str, x: f64, length: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"m\"\nelement = \"L3\"\n\
             mesh = {{ shape = \"interval\", min = {x}, max = {}, cells = 20 }}\n",
            x + length
        )
    };
    let (of_beam, rest) = SLENDER.split_once("[[body]]").unwrap();
    let (_, time) = rest.split_once("[time]").unwrap();
    let material = of_beam.replace("dimension = 2\nplane = \"stress\"", "dimension = 1");
    let found =
        at_start(&format!("{material}{}{}[time]{time}", bar("a", 0.0, 1.0), bar("b", 5.0, 1.001))).lowest;
    let right = [PI / 1.001, PI, 2.0 * PI / 1.001];
    assert_eq!(found.len(), 3);
    for (omega, right) in found.iter().zip(right) {
        assert!((omega / right - 1.0).abs() < 1e-4, "{found:?} instead of {right:?}");
    }
}
