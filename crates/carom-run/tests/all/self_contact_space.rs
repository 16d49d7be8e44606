//! In space: contact of a body with itself against the same contact of two bodies, and against half
//! of the body on a plane; continued from a state, bit for bit.

use std::path::Path;

use carom_run::case::Case;
use carom_run::{Setup, Simulation};

use super::common::continues_with_the_same_bits;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/space/");

fn simulation(case: &Case) -> Simulation {
    Setup::new(case).start().unwrap()
}

/// A box of hexahedra: name, corners, cells along the axes, and the angle by which it is turned
/// about an axis through its middle.
struct Block(&'static str, [f64; 3], [f64; 3], [usize; 3], usize, f64);

/// Two boxes in the format of Gmsh, each with a volume of its own and both with "both".
fn boxes(of: [Block; 2]) -> String {
    let (mut nodes, mut cells, mut names) = (Vec::new(), Vec::new(), vec!["3 9 \"both\"".to_owned()]);
    for (k, Block(name, low, high, [n, m, l], axis, angle)) in of.into_iter().enumerate() {
        let first = nodes.len() + 1;
        let all = (0..=n).flat_map(|i| (0..=m).flat_map(move |j| (0..=l).map(move |k| [i, j, k])));
        for index in all {
            let share = |i: usize| index[i] as f64 / [n, m, l][i] as f64;
            let mut x = [0, 1, 2].map(|i| (share(i) - 0.5) * (high[i] - low[i]));
            let (p, q) = ((axis + 1) % 3, (axis + 2) % 3);
            let (sine, cosine) = angle.to_radians().sin_cos();
            (x[p], x[q]) = (cosine * x[p] - sine * x[q], sine * x[p] + cosine * x[q]);
            let [x, y, z] = [0, 1, 2].map(|i| x[i] + 0.5 * (low[i] + high[i]));
            nodes.push(format!("{} {x} {y} {z}", nodes.len() + 1));
        }
        let at = |[i, j, k]: [usize; 3]| first + (i * (m + 1) + j) * (l + 1) + k;
        let all = (0..n).flat_map(|i| (0..m).flat_map(move |j| (0..l).map(move |k| [i, j, k])));
        for [i, j, k0] in all {
            let around = [[0, 0], [1, 0], [1, 1], [0, 1]];
            let layer =
                |dk: usize| around.map(|[di, dj]| at([i + di, j + dj, k0 + dk]).to_string()).join(" ");
            for tag in [k + 1, 9] {
                cells.push(format!("{} 5 2 {tag} {tag} {} {}", cells.len() + 1, layer(0), layer(1)));
            }
        }
        names.push(format!("3 {} \"{name}\"", k + 1));
    }
    let list = |name: &str, lines: Vec<String>| {
        format!("${name}\n{}\n{}\n$End{name}\n", lines.len(), lines.join("\n"))
    };
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n".to_owned()
        + &list("PhysicalNames", names)
        + &list("Nodes", nodes)
        + &list("Elements", cells)
}

/// The same two blocks as one body and as two: of these the second is the secondary.
fn one_and_two(mesh: &Path, velocity: &str, contact: &str, time: &str, law: &str) -> [Case; 2] {
    let body = |volume: &str| {
        format!(
            "[[body]]\nname = \"{volume}\"\nmaterial = \"m\"\nelement = \"Hex8\"\nvelocity = {velocity}\n\
             mesh = {{ file = '{}', volume = \"{volume}\" }}\n",
            mesh.display()
        )
    };
    let case = |bodies: String, between: &str| {
        let text = format!(
            "dimension = 3\n[[material]]\nname = \"m\"\nlaw = \"neo-hookean\"\ndensity = 1.0\n{law}\n\
             [[contact]]\nname = \"joint\"\n{between}\n{contact}\n[time]\n{time}\n{bodies}\n\
             # Tolerances are relative to the largest body: it is the same with one body and with two.\n\
             [[body]]\nname = \"other\"\nmaterial = \"m\"\nelement = \"Hex8\"\n\
             mesh = {{ shape = \"box\", min = [-10.0, 5.0, 0.0], max = [10.0, 6.0, 1.0], cells = [20, 1, 1] }}\n"
        );
        Case::from_text(&text, &[]).unwrap()
    };
    [
        case(body("both"), "between = [\"both\"]"),
        case(body("first") + &body("second"), "secondary = \"second.skin\"\nprimary = \"first.skin\""),
    ]
}

/// Runs both to the end, which must have the same positions.
fn same(cases: &[Case; 2], tolerance: f64) -> [Simulation; 2] {
    let mut met = 0;
    let mut both = cases.each_ref().map(simulation);
    while !both[0].finished() {
        let reports = both.each_mut().map(|simulation| simulation.step().unwrap());
        let [one, two] = &both;
        let active =
            |simulation: &Simulation| simulation.state().pairs[0].iter().filter(|p| p.active).count();
        met += active(one);
        assert_eq!(active(one), active(two), "{}", one.state().time);
        assert_eq!(reports[0].rejected, reports[1].rejected);
        let (a, b) = (&one.state().y, &two.state().y);
        assert_eq!(a.len(), b.len());
        let difference = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(difference < tolerance, "{}: {difference:e}", one.state().time);
    }
    assert!(met > 0);
    both
}

/// A block flies to a larger one, whose mesh does not match. The shortest facet, of which the nodes
/// of the first one may be a fiftieth deep, is one of the second.
fn blocks(folder: &Path) -> std::path::PathBuf {
    let first = Block("first", [-1.0, 0.0, 0.0], [0.0, 1.0, 1.0], [2, 3, 2], 0, 0.0);
    let second = Block("second", [0.02, -0.23, -0.31], [1.02, 1.2, 1.4], [2, 3, 6], 0, 0.0);
    let mesh = folder.join("blocks.msh");
    std::fs::write(&mesh, boxes([first, second])).unwrap();
    mesh
}

const SOFT: &str = "young = 1.0\npoisson = 0.0";
const TIME: &str = "end = 3.0\nstep = 0.05\nscheme = { kind = \"chung-hulbert\", rho_inf = 0.5 }";

#[test]
fn pieces_of_one_body_move_like_bodies() {
    let folder = tempfile::tempdir().unwrap();
    let velocity = "[\"if(X < 0.01, 0.1, 0)\", \"0\", \"0\"]";
    same(&one_and_two(&blocks(folder.path()), velocity, "", TIME, SOFT), 1e-12);
}

#[test]
#[ignore = "takes seconds: .ci/nightly"]
fn pieces_of_one_body_rub_like_bodies() {
    let folder = tempfile::tempdir().unwrap();
    let velocity =
        "[\"if(X < 0.01, 0.1, 0)\", \"if(X < 0.01, 0.06*(0.5 - Y), 0)\", \"if(X < 0.01, 0.03, 0)\"]";
    let cases = one_and_two(&blocks(folder.path()), velocity, "mu = 0.2", TIME, SOFT);
    // Slips are found to 1e-10.
    let [a, b] = same(&cases, 1e-10).map(|simulation| simulation.state().ledger.friction_work);
    assert!(a < -1e-5 && (a - b).abs() < 1e-12, "{a} {b}");
}

#[test]
fn edges_of_pieces_of_one_body_hold_like_those_of_bodies() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = folder.path().join("bars.msh");
    let below = Block("first", [-0.5, -0.1, -0.1], [0.5, 0.1, 0.1], [3, 1, 1], 0, 45.0);
    let above = Block("second", [-0.07, -0.48, 0.2], [0.13, 0.52, 0.4], [1, 3, 1], 1, 45.0);
    std::fs::write(&mesh, boxes([below, above])).unwrap();
    let velocity = "[\"0\", \"0\", \"if(Z > 0.1501, -0.1, 0)\"]";
    let time = "end = 0.6\nstep = 0.01\nscheme = { kind = \"chung-hulbert\", rho_inf = 0.5 }";
    let [one, _] = same(&one_and_two(&mesh, velocity, "", time, SOFT), 1e-12);
    assert!(one.state().pairs[0].iter().any(|pair| pair.node >= one.model().contacts[0].kinematics.nodes()));
}

/// A small block strikes the edge of a plate of one cell at a slant, fast enough to be past it
/// after a step: nothing penetrates at its ends. Off the middle of the cells, so that no two nodes
/// are equally deep.
#[test]
fn a_piece_that_would_pass_another_one_within_a_step_strikes_it() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = folder.path().join("plate.msh");
    let plate = Block("first", [-0.5, -0.02, 0.0], [0.5, 0.0, 0.4], [20, 1, 8], 0, 0.0);
    let small = Block("second", [-0.99, 0.48, 0.183], [-0.95, 0.52, 0.223], [2, 2, 2], 0, 0.0);
    std::fs::write(&mesh, boxes([plate, small])).unwrap();
    let velocity = "[\"if(Y > 0.4, 12, 0)\", \"if(Y > 0.4, -4, 0)\", \"0\"]";
    let time = "end = 0.2\nstep = 0.2\nscheme = { kind = \"chung-hulbert\", rho_inf = 0.5 }";
    let cases = one_and_two(&mesh, velocity, "", time, "young = 1e4\npoisson = 0.3");
    let mut both = cases.each_ref().map(simulation);
    let reports = both.each_mut().map(|simulation| simulation.step().unwrap());
    assert!(reports[0].rejected > 0, "no step was rejected");
    assert_eq!(reports[0].rejected, reports[1].rejected);
    let [one, two] = &both;
    let [a, b] = [one, two].map(|simulation| simulation.state().impulse());
    assert!(a[1].abs() > 1e-4, "{a:?}");
    let (y, z) = (&one.state().y, &two.state().y);
    let difference = y.iter().zip(z).map(|(y, z)| (y - z).abs()).fold(0.0, f64::max);
    assert!(difference < 1e-9, "{difference:e}; impulses {a:?} {b:?}");
}

#[test]
fn a_run_that_is_continued_from_its_state_is_the_same_with_other_threads() {
    let case = Case::from_file(format!("{ROOT}spring.toml"), &[]).unwrap();
    let mut whole = simulation(&case);
    while whole.state().time < 0.0999 {
        whole.step().unwrap();
    }
    continues_with_the_same_bits(&case, whole, 4);
}

/// A bar with a closed slit between planes of symmetry, in which its flanks end: with ν = 0 these
/// change nothing, and the flanks do not overlap while the pulse passes.
#[test]
fn a_slit_ends_in_planes_of_symmetry() {
    let path = Path::new(ROOT).join("slit.toml");
    let sets =
        ["support=[{ on = [\"bar.bottom\", \"bar.top\"], fix = [\"z\"] }]", "expect=[]", "time.end=4.0"];
    let case = Case::from_file(&path, &sets).unwrap();
    let mut sim = simulation(&case);
    while !sim.finished() {
        sim.step().unwrap();
    }
    let depths = carom_mechanics::penetration(sim.model(), sim.state());
    assert!(depths.all < 1e-7, "{depths:?}");
    let force = sim.state().pairs[0].iter().map(|pair| -pair.lambda).sum::<f64>();
    assert!(force > 1e-5, "{force}");
}
