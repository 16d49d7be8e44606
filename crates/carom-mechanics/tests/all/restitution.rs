//! The impulse that returns what an impact owes.

use carom_mechanics::velocity::restitution::root;

#[test]
fn the_root_returns_the_energy_or_what_nodes_can_lose() {
    for (a, b, owed) in [(2.0, 3.0, 1.0), (2.0, 0.0, 1.0), (2.0, -3.0, 1.0), (2.0, 3.0, -1.0)] {
        let factor: f64 = root(a, b, owed);
        assert!((0.5 * a * factor * factor + b * factor - owed).abs() < 1e-15, "{a} {b} {owed}");
        assert_eq!(factor > 0.0, owed > 0.0);
    }
    assert_eq!(root(2.0, 3.0, -3.0), -1.5);
    assert_eq!(root(2.0, -3.0, -1.0), 0.0);
}
