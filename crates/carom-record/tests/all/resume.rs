//! A run that is killed and resumed writes the same bytes as an uninterrupted one.

use std::fs;
use std::path::Path;
use std::time::Duration;

use carom_record::{RecordError, Run, RunWriter};

use crate::common::{STEPS, advance, all_bytes, fields, manifest, scratch, started, whole};

#[test]
fn killed_anywhere_ends_in_the_same_bytes() {
    let scratch = scratch();
    let expected = whole(&scratch.path().join("whole"));
    for kill in 0..STEPS {
        for lost in [None, Some("a.bin"), Some("b.bin")] {
            let directory = scratch.path().join(format!("killed-{kill}-{lost:?}"));
            drop(advance(started(&directory), 0, 0, kill));
            // The record can be read at any time, with every instant.
            let run = Run::open(&directory).unwrap();
            assert_eq!(run.fields.len() as u64, kill / 5 + 1);
            run.fields.iter().for_each(|e| assert_eq!(run.field(e).unwrap(), fields(e.step)));
            // A killed process leaves incomplete lines and half-written files behind.
            let path = directory.join("history.csv");
            let incomplete = [fs::read(&path).unwrap(), b"17,0.3".to_vec()].concat();
            fs::write(&path, incomplete).unwrap();
            fs::write(directory.join("fields/.00000099.vtu.partial"), "x").unwrap();
            let checkpoints = directory.join("checkpoint");
            if let Some(name) = lost {
                fs::remove_file(checkpoints.join(name)).unwrap();
                let _ = fs::remove_file(checkpoints.join("flushed.bin"));
            }
            let reopened = RunWriter::reopen(&directory).unwrap();
            assert!(reopened.fallback.is_none());
            assert_eq!(reopened.payload, reopened.step.to_le_bytes());
            assert!(reopened.step <= kill && (lost.is_some() || reopened.step + 6 > kill));
            let mut writer = advance(reopened.writer, reopened.step, reopened.rows, STEPS);
            writer.finish(&mut manifest()).unwrap();
            let mut got = all_bytes(&directory);
            let mut expected = expected.clone();
            if lost.is_some() {
                // Which of the two files has which step, and their sequence numbers, depend on the
                // step at which the run was reopened.
                got.retain(|path, _| !path.starts_with("checkpoint"));
                expected.retain(|path, _| !path.starts_with("checkpoint"));
            }
            assert!(got == expected, "killed at {kill}, without {lost:?}");
        }
    }
}

#[test]
fn a_damaged_checkpoint_falls_back_to_the_one_before() {
    let scratch = scratch();
    let directory = scratch.path().join("run");
    let expected = whole(&directory);
    // 36 is the newest step; find its file and change one byte.
    let newest = RunWriter::reopen(&directory).unwrap();
    assert_eq!(newest.step, 36);
    drop(newest);
    let newest = ["a.bin", "b.bin"].map(|n| directory.join("checkpoint").join(n)).into_iter().find(|path| {
        let bytes = fs::read(path).unwrap();
        bytes[bytes.len() - 40..bytes.len() - 32] == 36u64.to_le_bytes()
    });
    let newest = newest.unwrap();
    let good = fs::read(&newest).unwrap();
    for at in 0..good.len() {
        let mut bad = good.clone();
        bad[at] ^= 1;
        fs::write(&newest, bad).unwrap();
        let reopened = RunWriter::reopen(&directory).unwrap();
        assert_eq!((reopened.step, reopened.rows), (30, 31));
        assert!(reopened.fallback.unwrap().to_string().contains("is damaged"));
        if at == 0 {
            advance(reopened.writer, 30, 31, STEPS).finish(&mut manifest()).unwrap();
            let got = all_bytes(&directory);
            let differing: Vec<_> =
                expected.keys().chain(got.keys()).filter(|&k| expected.get(k) != got.get(k)).collect();
            assert!(differing.is_empty(), "{differing:?}");
        }
    }
}

/// Every byte that the last two checkpoints describe is protected: a change of it before the older
/// one is refused with the file's name, a later one is computed again.
#[test]
fn an_altered_record_is_not_continued() {
    let scratch = scratch();
    let directory = scratch.path().join("run");
    drop(advance(started(&directory), 0, 0, STEPS));
    let mut refused = 0;
    let mut repeated = 0;
    for (name, good) in all_bytes(&directory) {
        let row_file = ["csv", "jsonl"].iter().any(|e| name.extension().is_some_and(|x| x == *e));
        if !row_file && name.extension().is_none_or(|e| e != "vtu") {
            continue;
        }
        let path = directory.join(&name);
        for at in (0..good.len()).step_by(13) {
            let mut bad = good.clone();
            bad[at] ^= 1;
            fs::write(&path, bad).unwrap();
            // Reopening for writing would truncate the record.
            match altered(&directory, scratch.path()) {
                Err(error) => {
                    let text = error.to_string();
                    assert!(text.contains(name.to_str().unwrap()) && text.contains("is damaged"), "{text}");
                    assert!(text.contains("changed since") && text.contains("run the case again"), "{text}");
                    assert_eq!(error.exit_code(), 2);
                    refused += 1;
                }
                Ok((30, Some(_))) => repeated += 1,
                // What follows the last checkpoint is computed again anyway.
                Ok((step, fallback)) => {
                    assert!(step == 36 && fallback.is_none());
                    assert!(at > good.len() / 2 || name.ends_with("00000040.vtu"), "{name:?} at {at}");
                }
            }
        }
        fs::write(&path, &good).unwrap();
    }
    assert!(refused > 100 && repeated > 5, "{refused} {repeated}");
}

/// Reopens a copy of a run; the step reached and the error that was skipped.
fn altered(directory: &Path, scratch: &Path) -> Result<(u64, Option<RecordError>), RecordError> {
    let copy = scratch.join("copy");
    for (name, bytes) in all_bytes(directory) {
        let path = copy.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    fs::copy(directory.join("manifest.json"), copy.join("manifest.json")).unwrap();
    let reopened = RunWriter::reopen(&copy).map(|reopened| (reopened.step, reopened.fallback));
    fs::remove_dir_all(&copy).unwrap();
    reopened
}

#[test]
fn cut_and_missing_fields_are_refused_or_computed_again() {
    let scratch = scratch();
    let directory = scratch.path().join("run");
    drop(advance(started(&directory), 0, 0, STEPS));
    let file = |step: u64| directory.join(format!("fields/{step:08}.vtu"));
    // The checkpoints are those of steps 30 and 36.
    for (step, refused) in [(10, true), (35, false)] {
        let good = fs::read(file(step)).unwrap();
        for length in [None, Some(0), Some(good.len() / 2)] {
            match length {
                None => fs::remove_file(file(step)).unwrap(),
                Some(length) => fs::write(file(step), &good[..length]).unwrap(),
            }
            match altered(&directory, scratch.path()) {
                Err(error) if refused => {
                    let text = error.to_string();
                    assert!(text.contains(file(step).file_name().unwrap().to_str().unwrap()), "{text}");
                    assert!(length.is_some() || text.contains("it is missing"), "{text}");
                    assert_eq!(error.exit_code(), 2, "{text}");
                }
                Ok((30, Some(_))) if !refused => {}
                other => panic!("step {step}, {length:?}: {other:?}"),
            }
            fs::write(file(step), &good).unwrap();
        }
    }
}

/// A power failure leaves what was flushed to the disk; here, all written later is lost or empty.
/// The run is resumed from the last flushed checkpoint, to the same record.
#[test]
fn a_power_failure_costs_what_was_written_since_the_last_flush() {
    let scratch = scratch();
    let expected = whole(&scratch.path().join("whole"));
    let directory = scratch.path().join("cut");
    let mut writer = advance(started(&directory), 0, 0, 18);
    let flushed = all_bytes(&directory);
    writer.flush_interval(Duration::MAX);
    drop(advance(writer, 18, 19, STEPS));
    for (name, bytes) in all_bytes(&directory) {
        let kept = match flushed.get(&name) {
            Some(kept) if ["csv", "jsonl"].iter().any(|e| name.extension() == Some(e.as_ref())) => {
                kept.clone()
            }
            // Neither replaced nor written since.
            Some(kept) if *kept == bytes => bytes,
            _ => Vec::new(),
        };
        fs::write(directory.join(&name), kept).unwrap();
    }
    let reopened = RunWriter::reopen(&directory).unwrap();
    assert_eq!((reopened.step, reopened.rows), (18, 19));
    assert!(reopened.fallback.unwrap().to_string().contains("is damaged"));
    let mut writer = reopened.writer;
    writer.flush_interval(Duration::MAX);
    advance(writer, 18, 19, STEPS).finish(&mut manifest()).unwrap();
    let mut got = all_bytes(&directory);
    assert!(!got.contains_key(Path::new("checkpoint/flushed.bin")));
    // Which of the two files has which step depends on where the run was reopened.
    got.retain(|path, _| !path.starts_with("checkpoint"));
    let kept = expected.into_iter().filter(|(path, _)| !path.starts_with("checkpoint"));
    assert!(got == kept.collect());
}
