//! Natural frequencies of bars, and of a spring on a node, against closed forms.

use carom_run::frequencies::{frequencies, spring};
use carom_run::model::Model;

use super::common::case;

const BAR: &str = include_str!("../../../../cases/bar/single.toml");

fn model(sets: &[&str]) -> Model {
    carom_run::Setup::new(&case(BAR, sets)).build().unwrap()
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
    let found = frequencies(&model(&[])).unwrap();
    let exact = |k: f64| {
        let cos = (k * std::f64::consts::PI / 100.0).cos();
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
