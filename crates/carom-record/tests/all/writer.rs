//! How often a run flushes to the disk.

use std::time::Duration;

use carom_record::{Block, Cell, Column, Facts, FieldSet, Manifest, RunWriter, Source, Status};

/// A short run flushes its start and its end, however many checkpoints and fields it has; one
/// that may be resumed flushes its fields, too; and one that takes longer, every checkpoint
/// that is late enough.
#[test]
fn flushes_do_not_grow_with_fields_and_checkpoints() {
    const FIELDS: usize = 201;
    let flushes = |status, interval| {
        let scratch = tempfile::tempdir().unwrap();
        let column = |name: &str| Column {
            name: name.into(),
            unit: "s".into(),
            description: String::new(),
            integer: false,
        };
        let mut manifest = Manifest::new(
            "0.1.0",
            Facts::default(),
            serde_json::json!({}),
            Source::default(),
            vec![column("time")],
            1,
        );
        let before = carom_record::flushes();
        let mut writer = RunWriter::create(&scratch.path().join("run"), &manifest, b"0").unwrap();
        writer.flush_interval(interval);
        let body = Block { body: "b".into(), cell: Cell::Curve, degree: 1, connectivity: vec![0, 1] };
        let points = vec![[0.0; 3], [1.0, 0.0, 0.0]];
        let fields = FieldSet { points, blocks: vec![body], arrays: Vec::new(), ..FieldSet::default() };
        for step in 0..FIELDS as u64 {
            writer.history(&[step as f64]).unwrap();
            writer.fields(step, step as f64, &fields).unwrap();
            writer.checkpoint(step, b"0").unwrap();
        }
        manifest.status = status;
        writer.finish(&mut manifest).unwrap();
        carom_record::flushes() - before
    };
    let finished = flushes(Status::Finished, Duration::MAX);
    assert!(finished <= 20, "{finished}");
    // And each field file, their folder, their list and the run's directory.
    let stopped = flushes(Status::Stopped, Duration::MAX);
    assert_eq!(stopped, finished + FIELDS + if cfg!(unix) { 3 } else { 1 });
    assert!(flushes(Status::Finished, Duration::ZERO) > 5 * FIELDS);
}
