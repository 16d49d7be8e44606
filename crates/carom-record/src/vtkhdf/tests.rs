use super::*;
use crate::vtu::tests::sample;

/// Fields of a step: the sample, with values that differ from step to step.
fn fields(step: u64) -> FieldSet {
    let mut fields = sample();
    fields.arrays.iter_mut().flat_map(|a| &mut a.values).for_each(|v| *v += step as f64);
    fields
}

fn entry(step: u64) -> FieldEntry {
    FieldEntry { step, time: 0.125 * step as f64 }
}

fn written(directory: &Path, count: u64) {
    for i in 0..count {
        put(directory, i as usize, &entry(5 * i), &fields(5 * i)).unwrap();
    }
}

#[test]
fn reads_what_it_wrote_through_growth_and_cut() {
    let place = tempfile::tempdir().unwrap();
    // Beyond two doublings.
    for count in [1, 16, 17, 40] {
        keep(place.path(), &[]).unwrap();
        written(place.path(), count);
        for cut in [false, true] {
            if cut {
                finish(place.path()).unwrap();
            }
            let found = entries(place.path()).unwrap().unwrap();
            assert_eq!(found, (0..count).map(|i| entry(5 * i)).collect::<Vec<_>>());
            for entry in found {
                assert_eq!(read(place.path(), &entry).unwrap(), fields(entry.step));
            }
        }
    }
}

#[test]
fn the_same_steps_give_the_same_bytes() {
    let place = tempfile::tempdir().unwrap();
    let (whole, cut) = (place.path().join("whole"), place.path().join("cut"));
    [&whole, &cut].into_iter().for_each(|p| fs::create_dir(p).unwrap());
    written(&whole, 19);
    finish(&whole).unwrap();
    written(&cut, 18);
    finish(&cut).unwrap();
    let first: Vec<FieldEntry> = (0..7).map(|i| entry(5 * i)).collect();
    keep(&cut, &first).unwrap();
    assert_eq!(entries(&cut).unwrap().unwrap(), first);
    for i in 7..19 {
        put(&cut, i, &entry(5 * i as u64), &fields(5 * i as u64)).unwrap();
    }
    finish(&cut).unwrap();
    assert!(fs::read(path(&whole)).unwrap() == fs::read(path(&cut)).unwrap());
}

/// `count` writes one contiguous range within one sector, for any names.
#[test]
fn counting_a_step_changes_one_sector() {
    let place = tempfile::tempdir().unwrap();
    written(place.path(), 3);
    let before = fs::read(path(place.path())).unwrap();
    open(place.path(), true).unwrap().unwrap().count(2).unwrap();
    let after = fs::read(path(place.path())).unwrap();
    let changed: Vec<usize> = (0..before.len()).filter(|&i| before[i] != after[i]).collect();
    assert_eq!(changed.len(), 2);
    assert_eq!(changed[0] / 512, changed[1] / 512);
}

#[test]
fn damage_is_an_error_and_never_a_panic() {
    let place = tempfile::tempdir().unwrap();
    written(place.path(), 2);
    finish(place.path()).unwrap();
    let bytes = fs::read(path(place.path())).unwrap();
    let look = |bytes: &[u8]| {
        let mut opened = Opened::of(io::Cursor::new(bytes), PathBuf::new())?;
        opened.entries()?.iter().try_for_each(|e| opened.fields(e.step).map(|_| ()))
    };
    look(&bytes).unwrap();
    for end in (0..bytes.len() - 8).step_by(7) {
        assert!(look(&bytes[..end]).is_err(), "cut at {end}");
    }
    for at in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x95;
        let _ = look(&damaged);
    }
}

#[test]
fn errors_say_why() {
    let place = tempfile::tempdir().unwrap();
    written(place.path(), 2);
    let error = put(place.path(), 3, &entry(15), &fields(15)).unwrap_err().to_string();
    assert!(error.contains("2 steps, but had 3"), "{error}");
    let mut other = fields(10);
    other.arrays[1].unit = "kPa".into();
    let error = put(place.path(), 2, &entry(10), &other).unwrap_err().to_string();
    assert!(error.contains("other bodies or quantities"), "{error}");
    fs::remove_file(path(place.path())).unwrap();
    let error = put(place.path(), 2, &entry(10), &fields(10)).unwrap_err().to_string();
    assert!(error.contains("missing"), "{error}");
    assert!(entries(place.path()).unwrap().is_none());
}
