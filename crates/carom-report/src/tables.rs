//! The table beside a figure of curves, with columns `pane,curve,x,y`.

use std::fmt::Write as _;

use crate::chart::{Chart, Options, WIDTH};
use crate::figure::{Figure, NARROW};
use crate::plot::{Band, Plot};

impl Chart<'_> {
    /// The figure of that name, broad and narrow, with its table.
    pub(crate) fn figure(&self, name: &str, caption: String, options: &Options) -> Figure {
        let pictures = [WIDTH, NARROW].map(|width| self.draw(&Options { width, ..*options }));
        Figure::new(name, caption, pictures).with_table(self.csv())
    }

    fn csv(&self) -> String {
        // Tables have names without the signs of subscripts.
        let bare = |label: &str| label.replace("_{", "_").replace('}', "");
        let mut table = Table::default();
        for panel in &self.panels {
            for series in &panel.series {
                table.add(&bare(&panel.label), &bare(&series.label), series.x, &series.y);
            }
        }
        table.text()
    }
}

impl Plot {
    /// The figure, broad and narrow, with its table.
    pub(crate) fn figure(&self) -> Figure {
        let pictures = [WIDTH, NARROW].map(|width| self.drawn(width));
        Figure::new(&self.name, &self.caption, pictures).with_table(self.csv())
    }

    /// The values of all curves; the edges of a band and the ends of
    /// intervals are the curves `NAME, low` and `NAME, high`.
    pub(crate) fn csv(&self) -> String {
        let mut table = Table::default();
        for pane in &self.panes {
            if let Some(Band { name, x, low, high }) = &pane.band {
                table.add(pane.name(), &format!("{name}, low"), x, low);
                table.add(pane.name(), &format!("{name}, high"), x, high);
            }
            for curve in &pane.curves {
                table.add(pane.name(), &curve.label, &curve.x, &curve.y);
                if !curve.intervals.is_empty() {
                    let ends = |k: usize| curve.intervals.iter().map(|ends| ends[k]).collect::<Vec<f64>>();
                    table.add(pane.name(), &format!("{}, low", curve.label), &curve.x, &ends(0));
                    table.add(pane.name(), &format!("{}, high", curve.label), &curve.x, &ends(1));
                }
            }
        }
        table.text()
    }
}

/// Rows in the order in which curves are added.
#[derive(Default)]
struct Table {
    rows: String,
}

impl Table {
    fn add(&mut self, pane: &str, curve: &str, x: &[f64], y: &[f64]) {
        let names = format!("{},{}", quoted(pane), quoted(curve));
        for (x, y) in x.iter().zip(y) {
            let _ = writeln!(self.rows, "{names},{x:?},{y:?}");
        }
    }

    fn text(&self) -> String {
        format!("pane,curve,x,y\n{}", self.rows)
    }
}

/// Text as a cell of a table.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

#[cfg(test)]
mod tests {
    use crate::plot::tests::plot;

    #[test]
    fn the_table_has_all_values() {
        assert_eq!(
            plot().csv(),
            "pane,curve,x,y\n\"one\",\"Hu, \"\"a\"\"\",0.001,0.0\n\"one\",\"Hu, \"\"a\"\"\",0.01,0.0002\n"
        );
    }
}
