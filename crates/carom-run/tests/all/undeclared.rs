//! Bodies that meet although no contact is declared where they do: seen before the run and after.

use super::common::DISCS;
use super::warnings::{found, recorded};

/// Bodies of a case without any contact, too: what is expected, and what happened.
#[test]
fn bodies_that_overlap_without_a_contact() {
    assert_eq!(recorded(DISCS, &["contact=[]", "time.end=0.1"]), ["undeclared-contact"; 2]);
}

/// Three discs of radius ½: the one on the right flies at that on the left; the third is above.
const THREE: &str = r#"
dimension = 2
material = [{ name = "rubber", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }]
body = [
    { name = "left", material = "rubber", element = "T6", mesh = { shape = "disc", radius = 0.5, center = [0.0, 0.0], size = 0.25 } },
    { name = "right", material = "rubber", element = "T6", mesh = { shape = "disc", radius = 0.5, center = [2.0, 0.0], size = 0.25 }, velocity = [-1.0, 0.0] },
    { name = "above", material = "rubber", element = "T6", mesh = { shape = "disc", radius = 0.5, center = [0.0, 5.0], size = 0.25 } },
]
[[contact]]
name = "pair"
secondary = "left.arc"
primary = "above.arc"
[time]
end = 4.0
step = 0.01
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
"#;

#[test]
fn bodies_that_fly_at_each_other_without_a_contact() {
    let id = "undeclared-contact".to_owned();
    let meets = |sets: &[&str]| found(THREE, sets).into_iter().find(|(found, _)| *found == id);
    // They are 1 apart. Extents along 16 directions are those of the discs.
    let what = meets(&[]).unwrap().1;
    assert_eq!(what, "bodies \"left\" and \"right\": as they move at the start, they meet at t = 1.00");
    assert!(meets(&["time.end=0.9"]).is_none());
    assert!(meets(&["body.right.velocity=[-1.0, 0.9]"]).is_none());
    assert!(meets(&["body.left.velocity=[-1.0, 0.0]"]).is_none());
    assert!(meets(&["contact.pair.primary=right.arc"]).is_none());
    // Falling from 5: the gap of 4 takes √(8/g).
    let falls = ["contact=[]", "body.above.gravity=[0.0, -8.0]", "body.right.velocity=[0.0, 0.0]"];
    assert!(
        meets(&falls)
            .unwrap()
            .1
            .contains("bodies \"left\" and \"above\": as they move at the start, they meet at t = 1.00")
    );
    // What a declared contact does to a body is not known: with the third disc, or with a wall.
    let thrown = ["body.above.mesh.center=[1.0, 5.0]", "body.above.velocity=[0.0, -5.0]"];
    let middle = "contact.pair.secondary=right.arc";
    assert!(meets(&[&thrown[..], &[middle, "body.left.mesh.center=[-3.0, 0.0]"]].concat()).is_none());
    let wall = "contact.pair.primary={ plane = { point = [1.4, 0.0], normal = [1.0, 0.0] } }";
    assert!(meets(&[middle, wall]).is_none());
    assert!(meets(&[middle, &wall.replace("1.4", "-4.0")]).is_some());
}

/// Two blocks of which the right one flies at the left one; the contact names their far sides.
const FAR_SIDES: &str = r#"
dimension = 2
material = [{ name = "pu", law = "neo-hookean", density = 1000.0, young = 1e6, poisson = 0.3 }]
body = [
    { name = "a", material = "pu", element = "Q4", mesh = { shape = "rectangle", min = [0.0, 0.0], max = [0.1, 0.1], cells = [4, 4] } },
    { name = "b", material = "pu", element = "Q4", mesh = { shape = "rectangle", min = [0.11, 0.0], max = [0.2, 0.1], cells = [4, 4] }, velocity = [-1.0, 0.0] },
]
[[contact]]
name = "c"
secondary = "a.left"
primary = "b.right"
[time]
end = 0.05
step = 1e-3
scheme = { kind = "chung-hulbert", rho_inf = 0.5 }
"#;

fn findings(sets: &[&str]) -> Vec<String> {
    found(FAR_SIDES, sets).into_iter().map(|(_, what)| what).collect()
}

/// The warnings after a run, but that the long step takes energy.
fn of_contact(sets: &[&str]) -> Vec<String> {
    recorded(FAR_SIDES, sets).into_iter().filter(|id| id != "numerical-dissipation").collect()
}

#[test]
fn bodies_that_meet_where_their_contact_does_not_act() {
    // They are 0.01 apart; such a node is seen a tenth of a facet, 2.5e-3, deep at t = 0.0125.
    let what = findings(&[]).swap_remove(0);
    let rest = what.strip_prefix("bodies \"a\" and \"b\": as they move at the start, they meet at t = ");
    let (time, elsewhere) = rest.unwrap().split_once(", elsewhere than where ").unwrap();
    assert!((0.0125..0.0135).contains(&time.parse().unwrap()), "{what}");
    assert_eq!(elsewhere, "\"c\" acts between a.left and b.right");
    // Before the run, and after it, when the contact has not closed.
    assert_eq!(of_contact(&[]), ["undeclared-contact", "open-contact", "undeclared-contact"]);
    // The sides that meet, in either order, or all of them.
    let right = ["contact.c.secondary=a.right", "contact.c.primary=b.left"];
    let swapped = ["contact.c.secondary=b.left", "contact.c.primary=a.right"];
    for sets in [right, swapped, ["contact.c.secondary=a.skin", "contact.c.primary=b.skin"]] {
        assert!(of_contact(&sets).is_empty(), "{sets:?}");
    }
    // Faster, the far sides meet each other's bodies, and the run stops there.
    assert_eq!(of_contact(&["body.b.velocity=[-3.0, 0.0]"]), ["undeclared-contact"; 2]);
}

#[test]
fn a_body_that_falls_into_an_obstacle_beside_the_side_of_its_contact() {
    let floor = |side: &str| {
        let secondary = format!("contact.c.secondary=b.{side}");
        let sets = [
            secondary.as_str(),
            "contact.c.primary={ plane = { point = [0.0, -0.01], normal = [0.0, 1.0] } }",
            "body.b.velocity=[0.0, -1.0]",
            "time.end=0.04",
        ];
        (findings(&sets), of_contact(&sets))
    };
    let (before, after) = floor("top");
    let [what] = &before[..] else { panic!("{before:?}") };
    let start = "body \"b\": as it moves at the start, it meets the obstacle of contact \"c\" at t = 0.0";
    assert!(what.starts_with(start) && what.ends_with("\"c\" acts on b.top"), "{what}");
    assert_eq!(after, ["undeclared-contact", "open-contact", "undeclared-contact"]);
    assert_eq!(floor("bottom"), (Vec::new(), Vec::new()));
    // A side that reaches the floor with its corners.
    assert_eq!(floor("left").0, Vec::<String>::new());
}

/// The right half of a ring of 24 × 1 quadrilaterals, with the radii 0.9 and 1, as a file of Gmsh.
fn half_ring() -> String {
    const AROUND: usize = 24;
    let place = |node: usize| {
        let angle = std::f64::consts::PI * ((node / 2) as f64 / AROUND as f64 - 0.5);
        let radius = [0.9, 1.0][node % 2];
        format!("{} {:?} {:?} 0\n", node + 1, radius * angle.cos(), radius * angle.sin())
    };
    let nodes: String = (0..2 * (AROUND + 1)).map(place).collect();
    // Type, physical group and nodes: `inner`, `outer`, `start`, `end` and the cells.
    let along = |k: usize| {
        let [a, b] = [2 * k + 1, 2 * k + 3];
        let cell = format!("3 2 5 5 {a} {} {} {b}", a + 1, b + 1);
        [format!("1 2 1 1 {a} {b}"), format!("1 2 2 2 {} {}", a + 1, b + 1), cell]
    };
    let ends = ["1 2 3 3 1 2".to_owned(), format!("1 2 4 4 {} {}", 2 * AROUND + 1, 2 * AROUND + 2)];
    let elements: Vec<String> = (0..AROUND).flat_map(along).chain(ends).collect();
    let numbered: Vec<String> =
        elements.iter().enumerate().map(|(k, of)| format!("{} {of}\n", k + 1)).collect();
    let numbered = numbered.concat();
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n1 1 \"inner\"\n1 2 \"outer\"\n1 3 \"start\"\n1 4 \"end\"\n2 5 \"ring\"\n$EndPhysicalNames\n$Nodes\n{}\n{nodes}$EndNodes\n$Elements\n{}\n{numbered}$EndElements\n",
        2 * (AROUND + 1),
        elements.len()
    )
}

/// Half of a ring collapses until its ends touch, on its axis of symmetry and with their corners:
/// chords of neighbouring facets cross there by round-off. Without its contact they go on.
#[test]
fn a_ring_whose_contact_keeps_it_apart_does_not_cross_itself() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = folder.path().join("ring.msh");
    std::fs::write(&mesh, half_ring()).unwrap();
    let ring = format!(
        r#"
dimension = 2
material = [{{ name = "m", law = "saint-venant-kirchhoff", density = 1e-3, young = 1e6, poisson = 0.0 }}]
body = [{{ name = "ring", material = "m", element = "Q4", mesh = {{ file = {:?}, surface = "ring" }} }}]
support = [{{ on = ["ring.start", "ring.end"], fix = ["x"] }}]
load = [{{ on = ["ring.outer"], pressure = "4000*t*(1 + 0.3*Y^2)" }}]
contact = [{{ name = "fold", secondary = "ring.inner", primary = "ring.inner" }}]
time = {{ end = 0.3, step = 0.01, scheme = {{ kind = "backward-euler" }} }}
"#,
        mesh.display().to_string()
    );
    let crosses = |sets: &[&str]| recorded(&ring, sets).contains(&"undeclared-contact".to_owned());
    assert!(!crosses(&[]));
    assert!(crosses(&["contact=[]"]));
}

/// A cuboid on a rigid box of half its width: the edges of the box lie between nodes, a fortieth of
/// a facet beside a line of them, or just past it.
fn on_a_box(half_width: f64) -> String {
    let corner = |k: usize| [0, 1, 2].map(|i| if k >> i & 1 == 1 { 1.0 } else { -1.0 });
    let point = |k: usize| {
        let [x, y, z] = corner(k);
        format!("{} {} {}", half_width * x, -0.25 + 0.25 * y, z)
    };
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let facet = |nodes: [usize; 3]| {
        let vertices: Vec<String> = nodes.iter().map(|&k| format!("vertex {}", point(k))).collect();
        format!("facet normal 0 0 0\nouter loop\n{}\nendloop\nendfacet\n", vertices.join("\n"))
    };
    format!("solid box\n{}endsolid box\n", triangles.map(facet).collect::<String>())
}

#[test]
fn an_edge_of_a_rigid_surface_between_nodes_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let surface = |half_width: f64| {
        let path = folder.path().join(format!("box-{half_width}.stl"));
        std::fs::write(&path, on_a_box(half_width)).unwrap();
        format!(
            "contact=[{{ name = \"c\", secondary = \"block.skin\", primary = {{ surface = {{ file = \"{}\" }} }} }}]",
            path.display()
        )
    };
    let case = r#"
dimension = 3
material = [{ name = "rubber", law = "neo-hookean", density = 1.5, young = 2000.0, poisson = 0.25 }]
body = [{ name = "block", material = "rubber", element = "Hex8", mesh = { shape = "box", min = [-0.5, 0.0, -0.5], max = [0.5, 0.25, 0.5], cells = [4, 1, 4] } }]
support = [{ name = "top", on = ["block.back"], fix = ["x", "z"], move = { y = "-0.005*t" } }]
contact = []
time = { end = 1.0, step = 0.25, scheme = { kind = "static" } }
"#;
    let given = |half_width: f64| recorded(case, &[&surface(half_width)]);
    let id = "edge-between-nodes".to_owned();
    assert!(given(0.2).contains(&id), "{:?}", given(0.2));
    // At the nodes, and where nodes on either side hold the edge.
    assert!(!given(0.25).contains(&id), "{:?}", given(0.25));
}

/// A plate with facets of 0.3 on two rigid rollers. Wide ones are held by nodes alone, and chords
/// of facets lie inside them by h²/8r, 0.12 h with r = 0.31; narrower ones have rows of their own,
/// and on very wide ones the chords are less than h/100 deep.
#[test]
fn a_round_obstacle_between_nodes_is_said() {
    let given = |radius: f64| {
        let roller = |name: &str, x: f64| {
            format!(
                "[[contact]]\nname = \"{name}\"\nsecondary = \"b.bottom\"\n\
                 primary = {{ circle = {{ center = [{x}, {}], radius = {radius} }} }}\n",
                -radius
            )
        };
        let case = format!(
            r#"
dimension = 2
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 1e5, poisson = 0.0 }}]
[[body]]
name = "b"
material = "m"
element = "Q4"
mesh = {{ shape = "rectangle", min = [-3.15, 0.0], max = [2.85, 0.3], cells = [20, 1] }}
gravity = ["0", "-10"]
velocity = [0.3, 0.0]
{}{}[time]
end = 0.4
step = 0.005
scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }}
"#,
            roller("l", -1.5),
            roller("r", 1.5)
        );
        recorded(&case, &[]).contains(&"edge-between-nodes".to_owned())
    };
    assert!(given(0.31) && given(1.0));
    assert!(!given(0.29) && !given(6.0));
}

/// Where the primary is the far side of its body, nodes of the contact enter elsewhere; where
/// bodies overlap from the start they do not.
#[test]
fn a_contact_with_the_far_side_of_a_body() {
    let blocks = |height: f64, side: &str, more: &str| {
        format!(
            r#"
dimension = 2
material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.3 }}]
body = [
    {{ name = "above", material = "m", element = "T6", mesh = {{ shape = "rectangle", min = [0.0, {height}], max = [1.0, 1.5], cells = [2, 2] }}, velocity = [0.0, -1.0] }},
    {{ name = "below", material = "m", element = "T6", mesh = {{ shape = "rectangle", min = [-0.5, -0.5], max = [1.5, 0.0], cells = [4, 2] }} }},
]
[[contact]]
name = "c"
secondary = "above.bottom"
primary = "below.{side}"
{more}
[time]
end = 1.0
step = 0.01
scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }}
"#
        )
    };
    let warns = |text: &str| found(text, &[]).iter().any(|(id, _)| id == "undeclared-contact");
    assert!(warns(&blocks(0.1, "bottom", "")));
    assert!(!warns(&blocks(0.1, "top", "")));
    assert!(!warns(&blocks(-0.01, "top", "overlap = \"relax\"")));
}
