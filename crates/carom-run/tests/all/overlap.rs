//! Bodies that overlap at the start: relaxed into an interference fit, or with a gap that is kept.

use carom_run::Setup;

use crate::common::{DISCS, case, finish, simulation};

const BARS: &str = include_str!("../../../../cases/overlap/bars.toml");
const PRESS: &str = include_str!("../../../../cases/overlap/press-t3.toml");
const KEPT: &str = include_str!("../../../../cases/overlap/kept.toml");

/// δ/(L₁/E₁ + L₂/E₂).
const PRESSURE: f64 = 1e-3 / (1.0 / 100.0 + 1.501 / 300.0);

/// Every scheme starts from the same equilibrium, springs from theirs.
#[test]
fn the_pressure_of_a_fit_is_exact_with_every_family() {
    let sets = [
        "time.scheme={ kind = \"hu\" }",
        "time.scheme={ kind = \"energy-momentum\" }",
        "time.scheme={ kind = \"bdf2\" }",
        "time.scheme={ kind = \"static\" }",
        "contact.fit.primary=right.left",
    ];
    for set in sets {
        let start = simulation(BARS, &[set]);
        let force = start.state().contact_forces[0][0];
        assert!((force + PRESSURE).abs() < 1e-9 * PRESSURE, "{set}: {force}");
        let end = finish(start);
        let force = end.state().contact_forces[0][0];
        assert!((force + PRESSURE).abs() < 1e-7 * PRESSURE, "{set}: {force}");
        let ledger = &end.state().ledger;
        assert!(ledger.dissipation().abs() < 1e-12 * ledger.strain, "{set}: {ledger:?}");
    }
    // The spring adds its compliance: it is softer than the multiplier by its compression.
    let spring = simulation(BARS, &["contact.fit.enforcement=penalty"]);
    let force = spring.state().contact_forces[0][0];
    assert!(force < -0.9 * PRESSURE && force > -PRESSURE, "{force}");
}

/// The gap of a node in a rigid obstacle is kept too: nothing moves, and nothing is pushed out.
#[test]
fn an_overlap_with_an_obstacle_is_kept() {
    let sets = [
        "contact.fit.primary={ plane = { point = [0.999], normal = [-1.0] } }",
        "contact.fit.overlap=keep-gap",
    ];
    let end = finish(simulation(BARS, &sets));
    let moved = end.state().y.iter().zip(&end.model().reference).map(|(y, x)| (y - x).abs());
    assert!(moved.fold(0.0, f64::max) < 1e-14);
    let relaxed = simulation(BARS, &[sets[0]]);
    let force = relaxed.state().contact_forces[0][0];
    assert!((force + 0.1).abs() < 1e-9, "E δ/L = 0.1, not {force}");
}

/// Kept gaps are those of the case: a state of the middle continues to the same bits.
#[test]
fn kept_gaps_are_the_same_after_a_resume() {
    let sets = ["time.scheme={ kind = \"chung-hulbert\", rho_inf = 0.5 }", "time.step=0.02"];
    let mut run = simulation(KEPT, &sets);
    for _ in 0..7 {
        run.step().unwrap();
    }
    let mut again = Setup::new(&case(KEPT, &sets)).resume(run.state().clone()).unwrap();
    for _ in 0..20 {
        run.step().unwrap();
        again.step().unwrap();
    }
    assert!(run.state().pairs[0].iter().any(|pair| pair.active));
    assert_eq!(run.state(), again.state());
}

/// A block on another one, that is `by` narrower at each end, and overlaps it by 0.01.
fn blocks(element: &str, by: f64, primary: &str, overlap: &str) -> String {
    let in_space = element == "Hex8";
    let [dimension, shape, cells, up, sideways] = if in_space {
        ["3", "box", "[2, 2, 2]", "z", "\"x\", \"y\""]
    } else {
        ["2", "rectangle", "[4, 4]", "y", "\"x\""]
    };
    let corner = |x: f64, height: f64| {
        if in_space { format!("[{x}, {x}, {height}]") } else { format!("[{x}, {height}]") }
    };
    format!(
        r#"
        dimension = {dimension}
        material = [
          {{ name = "a", law = "linear-elastic", density = 1.0, young = 100.0, poisson = 0.0 }},
          {{ name = "b", law = "linear-elastic", density = 1.0, young = 300.0, poisson = 0.0 }},
        ]
        support = [
          {{ on = ["lo.bottom"], fix = [{sideways}, "{up}"] }},
          {{ on = ["up.top"], fix = [{sideways}], move = {{ {up} = "-0.001*t" }} }},
        ]
        contact = [{{ name = "c", secondary = "lo.top", primary = "{primary}", overlap = "{overlap}" }}]
        time = {{ end = 1.0, step = 1.0, scheme = {{ kind = "static" }} }}
        [[body]]
        name = "lo"
        material = "a"
        element = "{element}"
        mesh = {{ shape = "{shape}", min = {}, max = {}, cells = {cells} }}
        [[body]]
        name = "up"
        material = "b"
        element = "{element}"
        mesh = {{ shape = "{shape}", min = {}, max = {}, cells = {cells} }}
        "#,
        corner(0.0, 0.0),
        corner(1.0, 1.0),
        corner(by, 0.99),
        corner(1.0 - by, 2.5),
    )
}

/// A block on a rigid pedestal, which is `by` narrower at each end, and overlaps it by 0.01.
fn pedestal(by: f64, overlap: &str) -> String {
    let left = by;
    let right = 1.0 - by;
    format!(
        r#"
        dimension = 2
        material = [{{ name = "a", law = "linear-elastic", density = 1.0, young = 100.0, poisson = 0.0 }}]
        support = [{{ on = ["b.top"], fix = ["x"], move = {{ y = "-0.001*t" }} }}]
        time = {{ end = 1.0, step = 1.0, scheme = {{ kind = "static" }} }}
        [[body]]
        name = "b"
        material = "a"
        element = "Q4"
        mesh = {{ shape = "rectangle", min = [0.0, -0.01], max = [1.0, 1.0], cells = [4, 4] }}
        [[contact]]
        name = "c"
        secondary = "b.bottom"
        primary = {{ polyline = {{ points = [[{right}, -1.0], [{right}, 0.0], [{left}, 0.0], [{left}, -1.0]] }} }}
        overlap = "{overlap}"
        "#
    )
}

/// A block presses on another one, or on a rigid pedestal, of its own width or somewhat narrower or
/// wider, that it overlaps. The corner of the narrower one is nearer to the wall of the other than
/// it is deep, and pressed by the face below all the same: the stress is uniform but for the part
/// beyond the corner, which is 0.2 % of the width.
#[test]
fn corners_near_a_wall_keep_the_depth_below_the_face() {
    let force = |case: &str| {
        let end = finish(simulation(case, &[""; 0]));
        let d = end.model().dimension;
        end.state().contact_forces[0][d - 1].abs()
    };
    // With 0.01 that remains or not, over the compliances of both.
    let of_blocks = |closed: f64| closed / (1.0 / 100.0 + 1.51 / 300.0);
    let of_block = |closed: f64| closed / (1.01 / 100.0);
    for (overlap, closed) in [("keep-gap", 0.001), ("relax", 0.011)] {
        for by in [0.0, 1e-6, 1e-3] {
            for element in ["Q4", "Hex8"] {
                for primary in ["up.bottom", "up.skin"] {
                    let ratio = force(&blocks(element, by, primary, overlap)) / of_blocks(closed);
                    let error = (ratio - 1.0).abs();
                    assert!(error < 3.0 * by + 1e-9, "{element} {primary} {by} {overlap}: {ratio}");
                }
            }
            for by in [by, -by] {
                let ratio = force(&pedestal(by, overlap)) / of_block(closed);
                assert!((ratio - 1.0).abs() < 1e-9, "pedestal {by} {overlap}: {ratio}");
            }
        }
    }
}

#[test]
fn an_overlap_is_refused_by_default() {
    let refused = Setup::new(&case(BARS, &["contact.fit.overlap=refuse"])).start();
    let problems = refused.err().unwrap();
    assert!(problems[0].what.contains("overlap at the start by 0.001 m"), "{problems:?}");
}

/// What is due to chords is named, and closed by `relax` whatever scheme follows.
#[test]
fn chords_of_an_arc_are_told_from_an_interference() {
    let refused = Setup::new(&case(PRESS, &["contact.fit.overlap=refuse"])).start();
    let text = refused.err().unwrap().to_string();
    assert!(text.contains("of it behind straight cells") && text.contains("use curved cells"), "{text}");
    let hidden =
        Setup::new(&case(PRESS, &["body.shaft.mesh.radius=0.5001"])).start().err().unwrap().to_string();
    assert!(hidden.contains("straight cells deviate") && hidden.contains("h²/8R"), "{hidden}");
    // Lamé's energy π a δ p; the meshes are softer, and smaller than the circles.
    let exact = std::f64::consts::PI * 0.5 * 6.66667e-4 * 1e8;
    for sides in [["shaft.arc", "hub.inner"], ["hub.inner", "shaft.arc"]] {
        let sets =
            [format!("contact.fit.secondary={}", sides[0]), format!("contact.fit.primary={}", sides[1])];
        let strain = simulation(PRESS, &sets).state().ledger.strain;
        assert!((strain / exact - 1.0).abs() < 0.08, "{sides:?}: {strain:e} {exact:e}");
    }
}

/// Of a ring on a rigid core a little larger than its hole. Of linear elasticity, it can turn and
/// grow by √(1 + ω²) at no energy.
const CORE: &str = r#"
dimension = 2
plane = "strain"
material = [{ name = "rubber", law = "linear-elastic", density = 1.0, young = 100.0, poisson = 0.3 }]
[[body]]
name = "ring"
material = "rubber"
element = "T6"
mesh = { shape = "ring", inner = 1.0, outer = 1.5, center = [0.0, 0.0], size = 0.5 }
[[contact]]
name = "fit"
secondary = "ring.inner"
primary = { circle = { center = [0.0, 0.0], radius = 1.001 } }
overlap = "relax"
[time]
end = 0.2
step = 1e-2
scheme = { kind = "bathe", rho_inf = 0.5 }
"#;

#[test]
fn a_fit_that_a_rotation_releases_is_refused() {
    for size in ["0.5", "0.25"] {
        let case = case(CORE, &[format!("body.ring.mesh.size={size}")]);
        let Err(problems) = Setup::new(&case).start() else { panic!("{size}") };
        let text = problems.to_string();
        assert!(text.contains("body \"ring\" turns by") && text.contains("saint-venant-kirchhoff"), "{text}");
        // Lamé: an interference of 1e-3 with E = 100, ν = 0.3, r = 1, 1.5, plane strain.
        for law in ["saint-venant-kirchhoff", "neo-hookean"] {
            let sets = [format!("material.rubber.law={law}"), format!("body.ring.mesh.size={size}")];
            let strain = simulation(CORE, &sets).state().ledger.strain;
            let (a2, b2) = (1.0, 2.25);
            let compliance = 1.3 / 100.0 * (a2 * 0.4 + b2) / (b2 - a2);
            let exact = std::f64::consts::PI * 1e-6 / compliance;
            assert!((strain / exact - 1.0).abs() < 0.02, "{law} {size}: {strain:e} {exact:e}");
        }
    }
}

/// A hub on a held shaft, 0.05 too wide for it, that yields and may turn.
const YIELDING: &str = r#"
dimension = 2
plane = "strain"
material = [{ name = "steel", law = "hencky", density = 7.8e-9, young = 200e3, poisson = 0.3, plastic = { yield = 120.0, hardening = 2000.0 } }]
[[body]]
name = "shaft"
material = "steel"
element = "T6"
mesh = { shape = "ring", inner = 20.0, outer = 50.05, center = [0.0, 0.0], size = 9.0 }
[[body]]
name = "hub"
material = "steel"
element = "T6"
mesh = { shape = "ring", inner = 50.0, outer = 80.0, center = [0.0, 0.0], size = 7.0 }
[[support]]
on = ["shaft.inner"]
fix = ["x", "y"]
[[contact]]
name = "fit"
secondary = "hub.inner"
primary = "shaft.outer"
overlap = "relax"
[time]
end = 1e-5
step = 1e-6
scheme = { kind = "chung-hulbert", rho_inf = 0.8 }
"#;

/// The pressure is between that at which a thick ring begins to yield and that at which all of it
/// has yielded: 2/√3 times the yield stress times (1 − a²/b²)/2, and times ln b/a.
#[test]
fn a_fit_that_yields_is_relaxed() {
    let shear = 120.0 / 3.0_f64.sqrt();
    let first = shear * (1.0 - (50.0_f64 / 80.0).powi(2));
    let whole = 2.0 * shear * (80.0_f64 / 50.0).ln();
    for tolerance in ["1e-9", "3e-9"] {
        let start = simulation(YIELDING, &[format!("newton.tolerance={tolerance}")]);
        let force: f64 = start.state().pairs[0].iter().map(|pair| pair.lambda).sum();
        let pressure = -force / (100.0 * std::f64::consts::PI);
        assert!(pressure > first && pressure < 1.02 * whole, "{tolerance}: {pressure}");
    }
}

/// A disc that is given twice: no node of either side is inside the other one, which is its twin.
#[test]
fn bodies_at_one_place() {
    let twice = DISCS.replace("center = [0.55, -0.1]", "center = [-0.55, 0.1]");
    let problems = Setup::new(&case(&twice, &[""; 0])).start().err().unwrap();
    assert!(problems[0].what.ends_with("overlap at the start"), "{problems:?}");
    assert!(problems[0].why.starts_with("both \"left\" and \"right\" are at"), "{problems:?}");
}

/// A ring of straight cells on a rigid core as wide as its hole, pressed from outside.
const SLEEVE: &str = r#"
dimension = 2
plane = "strain"
material = [{ name = "steel", law = "hencky", density = 1.0, young = 200e3, poisson = 0.3 }]
[[body]]
name = "ring"
material = "steel"
element = "T3"
mesh = { shape = "ring", inner = 50.0, outer = 80.0, center = [0.0, 0.0], size = 5.0 }
[[load]]
on = ["ring.outer"]
pressure = "40 * t"
[[contact]]
name = "fit"
secondary = "ring.inner"
primary = { circle = { center = [0.0, 0.0], radius = 50.0 } }
method = "mortar"
mu = 0.3
[time]
end = 1.0
step = 0.5
scheme = { kind = "static" }
[[probe]]
name = "rim"
body = "ring"
at = [80.0, 0.0]
record = ["ux"]
"#;

/// On average, chords whose nodes lie on an obstacle lie inside it.
#[test]
fn chords_in_a_circle_are_refused_or_touch() {
    let text = Setup::new(&case(SLEEVE, &[""; 0])).start().err().unwrap().to_string();
    // Two thirds of h²/8R of the facets, 64 of them around the hole.
    assert!(text.contains("overlap at the start by 0.0401"), "{text}");
    assert!(text.contains("on average") && text.contains("overlap = \"touch\""), "{text}");
    // Lamé: u = A r + B/r with u(50) = 0 and σ_r(80) = −40.
    let (young, poisson) = (200e3, 0.3);
    let (a2, b2): (f64, f64) = (2500.0, 6400.0);
    let stiffness = young / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let slope = -40.0 / (stiffness * (1.0 + (1.0 - 2.0 * poisson) * a2 / b2));
    let exact = slope * (80.0 - a2 / 80.0);
    for overlap in ["touch", "keep-gap"] {
        let end = finish(simulation(SLEEVE, &[format!("contact.fit.overlap={overlap}")]));
        let model = end.model();
        let node = (0..model.reference.len() / 2).find(|n| model.reference[2 * n..2 * n + 2] == [80.0, 0.0]);
        let found = end.state().y[2 * node.unwrap()] - 80.0;
        assert!((found / exact - 1.0).abs() < 0.01, "{overlap}: {found} {exact}");
    }
}

/// A block that reaches into a rigid plane by less than its single nodes may, or by more.
#[test]
fn mortar_contact_keeps_an_overlap_with_an_obstacle() {
    for depth in [0.001, 0.01, 0.05] {
        let block = format!(
            r#"
dimension = 2
material = [{{ name = "m", law = "hencky", density = 1.0, young = 1000.0, poisson = 0.3 }}]
body = [{{ name = "b", material = "m", element = "T6", mesh = {{ shape = "rectangle", min = [0.0, {:?}], max = [2.0, 1.0], cells = [4, 2] }} }}]
support = [{{ on = ["b.top"], fix = ["x", "y"] }}]
contact = [{{ name = "fit", secondary = "b.bottom", primary = {{ plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}, method = "mortar" }}]
[time]
end = 0.02
step = 1e-3
scheme = {{ kind = "chung-hulbert", rho_inf = 0.8 }}
"#,
            -depth
        );
        for overlap in ["keep-gap", "touch"] {
            for enforcement in ["multiplier", "penalty", "augmented"] {
                let sets = [
                    format!("contact.fit.overlap={overlap}"),
                    format!("contact.fit.enforcement={enforcement}"),
                ];
                let end = finish(simulation(&block, &sets));
                let moved = end.state().y.iter().zip(&end.model().reference).map(|(y, x)| (y - x).abs());
                let moved = moved.fold(0.0, f64::max);
                assert!(moved < 1e-13, "{depth} {overlap} {enforcement}: {moved:e}");
            }
        }
        // Relaxed, the block is as with rows for nodes: a plane of its own nodes.
        let [mean, nodes] = ["mortar", "node-to-segment"].map(|method| {
            let sets = ["contact.fit.overlap=relax".to_owned(), format!("contact.fit.method={method}")];
            simulation(&block, &sets).state().ledger.strain
        });
        assert!((mean / nodes - 1.0).abs() < 1e-3, "{depth}: {mean} {nodes}");
    }
}
