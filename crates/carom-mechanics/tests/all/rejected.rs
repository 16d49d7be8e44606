//! Numbers in the messages of rejected steps.

use carom_mechanics::Rejected;

#[test]
fn a_depth_is_told_from_its_limit() {
    for (depth, bound, [depth_in_words, bound_in_words]) in [
        (4.2e-3, 4.1e-3, ["4.200e-3", "4.100e-3"]),
        (4.166_693_1e-3, 4.166_666_7e-3, ["4.16669e-3", "4.16667e-3"]),
        (0.1 + f64::EPSILON, 0.1, ["1.000000000000002e-1", "1.000000000000000e-1"]),
    ] {
        let message = Rejected::Deep { depth, bound }.to_string();
        let expected = format!("by {depth_in_words} [length], more than the {bound_in_words} [length]");
        assert!(message.contains(&expected), "{message}");
    }
}
