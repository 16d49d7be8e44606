//! Contacts in which the same facets face each other.

use carom_run::Setup;

use super::common::case;

/// Sides with common facets in two contacts are refused: friction would depend on their order.
#[test]
fn facets_that_face_each_other_in_two_contacts_are_refused() {
    let text = |first: &str, second: &str| {
        format!(
            r#"
            dimension = 2
            material = [{{ name = "m", law = "neo-hookean", density = 1.0, young = 1e4, poisson = 0.0 }}]
            support = [{{ on = ["f.bottom"], fix = ["x", "y"] }}]
            contact = [{{ name = "one", {first} }}, {{ name = "other", {second}, mu = 0.5 }}]
            time = {{ end = 1.0, step = 1.0, scheme = {{ kind = "backward-euler" }} }}
            [[body]]
            name = "b"
            material = "m"
            element = "Q4"
            mesh = {{ shape = "rectangle", min = [0.0, 0.0], max = [2.0, 0.5], cells = [8, 2] }}
            [[body]]
            name = "f"
            material = "m"
            element = "Q4"
            mesh = {{ shape = "rectangle", min = [-1.0, -1.0], max = [3.0, 0.0], cells = [8, 2] }}
            "#
        )
    };
    let plane = "primary = { plane = { point = [0.0, -1.0], normal = [0.0, 1.0] } }";
    let [skin, side] =
        [r#"secondary = "b.skin", primary = "f.top""#, r#"secondary = "b.bottom", primary = "f.top""#];
    let swapped = r#"secondary = "f.skin", primary = "b.bottom""#;
    let [whole, part] = ["b.skin", "b.bottom"].map(|side| format!("secondary = \"{side}\", {plane}"));
    for (first, second) in [(skin, side), (swapped, side), (side, swapped), (&*whole, &*part)] {
        let refused = Setup::new(&case(&text(first, second), &[""; 0])).start();
        let message = format!("{:?}", refused.err());
        assert!(message.contains("some facets face each other in contact"), "{first}, {second}: {message}");
    }
    let apart = r#"secondary = "b.left", primary = "f.top""#;
    assert!(Setup::new(&case(&text(apart, side), &[""; 0])).start().is_ok());
}
