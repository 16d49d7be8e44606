//! A table of amplitudes: a CSV file with the columns `t` and `value`; others are ignored. Every
//! error is reported with file and line.

use std::path::Path;

use serde::{Deserialize, Serialize};

/// A factor over time, linearly interpolated. It is stored completely, so that a run can be resumed
/// without the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TableSpec {
    /// Name of the file, as given.
    pub file: String,
    /// Times, ascending, at least two.
    pub times: Vec<f64>,
    /// Factors.
    pub values: Vec<f64>,
}

impl TableSpec {
    /// The factor at a time within the table.
    pub fn value(&self, time: f64) -> f64 {
        let after = self.times.partition_point(|t| *t <= time).clamp(1, self.times.len() - 1);
        let t = &self.times[after - 1..=after];
        let v = &self.values[after - 1..=after];
        let share = (time - t[0]) / (t[1] - t[0]);
        (1.0 - share) * v[0] + share * v[1]
    }
}

/// Largest number of lines; the resolved case stores them all.
const MOST_LINES: usize = 1_000_000;
/// Largest number of bytes: a file without line ends has no lines to count.
const MOST_BYTES: u64 = 100_000_000;

/// Why a table cannot be used, and what to try.
#[derive(Debug)]
pub(super) struct TableError {
    /// Reason, with the name and line of the file.
    pub(super) why: String,
    pub(super) help: String,
}

impl TableError {
    fn new(why: String, help: impl Into<String>) -> Self {
        Self { why, help: help.into() }
    }

    fn in_line(name: &str, line: u64, why: impl std::fmt::Display) -> Self {
        Self::new(format!("{name}:{line}: {why}"), format!("correct line {line} of {name}"))
    }

    fn of_path(why: String) -> Self {
        Self::new(why, "check the path: a relative one starts at the folder of this file")
    }
}

/// Reads the file at `path`, called `name` in messages.
///
/// # Errors
/// If it is not a table of amplitudes.
pub(super) fn read(path: &Path, name: &str) -> Result<TableSpec, TableError> {
    columns(path, name, ["t", "value"])
}

/// Reads the two columns with the headings `wanted` from the file at `path`, called `name` in
/// messages.
///
/// # Errors
/// If it is not a table with these columns.
pub(super) fn columns(path: &Path, name: &str, wanted: [&str; 2]) -> Result<TableSpec, TableError> {
    let unreadable = |error: csv::Error| match (error.kind(), error.position().map(csv::Position::line)) {
        (csv::ErrorKind::Io(io), _) if io.kind() == std::io::ErrorKind::NotFound => {
            TableError::of_path(format!("there is no file {}", path.display()))
        }
        (csv::ErrorKind::UnequalLengths { expected_len, len, .. }, Some(line)) => {
            let why = format!("{len} values, but the first line has {expected_len}");
            TableError::in_line(name, line, why)
        }
        (_, Some(line)) => TableError::in_line(name, line, error),
        (_, None) => TableError::of_path(format!("{name}: {error}")),
    };
    let facts = std::fs::metadata(path).map_err(|error| unreadable(error.into()))?;
    if !facts.is_file() {
        return Err(TableError::of_path(format!("{} is not a regular file", path.display())));
    }
    if facts.len() > MOST_BYTES {
        let why = format!("{name}: {} bytes, but a table has at most {MOST_BYTES}", facts.len());
        return Err(TableError::new(why, "leave out lines or columns"));
    }
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_path(path)
        .map_err(unreadable)?;
    let headers = reader.headers().map_err(unreadable)?.clone();
    let column = |wanted: &str| {
        headers.iter().position(|h| h == wanted).ok_or_else(|| {
            let found = headers.iter().collect::<Vec<_>>().join(", ");
            let why = format!("{name}:1: there is no column `{wanted}`; the columns are: {found}");
            TableError::new(why, format!("begin {name} with a line of headings, one of them `{wanted}`"))
        })
    };
    let columns = [column(wanted[0])?, column(wanted[1])?];
    let mut table = TableSpec { file: name.to_owned(), times: Vec::new(), values: Vec::new() };
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |k: usize| {
            let text = record.get(columns[k]).unwrap_or_default();
            let why = || format!("`{}` is not a finite number: {text:?}", wanted[k]);
            let wrong = || TableError::in_line(name, line, why());
            text.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(wrong)
        };
        let time = number(0)?;
        let value = number(1)?;
        if let Some(before) = table.times.last().filter(|before| **before >= time) {
            let why = format!("times must increase, but {time} follows {before}");
            return Err(TableError::in_line(name, line, why));
        }
        if table.times.len() == MOST_LINES {
            let why = format!("{name}:{line}: more than {MOST_LINES} lines");
            return Err(TableError::new(why, "leave out lines"));
        }
        table.times.push(time);
        table.values.push(value);
    }
    if table.times.len() < 2 {
        let why = format!("{name}: at least two lines of numbers are needed, not {}", table.times.len());
        return Err(TableError::new(why, "add the line of another time"));
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;

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
            (
                "t,value\n0,1\n1,x\n",
                "a.csv:3: `value` is not a finite number: \"x\"; correct line 3 of a.csv",
            ),
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
        assert!(
            error.why.contains("there is no file nowhere/b.csv") && error.help.contains("check the path")
        );
        let folder = tempfile::tempdir().unwrap();
        for endless in [Path::new("/dev/zero"), folder.path()].into_iter().filter(|path| path.exists()) {
            assert!(read(endless, "b.csv").unwrap_err().why.contains("is not a regular file"));
        }
    }
}
