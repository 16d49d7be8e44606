//! A table of amplitudes: a CSV file with the columns `t` and `value`; others are ignored. Every
//! error is reported with file and line.

use std::path::Path;

use super::TableSpec;

/// Largest number of lines; the resolved case stores them all.
const MOST_LINES: usize = 1_000_000;
/// Largest number of bytes: a file without line ends has no lines to count.
const MOST_BYTES: u64 = 100_000_000;

/// Reads the file at `path`, called `name` in messages.
///
/// # Errors
/// A message with the file's name and line.
pub(super) fn read(path: &Path, name: &str) -> Result<TableSpec, String> {
    columns(path, name, ["t", "value"])
}

/// The same of the columns with these headings.
///
/// # Errors
/// A message with the file's name and line.
pub(super) fn columns(path: &Path, name: &str, wanted: [&str; 2]) -> Result<TableSpec, String> {
    let unreadable = |error: csv::Error| {
        let line = error.position().map_or(String::new(), |p| format!(":{}", p.line()));
        match error.kind() {
            csv::ErrorKind::Io(io) if io.kind() == std::io::ErrorKind::NotFound => {
                format!("there is no file {}", path.display())
            }
            csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                format!("{name}{line}: {len} values, but the first line has {expected_len}")
            }
            _ => format!("{name}{line}: {error}"),
        }
    };
    let facts = std::fs::metadata(path).map_err(|error| unreadable(error.into()))?;
    if !facts.is_file() {
        return Err(format!("{} is not a regular file", path.display()));
    }
    if facts.len() > MOST_BYTES {
        return Err(format!("{name}: {} bytes, but a table has at most {MOST_BYTES}", facts.len()));
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
            format!("{name}:1: there is no column `{wanted}`; the columns are: {found}")
        })
    };
    let columns = [column(wanted[0])?, column(wanted[1])?];
    let mut table = TableSpec { file: name.to_owned(), times: Vec::new(), values: Vec::new() };
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |k: usize| {
            let text = record.get(columns[k]).unwrap_or_default();
            let wrong = || format!("{name}:{line}: `{}` is not a finite number: {text:?}", wanted[k]);
            text.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(wrong)
        };
        let (time, value) = (number(0)?, number(1)?);
        if let Some(before) = table.times.last().filter(|before| **before >= time) {
            return Err(format!("{name}:{line}: times must increase, but {time} follows {before}"));
        }
        if table.times.len() == MOST_LINES {
            return Err(format!("{name}:{line}: more than {MOST_LINES} lines"));
        }
        table.times.push(time);
        table.values.push(value);
    }
    if table.times.len() < 2 {
        return Err(format!("{name}: at least two lines of numbers are needed, not {}", table.times.len()));
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Result<TableSpec, String> {
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
            ("t,force\n0,1\n", "a.csv:1: there is no column `value`; the columns are: t, force"),
            ("t,value\n0,1\n1,x\n", "a.csv:3: `value` is not a finite number: \"x\""),
            ("t,value\n0,1\n1,nan\n", "a.csv:3: `value` is not a finite number: \"nan\""),
            ("t,value\n0,1\n0,2\n", "a.csv:3: times must increase, but 0 follows 0"),
            ("t,value\n0,1\n1\n", "a.csv:3: 1 values, but the first line has 2"),
            ("t,value\n0,1\n", "a.csv: at least two lines of numbers are needed, not 1"),
        ] {
            assert_eq!(table(text).unwrap_err(), message);
        }
        assert!(
            read(Path::new("nowhere/b.csv"), "b.csv").unwrap_err().contains("there is no file nowhere/b.csv")
        );
        let folder = tempfile::tempdir().unwrap();
        for endless in [Path::new("/dev/zero"), folder.path()].into_iter().filter(|path| path.exists()) {
            assert!(read(endless, "b.csv").unwrap_err().contains("is not a regular file"));
        }
    }
}
