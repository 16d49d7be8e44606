//! Tables whose cells stand below each other in a narrow window, each with the heading of its
//! column.
//!
//! The style sheet does so for tables of the class `stack`; it reads the headings from the cells.

/// A page on which every cell of these tables names its column.
pub(crate) fn with_headings(page: &str) -> String {
    let mut parts = page.split("<table class=\"stack\"");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |out, part| {
        let (table, rest) = part.split_once("</table>").unwrap_or((part, ""));
        format!("{out}<table class=\"stack\"{}</table>{rest}", headed(table))
    })
}

fn headed(table: &str) -> String {
    let Some((head, body)) = table.split_once("</thead>") else { return table.to_owned() };
    let headings: Vec<String> = head.split("<th").skip(2).map(words).collect();
    let row = |row: &str| {
        let mut cells = row.split("<td");
        let before = cells.next().unwrap_or_default().to_owned();
        cells.zip(&headings).fold(before, |out, (cell, heading)| {
            // What runs through several columns is under none of them.
            let is_wide = cell.split('>').next().is_some_and(|tag| tag.contains("colspan"));
            let name = if is_wide { String::new() } else { format!(" data-head=\"{heading}\"") };
            format!("{out}<td{name}{cell}")
        })
    };
    let rows: Vec<String> = body.split("<tr>").map(row).collect();
    format!("{head}</thead>{}", rows.join("<tr>"))
}

/// The text of an element whose tag was cut open.
fn words(element: &str) -> String {
    element.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_names_its_column() {
        let table = |cells: [&str; 3]| {
            let [a, b, wide] = cells;
            format!(
                "<p><table class=\"stack\"><thead><tr><th>A</th><th class=\"n\">B<sub>2</sub></th></tr></thead>\
                 <tr><td{a}>1</td><td{b} class=\"n\">2</td></tr><tr><td{wide} colspan=\"2\">3</td></tr></table><td>"
            )
        };
        let headed = table([" data-head=\"A\"", " data-head=\"B2\"", ""]);
        assert_eq!(with_headings(&table([""; 3])), headed);
        assert_eq!(with_headings("<table><td>"), "<table><td>");
    }
}
