//! Contact in space: an impact of slabs is the impact of the plane, forces and moments balance,
//! no direction is special, and the same bits come from every number of threads.

use super::common::{finish, on_threads, simulation};
use super::space::apart;
use carom_run::{GridReport, Simulation};

pub(crate) const IMPACT: &str = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]
body = [
    { name = "upper", material = "rubber", element = "Q9", mesh = { shape = "rectangle", min = [0.55, 0.01], max = [2.55, 1.01], cells = [3, 2] }, velocity = ["0.4", "-3 - 0.3*X"] },
    { name = "lower", material = "rubber", element = "Q9", mesh = { shape = "rectangle", min = [0.0, -1.0], max = [4.0, 0.0], cells = [5, 2] } },
]
support = [{ on = ["lower.bottom"], fix = ["x", "y"] }]
contact = [{ name = "strike", secondary = "upper.bottom", primary = "lower.top" }]
time = { scheme = { kind = "chung-hulbert", rho_inf = 0.8 }, step = 2e-3, end = 0.03 }
newton = { tolerance = 1e-12 }
"#;

/// Settings that make slabs of the bodies, with u_z = 0.
const SLABS: [&str; 7] = [
    "dimension=3",
    "body.upper.element=\"Hex27\"",
    "body.lower.element=\"Hex27\"",
    "body.upper.mesh={ shape = \"box\", min = [0.55, 0.01, 0.0], max = [2.55, 1.01, 0.5], cells = [3, 2, 1] }",
    "body.lower.mesh={ shape = \"box\", min = [0.0, -1.0, 0.0], max = [4.0, 0.0, 0.5], cells = [5, 2, 1] }",
    "body.upper.velocity=[\"0.4\", \"-3 - 0.3*X\", 0]",
    "support=[{ on = [\"lower.front\"], fix = [\"x\", \"y\"] }, { on = [\"lower.bottom\", \"lower.top\", \"upper.bottom\", \"upper.top\"], fix = [\"z\"] }]",
];

const SIDES: &str = "contact=[{ name = \"strike\", secondary = \"upper.front\", primary = \"lower.back\" }]";

pub(crate) fn slab(sets: &[&str]) -> Vec<String> {
    SLABS.iter().chain([&SIDES]).chain(sets).map(ToString::to_string).collect()
}

#[test]
fn an_impact_of_slabs_is_that_of_the_plane() {
    // A discrete gradient is corrected along the motion of all nodes of a facet, of which a slab
    // has more: to the order of the scheme.
    let schemes = [
        ("time.scheme={ kind = \"chung-hulbert\", rho_inf = 0.8 }", "neo-hookean", 1e-8),
        ("time.scheme={ kind = \"bathe\", rho_inf = 0.0 }", "neo-hookean", 1e-8),
        ("time.scheme={ kind = \"energy-momentum\" }", "saint-venant-kirchhoff", 1e-5),
    ];
    for (scheme, law, bound) in schemes {
        let law = format!("material.rubber.law=\"{law}\"");
        let sets = [scheme, &law];
        let (plane, space) = (finish(simulation(IMPACT, &sets)), finish(simulation(IMPACT, &slab(&sets))));
        assert!(plane.state().pairs[0].iter().any(|pair| pair.active), "{scheme}: no contact");
        let worst = apart(&plane, &space);
        assert!(worst < bound, "{scheme}: {worst:e}");
    }
}

pub(crate) const BALL: &str = r#"
dimension = 3
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, lambda = 200.0, mu = 15.0 }]
body = [
    { name = "ball", material = "rubber", element = "Tet10", mesh = { shape = "ball", radius = 0.5, center = [0.1, -0.05, 0.51], size = 0.5 }, velocity = { linear = [0.5, 0.2, -3.0], angular = [1.0, 2.0, 3.0], about = [0.1, -0.05, 0.51] } },
    { name = "block", material = "rubber", element = "Tet10", mesh = { shape = "box", min = [-1.0, -1.0, -0.5], max = [1.0, 1.0, 0.0], cells = [2, 2, 1] } },
]
support = []
contact = [{ name = "strike", secondary = "ball.sphere", primary = "block.top" }]
time = { scheme = { kind = "chung-hulbert", rho_inf = 0.8 }, step = 5e-3, end = 0.05 }
newton = { tolerance = 1e-12 }
"#;

/// Momentum and angular momentum.
pub(crate) fn momenta(sim: &Simulation) -> [f64; 6] {
    let (y, v) = (&sim.state().y, &sim.state().v);
    let mut p = vec![0.0; v.len()];
    sim.model().mass.multiply_into(v, &mut p);
    let pairs = y.as_chunks::<3>().0.iter().zip(p.as_chunks::<3>().0);
    pairs.fold([0.0; 6], |s, (y, p)| {
        let about = |i: usize| y[(i + 1) % 3] * p[(i + 2) % 3] - y[(i + 2) % 3] * p[(i + 1) % 3];
        std::array::from_fn(|i| s[i] + if i < 3 { p[i] } else { about(i - 3) })
    })
}

#[test]
fn two_free_bodies_exchange_momentum_and_keep_their_sum() {
    let set = [
        "time.scheme={ kind = \"energy-momentum\" }",
        "material.rubber.law=\"saint-venant-kirchhoff\"",
        "contact.strike.restitution=1.0",
    ];
    let start = simulation(BALL, &set);
    let (before, energy) = (momenta(&start), start.state().ledger.total());
    let end = finish(start);
    assert!(end.state().pairs[0].iter().any(|pair| pair.active));
    let after = momenta(&end);
    for (i, (a, b)) in before.iter().zip(&after).enumerate() {
        assert!((a - b).abs() < 1e-11, "{i}: {a} {b}");
    }
    let ledger = &end.state().ledger;
    let lost = energy + ledger.contact_work - ledger.total();
    assert!(lost.abs() < 1e-9 * energy, "{lost:e} of {energy}");
}

#[test]
fn a_turned_impact_is_the_same() {
    // 120° about the diagonal: x → y → z → x.
    let (_, worst) = turned_impact(&[], "axis = [1.0, 1.0, 1.0], angle = 120.0", |x| [x[2], x[0], x[1]]);
    assert!(worst < 1e-10, "{worst:e}");
}

/// An impact with these settings, and how far nodes of the turned impact are from their turned
/// places.
pub(crate) fn turned_impact(
    sets: &[String],
    rotation: &str,
    turned: impl Fn([f64; 3]) -> [f64; 3],
) -> (Simulation, f64) {
    let still = finish(simulation(BALL, sets));
    let vector = |x: [f64; 3]| format!("{:?}", turned(x));
    let mut other = sets.to_vec();
    other.extend(["ball", "block"].map(|body| format!("body.{body}.place={{ rotate = {{ {rotation} }} }}")));
    other.push(format!(
        "body.ball.velocity={{ linear = {}, angular = {}, about = {} }}",
        vector([0.5, 0.2, -3.0]),
        vector([1.0, 2.0, 3.0]),
        vector([0.1, -0.05, 0.51])
    ));
    let other = finish(simulation(BALL, &other));
    let pairs = still.state().y.as_chunks::<3>().0.iter().zip(other.state().y.as_chunks::<3>().0);
    let apart = |(here, there): (&[f64; 3], &[f64; 3])| {
        let expected = turned(*here);
        (0..3).map(|i| (expected[i] - there[i]).abs()).fold(0.0, f64::max)
    };
    let worst = pairs.map(apart).fold(0.0, f64::max);
    (still, worst)
}

#[test]
fn threads_change_no_bit_of_an_impact() {
    let [one, two] = [1, 2].map(|threads| finish(on_threads(BALL, &[] as &[&str], threads)));
    assert!(one.state().y == two.state().y && one.state().v == two.state().v);
}

/// A ball that hits a rigid plane, and the same plane as the facet of a rigid sphere of large
/// radius.
#[test]
fn a_rigid_sphere_of_large_radius_is_a_plane() {
    let rigid = |shape: &str| {
        [
            format!("contact=[{{ name = \"floor\", secondary = \"ball.sphere\", primary = {{ {shape} }} }}]"),
            "body.block.place={ shift = [0.0, 0.0, -5.0] }".to_owned(),
        ]
    };
    let plane =
        finish(simulation(BALL, &rigid("plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }")));
    assert!(plane.state().pairs[0].iter().filter(|pair| pair.active).count() > 3);
    let mut last = f64::INFINITY;
    for radius in [30.0, 100.0, 300.0] {
        let shape = format!("sphere = {{ center = [0.0, 0.0, -{radius:?}], radius = {radius:?} }}");
        let sphere = finish(simulation(BALL, &rigid(&shape)));
        let pairs = plane.state().y.iter().zip(&sphere.state().y);
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 0.5 * last && worst < 1.0 / radius, "{radius}: {worst:e}");
        last = worst;
    }
}

/// Two blocks that meet with whole skins, in a frame in which both move by two of their lengths in
/// a step: the impulse is the same, and no step is rejected.
#[test]
fn an_impact_is_the_same_in_a_fast_frame() {
    let text = r#"
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 200.0, poisson = 0.3 }]
contact = [{ name = "c", secondary = "a.skin", primary = "b.skin", mu = 0.3 }]
"#;
    let in_space = |[x, y, z]: [f64; 3]| {
        format!(
            r#"dimension = 3
body = [
    {{ name = "a", material = "m", element = "Hex8", mesh = {{ shape = "box", min = [-0.3, -0.2, 0.01], max = [0.3, 0.25, 0.4], cells = [3, 3, 2] }}, velocity = {{ linear = [{:?}, {:?}, {:?}], angular = [0.3, 2.0, 0.5], about = [0, 0, 0.2] }} }},
    {{ name = "b", material = "m", element = "Hex8", mesh = {{ shape = "box", min = [-0.6, -0.5, -0.4], max = [0.5, 0.5, 0.0], cells = [4, 4, 2] }}, velocity = [{x:?}, {y:?}, {z:?}] }},
]"#,
            x + 0.5,
            y + 0.1,
            z - 1.0
        )
    };
    let in_plane = |[x, y, _]: [f64; 3]| {
        format!(
            r#"dimension = 2
body = [
    {{ name = "a", material = "m", element = "Q4", mesh = {{ shape = "rectangle", min = [-0.3, 0.01], max = [0.3, 0.4], cells = [3, 2] }}, velocity = {{ linear = [{:?}, {:?}], angular = 2.0, about = [0, 0.2] }} }},
    {{ name = "b", material = "m", element = "Q4", mesh = {{ shape = "rectangle", min = [-0.6, -0.4], max = [0.5, 0.0], cells = [4, 2] }}, velocity = [{x:?}, {y:?}] }},
]"#,
            x + 0.5,
            y - 1.0
        )
    };
    let schemes = [
        r#"{ kind = "moreau-jean", theta = 0.5 }"#,
        r#"{ kind = "nonsmooth-generalized-alpha", rho_inf = 0.8 }"#,
        r#"{ kind = "chung-hulbert", rho_inf = 0.8 }"#,
    ];
    for scheme in schemes {
        let time = format!("[time]\nend = 0.045\nstep = 1e-3\nscheme = {scheme}\n");
        let impulse = |bodies: String| {
            let mut sim = simulation(&format!("{bodies}\n{text}{time}"), &[""; 0]);
            while !sim.finished() {
                let mut report = GridReport::default();
                sim.advance(&mut report).unwrap();
                assert_eq!(report.rejected, 0, "{scheme}");
            }
            sim.state().impulses[0]
        };
        let fast = [2000.0, 1000.0, -1400.0];
        for [at_rest, moved] in [[in_plane([0.0; 3]), in_plane(fast)], [in_space([0.0; 3]), in_space(fast)]] {
            let [at_rest, moved] = [at_rest, moved].map(impulse);
            let size = at_rest.iter().fold(0.0, |size, x| f64::hypot(size, *x));
            let error = at_rest.iter().zip(moved).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
            assert!(size > 1e-3 && error < 1e-6 * size, "{scheme}: {at_rest:?} {moved:?}");
        }
    }
}

/// A box falls on a corner of a softer block and dents it: the corner of the box presses on a face
/// whose normal there leans by 16° from that in its middle, and is let go and met again. It was
/// left to the edge of that face and sank in, and the run stopped.
#[test]
fn a_node_in_a_dented_face_is_met_again() {
    let text = r#"
dimension = 3
material = [
    { name = "hard", law = "neo-hookean", density = 1.0, young = 147.79, poisson = 0.3 },
    { name = "soft", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 },
]
support = [{ on = ["block.bottom"], fix = ["x", "y", "z"] }]
contact = [{ name = "c1", between = "all", self = false, mu = 1.0 }]
time = { end = 0.462, step = 0.0154, scheme = { kind = "newmark", beta = 0.25, gamma = 0.5 } }
[[body]]
name = "box"
material = "hard"
element = "Hex27"
mesh = { shape = "box", min = [-0.26377, -0.30441, -0.42471], max = [0.26377, 0.30441, 0.42471], cells = [1, 1, 2] }
place = { rotate = { axis = [0.76564, -0.54162, 0.34706], angle = 52.558 }, shift = [-0.042694, -0.040717, 0.59178] }
velocity = [-0.62661, 0.39633, -2.4835]
[[body]]
name = "block"
material = "soft"
element = "Hex27"
mesh = { shape = "box", min = [-0.5, -0.5, -0.5], max = [0.5, 0.5, 0.5], cells = [2, 2, 2] }
place = { shift = [-0.5, -0.5, -0.5] }
"#;
    let run = finish(simulation(text, &[""; 0]));
    // The box rises again.
    let rise = (0..45).map(|node| run.state().v[3 * node + 2]).sum::<f64>() / 45.0;
    assert!(rise > 0.5, "{rise}");
}

/// A box with edges of one cell falls almost flat on an edge of it, across the facets of a softer
/// table: its nodes dent the table, whose facets between them the edge crosses. It sank in by
/// 0.078, and the run stopped; points of edges may be 0.0067 deep, a fiftieth of a facet of the
/// table.
#[test]
fn an_edge_does_not_sink_into_the_facets_between_its_nodes() {
    let text = r#"
dimension = 3
material = [
    { name = "hard", law = "neo-hookean", density = 1.0, young = 452.45, poisson = 0.3 },
    { name = "soft", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 },
]
support = [{ on = ["table.bottom"], fix = ["x", "y", "z"] }]
contact = [{ name = "c1", between = "all", self = false }]
time = { end = 0.2625, step = 0.0175, scheme = { kind = "chung-hulbert", rho_inf = 0.5 } }
[[body]]
name = "box"
material = "hard"
element = "Hex27"
mesh = { shape = "box", min = [-0.35317, -0.38754, -0.32687], max = [0.35317, 0.38754, 0.32687], cells = [1, 1, 1] }
place = { rotate = { axis = [0.76802, 0.3106, 0.56006], angle = 61.399 }, shift = [-0.094135, -0.1745, 0.53838] }
velocity = [0.6878, 0.61054, -2.3897]
[[body]]
name = "table"
material = "soft"
element = "Hex8"
mesh = { shape = "box", min = [-1.0, -1.0, -0.25], max = [1.0, 1.0, 0.25], cells = [6, 6, 2] }
place = { shift = [0.0, 0.0, -0.25] }
"#;
    let mut sim = simulation(text, &[""; 0]);
    let mut deepest = 0.0_f64;
    while !sim.finished() {
        deepest = deepest.max(sim.step().unwrap().penetration.all);
    }
    assert!(deepest < 0.01, "{deepest}");
    // The box rises again.
    let rise = (0..27).map(|node| sim.state().v[3 * node + 2]).sum::<f64>() / 27.0;
    assert!(rise > 0.5, "{rise}");
}

/// A box falls on an edge of it onto a plate whose nodes lie below its own. Nodes in the plane of
/// symmetry slide along an edge of the plate's facets and past its end, where the surface turns by
/// 36°; one sank by a hundredth of a facet on the extension, and the run stopped.
#[test]
fn nodes_that_slide_along_a_joint_go_on_past_its_end() {
    let text = r#"
dimension = 3
material = [{ name = "rubber", law = "neo-hookean", density = 0.25, young = 60.0, poisson = 0.3 }]
support = [{ on = ["plate.bottom"], fix = ["x", "y", "z"] }]
contact = [{ name = "hit", secondary = "box.skin", primary = "plate.top", mu = 0.3 }]
time = { end = 0.12, step = 4e-3, scheme = { kind = "energy-momentum" } }
[[body]]
name = "box"
material = "rubber"
element = "Hex8"
mesh = { shape = "box", min = [-0.3, -0.3, -0.3], max = [0.3, 0.3, 0.3], cells = [4, 4, 4] }
place = { rotate = { axis = [0.0, 1.0, 0.0], angle = 45.0 }, shift = [0.0, 0.0, 0.5] }
velocity = [0.0, 0.0, -2.0]
gravity = [0.0, 0.0, -9.81]
[[body]]
name = "plate"
material = "rubber"
element = "Hex8"
mesh = { shape = "box", min = [-0.8, -0.8, -0.2], max = [0.8, 0.8, 0.0], cells = [8, 8, 2] }
"#;
    let run = finish(simulation(text, &[""; 0]));
    let mean = |i: usize| (0..125).map(|node| run.state().v[3 * node + i]).sum::<f64>() / 125.0;
    // In free fall it would be −3.2.
    assert!(mean(1).abs() < 1e-9 && mean(2) > -1.0, "{} {}", mean(1), mean(2));
}

/// A punch on a plate of oblong facets, and the same with x and y exchanged: which edge of a facet
/// comes first in its numbering does not matter.
#[test]
fn permitted_depths_do_not_depend_on_numbering() {
    let case = |[x, y]: [usize; 2]| {
        let triple = |values: [f64; 3]| format!("[{}, {}, {}]", values[x], values[y], values[2]);
        let cells = [3, 8, 2];
        let cells = format!("[{}, {}, 2]", cells[x], cells[y]);
        format!(
            r#"
dimension = 3
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }}]
[[body]]
name = "plate"
material = "m"
element = "Hex8"
mesh = {{ shape = "box", min = [-1.0, -1.0, -0.5], max = [1.0, 1.0, 0.0], cells = {cells} }}
[[body]]
name = "punch"
material = "m"
element = "Hex8"
mesh = {{ shape = "box", min = {}, max = {}, cells = [1, 1, 1] }}
[[support]]
on = ["plate.bottom"]
fix = ["x", "y", "z"]
[[support]]
on = ["punch.top"]
fix = ["x", "y"]
move = {{ z = "-0.1*t" }}
[[contact]]
name = "c"
secondary = "punch.bottom"
primary = "plate.top"
[time]
end = 1.0
step = 0.25
scheme = {{ kind = "static" }}
"#,
            triple([-0.3, -0.25, 0.01]),
            triple([0.3, 0.25, 0.31]),
        )
    };
    let force = |axes| finish(simulation(&case(axes), &[""; 0])).state().contact_forces[0][2];
    let [one, other] = [[0, 1], [1, 0]].map(force);
    assert!(one > 7.0 && (one / other - 1.0).abs() < 1e-10, "{one} {other}");
}

/// The facets of a coarse ball turn by 45° from one to the next, and still join smoothly: nodes
/// that slide over its joints go on with the next facet, and none sinks in.
#[test]
fn nodes_slide_over_the_joints_of_a_coarse_ball() {
    const STRUCK: &str = r#"
dimension = 3
[[material]]
name = "stone"
law = "neo-hookean"
density = 4.0
young = 1000.0
poisson = 0.3
[[material]]
name = "plate"
law = "neo-hookean"
density = 1.0
young = 423.54
poisson = 0.3
[[body]]
name = "stone"
material = "stone"
element = "Hex27"
mesh = { shape = "ball", radius = 0.18064, center = [0.0, 0.0, 0.0], size = 0.14202 }
place = { rotate = { axis = [-0.35107, -0.13897, -0.92598], angle = 123.31 }, shift = [0.25736, 0.48744, 0.19064] }
velocity = [0.30059, 0.58893, -2.3265]
mass = "lumped"
[[body]]
name = "plate"
material = "plate"
element = "Tet4"
mesh = { shape = "box", min = [-0.8, -0.8, -0.047206], max = [0.8, 0.8, 0.047206], cells = [6, 6, 1] }
place = { shift = [0.0, 0.0, -0.047206] }
mass = "lumped"
[[support]]
on = ["plate.left", "plate.right", "plate.front", "plate.back"]
fix = ["x", "y", "z"]
[[contact]]
name = "c"
between = "all"
self = false
[time]
end = 0.0295
step = 0.000295
scheme = { kind = "paoli-schatzman" }
"#;
    let mut sim = simulation(STRUCK, &[""; 0]);
    let mut deepest = 0.0_f64;
    while !sim.finished() {
        deepest = deepest.max(sim.step().unwrap().penetration.constrained);
    }
    assert!(deepest < 1.1e-7, "{deepest:e}");
}

/// A block that lands on a narrower pedestal and spreads: its nodes slide off the pedestal's edges,
/// whose nodes hold it from then on, though they are inside its facets by then.
const PEDESTAL: &str = r#"
dimension = 3
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 1000.0, poisson = 0.3 }]
body = [
    { name = "block", material = "m", element = "Hex8", mesh = { shape = "box", min = [-0.25, -0.25, 0.005], max = [0.25, 0.25, 0.255], cells = [4, 4, 2] }, velocity = [0, 0, -0.5] },
    { name = "pedestal", material = "m", element = "Hex8", mesh = { shape = "box", min = [-0.125, -0.125, -0.25], max = [0.125, 0.125, 0], cells = [2, 2, 2] } },
]
support = [{ on = ["pedestal.bottom"], fix = ["x", "y", "z"] }]
contact = [{ name = "c", secondary = "block.skin", primary = "pedestal.skin" }]
time = { scheme = { kind = "energy-momentum" }, step = 1e-3, end = 0.05 }
newton = { tolerance = 1e-11 }
"#;

#[test]
fn nodes_that_are_inside_when_their_pair_begins_are_not_pushed_out() {
    let mut sim = simulation(PEDESTAL, &[""; 0]);
    let mut report = GridReport::default();
    while !sim.finished() {
        sim.advance(&mut report).unwrap();
    }
    assert!(report.releases >= 8, "{} nodes slid off", report.releases);
    let ledger = &sim.state().ledger;
    let share = ledger.created() / ledger.scale();
    assert!(share < 1e-9, "{share:e} of the energy is created");
}

/// Two cubes whose sharp edges cross at their middle nodes: the pair of the edges goes on along one
/// that turns there. What its depth did would stop the run.
#[test]
fn edges_that_turn_where_a_pair_goes_on_create_no_energy() {
    let cubes = r#"
dimension = 3
material = [{ name = "m", law = "neo-hookean", density = 1.0, young = 1000.0, poisson = 0.3 }]
body = [
    { name = "cube", material = "m", element = "Tet10", mass = "lumped", mesh = { shape = "box", min = [-0.2, -0.2, -0.2], max = [0.2, 0.2, 0.2], cells = [2, 2, 2] }, place = { rotate = { axis = [1.0, 0.0, 0.0], angle = 45.0 }, shift = [0.0, 0.0, 0.287842712474619] }, velocity = [0, 0, -0.5] },
    { name = "base", material = "m", element = "Tet10", mass = "lumped", mesh = { shape = "box", min = [-0.2, -0.2, -0.2], max = [0.2, 0.2, 0.2], cells = [2, 2, 2] }, place = { rotate = { axis = [0.0, 1.0, 0.0], angle = 45.0 }, shift = [0.0, 0.0, -0.282842712474619] } },
]
support = [{ on = ["base.bottom"], fix = ["x", "y", "z"] }]
contact = [{ name = "c", secondary = "base.skin", primary = "cube.skin" }]
time = { scheme = { kind = "central-difference" }, step = 0.00055, end = 0.06985 }
"#;
    let sim = finish(simulation(cubes, &[""; 0]));
    let ledger = &sim.state().ledger;
    let share = ledger.created() / ledger.scale();
    assert!(share < 0.02, "{share:e} of the energy is created");
}

/// Two equal balls that meet node on node, where facets of a symmetric mesh turn by 22° across
/// edges and by 30° across the corner, leave along their line, and exchange their velocities.
#[test]
fn balls_that_meet_at_a_corner_of_facets_leave_along_their_line() {
    let case = |element: &str, size: f64, scheme: &str| {
        format!(
            r#"
            dimension = 3
            material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 5000.0, poisson = 0.3 }}]
            contact = [{{ name = "c", secondary = "a.sphere", primary = "b.sphere" }}]
            time = {{ end = 0.08, step = 2e-3, scheme = {scheme} }}
            [[body]]
            name = "a"
            material = "m"
            element = "{element}"
            mesh = {{ shape = "ball", radius = 0.5, center = [-1.004, 0.0, 0.0], size = {size} }}
            velocity = [2.0, 0.0, 0.0]
            [[body]]
            name = "b"
            material = "m"
            element = "{element}"
            mesh = {{ shape = "ball", radius = 0.5, center = [0.0, 0.0, 0.0], size = {size} }}
            "#
        )
    };
    let conserving = "{ kind = \"energy-momentum\" }";
    let impulses = "{ kind = \"moreau-jean\", theta = 0.5 }";
    for (element, size, scheme) in
        [("Hex8", 0.3, conserving), ("Hex8", 0.3, impulses), ("Tet4", 0.3, conserving)]
    {
        let end = finish(simulation(&case(element, size, scheme), &[""; 0]));
        let model = end.model();
        let mut momenta = vec![0.0; model.dofs()];
        model.mass.multiply_into(&end.state().v, &mut momenta);
        let nodes = model.parts[0].nodes();
        let [x, y, z] = [0, 1, 2].map(|i| nodes.clone().map(|node| momenta[3 * node + i]).sum::<f64>());
        assert!(x.abs() < 0.1, "{element}, {scheme}: {x}");
        assert!(y.abs() < 1e-12 && z.abs() < 1e-12, "{element}, {scheme}: {y} {z}");
    }
}
