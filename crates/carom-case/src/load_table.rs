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
pub struct TableError {
    /// Reason, with the name and line of the file.
    pub why: String,
    /// Advice to the user.
    pub help: String,
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
pub fn read(path: &Path, name: &str) -> Result<TableSpec, TableError> {
    columns(path, name, ["t", "value"])
}

/// Reads the two columns with the headings `wanted` from the file at `path`, called `name` in
/// messages.
///
/// # Errors
/// If it is not a table with these columns.
pub(crate) fn columns(path: &Path, name: &str, wanted: [&str; 2]) -> Result<TableSpec, TableError> {
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
