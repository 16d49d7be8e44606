//! Tables of loads.

use std::path::Path;

use carom_case::TableSpec;
use carom_case::load_table::{TableError, read};

fn table(text: &str) -> Result<TableSpec, TableError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    std::fs::write(&path, text).unwrap();
    read(&path, "a.csv")
}

#[test]
fn a_table_is_linear_between_its_lines() {
    let table = table("# a ramp\nvalue, t\n0, 0\n2, 0.5\n\n-2, 1.5\n").unwrap();
    for (time, value) in [(0.0, 0.0), (0.25, 1.0), (0.5, 2.0), (1.0, 0.0), (1.5, -2.0)] {
        assert_eq!(table.value(time), value);
    }
}

#[test]
fn errors_name_file_and_line() {
    for (text, message) in [
        (
            "t,force\n0,1\n",
            "a.csv:1: there is no column `value`; the columns are: t, force; \
             begin a.csv with a line of headings, one of them `value`",
        ),
        ("t,value\n0,1\n1,x\n", "a.csv:3: `value` is not a finite number: \"x\"; correct line 3 of a.csv"),
        (
            "t,value\n0,1\n1,nan\n",
            "a.csv:3: `value` is not a finite number: \"nan\"; correct line 3 of a.csv",
        ),
        ("t,value\n0,1\n0,2\n", "a.csv:3: times must increase, but 0 follows 0; correct line 3 of a.csv"),
        ("t,value\n0,1\n1\n", "a.csv:3: 1 values, but the first line has 2; correct line 3 of a.csv"),
        (
            "t,value\n0,1\n",
            "a.csv: at least two lines of numbers are needed, not 1; add the line of another time",
        ),
    ] {
        let error = table(text).unwrap_err();
        assert_eq!(format!("{}; {}", error.why, error.help), message);
    }
    let error = read(Path::new("nowhere/b.csv"), "b.csv").unwrap_err();
    assert!(error.why.contains("there is no file nowhere/b.csv") && error.help.contains("check the path"));
    let folder = tempfile::tempdir().unwrap();
    for endless in [Path::new("/dev/zero"), folder.path()].into_iter().filter(|path| path.exists()) {
        assert!(read(endless, "b.csv").unwrap_err().why.contains("is not a regular file"));
    }
}
