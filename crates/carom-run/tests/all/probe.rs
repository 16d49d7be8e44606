//! Probes at points where cells are strongly distorted.

use carom_run::model::Probe;

use super::common::simulation;
use super::rebound::record;

const SQUARE: &str = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 1.0, lambda = 2.0, mu = 1.5 }]
body = [{ name = "a", material = "rubber", element = "T6", mesh = { shape = "rectangle", min = [0, 0], max = [1, 1], cells = [1, 1] } }]
time = { end = 1.0, step = 1.0, scheme = { kind = "hu" } }
probe = [
  { name = "corner", at = [1, 0], body = "a", record = ["sigma_xx", "det_f", "ux"] },
  { name = "shared", at = [0, 0], body = "a", record = ["sigma_yy"] },
]
"#;

/// An edge's middle node moved to four fifths of it: dx/dξ is 4·0.8 − 3 > 0 at its start, 1 − 4·0.2
/// = −0.2 < 0 backwards from its end, and positive at every quadrature point.
#[test]
fn a_corner_turned_over_has_j_but_no_stress() {
    let sim = simulation(SQUARE, &[""; 0]);
    let (model, mut state) = (sim.model(), sim.state().clone());
    let [corner, shared] = &model.probes[..] else { panic!() };
    assert!(corner.has_stress(&model.parts, &state.y, &[]));
    let middle = model.reference.as_chunks::<2>().0.iter().position(|x| *x == [0.5, 0.0]).unwrap();
    state.y[2 * middle] = 0.8;
    assert!(model.min_det_f(&state.y, &[]) > 0.0);
    assert!(
        !corner.has_stress(&model.parts, &state.y, &[]) && shared.has_stress(&model.parts, &state.y, &[])
    );
    let values_of = |probe: &Probe| {
        let mut values = Vec::new();
        probe.values(&model.parts, &model.reference, [&state.y, &state.v, &state.a], &[], &mut values);
        values
    };
    let values = values_of(corner);
    assert!(values[0].is_nan() && (values[1] + 0.2).abs() < 1e-14 && values[2].abs() < 1e-14, "{values:?}");
    assert!(values_of(shared)[0].is_finite());
}

/// The stress across the plane: ν (σ_xx + σ_yy) of a linear body in plane strain, and nothing in
/// plane stress.
#[test]
fn stress_across_the_plane() {
    let text = r#"
dimension = 2
material = [{ name = "steel", law = "linear-elastic", density = 1.0, young = 1e4, poisson = 0.3 }]
support = [{ on = ["plate.left"], fix = ["x"] }, { on = ["plate.bottom"], fix = ["y"] }]
load = [{ on = ["plate.right"], traction = [2.0, 0.0] }, { on = ["plate.top"], traction = [0.0, -0.5] }]
[[body]]
name = "plate"
material = "steel"
element = "T6"
mesh = { shape = "rectangle", min = [0, 0], max = [1, 1], cells = [1, 1] }
[[probe]]
name = "p"
body = "plate"
at = [0.4, 0.4]
record = ["sigma_xx", "sigma_yy", "sigma_zz"]
[time]
end = 1.0
step = 1.0
scheme = { kind = "static" }
"#;
    for (plane, across) in [("strain", 0.3 * 1.5), ("stress", 0.0)] {
        let run = record(text, &[&format!("plane={plane}")]);
        let stress =
            ["xx", "yy", "zz"].map(|axes| *run.column(&format!("p.sigma_{axes}")).unwrap().last().unwrap());
        for (found, exact) in stress.iter().zip([2.0, -0.5, across]) {
            assert!((found - exact).abs() < 1e-9, "{plane}: {stress:?}");
        }
    }
}

/// Where cells meet, the von Mises stress of a probe is that of its mean stress.
#[test]
fn the_von_mises_stress_is_that_of_the_recorded_stress() {
    let text = SQUARE.replace(
        "record = [\"sigma_yy\"]",
        "record = [\"sigma_xx\", \"sigma_yy\", \"sigma_zz\", \"sigma_xy\", \"von_mises\"]",
    );
    let sim = simulation(&text, &[""; 0]);
    let model = sim.model();
    let bent: Vec<f64> = model
        .reference
        .as_chunks::<2>()
        .0
        .iter()
        .flat_map(|[x, y]| [x + 0.3 * x * y, y + 0.1 * x * x])
        .collect();
    let mut values = Vec::new();
    let zero = vec![0.0; bent.len()];
    model.probes[1].values(&model.parts, &model.reference, [&bent, &zero, &zero], &[], &mut values);
    let [xx, yy, zz, xy, mises] = values[..] else { panic!("{values:?}") };
    let square = 0.5 * ((xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2)) + 3.0 * xy * xy;
    assert!((mises - square.sqrt()).abs() < 1e-12 * mises, "{mises} {}", square.sqrt());
}
