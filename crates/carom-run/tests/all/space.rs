//! The plane is a slice of space, a bar is a prism, no direction of space is special, and what
//! conserves or conducts in the plane does so in space.

use super::common::{finish, on_threads, simulation, turned};
use carom_run::Simulation;

const BEAM: &str = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]
body = [{ name = "beam", material = "rubber", element = "Q9", mesh = { shape = "rectangle", min = [0.0, 0.0], max = [4.0, 1.0], cells = [4, 2] }, velocity = ["0.5*sin(X)", "X*Y"], gravity = [0.0, -3.0] }]
support = [{ on = ["beam.left"], fix = ["x", "y"] }]
load = [{ on = ["beam.top"], pressure = "5*sin(20*t)" }]
time = { scheme = { kind = "chung-hulbert", rho_inf = 0.8 }, step = 5e-3, end = 0.05 }
newton = { tolerance = 1e-12 }
"#;

/// Settings that make a slab of a plane strip, with u_z = 0.
const SLAB: [&str; 7] = [
    "dimension=3",
    "body.beam.element=\"Hex27\"",
    "body.beam.mesh={ shape = \"box\", min = [0.0, 0.0, 0.0], max = [4.0, 1.0, 0.5], cells = [4, 2, 1] }",
    "body.beam.velocity=[\"0.5*sin(X)\", \"X*Y\", 0]",
    "body.beam.gravity=[0.0, -3.0, 0.0]",
    "support=[{ on = [\"beam.left\"], fix = [\"x\", \"y\"] }, { on = [\"beam.bottom\", \"beam.top\"], fix = [\"z\"] }]",
    "load=[{ on = [\"beam.back\"], pressure = \"5*sin(20*t)\" }]",
];

/// Largest distance of a node of the slab from that of the plane at the same reference place, and
/// how many nodes of the slab have one.
pub(crate) fn distance(plane: &Simulation, slab: &Simulation) -> (f64, usize) {
    let (flat, solid) = (plane.model(), slab.model());
    let (mut worst, mut seen) = (0.0_f64, 0);
    for (k, x) in solid.reference.as_chunks::<3>().0.iter().enumerate() {
        let near = |p: &[f64; 2]| (p[0] - x[0]).abs().max((p[1] - x[1]).abs()) < 1e-12;
        let Some(node) = flat.reference.as_chunks::<2>().0.iter().position(near) else { continue };
        let (here, there) = (&plane.state().y[2 * node..2 * node + 2], &slab.state().y[3 * k..3 * k + 3]);
        worst = worst.max((here[0] - there[0]).hypot(here[1] - there[1])).max((there[2] - x[2]).abs());
        seen += 1;
    }
    (worst, seen)
}

/// The distance of a slab whose nodes all stand above those of the plane.
pub(crate) fn apart(plane: &Simulation, slab: &Simulation) -> f64 {
    let (worst, seen) = distance(plane, slab);
    assert_eq!(seen, slab.model().reference.len() / 3);
    worst
}

#[test]
fn a_slab_without_motion_across_is_plane_strain() {
    let implicit = [
        "{ kind = \"chung-hulbert\", rho_inf = 0.8 }",
        "{ kind = \"energy-momentum\" }",
        "{ kind = \"bathe\", rho_inf = 0.0 }",
        "{ kind = \"static\" }",
    ];
    for scheme in implicit {
        let law = if scheme.contains("energy") { "saint-venant-kirchhoff" } else { "neo-hookean" };
        let both = [format!("time.scheme={scheme}"), format!("material.rubber.law=\"{law}\"")];
        let rest = |velocity: &str| {
            let still = [
                format!("body.beam.velocity={velocity}"),
                "material.rubber.lambda=20000.0".to_owned(),
                "material.rubber.mu=1500.0".to_owned(),
            ];
            let still = still.into_iter().filter(|_| scheme.contains("static"));
            both.iter().cloned().chain(still).collect::<Vec<_>>()
        };
        let solid: Vec<String> = SLAB.iter().map(ToString::to_string).chain(rest("[0, 0, 0]")).collect();
        let sets = rest("[0, 0]");
        let (plane, slab) = (finish(simulation(BEAM, &sets)), finish(simulation(BEAM, &solid)));
        let worst = apart(&plane, &slab);
        assert!(worst < 1e-12, "{scheme}: {worst:e}");
        // Forces per unit of thickness; the slab is half as thick.
        let (flat, thick) = (&plane.state().ledger, &slab.state().ledger);
        assert!((flat.strain - 2.0 * thick.strain).abs() < 1e-11 * flat.strain, "{scheme}");
        assert!((flat.external_work - 2.0 * thick.external_work).abs() < 1e-10, "{scheme}");
    }
}

#[test]
fn explicit_steps_of_a_slab_are_those_of_plane_strain() {
    let sets = [
        "time.scheme={ kind = \"central-difference\" }",
        "time.step=2e-4",
        "time.end=0.02",
        "body.beam.mass=\"lumped\"",
    ];
    let solid: Vec<&str> = SLAB.into_iter().chain(sets).collect();
    let worst = apart(&finish(simulation(BEAM, &sets)), &finish(simulation(BEAM, &solid)));
    assert!(worst < 1e-13, "{worst:e}");
}

const FREE: &str = r#"
dimension = 3
material = [{ name = "rubber", law = "neo-hookean", density = 1.0, young = 50.0, poisson = 0.3 }]
body = [{ name = "block", material = "rubber", element = "Tet10", mesh = { shape = "box", min = [-1.0, -0.5, -0.25], max = [1.0, 0.5, 0.25], cells = [2, 2, 1] }, velocity = { linear = [0.3, -0.2, 0.1], angular = [0.5, 2.0, -1.0], about = [0.0, 0.0, 0.0] }, gravity = [0.0, 0.0, -2.0] }]
support = []
time = { scheme = { kind = "chung-hulbert", rho_inf = 0.8 }, step = 0.02, end = 0.4 }
newton = { tolerance = 1e-12 }
"#;

/// By 120° about the diagonal, x → y → z → x, and by an angle that mixes all components.
#[test]
fn a_turned_case_moves_alike() {
    type Rotation = fn([f64; 3]) -> [f64; 3];
    let load = "load=[{ on = [\"block.right\"], pressure = \"3*t\" }]";
    let still = finish(simulation(FREE, &[load]));
    let rotations: [(&str, Rotation, f64); 2] = [
        ("axis = [1.0, 1.0, 1.0], angle = 120.0", |x| [x[2], x[0], x[1]], 1e-12),
        ("axis = [2.0, 3.0, 6.0], angle = 50.0", turned, 1e-12),
    ];
    for (rotation, turned, bound) in rotations {
        let vector = |x: [f64; 3]| format!("{:?}", turned(x));
        let sets = [
            load.to_owned(),
            format!("body.block.place={{ rotate = {{ {rotation} }} }}"),
            format!(
                "body.block.velocity={{ linear = {}, angular = {}, about = [0.0, 0.0, 0.0] }}",
                vector([0.3, -0.2, 0.1]),
                vector([0.5, 2.0, -1.0])
            ),
            format!("body.block.gravity={}", vector([0.0, 0.0, -2.0])),
        ];
        let other = finish(simulation(FREE, &sets));
        let pairs = still.state().y.as_chunks::<3>().0.iter().zip(other.state().y.as_chunks::<3>().0);
        for (here, there) in pairs {
            let expected = turned(*here);
            assert!((0..3).all(|i| (expected[i] - there[i]).abs() < bound), "{expected:?} {there:?}");
        }
    }
}

#[test]
fn momentum_is_conserved_in_free_flight_and_energy_where_the_scheme_says_so() {
    let sets = ["body.block.gravity=[0.0, 0.0, 0.0]"];
    let momenta = |sim: &Simulation| {
        let (y, v) = (&sim.state().y, &sim.state().v);
        let mut p = vec![0.0; v.len()];
        sim.model().mass.multiply_into(v, &mut p);
        let pairs = y.as_chunks::<3>().0.iter().zip(p.as_chunks::<3>().0);
        pairs.fold([0.0; 6], |s, (y, p)| {
            let about = |i: usize| y[(i + 1) % 3] * p[(i + 2) % 3] - y[(i + 2) % 3] * p[(i + 1) % 3];
            std::array::from_fn(|i| s[i] + if i < 3 { p[i] } else { about(i - 3) })
        })
    };
    for (scheme, exact) in
        [("{ kind = \"energy-momentum\" }", true), ("{ kind = \"bathe\", rho_inf = 0.0 }", false)]
    {
        let scheme = format!("time.scheme={scheme}");
        let start = simulation(FREE, &[sets[0], &scheme]);
        let (before, energy) = (momenta(&start), start.state().ledger.total());
        let end = finish(start);
        let after = momenta(&end);
        let size = before.iter().map(|p| p.abs()).fold(0.0, f64::max);
        for i in 0..if exact { 6 } else { 3 } {
            assert!((after[i] - before[i]).abs() < 1e-11 * size, "{scheme}: {before:?} {after:?}");
        }
        if exact {
            assert!((end.state().ledger.total() / energy - 1.0).abs() < 1e-10);
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let sets = ["body.block.mesh.cells=[6, 6, 3]", "time.end=0.1"];
    let [one, two] = [1, 2].map(|threads| finish(on_threads(FREE, &sets, threads)));
    assert_eq!(one.state().y, two.state().y);
    assert_eq!(one.state().v, two.state().v);
}

#[test]
fn every_element_falls_without_deforming() {
    for element in ["Tet4", "Tet10", "Tet20", "Hex8", "Hex27"] {
        for mass in ["consistent", "lumped"] {
            let sets = [
                format!("body.block.element=\"{element}\""),
                format!("body.block.mass=\"{mass}\""),
                "body.block.velocity=[0.0, 0.0, 1.0]".to_owned(),
                "time.scheme={ kind = \"newmark\", beta = 0.25, gamma = 0.5 }".to_owned(),
            ];
            let sim = finish(simulation(FREE, &sets));
            let (t, state) = (sim.state().time, sim.state());
            for (y, x) in state.y.as_chunks::<3>().0.iter().zip(sim.model().reference.as_chunks::<3>().0) {
                let fallen = [x[0], x[1], x[2] + t - t * t];
                assert!(
                    (0..3).all(|i| (y[i] - fallen[i]).abs() < 1e-12),
                    "{element} {mass}: {y:?} {fallen:?}"
                );
            }
        }
    }
}

#[test]
fn a_bar_is_a_prism_without_lateral_contraction() {
    const BAR: &str = r#"
    dimension = 1
    thickness = 0.25
    material = [{ name = "rubber", law = "neo-hookean", density = 2.0, young = 50.0, poisson = 0.0 }]
    body = [{ name = "bar", material = "rubber", element = "L3", mesh = { shape = "interval", min = 0.0, max = 4.0, cells = 8 }, velocity = ["0.8*sin(X)"] }]
    support = [{ name = "wall", on = ["bar.left"], fix = ["x"] }]
    load = [{ on = ["bar.right"], traction = ["3*t"] }]
    time = { scheme = { kind = "chung-hulbert", rho_inf = 0.8 }, step = 0.02, end = 0.6 }
    newton = { tolerance = 1e-12 }
    "#;
    let prism = [
        "dimension=3",
        "thickness=1.0",
        "body.bar.element=\"Hex27\"",
        "body.bar.mesh={ shape = \"box\", min = [0.0, 0.0, 0.0], max = [4.0, 0.5, 0.5], cells = [8, 1, 1] }",
        "body.bar.velocity=[\"0.8*sin(X)\", 0, 0]",
        "support=[{ name = \"wall\", on = [\"bar.left\"], fix = [\"x\"] }]",
        "load=[{ on = [\"bar.right\"], traction = [\"3*t\", 0, 0] }]",
    ];
    let (bar, solid) = (finish(simulation(BAR, &[""; 0])), finish(simulation(BAR, &prism)));
    for (k, x) in solid.model().reference.as_chunks::<3>().0.iter().enumerate() {
        let node = bar.model().reference.iter().position(|p| (p - x[0]).abs() < 1e-12).unwrap();
        let y = &solid.state().y[3 * k..3 * k + 3];
        assert!((y[0] - bar.state().y[node]).abs() < 1e-11, "{y:?}");
        assert!((y[1] - x[1]).abs().max((y[2] - x[2]).abs()) < 1e-11, "{y:?}");
    }
    assert!((bar.state().ledger.strain - solid.state().ledger.strain).abs() < 1e-11);
}

/// Q4 in plane strain and Hex8 between planes: one pressure in a cell in both.
#[test]
fn mean_dilatation_of_a_slab_is_that_of_plane_strain() {
    for scheme in ["{ kind = \"chung-hulbert\", rho_inf = 0.8 }", "{ kind = \"energy-momentum\" }"] {
        let both = [
            format!("time.scheme={scheme}"),
            "body.beam.volumetric=\"mean\"".to_owned(),
            "material.rubber.lambda=1500.0".to_owned(),
        ];
        let of = |sets: &[&str], element: &str| {
            let sets = sets.iter().map(ToString::to_string).chain(both.iter().cloned());
            sets.chain([format!("body.beam.element=\"{element}\"")]).collect::<Vec<_>>()
        };
        let plane = finish(simulation(BEAM, &of(&[], "Q4")));
        let slab = finish(simulation(BEAM, &of(&SLAB, "Hex8")));
        let worst = apart(&plane, &slab);
        assert!(worst < 1e-12, "{scheme}: {worst:e}");
        let (flat, thick) = (&plane.state().ledger, &slab.state().ledger);
        assert!((flat.strain - 2.0 * thick.strain).abs() < 1e-10 * flat.strain, "{scheme}");
        // The ledger closes: nothing dissipates.
        if scheme.contains("energy") {
            assert!(thick.dissipation().abs() < 1e-10 * thick.total().abs(), "{:e}", thick.dissipation());
        }
    }
}

/// `fix = ["normal"]` is the direction across a side, and refused where a side has none.
#[test]
fn sides_are_held_across() {
    let on = "[\"block.left\", \"block.bottom\"], fix = [\"normal\"]";
    let same = [
        format!("support=[{{ on = {on} }}]"),
        "support=[{ on = [\"block.left\"], fix = [\"x\"] }, { on = [\"block.bottom\"], fix = [\"z\"] }]"
            .to_owned(),
    ];
    let still = "body.block.velocity=[0.1, 0.2, 0.0]";
    let [across, named] = same.map(|support| finish(simulation(FREE, &[&support, still])).state().y.clone());
    assert_eq!(across, named);
    let turned = "body.block.place={ rotate = { axis = [0.0, 0.0, 1.0], angle = 30.0 } }";
    let case =
        carom_run::case::Case::from_text(FREE, &[&format!("support=[{{ on = {on} }}]"), turned]).unwrap();
    let problems = carom_run::Setup::new(&case).start().err().unwrap();
    assert!(problems.to_string().contains("is not in a plane"), "{problems}");
}
