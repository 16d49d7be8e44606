//! A run that is killed and resumed writes the same bytes as an uninterrupted one.

#![allow(clippy::unwrap_used)] // the helpers are tests too

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use carom_record::{
    Block, Cell, Column, ContactRow, Event, FieldFormat, FieldSet, Generation, Manifest, PointArray,
    RecordError, Run, RunWriter, Source, Status,
};

const STEPS: u64 = 40;

fn manifest() -> Manifest {
    let column = |name: &str, integer| Column {
        name: name.into(),
        unit: "s".into(),
        description: String::new(),
        integer,
    };
    let columns = vec![column("step", true), column("time", false), column("A.uy, \"odd\"", false)];
    Manifest::new("0.1.0", serde_json::json!({"title": "t"}), Source::default(), columns, 1)
}

fn fields(step: u64) -> FieldSet {
    FieldSet {
        points: vec![[0.0, 2.5, 0.0], [1.0, 0.0, 0.0]],
        blocks: vec![Block { body: "b".into(), cell: Cell::Curve, degree: 1, connectivity: vec![0, 1] }],
        arrays: vec![PointArray {
            name: "p".into(),
            unit: "Pa".into(),
            components: 1,
            values: vec![step as f64, -1.0],
        }],
    }
}

/// A folder in memory, if the system has one: a process is killed here, and no disk. On a disk the
/// tests would wait for thousands of its writes.
fn scratch() -> tempfile::TempDir {
    tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap()
}

/// Records one step of a simulation; the payload is the step.
fn record(writer: &mut RunWriter, step: u64) -> Result<(), RecordError> {
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
        };
        writer.contact(&row)?;
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
fn advance(mut writer: RunWriter, from: u64, rows: u64, end: u64) -> RunWriter {
    let first = if rows == 0 { 0 } else { from + 1 };
    (first..=end).for_each(|step| record(&mut writer, step).unwrap());
    writer
}

fn all_bytes(directory: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
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

/// A run at its start.
fn started(directory: &Path, format: FieldFormat) -> RunWriter {
    let mut writer = RunWriter::create(directory, &manifest(), &0u64.to_le_bytes()).unwrap();
    writer.field_format(format);
    writer
}

fn whole(directory: &Path, format: FieldFormat) -> BTreeMap<PathBuf, Vec<u8>> {
    advance(started(directory, format), 0, 0, STEPS).finish(&mut manifest()).unwrap();
    all_bytes(directory)
}

#[test]
fn killed_anywhere_ends_in_the_same_bytes() {
    killed_anywhere(FieldFormat::Vtu);
}

#[test]
fn killed_anywhere_with_fields_in_one_file_ends_in_the_same_bytes() {
    killed_anywhere(FieldFormat::VtkHdf);
}

fn killed_anywhere(format: FieldFormat) {
    let scratch = scratch();
    let expected = whole(&scratch.path().join("whole"), format);
    for kill in 0..STEPS {
        for generation in [None, Some(Generation::A), Some(Generation::B)] {
            let directory = scratch.path().join(format!("killed-{kill}-{generation:?}"));
            drop(advance(started(&directory, format), 0, 0, kill));
            // The record can be read at any time, with every instant.
            let run = Run::open(&directory).unwrap();
            assert_eq!(run.fields.len() as u64, kill / 5 + 1);
            run.fields.iter().for_each(|e| assert_eq!(run.field(e).unwrap(), fields(e.step)));
            // A killed process leaves incomplete lines and half-written files behind.
            let path = directory.join("history.csv");
            let incomplete = [fs::read(&path).unwrap(), b"17,0.3".to_vec()].concat();
            fs::write(&path, incomplete).unwrap();
            match format {
                FieldFormat::Vtu => fs::write(directory.join("fields/.00000099.vtu.partial"), "x").unwrap(),
                FieldFormat::VtkHdf => fs::write(directory.join(".fields.vtkhdf.partial"), "x").unwrap(),
            }
            let mut reopened = match generation {
                None => RunWriter::reopen(&directory).unwrap(),
                Some(generation) => RunWriter::reopen_at(&directory, generation).unwrap(),
            };
            assert!(reopened.fallback.is_none());
            assert_eq!(reopened.payload, reopened.step.to_le_bytes());
            assert!(reopened.step <= kill && (generation.is_some() || reopened.step + 6 > kill));
            reopened.writer.field_format(format);
            let mut writer = advance(reopened.writer, reopened.step, reopened.rows, STEPS);
            writer.finish(&mut manifest()).unwrap();
            let mut got = all_bytes(&directory);
            let mut expected = expected.clone();
            if generation.is_some() {
                // Which of the two files has which step, and their sequence numbers, depend on the
                // step at which the run was reopened.
                got.retain(|path, _| !path.starts_with("checkpoint"));
                expected.retain(|path, _| !path.starts_with("checkpoint"));
            }
            assert!(got == expected, "killed at {kill}, {generation:?}");
        }
    }
}

#[test]
fn a_damaged_checkpoint_falls_back_to_the_one_before() {
    let scratch = scratch();
    let directory = scratch.path().join("run");
    let expected = whole(&directory, FieldFormat::Vtu);
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
    for format in [FieldFormat::Vtu, FieldFormat::VtkHdf] {
        let scratch = scratch();
        let directory = scratch.path().join("run");
        drop(advance(started(&directory, format), 0, 0, STEPS));
        let (mut refused, mut repeated) = (0, 0);
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
                        assert!(
                            text.contains(name.to_str().unwrap()) && text.contains("is damaged"),
                            "{text}"
                        );
                        assert!(
                            text.contains("changed since") && text.contains("run the case again"),
                            "{text}"
                        );
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
    for format in [FieldFormat::Vtu, FieldFormat::VtkHdf] {
        let scratch = scratch();
        let directory = scratch.path().join("run");
        drop(advance(started(&directory, format), 0, 0, STEPS));
        let file = |step: u64| match format {
            FieldFormat::Vtu => directory.join(format!("fields/{step:08}.vtu")),
            FieldFormat::VtkHdf => directory.join("fields.vtkhdf"),
        };
        // The checkpoints are those of steps 30 and 36.
        for (step, refused) in [(10, true), (35, format == FieldFormat::VtkHdf)] {
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
                    other => panic!("{format:?}, step {step}, {length:?}: {other:?}"),
                }
                fs::write(file(step), &good).unwrap();
            }
        }
        // One value of one instant, in the one file.
        if format == FieldFormat::VtkHdf {
            let good = fs::read(file(0)).unwrap();
            let value = 10.0_f64.to_le_bytes();
            let at = good.windows(16).rposition(|w| w[..8] == value && w[8..] == (-1.0_f64).to_le_bytes());
            let mut bad = good.clone();
            bad[at.unwrap()] ^= 1;
            fs::write(file(0), bad).unwrap();
            let text = altered(&directory, scratch.path()).unwrap_err().to_string();
            assert!(text.contains("the fields of step 10 have changed"), "{text}");
        }
    }
}

#[test]
fn what_is_written_is_read_back() {
    let scratch = scratch();
    let directory = scratch.path().join("deep/er/run");
    let mut writer = RunWriter::create(&directory, &manifest(), b"").unwrap();
    let awkward =
        [0.1 + 0.2, -0.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, 1e16, 123456789.125, f64::INFINITY, 1.0];
    for (i, &x) in awkward.iter().enumerate() {
        writer.history(&[i as f64, x, -x]).unwrap();
    }
    let row = ContactRow {
        step: 3,
        time: 0.1,
        contact: "a \"b\", c".into(),
        node: 5,
        point: [0.1, -2e-9, 0.0],
        facet: 1,
        xi: -0.99,
        eta: 0.0,
        gap: 1e-18,
        multiplier: -7.5,
        pressure: 75.0,
        normal: [-0.0, 1.0, 0.0],
        friction: "none".into(),
        traction: 0.0,
        slip: 0.0,
        rubbing: [0.0; 3],
    };
    writer.contact(&row).unwrap();
    let event = Event::new(3, 0.1, "cycle", "line\nbreak").with("nodes", vec![1, 2]);
    writer.log(&event).unwrap();
    writer.fields(2, 0.2, &fields(2)).unwrap();
    let mut done = manifest();
    done.status = Status::Finished;
    writer.finish(&mut done).unwrap();

    let run = Run::open(&directory).unwrap();
    assert_eq!(run.manifest, done);
    let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(run.times()), bits(&awkward));
    assert_eq!(run.column("A.uy, \"odd\"").unwrap()[0], -(0.1 + 0.2));
    assert_eq!(run.column("step").unwrap(), [0., 1., 2., 3., 4., 5., 6., 7., 8.]);
    assert!(fs::read_to_string(directory.join("history.csv")).unwrap().contains("\n3,5e-324,-5e-324\n"));
    assert_eq!(run.contact, [row]);
    assert_eq!(run.log, [event]);
    assert_eq!((run.fields[0].step, run.fields[0].time), (2, 0.2));
    assert_eq!(run.field(&run.fields[0]).unwrap(), fields(2));
}

#[test]
fn rows_of_contact_in_space_are_read_back() {
    let scratch = scratch();
    let directory = scratch.path().join("run");
    let mut of_space = manifest();
    of_space.case = serde_json::json!({"dimension": 3});
    let mut writer = RunWriter::create(&directory, &of_space, b"").unwrap();
    let row = ContactRow {
        step: 1,
        time: 0.1,
        contact: "c".into(),
        node: 5,
        point: [0.1, 0.2, 0.3],
        facet: 1,
        xi: 0.25,
        eta: -0.5,
        gap: 1e-18,
        multiplier: -7.5,
        pressure: 75.0,
        normal: [0.6, 0.0, 0.8],
        friction: "slip".into(),
        traction: 5.0,
        slip: 0.7,
        rubbing: [4.0, 0.0, -3.0],
    };
    writer.history(&[0.0, 0.1, 0.0]).unwrap();
    writer.contact(&row).unwrap();
    writer.finish(&mut Manifest { status: Status::Finished, ..of_space }).unwrap();
    let header = fs::read_to_string(directory.join("contact.csv")).unwrap();
    let columns = "step,time,contact,node,x,y,z,facet,xi,eta,gap,multiplier,pressure,normal_x,normal_y,\
        normal_z,friction,traction,slip,friction_x,friction_y,friction_z\n";
    assert!(header.starts_with(columns), "{header}");
    assert_eq!(Run::open(&directory).unwrap().contact, [row]);
}

/// A row or a byte that is lost or changed after the end of a run is noticed; while a run is being
/// written, what there is is read.
#[test]
fn a_record_that_has_changed_since_its_run_ended_is_named() {
    let scratch = scratch();
    let directory = scratch.path().join("run");
    let mut done = Manifest { status: Status::Finished, ..manifest() };
    let mut writer = advance(started(&directory, FieldFormat::Vtu), 0, 0, STEPS);
    writer.manifest(&manifest()).unwrap();
    assert!(Run::open(&directory).is_ok());
    writer.finish(&mut done).unwrap();
    drop(writer);
    assert_eq!(Run::open(&directory).unwrap().manifest, done);
    for name in ["history.csv", "contact.csv", "log.jsonl"] {
        let path = directory.join(name);
        let whole = fs::read(&path).unwrap();
        let last_row = whole[..whole.len() - 1].iter().rposition(|&b| b == b'\n').unwrap() + 1;
        let other_digit = whole.iter().map(|&b| if b == b'1' { b'2' } else { b }).collect();
        assert_ne!(other_digit, whole);
        for changed in [whole[..last_row].to_vec(), other_digit, Vec::new()] {
            fs::write(&path, changed).unwrap();
            let error = Run::open(&directory).unwrap_err();
            assert_eq!(error.exit_code(), 2);
            let told = format!("{name} is damaged: it has changed since it was written");
            assert!(error.to_string().contains(&told), "{error}");
        }
        fs::remove_file(&path).unwrap();
        let error = Run::open(&directory).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains("it is missing"), "{error}");
        fs::write(&path, whole).unwrap();
        assert!(Run::open(&directory).is_ok());
    }
}

#[test]
fn errors_say_why() {
    let scratch = scratch();
    let directory = scratch.path().join("run");
    let mut writer = RunWriter::create(&directory, &manifest(), b"0").unwrap();
    let shown = |error: RecordError| (error.exit_code(), error.to_string());
    let create = |path: &Path| shown(RunWriter::create(path, &manifest(), b"0").err().unwrap());
    assert_eq!(create(&directory).0, 2);
    let empty = scratch.path().join("empty");
    fs::create_dir(&empty).unwrap();
    let (code, text) = create(&scratch.path().join("run/history.csv/x"));
    assert!(code == 4 && text.contains("cannot create"), "{text}");
    assert!(shown(RunWriter::reopen(&directory).err().unwrap()).1.contains("another process"));
    assert!(shown(RunWriter::reopen(&empty).err().unwrap()).1.contains("no manifest.json"));
    // An empty directory, which may have been created to reserve its name, is used.
    assert!(RunWriter::create(&empty, &manifest(), b"0").is_ok());
    assert!(create(&empty).1.contains("exists already"));
    assert!(matches!(writer.history(&[1.0]), Err(RecordError::Width { got: 1, expected: 3 })));
    drop(writer);
    fs::write(directory.join("history.csv"), "step,time,\"A.uy, \"\"odd\"\"\"\n0,0,0\n1,x,0\n2,tor").unwrap();
    let (code, text) = shown(Run::open(&directory).unwrap_err());
    assert!(
        code == 2 && text.contains("history.csv:3 is damaged: `x` in column time is not a number"),
        "{text}"
    );
    fs::write(directory.join("history.csv"), "step").unwrap();
    let text = shown(RunWriter::reopen(&directory).err().unwrap()).1;
    assert!(text.contains("history.csv") && text.contains("4 bytes"), "{text}");
}

/// Every value comes back with its bits, and names and units with commas and quotes as they are.
#[test]
fn exported_text_is_read_back() {
    let scratch = scratch();
    let directory = scratch.path().join("run");
    let mut manifest = manifest();
    manifest.columns[1].unit = "kg, net".into();
    let mut writer = RunWriter::create(&directory, &manifest, b"0").unwrap();
    let values = [[0.0, 0.1 + 0.2, 5e-324], [1.0, -0.0, f64::NAN]];
    values.iter().for_each(|row| writer.history(row).unwrap());
    writer.finish(&mut manifest).unwrap();
    let run = Run::open(&directory).unwrap();
    let text = run.to_csv().unwrap();
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
    let rows: Vec<Vec<String>> =
        reader.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect();
    assert_eq!(rows[0], ["step", "time", "A.uy, \"odd\""]);
    assert_eq!(rows[1], ["s", "kg, net", "s"]);
    let json: serde_json::Value = serde_json::from_str(&run.to_json()).unwrap();
    for (i, row) in values.iter().enumerate() {
        for (k, value) in row.iter().enumerate() {
            assert_eq!(rows[2 + i][k].parse::<f64>().unwrap().to_bits(), value.to_bits());
            let found = &json["columns"][k]["values"][i];
            assert_eq!(found.as_f64().map(f64::to_bits), value.is_finite().then(|| value.to_bits()));
        }
    }
    assert_eq!(rows[2][0], "0");
}
