//! Every warning appears where it is due, and nowhere else; the numbers in them against runs and
//! closed formulas.

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

use carom_record::{Manifest, Source, Warning};
use carom_run::recording::run;
use carom_run::{GridReport, Setup, WARNINGS, warnings};

use super::common::{BAR, DISCS, case, finish, simulation};

const IMPACT: &str = include_str!("../../../../cases/impact/impact.toml");

/// A cantilever with L/h = 20 of n × 20 n square cells, loaded at its end.
const CANTILEVER: &str = r#"
dimension = 2
plane = "stress"
[[material]]
name = "steel"
law = "linear-elastic"
density = 1.0
young = 1e6
poisson = 0.0
[[body]]
name = "beam"
material = "steel"
element = "T3"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [20.0, 1.0], cells = [80, 4] }
[[support]]
on = ["beam.left"]
fix = ["x", "y"]
[[load]]
on = ["beam.right"]
traction = [0.0, -1e-3]
[time]
end = 1.0
step = 1.0
scheme = { kind = "static" }
"#;

/// A stretched bar whose free end may meet a wall.
const STRETCHED: &str = r#"
dimension = 1
[[material]]
name = "steel"
law = "linear-elastic"
density = 1.0
young = 100.0
poisson = 0.0
[[body]]
name = "bar"
material = "steel"
element = "L2"
mesh = { shape = "interval", min = 0.0, max = 1.0, cells = 10 }
mass = "redistributed"
position = ["1.01*X"]
[[support]]
on = ["bar.left"]
fix = ["x"]
[[contact]]
name = "wall"
secondary = "bar.right"
primary = { plane = { point = [2.0], normal = [-1.0] } }
[time]
end = 0.2
step = 1e-3
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
"#;

/// The warnings before a run: id, place and finding.
pub(super) fn found(text: &str, sets: &[&str]) -> Vec<(String, String)> {
    let case = case(text, sets);
    let given = warnings(&case, &Setup::new(&case).build().unwrap());
    given.into_iter().map(|w| (w.id, format!("{}: {}", w.place, w.what))).collect()
}

fn ids(text: &str, sets: &[&str]) -> Vec<String> {
    found(text, sets).into_iter().map(|(id, _)| id).collect()
}

/// The warnings in the manifest of a run, also in its log.
fn recorded_in_full(text: &str, sets: &[&str]) -> Vec<Warning> {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path().join("run");
    let source = Source { text: text.to_owned(), sets: Vec::new(), ..Source::default() };
    run(&case(text, sets), source, &directory, 1, &mut |_| {}, &AtomicBool::new(false)).unwrap();
    let warnings = Manifest::read(&directory).unwrap().warnings;
    let log = std::fs::read_to_string(directory.join("log.jsonl")).unwrap();
    assert_eq!(log.matches("\"kind\":\"warning\"").count(), warnings.len(), "{log}");
    warnings
}

pub(super) fn recorded(text: &str, sets: &[&str]) -> Vec<String> {
    recorded_in_full(text, sets).into_iter().map(|w| w.id).collect()
}

/// Springs under a block, whose facets are 0.25 long, let it sink by as much as they are soft: into
/// another block, and into a rigid floor.
#[test]
fn sides_deeper_than_a_fifth_of_a_facet() {
    const BLOCKS: &str = include_str!("../../../../cases/static/blocks.toml");
    const FLOOR: &str = "contact.joint.primary={ plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }";
    const PRESSED: [&str; 3] = [
        "time.step=0.05",
        "time.scheme={ kind = \"bathe\", rho_inf = 0.5 }",
        "contact.joint.enforcement=penalty",
    ];
    let mut given = Vec::new();
    for other in [&[][..], &[FLOOR]] {
        for stiffness in [0.01, 1.0] {
            let springs = format!("contact.joint.stiffness={stiffness}");
            let sets = [other, &PRESSED, &[&*springs]].concat();
            let mut simulation = simulation(BLOCKS, &sets);
            let mut deepest = 0.0_f64;
            while !simulation.finished() {
                deepest = deepest.max(simulation.step().unwrap().penetration.all);
            }
            let is_warned = recorded(BLOCKS, &sets).iter().any(|id| id == "deep-penetration");
            assert_eq!(is_warned, deepest > 0.05, "{sets:?}: {deepest}");
            given.push(is_warned);
        }
    }
    assert_eq!(given, [true, false, true, false]);
}

/// The bar lies inside a wall that is turned away from it, also if only its end touches the
/// surface.
#[test]
fn a_wall_that_is_turned_the_wrong_way() {
    let turned = "contact.wall.primary={ plane = { point = [1.01], normal = [1.0] } }";
    let given = found(STRETCHED, &[turned]);
    let of_wall = given.iter().find(|(id, _)| id == "inside-obstacle").map(|(_, what)| what.as_str());
    assert_eq!(of_wall, Some("contact \"wall\": 10 of 11 nodes of body \"bar\" are inside the obstacle"));
    assert!(!ids(STRETCHED, &[]).contains(&"inside-obstacle".to_owned()));
}

#[test]
fn ids_are_distinct() {
    assert_eq!(WARNINGS.iter().map(|entry| entry.id).collect::<BTreeSet<_>>().len(), WARNINGS.len());
}

#[test]
fn a_secondary_side_coarser_than_the_primary() {
    // T10: three intervals per facet. The cylinder's facets are about 0.1 long.
    let (id, what) = found(IMPACT, &["body.prism.mesh.cells=[32,16]"]).swap_remove(0);
    assert_eq!(id, "coarse-secondary");
    assert!(what.contains("contact \"strike\"") && what.contains("those of the primary 0.0104"), "{what}");
    assert!(!ids(IMPACT, &[]).contains(&id));
    // With `between` nobody chooses the sides: the first of two equal bodies is secondary.
    let all = DISCS.replace("secondary = \"left.arc\"\nprimary = \"right.arc\"", "between = \"all\"");
    let model = Setup::new(&case(&all, &["body.right.mesh.size=0.1"])).build().unwrap();
    let given = warnings(&case(&all, &["body.right.mesh.size=0.1"]), &model);
    let advice = &given.iter().find(|warning| warning.id == "coarse-secondary").unwrap().advice;
    assert!(
        advice.contains("a finer mesh of left") && advice.contains("secondary = \"right.SIDE\""),
        "{advice}"
    );
    // Quadratic facets of the same length have nodes further apart.
    assert!(ids(IMPACT, &["body.cylinder.element=T3"]).contains(&id));
}

#[test]
fn pressures_on_meshes_that_do_not_match() {
    let unmatched = "unmatched-pressure".to_owned();
    let at_b = found(IMPACT, &["probe.B.record=[\"uy\", \"sigma_yy\"]"]);
    assert!(at_b.iter().any(|(id, what)| *id == unmatched && what.contains("probe \"B\"")), "{at_b:?}");
    // It is given where the case asks for what is wrong.
    for unasked in ["probe.B.record=[\"uy\"]", "probe.B.at=[0.0, -0.3]"] {
        assert!(!ids(IMPACT, &[unasked]).contains(&unmatched), "{unasked}");
    }
    let asked = ["probe=[]", "expect=[{ what = \"pressure_max\", at_most = 1.0 }]"];
    let (_, what) = found(IMPACT, &asked).into_iter().find(|(id, _)| *id == unmatched).unwrap();
    assert!(what.ends_with("which affects the expected pressure_max"), "{what}");
    let blocks = |other: usize| {
        format!(
            r#"
dimension = 2
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
lambda = 1.0
mu = 1.0
[[body]]
name = "upper"
material = "rubber"
element = "T6"
mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [4, 4] }}
[[body]]
name = "lower"
material = "rubber"
element = "T6"
mesh = {{ shape = "rectangle", min = [0.0, -1.0], max = [1.0, 0.0], cells = [{other}, 4] }}
[[contact]]
name = "press"
secondary = "upper.bottom"
primary = "lower.top"
[[probe]]
name = "P"
body = "lower"
at = [0.5, -0.1]
record = ["von_mises"]
[time]
end = 1.0
step = 1.0
scheme = {{ kind = "static" }}
"#
        )
    };
    assert!(ids(&blocks(4), &[]).is_empty());
    assert_eq!(ids(&blocks(5), &[]), ["coarse-secondary".to_owned(), unmatched]);
}

/// Faces of 1/4 on faces of 1/4, 1/5 and, shifted by half a face, 1/4; the probe is near them.
#[test]
fn sides_in_space_are_compared_as_in_the_plane() {
    let blocks = |element: &str, cells: usize, shift: f64| {
        let box_of = |name: &str, [x0, x1, z0, z1]: [f64; 4], cells: usize| {
            format!(
                r#"
[[body]]
name = "{name}"
material = "rubber"
element = "{element}"
mesh = {{ shape = "box", min = [{x0}, 0.0, {z0}], max = [{x1}, 1.0, {z1}], cells = [{cells}, {cells}, 2] }}
"#
            )
        };
        format!(
            r#"
dimension = 3
material = [{{ name = "rubber", law = "neo-hookean", density = 1.0, lambda = 1.0, mu = 1.0 }}]
contact = [{{ name = "press", secondary = "upper.bottom", primary = "lower.top" }}]
probe = [{{ name = "P", body = "lower", at = [0.5, 0.5, -0.1], record = ["sigma_zz"] }}]
time = {{ end = 1.0, step = 1.0, scheme = {{ kind = "static" }} }}
{}{}"#,
            box_of("upper", [shift, 1.0 + shift, 0.0, 1.0], 4),
            box_of("lower", [0.0, 1.0, -1.0, 0.0], cells)
        )
    };
    let unmatched = "unmatched-pressure".to_owned();
    for element in ["Hex8", "Tet10"] {
        assert!(ids(&blocks(element, 4, 0.0), &[]).is_empty(), "{element}");
        let coarse = ids(&blocks(element, 5, 0.0), &[]);
        assert_eq!(coarse, ["coarse-secondary".to_owned(), unmatched.clone()], "{element}");
        assert_eq!(ids(&blocks(element, 4, 0.125), &[]), std::slice::from_ref(&unmatched), "{element}");
    }
}

#[test]
fn nearly_incompressible_t3() {
    let soft = "material.rubber.lambda=135.0"; // ν = 0.45: the bulk modulus is ten times μ
    let locking =
        |sets: &[&str]| found(IMPACT, sets).into_iter().filter(|(id, _)| id == "locking").collect::<Vec<_>>();
    let none: Vec<(String, String)> = Vec::new();
    assert_eq!(locking(&[]), none);
    assert_eq!(locking(&["body.prism.element=T3", soft]), none);
    assert_eq!(locking(&["body.prism.element=T3", "plane=stress"]), none);
    let rectangle = ["body.prism.element=Q4", "body.prism.volumetric=mean"];
    assert_eq!(locking(&rectangle[..1]).len(), 1);
    // What is advised is for the element of the body.
    let advice = |sets: &[&str]| {
        let case = case(IMPACT, sets);
        let given = warnings(&case, &Setup::new(&case).build().unwrap());
        given.into_iter().find(|warning| warning.id == "locking").unwrap().advice
    };
    assert_eq!(advice(&rectangle[..1]), "element = \"Q9\", or volumetric = \"mean\"");
    assert_eq!(advice(&["body.prism.element=T3"]), "element = \"T6\"");
    assert_eq!(locking(&rectangle), none);
    let found: Vec<(String, String)> = locking(&["body.prism.element=T3"]);
    assert!(
        found.len() == 1 && found[0].1.contains("\"prism\"") && found[0].1.contains("0.4651"),
        "{found:?}"
    );
}

/// The excess of stiffness that the warning states, against the deflection PL³/3EI of beam theory.
#[test]
fn triangles_of_constant_strain_in_bending() {
    let stated = |n: usize| {
        let cells = format!("body.beam.mesh.cells=[{}, {n}]", 20 * n);
        let warning = found(CANTILEVER, &[&cells]);
        let end = finish(simulation(CANTILEVER, &[&cells]));
        let tip = 20 * n;
        let deflection = -(end.state().y[2 * tip + 1] - end.model().reference[2 * tip + 1]);
        // P = 1e-3, I = 1/12.
        let exact = 1e-3 * 20.0_f64.powi(3) * 12.0 / (3.0 * 1e6);
        (warning, 100.0 * (exact / deflection - 1.0))
    };
    for (n, percent) in [(2, 75.0), (4, 18.8), (6, 8.33)] {
        let (warning, excess) = stated(n);
        let [(id, what)] = &warning[..] else { panic!("{warning:?}") };
        assert!(id == "stiff-bending" && what.contains(&format!("about {n} cells")), "{what}");
        let (before, _) = what.split_once(" %").unwrap();
        let number: f64 = before.rsplit(' ').next().unwrap().parse().unwrap();
        assert!((number - percent).abs() < 1e-2 * percent, "{what}: {percent}");
        assert!((excess - number).abs() < 0.12 * number, "{n}: {excess} against {number}");
    }
    let (warning, excess) = stated(8);
    assert!(warning.is_empty() && excess < 6.0, "{excess}: {warning:?}");
    assert!(found(CANTILEVER, &["body.beam.element=T6"]).is_empty());
    assert!(found(CANTILEVER, &["body.beam.mesh.max=[4.0, 1.0]"]).is_empty(), "it shears");
    let disc = "body.beam.mesh={ shape = \"half-disc\", radius = 1.0, center = [0.0, 0.0], size = 0.5 }";
    let free = ["support=[]", "load=[]", "time.scheme={ kind = \"hu\" }"];
    let sets: Vec<&str> = free.into_iter().chain([disc]).collect();
    assert!(found(CANTILEVER, &sets).is_empty(), "it is not slender");
}

/// Cells of four and of eight nodes, of any aspect, against beam theory.
#[test]
fn rectangles_in_bending() {
    let in_space: Vec<String> = [
        "dimension=3",
        "body.beam.mesh={ shape = \"box\", min = [0, 0, 0], max = [20, 1, 1], cells = [40, 2, 1] }",
        "support=[{ on = [\"beam.left\"], fix = [\"x\", \"y\", \"z\"] }]",
        "load=[{ on = [\"beam.right\"], traction = [0, -1e-3, 0] }]",
    ]
    .map(str::to_owned)
    .to_vec();
    let in_plane = |cells: [usize; 2], other: &[&str]| -> Vec<String> {
        let sets = [format!("body.beam.mesh.cells={cells:?}"), "body.beam.element=Q4".to_owned()];
        sets.into_iter().chain(other.iter().map(|set| (*set).to_owned())).collect()
    };
    let poisson = "material.steel.poisson=0.3";
    let of_solids = |element: &str| [in_space.clone(), vec![format!("body.beam.element={element}")]].concat();
    // Stiffness of plane strain: 1/(1 − ν²).
    let in_strain = |other: &[&str]| in_plane([20, 1], &[&["plane=strain", poisson], other].concat());
    let beams = [
        (in_plane([20, 1], &[]), 1.0),
        (in_plane([20, 2], &[]), 1.0),
        (in_plane([40, 2], &[poisson]), 1.0),
        (in_plane([60, 4], &[]), 1.0),
        (in_strain(&[]), 1.0 / 0.91),
        (in_plane([10, 1], &["plane=strain", poisson, "body.beam.volumetric=mean"]), 1.0 / 0.91),
        (of_solids("Hex8"), 1.0),
        (of_solids("Tet4"), 1.0),
    ];
    for (sets, stiffness) in beams {
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let is_solid = sets.contains(&"dimension=3");
        let text =
            if is_solid { CANTILEVER.replace("plane = \"stress\"\n", "") } else { CANTILEVER.to_owned() };
        let warning = found(&text, &sets);
        let end = finish(simulation(&text, &sets));
        let moved = end.state().y.iter().zip(&end.model().reference).map(|(y, x)| (y - x).abs());
        let exact = 1e-3 * 20.0_f64.powi(3) * 12.0 / (3.0 * 1e6 * stiffness);
        let excess = 100.0 * (exact / moved.fold(0.0, f64::max) - 1.0);
        let [(id, what)] = &warning[..] else { panic!("{sets:?}: {warning:?}") };
        let (before, _) = what.split_once(" %").unwrap();
        let number: f64 = before.rsplit(' ').next().unwrap().parse().unwrap();
        let agrees = if what.contains("more than") {
            excess > number
        } else {
            (excess - number).abs() < 0.12 * number
        };
        assert!(id == "stiff-bending" && agrees, "{what}: {excess}");
    }
    let fine = in_plane([120, 6], &[]);
    assert!(found(CANTILEVER, &fine.iter().map(String::as_str).collect::<Vec<_>>()).is_empty());
}

/// A bar that bounces for so long that 2 % of the time are longer than its flights.
#[test]
fn impacts_that_count_as_one() {
    let low = ["body.bar.gravity=[-1.0]", "time.step=0.02", "output.fields_every=0"];
    let with = |end: &str| {
        let sets: Vec<&str> = low.iter().copied().chain([end]).collect();
        recorded(BAR, &sets)
    };
    let merged = "merged-impacts".to_owned();
    assert!(!with("time.end=20.0").contains(&merged));
    assert!(with("time.end=140.0").contains(&merged));
}

/// A bar that bounces: flights of 2v/g between contacts of 2L/c = 0.67.
#[test]
fn an_impact_that_may_be_a_part() {
    let with = |gravity: &str| recorded(BAR, &[gravity, "output.fields_every=0"]);
    let split = "split-impact".to_owned();
    assert!(with("body.bar.gravity=[-5.0]").contains(&split));
    assert!(!with("body.bar.gravity=[-1.0]").contains(&split));
}

/// Newmark's method is stable for all steps if β ≥ γ/2 ≥ 1/4.
#[test]
fn steps_that_may_be_unstable() {
    let with = |beta: f64| {
        let scheme = format!("time.scheme={{ kind = \"newmark\", beta = {beta}, gamma = 0.5 }}");
        ids(BAR, &[&scheme])
    };
    let conditional = "conditional-stability".to_owned();
    assert!(with(0.1).contains(&conditional) && with(0.24).contains(&conditional));
    assert!(!with(0.25).contains(&conditional));
}

/// A contact that is shorter than a step is an impact, and is told.
#[test]
fn an_impact_within_a_step() {
    let text = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 1100.0, young = 5e6, poisson = 0.45 }]
[[body]]
name = "ball"
material = "rubber"
element = "T6"
mesh = { shape = "disc", radius = 0.03, center = [0.0, 0.0301], size = 0.006 }
velocity = [4.0, -3.0]
[[contact]]
name = "floor"
secondary = "ball.arc"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
mu = 0.1
[time]
end = 0.02
step = 5e-3
scheme = { kind = "chung-hulbert", rho_inf = 0.8 }
[output]
fields_every = 0
"#;
    let warnings = recorded_in_full(text, &[]);
    let told = warnings.iter().find(|warning| warning.id == "long-step").unwrap();
    assert!(told.what.contains("contact begins and ends within the step before t = 0.005"), "{}", told.what);
    assert!(!recorded(text, &["time.step=5e-5"]).contains(&"long-step".to_owned()));
}

/// The last cell relaxes in the first step: a tenth of the energy is gone, and no more later.
#[test]
fn a_strained_body_without_mass_at_its_contact() {
    let (id, what) = found(STRETCHED, &[]).swap_remove(0);
    assert!(id == "strained-massless" && what.contains("10.0 %"), "{id} {what}");
    assert!(ids(STRETCHED, &["body.bar.mass=consistent"]).is_empty());
    assert!(ids(STRETCHED, &["body.bar.position=[\"X\"]"]).is_empty());
    let energy = |sim: &carom_run::Simulation| sim.state().ledger.kinetic + sim.state().ledger.strain;
    let mut sim = simulation(STRETCHED, &["time.scheme.rho_inf=1.0"]);
    let start = energy(&sim);
    sim.step().unwrap();
    let lost = 1.0 - energy(&sim) / start;
    assert!((0.05..0.15).contains(&lost), "{lost}");
}

#[test]
fn one_node_that_carries_a_contact() {
    let id = "one-node".to_owned();
    // A hexagon falls on its lowest corner.
    let floor = "contact.strike.primary={ plane = { point = [0.0, -0.42], normal = [0.0, 1.0] } }";
    let coarse = [
        "body.left.element=T3",
        "body.left.mesh.size=0.5",
        "body.left.velocity=[0.0, -1.5]",
        floor,
        "time.end=0.05",
    ];
    assert!(recorded(DISCS, &coarse).contains(&id));
    assert!(!recorded(DISCS, &["time.end=0.2"]).contains(&id));
}

/// Discs that end before they meet, and contacts of one table of which one closes.
#[test]
fn contacts_that_never_close() {
    let id = "open-contact".to_owned();
    assert!(recorded(DISCS, &["time.end=0.002"]).contains(&id));
    assert!(!recorded(DISCS, &["time.end=0.2"]).contains(&id));
    let all = DISCS.replace("secondary = \"left.arc\"\nprimary = \"right.arc\"", "between = \"all\"");
    assert!(!recorded(&all, &["time.end=0.2"]).contains(&id));
}

/// Against the strain of the run: with u = 0.012 at E = 1000 the bar has its free length.
#[test]
fn bars_that_cannot_widen() {
    let pulled = |poisson: &str| {
        let sets = ["material.steel.young=1000.0", poisson, "body.bar.position=[\"X\"]", "contact=[]"];
        let load = "load=[{ on = [\"bar.right\"], traction = [12.0] }]";
        let still = [
            "body.bar.mass=consistent",
            "time.end=1.0",
            "time.step=1.0",
            "time.scheme={ kind = \"static\" }",
        ];
        let sets = [&sets[..], &[load], &still].concat();
        let end = finish(simulation(STRETCHED, &sets));
        let strain = end.state().y[10] - 1.0;
        let given: Vec<String> =
            found(STRETCHED, &sets).into_iter().map(|(id, what)| format!("{id}: {what}")).collect();
        (given, 12.0 / strain)
    };
    let (given, modulus) = pulled("material.steel.poisson=0.3");
    let stated = "its modulus is Λ + 2μ = 1346, 1.35 times Young's modulus 1000";
    assert_eq!(given, [format!("bar-modulus: body \"bar\": {stated}")]);
    assert!((modulus - 1346.15).abs() < 0.01, "{modulus}");
    let (given, modulus) = pulled("material.steel.poisson=0.0");
    assert!(given.is_empty() && (modulus - 1000.0).abs() < 1e-6, "{given:?} {modulus}");
    let yielding =
        ["material.steel.law=\"hencky\"", "material.steel.poisson=0.0", "material.steel.plastic.yield=1e6"];
    let given = found(STRETCHED, &yielding);
    assert!(
        given.iter().any(|(id, what)| *id == "bar-modulus" && what.contains("plastic flow")),
        "{given:?}"
    );
}

/// The warnings of linear elasticity of a free square of a law, from given positions on.
fn placed(law: &str, [x, y]: [&str; 2]) -> Vec<Warning> {
    let case = format!(
        r#"
dimension = 2
material = [{{ name = "soft", law = "{law}", density = 1.0, young = 1.0, poisson = 0.3 }}]
[[body]]
name = "block"
material = "soft"
element = "Q4"
mesh = {{ shape = "rectangle", min = [-0.5, -0.5], max = [0.5, 0.5], cells = [2, 2] }}
position = ["{x}", "{y}"]
[time]
end = 1e-3
step = 1e-3
scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }}
"#
    );
    let mut warnings = recorded_in_full(&case, &[]);
    warnings.retain(|warning| warning.id.starts_with("large-"));
    warnings
}

/// A square that is stretched along x by λ at its start: E₁₁ = (λ² − 1)/2, 0.105 at λ = 1.1.
#[test]
fn linear_elasticity_that_is_strained() {
    let given = placed("linear-elastic", ["1.1*X", "Y"]);
    let [warning] = &given[..] else { panic!("{given:?}") };
    let stated = "the strain reached 0.105 at t = 0";
    assert_eq!((warning.id.as_str(), warning.what.as_str()), ("large-strain", stated));
    assert!(placed("linear-elastic", ["1.04*X", "Y"]).is_empty());
    assert!(placed("neo-hookean", ["1.1*X", "Y"]).is_empty());
}

/// A square that is turned at its start, by an angle that the formulas give exactly.
#[test]
fn linear_elasticity_that_turns() {
    let turned = |angle: f64, law: &str| {
        let x = format!("X*cos({angle}) - Y*sin({angle})");
        placed(law, [&x, &format!("X*sin({angle}) + Y*cos({angle})")])
    };
    let given = turned(0.5, "linear-elastic");
    let [warning] = &given[..] else { panic!("{given:?}") };
    let stated = "a point turned by 0.500 rad at t = 0, which alone makes strains of cos θ − 1 = -0.122";
    assert_eq!((warning.id.as_str(), warning.what.as_str()), ("large-rotation", stated));
    assert!(turned(0.09, "linear-elastic").is_empty());
    assert!(turned(0.5, "neo-hookean").is_empty());
}

/// A rubber bar that is stretched by half under its load, by one step of static loading, and free
/// oscillations about it with a long step.
const PULLED: &str = r#"
dimension = 1
[[material]]
name = "rubber"
law = "neo-hookean"
density = 1.0
young = 100.0
poisson = 0.0
[[body]]
name = "bar"
material = "rubber"
element = "L2"
mesh = { shape = "interval", min = 0.0, max = 1.0, cells = 10 }
[[support]]
on = ["bar.left"]
fix = ["x"]
[[load]]
on = ["bar.right"]
traction = [40.0]
[time]
end = 1.0
step = 1.0
scheme = { kind = "static" }
"#;

#[test]
fn energy_that_load_steps_do_not_create() {
    assert!(recorded(PULLED, &[]).is_empty());
}

/// Waves in a bar that the step does not resolve: Hu's scheme takes them, a scheme that keeps
/// energy does not, and of backward Euler all know.
#[test]
fn energy_that_the_integrator_takes() {
    let id = "numerical-dissipation".to_owned();
    let of = |scheme: &str| recorded(BAR, &[&format!("time.scheme={scheme}")]).contains(&id);
    assert!(of("{ kind = \"hu\" }"));
    assert!(!of("{ kind = \"energy-momentum\" }"));
    assert!(!of("{ kind = \"backward-euler\" }"));
}

#[test]
fn energy_that_a_run_without_guard_creates() {
    let sets = [
        "time.scheme={ kind = \"newmark\", beta = 0.25, gamma = 0.5 }",
        "contact.strike.persistency=none",
        "body.cylinder.mesh.size=0.25",
        "body.prism.mesh.cells=[4,2]",
    ];
    let id = "energy-created".to_owned();
    // Later the motion that was created inverts a cell.
    let unguarded: Vec<&str> = sets.into_iter().chain(["time.energy_guard=false", "time.end=0.45"]).collect();
    assert!(recorded(IMPACT, &unguarded).contains(&id));
    assert!(!recorded(IMPACT, &sets[2..]).contains(&id));
}

/// A cube that slides: with the trapezoidal rule it hops, and friction takes what that creates.
#[test]
fn energy_that_friction_hides() {
    const CUBE: &str = include_str!("../../../../cases/friction/cube.toml");
    let short = ["body.cube.mesh.cells=[1,1]", "output.fields_every=0", "expect=[]"];
    let id = "hidden-energy".to_owned();
    let hops =
        ["time.scheme={ kind = \"newmark\", beta = 0.25, gamma = 0.5 }", "time.step=5e-4", "time.end=0.8"];
    let found = recorded(CUBE, &[&short[..], &hops].concat());
    assert!(found.contains(&id) && !found.contains(&"energy-created".to_owned()), "{found:?}");
    assert!(!recorded(CUBE, &[&short[..], &["time.end=0.4"]].concat()).contains(&id));
}

/// A square of two triangles without lateral strain, of which one corner is free: its triangle has
/// K = ¼ [3 −1; −1 3] (tangential, normal), so that pushed to the right it is singular for μ = 3.
const CORNER: &str = r#"
dimension = 2
[[material]]
name = "soft"
law = "linear-elastic"
density = 1.0
young = 1.0
poisson = 0.0
[[body]]
name = "block"
material = "soft"
element = "T3"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [1, 1] }
[[support]]
on = ["block.left", "block.top"]
fix = ["x", "y"]
[[contact]]
name = "bed"
secondary = "block.bottom"
primary = { plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }
mu = 2.9
[[load]]
body = "block"
body_force = ["3.1e-6*t", "-1e-6"]
[time]
end = 1.0
step = 0.5
scheme = { kind = "static" }
"#;

/// Beyond μ = 3 loads between 3 and μ times the pressure allow stick, slip and lift-off; a load
/// above μ has no way from stick but to lift off, which slip does not find.
#[test]
fn friction_beyond_the_singular_coefficient_is_said() {
    assert!(!recorded(CORNER, &["contact.bed.mu=2.9"]).contains(&"ambiguous-friction".to_owned()));
    let mut simulation = Setup::new(&case(CORNER, &["contact.bed.mu=3.05"])).start().unwrap();
    simulation.advance(&mut GridReport::default()).unwrap();
    let stopped = simulation.advance(&mut GridReport::default()).unwrap_err().to_string();
    assert!(stopped.contains("not unique (relative singular value -0.017"), "{stopped}");
}

/// A mass of one cell that sticks and slips: what vibrates where stick begins, and what damps it.
#[test]
fn stick_that_begins_in_vibrations() {
    const BELT: &str = include_str!("../../../../cases/friction/stick-slip.toml");
    let undamped = |sets: &[&str]| {
        let found = found(BELT, sets).into_iter().filter(|(id, _)| id == "undamped-stick");
        found.map(|(_, what)| what).collect::<Vec<_>>()
    };
    // Its only free nodes are those that stick.
    assert!(undamped(&[]).is_empty());
    let damped = "time.scheme={ kind = \"bathe\", rho_inf = 0.5 }";
    let pad = ["body.spring.mesh.cells=[2,1]"];
    let springs = [
        "contact.below.enforcement=penalty",
        "contact.below.stiffness=1e4",
        "contact.below.persistency=none",
    ];
    let unprojected = ["contact.below.persistency=none", "contact.above.persistency=none"];
    for (sets, count, what) in [
        (&pad[..], 2, "the bodies begin to vibrate"),
        (&springs, 1, "the springs of sticking nodes"),
        (&unprojected, 2, "turned round in every step"),
    ] {
        let said = undamped(sets);
        assert!(said.len() == count && said.iter().all(|said| said.contains(what)), "{sets:?}: {said:?}");
        assert!(undamped(&[sets, &[damped]].concat()).is_empty(), "{sets:?}");
        let equal = ["contact.below.mu_dynamic=0.4", "contact.above.mu_dynamic=0.4"];
        assert!(undamped(&[sets, &equal].concat()).is_empty(), "{sets:?}");
    }
}

/// Two squares with a common edge, or a common corner, or apart.
#[test]
fn bodies_that_touch_without_a_contact() {
    let text = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 1.0, lambda = 100.0, mu = 50.0 }]
[[body]]
name = "left"
material = "rubber"
element = "T6"
mesh = { shape = "rectangle", min = [0.0, 0.0], max = [0.1, 0.1], cells = [3, 3] }
[[body]]
name = "right"
material = "rubber"
element = "Q9"
mesh = { shape = "rectangle", min = [0.1, 0.0], max = [0.2, 0.1], cells = [3, 3] }
[time]
end = 1e-2
step = 1e-3
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
"#;
    let [(id, what)] = &found(text, &[])[..] else { panic!() };
    assert_eq!(id, "unconnected-bodies");
    assert!(what.contains("bodies \"left\" and \"right\": they have 3 edges in common"), "{what}");
    let declared = "contact=[{ name = \"joint\", secondary = \"left.right\", primary = \"right.left\" }]";
    for set in [
        declared,
        // They have a corner in common.
        "body.right.place.shift=[0.0, 0.1]",
        "body.right.place.shift=[1e-7, 0.0]",
        "body.right.mesh.cells=[3, 4]",
    ] {
        assert!(!ids(text, &[set]).contains(id), "{set}");
    }
    assert!(ids(text, &["body.right.place.shift=[1e-11, 0.0]"]).contains(id));
}

/// By the trapezoidal rule sin ωt has the integral (x cot x) of the exact one over each step, with
/// x = ωh/2: 0.877 for ωh = 1.2, 0.915 for 1. Steps in which it changes its sign count less: in 20
/// steps of ωh = 1.2 the exact integrals add up to 0.941 of that of |sin ωt|.
#[test]
fn loads_that_steps_do_not_resolve() {
    let found_in = |load: &str| {
        let load = format!("load=[{{ on = [\"bar.right\"], {load} }}]");
        let sets = ["body.bar.position=[\"X\"]", "time.step=1e-2", &load];
        let all = found(STRETCHED, &sets).into_iter();
        all.filter(|(id, _)| id == "unresolved-load").map(|(_, what)| what).collect::<Vec<_>>()
    };
    for resolved in ["traction = [2.0]", "traction = [\"sin(100*t)\"]", "traction = [\"if(t > 0.1, 1, 0)\"]"]
    {
        assert_eq!(found_in(resolved), [""; 0], "{resolved}");
    }
    let fast = found_in("traction = [\"sin(120*t)\"]");
    assert!(fast[0].contains(" by 11.6 % in total"), "{fast:?}");
    let blow = found_in("traction = [\"if(t > 0.052 && t < 0.058, 1, 0)\"]");
    assert!(blow[0].contains("by 100 % in total, most in the step that ends at t = 0.0600"), "{blow:?}");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("blow.csv");
    std::fs::write(&file, "t,value\n0,0\n0.05510,0\n0.05511,1\n0.05512,0\n1,0\n").unwrap();
    let blow = found_in(&format!("traction = [1.0], table = {:?}", file.display().to_string()));
    assert!(blow[0].contains("by 100 %"), "{blow:?}");
}
