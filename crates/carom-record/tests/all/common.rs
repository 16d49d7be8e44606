//! A small record that the tests write.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use carom_record::{
    Block, Cell, Column, ContactRow, Event, Facts, FieldSet, Manifest, PointArray, RecordError, RunWriter,
    Source,
};

pub(crate) const STEPS: u64 = 40;

pub(crate) fn manifest() -> Manifest {
    let column = |name: &str, integer| Column {
        name: name.into(),
        unit: "s".into(),
        description: String::new(),
        integer,
    };
    let columns = vec![column("step", true), column("time", false), column("A.uy, \"odd\"", false)];
    Manifest::new("0.1.0", Facts::default(), serde_json::json!({"title": "t"}), Source::default(), columns, 1)
}

pub(crate) fn fields(step: u64) -> FieldSet {
    FieldSet {
        points: vec![[0.0, 2.5, 0.0], [1.0, 0.0, 0.0]],
        blocks: vec![Block { body: "b".into(), cell: Cell::Curve, degree: 1, connectivity: vec![0, 1] }],
        arrays: vec![PointArray {
            name: "p".into(),
            unit: "Pa".into(),
            components: 1,
            values: vec![step as f64, -1.0],
        }],
        ..FieldSet::default()
    }
}

/// A folder in memory, if the system has one: a process is killed here, and no disk. On a disk the
/// tests would wait for thousands of its writes.
pub(crate) fn scratch() -> tempfile::TempDir {
    tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap()
}

/// Records one step of a simulation; the payload is the step.
pub(crate) fn record(writer: &mut RunWriter, step: u64) -> Result<(), RecordError> {
    let time = step as f64 * 0.1;
    // From very small to very large by exact powers of two; `powi` may differ in the last digit.
    writer.history(&[step as f64, time, (time - 1.7) * f64::from_bits((step * 50 + 20) << 52)])?;
    for node in 0..step % 3 {
        let (xi, gap, multiplier) = (-0.3, 1e-17, -time);
        let contact = "a,b".into();
        let row = ContactRow {
            step,
            time,
            contact,
            node,
            point: [1.0, 2.0, 0.0],
            facet: 7,
            xi,
            eta: 0.0,
            gap,
            multiplier,
            pressure: f64::NAN,
            normal: [0.6, 0.8, 0.0],
            friction: "none".into(),
            traction: 0.0,
            slip: 0.0,
            rubbing: [0.0; 3],
            ..ContactRow::default()
        };
        writer.contact(&[row])?;
    }
    if step % 7 == 3 {
        writer.log(&Event::new(step, time, "rejected", "too far").with("depth", 0.1 * time))?;
    }
    if step.is_multiple_of(5) {
        writer.fields(step, time, &fields(step))?;
    }
    if step.is_multiple_of(6) {
        writer.checkpoint(step, &step.to_le_bytes())?;
    }
    Ok(())
}

/// Records the steps up to `end`; the first row only if it is missing.
pub(crate) fn advance(mut writer: RunWriter, from: u64, rows: u64, end: u64) -> RunWriter {
    let first = if rows == 0 { 0 } else { from + 1 };
    (first..=end).for_each(|step| record(&mut writer, step).unwrap());
    writer
}

pub(crate) fn all_bytes(directory: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![directory.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if !path.ends_with("manifest.json") {
                found.insert(path.strip_prefix(directory).unwrap().to_path_buf(), fs::read(&path).unwrap());
            }
        }
    }
    found
}

/// A run at its start, which flushes every checkpoint.
pub(crate) fn started(directory: &Path) -> RunWriter {
    let mut writer = RunWriter::create(directory, &manifest(), &0u64.to_le_bytes()).unwrap();
    writer.flush_interval(Duration::ZERO);
    writer
}

pub(crate) fn whole(directory: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    advance(started(directory), 0, 0, STEPS).finish(&mut manifest()).unwrap();
    all_bytes(directory)
}
