//! Meshes that are turned and moved.

use carom_case::PlaceSpec;
use carom_solid::{Element, Mesh, generate};

/// Arc nodes lie on the circle about the moved centre, and distances are unchanged.
#[test]
fn a_placed_disc_is_the_disc_elsewhere() {
    let made = generate::disc(Element::T10, 0.5, [1.0, 2.0], 0.2).unwrap();
    let mut mesh = made.clone();
    PlaceSpec { rotate: 30.0, axis: Vec::new(), about: vec![1.0, 0.0], shift: vec![-3.0, 0.25] }
        .apply(&mut mesh);
    let s = 0.5;
    let c = 0.75_f64.sqrt();
    let center = [1.0 - 2.0 * s - 3.0, 2.0 * c + 0.25];
    for n in mesh.side_nodes("arc").unwrap() {
        let r = (mesh.nodes[n][0] - center[0]).hypot(mesh.nodes[n][1] - center[1]);
        assert!((r - 0.5).abs() < 1e-14);
    }
    let length = |m: &Mesh, a: usize| (m.nodes[a][0] - m.nodes[0][0]).hypot(m.nodes[a][1] - m.nodes[0][1]);
    assert!((1..made.nodes.len()).all(|a| (length(&made, a) - length(&mesh, a)).abs() < 1e-14));
}

#[test]
fn right_angles_are_exact() {
    let made = generate::rectangle(Element::T3, [0.0, 0.0], [0.3, 0.1], [3, 1]).unwrap();
    for (rotate, ends) in
        [(90.0, [-0.1, 0.3]), (-180.0, [-0.3, -0.1]), (630.0, [0.1, -0.3]), (720.0, [0.3, 0.1])]
    {
        let mut mesh = made.clone();
        PlaceSpec { rotate, axis: Vec::new(), about: vec![0.0; 2], shift: vec![0.0; 2] }.apply(&mut mesh);
        assert!(mesh.nodes.iter().any(|x| x == ends), "{rotate}");
    }
}
