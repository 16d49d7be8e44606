//! The plane is a slice of space in impacts of other geometries than two blocks: a ring on a block,
//! a corner on a block. Hexahedra of extruded Q9 meshes have the motion of the plane; tetrahedra of
//! extruded T6 meshes have it to their order, since they have more freedom across.

use carom_run::Simulation;
use carom_run::case::Case;

use super::common::{finish, simulation};
use super::space::{apart, distance};

/// A quarter of a ring, whose middle strikes.
const RING: &str = concat!(
    r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]
body = [
    { name = "upper", material = "rubber", element = "Q9", mesh = { file = ""#,
    env!("CARGO_MANIFEST_DIR"),
    r#"/../../cases/space/sector.msh", surface = "sector" }, place = { rotate = -135.0, shift = [0.1, 2.005] }, velocity = ["0.5", "-3 - 0.3*X"] },
    { name = "lower", material = "rubber", element = "Q9", mesh = { shape = "rectangle", min = [-2.0, -1.0], max = [2.2, 0.0], cells = [7, 2] } },
]
support = [{ on = ["lower.bottom"], fix = ["x", "y"] }]
contact = [{ name = "strike", secondary = "upper.outer", primary = "lower.top" }]
time = { scheme = { kind = "chung-hulbert", rho_inf = 0.8 }, step = 2e-3, end = 0.03 }
newton = { tolerance = 1e-12 }
"#
);

const DISC: &str = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]
body = [
    { name = "upper", material = "rubber", element = "T6", mesh = { shape = "disc", radius = 0.5, center = [0.1, 0.505], size = 0.1 }, velocity = ["0.5", "-3 - 0.3*X"] },
    { name = "lower", material = "rubber", element = "T6", mesh = { shape = "rectangle", min = [-1.0, -0.5], max = [1.2, 0.0], cells = [22, 6] } },
]
support = [{ on = ["lower.bottom"], fix = ["x", "y"] }]
contact = [{ name = "strike", secondary = "upper.arc", primary = "lower.top" }]
time = { scheme = { kind = "chung-hulbert", rho_inf = 0.8 }, step = 4e-3, end = 0.06 }
newton = { tolerance = 1e-12 }
"#;

/// The corner strikes between two nodes of the block. A node at the rim of the slab, on a sharp
/// edge, is not let into the other body at all, as that of the plane is by a fiftieth of a facet:
/// where the corner meets one, the slab differs from the plane.
const CORNER: &str = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]
body = [
    { name = "upper", material = "rubber", element = "Q9", mesh = { shape = "rectangle", min = [0.0, 0.0], max = [0.6, 0.5], cells = [2, 2] }, place = { rotate = 35.0, shift = [0.17, 0.005] }, velocity = ["0.5", "-3"] },
    { name = "lower", material = "rubber", element = "Q9", mesh = { shape = "rectangle", min = [-1.0, -0.5], max = [1.2, 0.0], cells = [7, 2] } },
]
support = [{ on = ["lower.bottom"], fix = ["x", "y"] }]
contact = [{ name = "strike", secondary = "upper.bottom", primary = "lower.top" }]
time = { scheme = { kind = "chung-hulbert", rho_inf = 0.8 }, step = 2e-3, end = 0.03 }
newton = { tolerance = 1e-12 }
"#;

/// Settings that extrude both bodies by more than a facet is long, so that permitted depths are
/// those of the plane, in one layer, with u_z = 0 at both ends.
fn extruded(text: &str, elements: &str, place: Option<&str>) -> Vec<String> {
    let shape = |body: &str| {
        let of = text.split(&format!("name = \"{body}\"")).nth(1).unwrap();
        let of = of.split("mesh = ").nth(1).unwrap().split_inclusive('}').next().unwrap();
        format!("body.{body}.mesh={{ shape = \"extrusion\", of = {of}, height = 0.75, layers = 1 }}")
    };
    let ends = |body: &str| {
        let [low, high] = if text != CORNER && body == "upper" { ["bottom", "top"] } else { ["base", "lid"] };
        format!("\"{body}.{low}\", \"{body}.{high}\"")
    };
    let velocity = text.split("velocity = [").nth(1).unwrap().split(']').next().unwrap();
    let mut sets = vec![
        "dimension=3".to_owned(),
        shape("upper"),
        shape("lower"),
        format!("body.upper.velocity=[{velocity}, \"0\"]"),
        format!(
            "support=[{{ on = [\"lower.bottom\"], fix = [\"x\", \"y\"] }}, {{ on = [{}, {}], fix = [\"z\"] }}]",
            ends("upper"),
            ends("lower")
        ),
    ];
    sets.extend(["upper", "lower"].map(|body| format!("body.{body}.element=\"{elements}\"")));
    sets.extend(place.map(|place| format!("body.upper.place={place}")));
    sets
}

#[test]
fn impacts_of_a_ring_and_of_a_corner_as_slabs_are_those_of_the_plane() {
    let turned = "{ rotate = { axis = [0.0, 0.0, 1.0], angle = 35.0 }, shift = [0.17, 0.005, 0.0] }";
    let down = "{ rotate = { axis = [0.0, 0.0, 1.0], angle = -135.0 }, shift = [0.1, 2.005, 0.0] }";
    for (text, place) in [(RING, Some(down)), (CORNER, Some(turned))] {
        for scheme in ["{ kind = \"chung-hulbert\", rho_inf = 0.8 }", "{ kind = \"bathe\", rho_inf = 0.0 }"] {
            let scheme = format!("time.scheme={scheme}");
            let mut sets = extruded(text, "Hex27", place);
            sets.push(scheme.clone());
            let (plane, space) = (finish(simulation(text, &[scheme])), finish(simulation(text, &sets)));
            assert!(plane.state().pairs[0].iter().any(|pair| pair.active), "{sets:?}: no contact");
            let worst = apart(&plane, &space);
            assert!(worst < 1e-8, "{sets:?}: {worst:e}");
        }
    }
}

/// A stiff block pressed into a soft one, with friction: nodes of the soft one's grooves have two
/// rows, of which one begins to pull while Newton's method iterates.
const PRESSED: &str = r#"
dimension = 2
material = [
    { name = "soft", law = "neo-hookean", density = 1.0, young = 1.0, poisson = 0.3 },
    { name = "stiff", law = "neo-hookean", density = 1.0, young = 30.0, poisson = 0.3 },
]
body = [
    { name = "upper", material = "stiff", element = "Q4", mesh = { shape = "rectangle", min = [-0.4, 1e-6], max = [0.0, 0.3], cells = [6, 3] } },
    { name = "lower", material = "soft", element = "Q4", mesh = { shape = "rectangle", min = [-0.8, -0.4], max = [0.8, 0.0], cells = [8, 3] } },
]
support = [{ on = ["lower.bottom"], fix = ["x", "y"] }, { on = ["upper.top"], move = { x = "0", y = "-0.06*t" } }]
contact = [{ name = "press", secondary = "upper.bottom", primary = "lower.top", mu = 0.1 }]
time = { scheme = { kind = "static" }, step = 0.05, end = 1.0 }
newton = { tolerance = 1e-12 }
"#;

#[test]
fn load_steps_of_a_slab_with_friction_in_grooves_are_those_of_the_plane() {
    let slab = |name: &str, of: &str| {
        format!("body.{name}.mesh={{ shape = \"extrusion\", of = {of}, height = 0.2, layers = 1 }}")
    };
    let rectangle = |min: &str, max: &str, cells: &str| {
        format!("{{ shape = \"rectangle\", min = {min}, max = {max}, cells = {cells} }}")
    };
    let sets = [
        "dimension=3".to_owned(),
        slab("upper", &rectangle("[-0.4, 1e-6]", "[0.0, 0.3]", "[6, 3]")),
        slab("lower", &rectangle("[-0.8, -0.4]", "[0.8, 0.0]", "[8, 3]")),
        "body.upper.element=\"Hex8\"".to_owned(),
        "body.lower.element=\"Hex8\"".to_owned(),
        "support=[{ on = [\"lower.bottom\"], fix = [\"x\", \"y\"] }, { on = [\"upper.top\"], move = { x = \"0\", y = \"-0.06*t\" } }, { on = [\"upper.base\", \"upper.lid\", \"lower.base\", \"lower.lid\"], fix = [\"z\"] }]".to_owned(),
    ];
    let [plane, space] = [&[][..], &sets[..]].map(|sets| finish(simulation(PRESSED, sets)));
    let worst = apart(&plane, &space);
    assert!(worst < 1e-10, "{worst:e}");
}

/// Tet10 cells of a mesh that is extruded have quadratic motions along diagonals, too: they are not
/// T6 cells, but both approach the same impact. Impulse and fall of the disc's centre; the depth of
/// the block below the disc, where single nodes press, is the same to 1 %.
#[test]
fn an_impact_of_tetrahedra_has_the_depth_and_the_impulse_of_the_plane() {
    let figures = |sim: &Simulation, d: usize| {
        let (model, y) = (sim.model(), &sim.state().y);
        let down = |node: usize| model.reference[d * node + 1] - y[d * node + 1];
        let is_centre = |node: &usize| {
            let x = &model.reference[d * node..d * node + 2];
            (x[0] - 0.1).hypot(x[1] - 0.505) < 1e-9
        };
        let centre = model.parts[0].nodes().find(is_centre).unwrap();
        let depth = model.parts[1].nodes().map(down).fold(0.0, f64::max);
        [sim.state().impulses[0][1] * if d == 2 { 0.75 } else { 1.0 }, down(centre), depth]
    };
    let plane = figures(&finish(simulation(DISC, &[] as &[&str])), 2);
    let solid = figures(&finish(simulation(DISC, &extruded(DISC, "Tet10", None))), 3);
    let apart: [f64; 3] = std::array::from_fn(|i| (solid[i] / plane[i] - 1.0).abs());
    assert!(apart[0] < 2e-3 && apart[1] < 2e-3 && apart[2] < 0.012, "{apart:?}");
}

/// A T6 cell extruded is three Tet10 cells. Linear motions are the same to round-off, others to the
/// order of the cells: both have errors of the order 3, and these differ.
#[test]
fn a_slab_of_tetrahedra_is_plane_strain_to_the_order_of_the_cells() {
    let text = |scheme: &str, motion: &str, support: &str, cells: usize| {
        format!(
            r#"
dimension = 2
material = [{{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 20.0, mu = 15.0 }}]
body = [{{ name = "upper", material = "rubber", element = "T6", mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 1.0], cells = [{cells}, {cells}] }}, velocity = {motion} }}]
support = [{{ on = ["upper.left", "upper.right", "upper.bottom", "upper.top"], {support} }}]
time = {{ scheme = {{ {scheme} }}, step = 5e-3, end = 0.05 }}
newton = {{ tolerance = 1e-12 }}
"#
        )
    };
    let both = |scheme: &str, motion: &str, support: &str, cells: usize| {
        let text = text(scheme, motion, support, cells);
        let mesh = text.split("mesh = ").nth(1).unwrap().split_inclusive('}').next().unwrap();
        let sets = [
            "dimension=3".to_owned(),
            "body.upper.element=\"Tet10\"".to_owned(),
            format!(
                "body.upper.mesh={{ shape = \"extrusion\", of = {mesh}, height = {:?}, layers = 1 }}",
                1.0 / cells as f64
            ),
            format!("body.upper.velocity={}, \"0\"]", motion.trim_end_matches(']')),
            format!(
                "support=[{{ on = [\"upper.left\", \"upper.right\", \"upper.bottom\", \"upper.top\"], {support} }}, \
                 {{ on = [\"upper.base\", \"upper.lid\"], fix = [\"z\"] }}]"
            ),
        ];
        let (plane, space) = (finish(simulation(&text, &[] as &[&str])), finish(simulation(&text, &sets)));
        // The faces across have nodes of their own.
        let (worst, seen) = distance(&plane, &space);
        assert!(seen >= plane.model().reference.len(), "{seen}");
        worst
    };
    let moved = "move = { x = \"4*t*X + 2*t*Y\", y = \"t*X - 3*t*Y\" }";
    let affine = both("kind = \"static\"", "[\"0\", \"0\"]", moved, 2);
    assert!(affine < 1e-12, "{affine:e}");
    let start = "[\"sin(pi*X)*sin(pi*Y)\", \"0.5*sin(pi*X)*sin(2*pi*Y)\"]";
    let dynamic =
        |cells| both("kind = \"chung-hulbert\", rho_inf = 0.8", start, "fix = [\"x\", \"y\"]", cells);
    let [coarse, fine] = [4, 8].map(dynamic);
    assert!((coarse / fine).log2() > 2.5, "{coarse:e} {fine:e}");
}

/// Planes of symmetry cut an extrusion: what is left of it, held on them, moves like the whole.
#[test]
fn a_part_of_an_extrusion_moves_like_the_whole() {
    let text = |of: &str, symmetry: &str, support: &str| {
        format!(
            r#"
dimension = 3
material = [{{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }}]
body = [{{ name = "part", material = "rubber", element = "Hex8", mesh = {{ shape = "extrusion", of = {of}, height = 0.5, layers = 2{symmetry} }}, velocity = ["X", "-0.5*Y", "2*(Z - 0.25)"] }}]
{support}
time = {{ scheme = {{ kind = "chung-hulbert", rho_inf = 0.8 }}, step = 2e-3, end = 0.02 }}
newton = {{ tolerance = 1e-12 }}
"#
        )
    };
    let plane = "{ shape = \"rectangle\", min = [-0.6, -0.4], max = [0.6, 0.4], cells = CELLS }";
    let run = |cells: &str, layers: &str, symmetry: &str, support: &str| {
        let text = text(&plane.replace("CELLS", cells), symmetry, support);
        finish(simulation(&text, &[format!("body.part.mesh.layers={layers}")]))
    };
    let whole = run("[4, 4]", "4", "", "");
    let part = run(
        "[2, 2]",
        "2",
        ", symmetry = [\"x\", \"y\", \"z\"]",
        "support = [{ on = [\"part.plane_x\"], fix = [\"x\"] }, { on = [\"part.plane_y\"], fix = [\"y\"] }, \
         { on = [\"part.plane_z\"], fix = [\"z\"] }]",
    );
    let of = |sim: &Simulation| {
        let places = sim.model().reference.as_chunks::<3>().0.iter().copied();
        places.zip(sim.state().y.as_chunks::<3>().0.iter().copied()).collect::<Vec<_>>()
    };
    let (all, own) = (of(&whole), of(&part));
    assert_eq!(own.len(), 27);
    for (x, y) in own {
        let near = |(other, _): &&([f64; 3], [f64; 3])| (0..3).all(|i| (other[i] - x[i]).abs() < 1e-12);
        let z = all.iter().find(near).unwrap().1;
        assert!((0..3).all(|i| (y[i] - z[i]).abs() < 1e-10), "{y:?} {z:?}");
    }
    // By their size, and a disc.
    let disc = "{ shape = \"disc\", radius = 0.5, center = [0.0, 0.0], size = 0.2 }";
    let mesh = |of: &str, symmetry: &str| {
        let text = text(of, symmetry, "").replace("Hex8", "Tet4");
        let case = Case::from_text(&text, &[] as &[&str]);
        case.map(|case| case.bodies[0].make_mesh(3).unwrap())
    };
    let half = mesh(disc, ", symmetry = [\"x\"]").unwrap();
    let sides: Vec<&str> = half.sides.keys().map(String::as_str).collect();
    assert_eq!(sides, ["arc", "bottom", "plane_x", "top"]);
    assert!(half.nodes.iter().all(|x| x[0] >= 0.0) && half.nodes.iter().any(|x| x[2] == 0.0));
    let sized = plane.replace("cells = CELLS", "size = 0.2");
    let half = mesh(&sized, ", symmetry = [\"y\"]").unwrap();
    assert_eq!(half.nodes.len(), 7 * 3 * 3);
    assert!(half.sides.contains_key("plane_y") && half.sides.contains_key("base"));
    let ring = "{ shape = \"ring\", inner = 0.4, outer = 0.5, center = [0.0, 0.0], size = 0.1 }";
    let problem = mesh(ring, ", symmetry = [\"y\"]").err().unwrap().to_string();
    assert!(problem.contains("is not cut by that plane"), "{problem}");
}
