//! Subjects of metrics: the headings under which pages list them.

use carom_record::metrics::group::GROUPS;
use carom_record::metrics::run_table::REBOUND;
use carom_record::metrics::table::HISTORY;
use carom_record::metrics::{OVERLAY, group};

/// Every metric of a history has a heading of its own kind; what has none is of a probe.
#[test]
fn every_metric_has_a_heading() {
    for definition in &HISTORY {
        assert_ne!(group(definition.name), "Probes", "{}", definition.name);
    }
    assert_eq!(group("energy_lost:3"), "Energy");
    assert_eq!(group("A.sigma_yy:peak_mean"), "Probes");
    assert_eq!(group("cpu_time"), "Computational work");
    let names = GROUPS.iter().flat_map(|group| group.names);
    let known = |name: &&&str| HISTORY.iter().chain(&REBOUND).chain(&OVERLAY).any(|d| d.name == **name);
    assert!(names.clone().all(|name| known(&name)));
    assert_eq!(names.count(), HISTORY.len() + REBOUND.len() + OVERLAY.len());
}
