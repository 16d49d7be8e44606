//! Manufactured motions with schemes and materials that do not balance all of their load.

use carom_run::Setup;

use super::common::{case, finish, simulation};

const MOTION: &str = r#"
dimension = 2
material = [{ name = "m", law = "hencky", density = 2.0, young = 100.0, poisson = 0.3 }]
manufactured = { y = ["X + 4*t^2*sin(2*X + Y)", "Y + 3*t^2*cos(X - 3*Y)"] }
time = { end = 0.2, step = 0.1, scheme = { kind = "static" }, energy_guard = false }
newton = { tolerance = 1e-11 }
[[body]]
name = "b"
material = "m"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.8], cells = [4, 4] }
"#;

/// Load steps have no inertia, and their load neither: without it, cubic convergence ends at an
/// error in proportion to the density.
#[test]
fn load_steps_balance_stresses_alone() {
    let error = |cells: &str, density: &str| {
        let end = finish(simulation(MOTION, &[cells, density]));
        let motion = end.model().loads.manufactured.as_ref().unwrap();
        motion.errors(&end.model().parts, &end.state().y, 0.2)[0]
    };
    let sets = ["[4, 4]", "[8, 8]"].map(|cells| {
        format!(
            "body.b.mesh={{ shape = \"rectangle\", min = [0.0, 0.0], max = [1.0, 0.8], cells = {cells} }}"
        )
    });
    let [coarse, fine] = sets.each_ref().map(|cells| error(cells, "material.m.density=2.0"));
    assert!(coarse / fine > 7.0, "{coarse:e} {fine:e}");
    let light = error(&sets[1], "material.m.density=0.0");
    assert!((fine / light - 1.0).abs() < 1e-9, "{fine:e} {light:e}");
}

/// The boundary moves, which schemes with impulses and explicit ones do not support, and the stress
/// of metal depends on more than the motion of an instant.
#[test]
fn what_cannot_follow_the_motion_is_refused() {
    let schemes = [
        "{ kind = \"central-difference\" }",
        "{ kind = \"moreau-jean\", theta = 0.5 }",
        "{ kind = \"nonsmooth-generalized-alpha\", rho_inf = 0.8 }",
    ];
    for scheme in schemes {
        let refused = carom_case::Case::from_text(MOTION, &[&format!("time.scheme={scheme}")]).unwrap_err();
        assert!(refused.to_string().contains("a boundary that moves is not available"), "{refused}");
    }
    let plastic = ["material.m.plastic={ yield = 1.0, hardening = 10.0 }"];
    let problems = Setup::new(&case(MOTION, &plastic)).start().err().unwrap();
    assert_eq!(problems[0].what, "the material of body \"b\" cannot be used with [manufactured]");
}
