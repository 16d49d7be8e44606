//! Examples of keys in other dimensions.

use carom_case::MeshSpec;
use carom_case::example::{in_dimension, sides_of};

#[test]
fn vectors_have_the_dimension_of_the_case() {
    let plane = "{ point = [0.0, 0.0], normal = [0.0, 1.0] }";
    for (example, one, three) in [
        ("[0.0, -9.81]", "[-9.81]", "[0.0, -9.81, 0.0]"),
        ("[0.0, 0.0]", "[0.0]", "[0.0, 0.0, 0.0]"),
        ("[8, 2]", "[8]", "[8, 2, 2]"),
        ("[\"0.1*X\", 0.0]", "[\"0.1*X\"]", "[\"0.1*X\", 0.0, 0.0]"),
        (plane, "{ point = [0.0], normal = [1.0] }", "{ point = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0] }"),
        ("\"x\"", "\"x\"", "\"x\""),
    ] {
        let found = [1, 2, 3].map(|dimension| in_dimension(example, Some(dimension)));
        assert_eq!(found, [one, example, three]);
    }
}

/// Every built-in shape is listed here, with the sides that its documentation names.
#[test]
fn sides_are_those_of_the_shapes() {
    for (shape, table) in MeshSpec::variants().tables {
        let sides = sides_of(shape);
        assert!(!sides.is_empty() && sides.iter().all(|side| table.doc.contains(side)), "{shape}");
    }
}
