//! Metrics of a record: of its history, of one of its columns, and all metrics that a study
//! tabulates for a run.

use carom_record::metrics::Metric;

#[test]
fn times_and_counts_are_work() {
    let is_work = |name: &'static str| {
        Metric { name: name.into(), value: None, unit: String::new(), definition: "" }.is_work()
    };
    let work =
        ["steps", "newton_iterations", "rejected_steps", "factorisations", "cost", "cpu_time", "wall_time"];
    assert!(work.into_iter().all(is_work));
    assert!(!is_work("chatter") && !is_work("energy_lost:1") && !is_work("A.ux:max"));
}
