//! A frictionless constraint by an augmented Lagrangian.

use carom_contact::{Augmented, Interface, Point};

#[test]
fn rounds_find_the_multiplier_of_a_node_on_a_spring() {
    // A spring of stiffness K presses a node with the force f onto a plane: K g = f − λ with
    // g = 0 has λ = f = −3, whatever r.
    let interface = Augmented::default();
    let stiffness = 7.0;
    let force = -3.0;
    let mut multiplier = 0.0;
    let augmentation = 14.0;
    for round in 0..40 {
        // The root of the row and of the balance.
        let gap: f64 = (force - multiplier) / (stiffness + augmentation);
        let lambda = multiplier + augmentation * gap;
        let at =
            Point { node: 0, gap, start: gap, lambda, active: true, multiplier, stiffness: augmentation };
        let answer = interface.respond(&at);
        assert!(answer.open.abs() < 1e-15 && answer.energy == 0.0, "{round}: {answer:?}");
        assert!((stiffness * gap + lambda - force).abs() < 1e-14);
        multiplier = lambda;
    }
    assert!((multiplier - force).abs() < 1e-12, "{multiplier}");
}
