//! What is written is read back, by bits; what has changed since is named.

use std::fs;
use std::path::Path;

use carom_record::{ContactRow, Event, Manifest, RecordError, Run, RunWriter, Status};

use crate::common::{STEPS, advance, fields, manifest, scratch, started};

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
        ..ContactRow::default()
    };
    writer.contact(std::slice::from_ref(&row)).unwrap();
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
    of_space.facts.dimension = 3;
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
        ..ContactRow::default()
    };
    writer.history(&[0.0, 0.1, 0.0]).unwrap();
    writer.contact(std::slice::from_ref(&row)).unwrap();
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
    let mut writer = advance(started(&directory), 0, 0, STEPS);
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
