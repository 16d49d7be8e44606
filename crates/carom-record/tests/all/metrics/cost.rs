//! Counted cost of a run: how often each kernel was called, times its weight.

use std::collections::BTreeMap;

use carom_record::Stepping;
use carom_record::metrics::cost;

/// By hand: 3 steps with 7 iterations and 2 factorisations cost 15 + 14 + 20, of the
/// energy–momentum scheme 15 + 35 + 20, and 3 explicit steps 4.5.
#[test]
fn costs_by_hand() {
    let counters = [("steps", 3), ("newton", 7), ("factorisations", 2), ("activations", 99)];
    let counters = counters.map(|(name, calls)| (name.to_owned(), calls)).into();
    assert_eq!(cost(&counters, Stepping::Implicit), Some(49.0));
    assert_eq!(cost(&counters, Stepping::EnergyMomentum), Some(70.0));
    let counters = [("steps", 3), ("newton", 7)].map(|(name, calls)| (name.to_owned(), calls)).into();
    assert_eq!(cost(&counters, Stepping::Explicit), Some(4.5));
    assert_eq!(cost(&BTreeMap::new(), Stepping::Implicit), None);
}
