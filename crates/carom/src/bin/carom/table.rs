//! Tables in a terminal.

/// Lines with the cells of some rows below each other, two spaces apart. The columns `right` are
/// set flush right. What ends a row is text, which is not padded and whose length does not count:
/// the last cell, unless it is one of `right` in a row with all cells.
pub(crate) fn lines(rows: &[Vec<String>], right: &[usize]) -> Vec<String> {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let is_text = |row: &[String], column: usize| {
        column + 1 == row.len() && (row.len() < count || !right.contains(&column))
    };
    let width = |column: usize| {
        let cells = rows.iter().filter(|row| column < row.len() && !is_text(row, column));
        cells.map(|row| row[column].chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..count).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
            match (is_text(row, column), right.contains(&column)) {
                (true, _) => cell.clone(),
                (_, true) => format!("{cell:>width$}"),
                _ => format!("{cell:width$}"),
            }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::lines;

    #[test]
    fn numbers_stand_below_each_other_and_text_ends_a_row() {
        let rows = [["peak", "1.5", "a long text"], ["duration", "12.25", "short"]];
        let mut rows: Vec<Vec<String>> = rows.map(|row| row.map(str::to_owned).into()).into();
        rows.push(vec!["x".to_owned(), "failed: a row of other cells".to_owned()]);
        assert_eq!(lines(&rows[..2], &[1]), ["peak        1.5  a long text", "duration  12.25  short"]);
        assert_eq!(
            lines(&rows, &[1])[1..],
            ["duration  12.25  short", "x         failed: a row of other cells"]
        );
    }
}
