//! Mortar contact with friction in runs: momentum over the joint of two tables, half a model
//! against the whole, and faces that are pulled.

use carom_contact::FrictionState;
use carom_run::{GridReport, Simulation};

use super::common::{finish, simulation};

/// A block slides over the joint of two flush tables. It is carried by normal forces whose impulse
/// is that of its weight but for what its height oscillates, so that friction takes μ g t from its
/// velocity, whichever side is secondary. At the ends of the tables coefficients of the pressure
/// gain and lose their partners within a step.
#[test]
#[ignore = "takes seconds: .ci/nightly"]
fn friction_over_a_joint_takes_no_more_than_mu_times_the_weight() {
    let joint = |element: &str, cells: usize, sides: [[&str; 2]; 2]| {
        let [[first, on_first], [second, on_second]] = sides;
        let table = |name: &str, from: f64, to: f64, cells: usize| {
            format!(
                r#"
                [[body]]
                name = "{name}"
                material = "m"
                element = "{element}"
                mesh = {{ shape = "rectangle", min = [{from:?}, -0.2], max = [{to:?}, 0.0], cells = [{cells}, 1] }}
                [[support]]
                on = ["{name}.bottom"]
                fix = ["x", "y"]
                "#
            )
        };
        format!(
            r#"
            dimension = 2
            material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 2e4, poisson = 0.2 }}]
            time = {{ end = 0.7, step = 0.002, scheme = {{ kind = "chung-hulbert", rho_inf = 0.5 }} }}
            [[body]]
            name = "b"
            material = "m"
            element = "{element}"
            mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.2], cells = [{cells}, 1] }}
            gravity = [0.0, -10.0]
            velocity = [2.0, 0.0]
            {}
            {}
            [[contact]]
            name = "first"
            secondary = "{first}"
            primary = "{on_first}"
            mu = 0.2
            method = "mortar"
            [[contact]]
            name = "second"
            secondary = "{second}"
            primary = "{on_second}"
            mu = 0.2
            method = "mortar"
            "#,
            table("s", -0.5, 1.0, 6),
            table("t", 1.0, 1.8, 4)
        )
    };
    let below = [["b.bottom", "s.top"], ["b.bottom", "t.top"]];
    let above = [["s.top", "b.bottom"], ["t.top", "b.bottom"]];
    for (element, cells, sides) in [("Q4", 5, below), ("T6", 6, above)] {
        let mut end = simulation(&joint(element, cells, sides), &[""; 0]);
        while !end.finished() {
            end.advance(&mut GridReport::default()).unwrap();
            let mut closed = end.state().pairs.iter().flatten().filter(|pair| pair.active);
            let sticks = closed.any(|pair| pair.tangential.friction_state == FrictionState::Stick);
            assert!(!sticks, "{element}: a pair sticks at {} while the block slides", end.state().time);
        }
        let mut momenta = vec![0.0; end.model().dofs()];
        end.model().mass.multiply_into(&end.state().v, &mut momenta);
        let momentum: f64 = end.model().parts[0].nodes().map(|node| momenta[2 * node]).sum();
        let velocity = momentum / 0.2;
        assert!((velocity - (2.0 - 0.2 * 10.0 * 0.7)).abs() < 1e-3, "{element}: {velocity}");
        let slips = end.state().pairs.iter().flatten().map(|pair| pair.tangential.slip[0]);
        assert!(slips.into_iter().all(f64::is_finite), "{element}");
    }
}

/// A block that drops on a slab, and half of both on rollers in the plane of symmetry move alike,
/// under friction, too: the tangential traction is zero in that plane, and the slab, which the
/// impact bends, goes on behind it as its mirror image.
#[test]
fn half_a_model_moves_like_the_whole() {
    let model = |from: f64, share: usize, support: &str, mu: f64| {
        format!(
            r#"
            dimension = 2
            material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 100.0, poisson = 0.4 }}]
            contact = [{{ name = "c", secondary = "b.bottom", primary = "p.top", mu = {mu}, method = "mortar" }}]
            time = {{ end = 0.1, step = 0.002, scheme = {{ kind = "chung-hulbert", rho_inf = 0.6 }} }}
            [[body]]
            name = "b"
            material = "m"
            element = "Q9"
            mesh = {{ shape = "rectangle", min = [{:?}, 0.002], max = [0.5, 0.6], cells = [{}, 3] }}
            velocity = [0.0, -1.0]
            [[body]]
            name = "p"
            material = "m"
            element = "Q9"
            mesh = {{ shape = "rectangle", min = [{:?}, -0.5], max = [1.0, 0.0], cells = [{}, 3] }}
            [[support]]
            on = ["p.bottom"]
            fix = ["x", "y"]
            {support}
            "#,
            0.5 * from,
            3 * share,
            from,
            5 * share
        )
    };
    let rollers = "[[support]]\non = [\"b.left\", \"p.left\"]\nfix = [\"x\"]";
    let corner = |sim: &Simulation| {
        let x = &sim.model().reference;
        let is_there = |&node: &usize| (x[2 * node] - 0.5).hypot(x[2 * node + 1] - 0.002) < 1e-12;
        let node = (0..x.len() / 2).find(is_there).unwrap();
        [0, 1].map(|axis| sim.state().y[2 * node + axis] - x[2 * node + axis])
    };
    for mu in [0.0, 0.3] {
        let texts = [model(-1.0, 2, "", mu), model(0.0, 1, rollers, mu)];
        let [whole, half] = texts.map(|text| finish(simulation(&text, &[""; 0])));
        let [one, other] = [&whole, &half].map(corner);
        assert!(other[0].abs() > 1e-3, "{other:?}");
        for axis in [0, 1] {
            assert!((one[axis] / other[axis] - 1.0).abs() < 1e-10, "{one:?} {other:?}");
        }
        let [one, other] = [&whole, &half].map(|sim| sim.state().impulses[0][1]);
        assert!((one / (2.0 * other) - 1.0).abs() < 1e-10, "{one} {other}");
    }
}

/// A block that its end face pulls over a rigid floor or a table, and one that a table is pulled
/// under: friction carries μ times the pressing force, all of it. A face that moves is no plane of
/// symmetry.
#[test]
fn a_face_that_is_pulled_rubs_up_to_its_end() {
    let pulled = "[[support]]\non = [\"b.right\"]\nmove = { x = \"if(t < 1, 0, 0.1*(t - 1))\" }";
    let held = "[[support]]\non = [\"b.left\"]\nfix = [\"x\"]\n\
                [[support]]\non = [\"p.bottom\"]\nfix = [\"y\"]\n\
                [[support]]\non = [\"p.left\"]\nmove = { x = \"if(t < 1, 0, -0.05*(t - 1))\" }";
    let table = "[[body]]\nname = \"p\"\nmaterial = \"m\"\nelement = \"Q4\"\n\
                 mesh = { shape = \"rectangle\", min = [0.0, -0.5], max = [2.0, 0.0], cells = [7, 2] }";
    let floor = "{ plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }";
    for (supports, other, primary) in [(pulled, "", floor), (held, table, "\"p.top\"")] {
        let text = format!(
            r#"
            dimension = 2
            material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 1000.0, poisson = 0.0 }}]
            load = [{{ on = ["b.top"], traction = ["0", "-1"] }}]
            time = {{ end = 2.0, step = 0.2, scheme = {{ kind = "static" }} }}
            [[body]]
            name = "b"
            material = "m"
            element = "Q4"
            mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [1.0, 0.5], cells = [4, 2] }}
            {other}
            {supports}
            [[contact]]
            name = "floor"
            secondary = "b.bottom"
            primary = {primary}
            method = "mortar"
            mu = 0.5
            "#
        );
        let end = finish(simulation(&text, &[""; 0]));
        let force: f64 = end.state().pairs[0].iter().map(|pair| pair.tangential.traction[0]).sum();
        assert!((force.abs() / 0.5 - 1.0).abs() < 2e-3, "{primary}: {force}");
    }
}
