//! SVG path data on a grid of 1/20 pixel, as relative integers: short, and without accumulated
//! rounding errors.
//!
//! Such data belong in a group opened by [`open_grid`], where stroke widths are in grid units.

use std::fmt::Write as _;

/// A point in pixels or in the units of length of the case.
pub(crate) type Point = [f64; 2];

/// A frame around no point: left, right, bottom, top.
pub(crate) const NOTHING: [f64; 4] = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];

/// The frame around another one and these points.
pub(crate) fn around(frame: [f64; 4], points: impl IntoIterator<Item = Point>) -> [f64; 4] {
    points.into_iter().fold(frame, |f, [x, y]| [f[0].min(x), f[1].max(x), f[2].min(y), f[3].max(y)])
}

/// Grid lines per pixel.
pub(crate) const GRID: f64 = 20.0;

/// Opens a group in the coordinates of a pen; close it with `</g>`.
pub(crate) fn open_grid() -> String {
    format!("<g transform=\"scale({})\">\n", 1.0 / GRID)
}

/// The data of a path through points in pixels, with a tenth of them; it is not closed.
pub(crate) fn polyline(points: &[Point]) -> String {
    let points: Vec<String> = points.iter().map(|[x, y]| format!("{x:.1} {y:.1}")).collect();
    format!("M{}", points.join("L"))
}

/// Adds a path of a pen.
pub(crate) fn path(out: &mut String, pen: &Pen, style: &str) {
    let _ = writeln!(out, "{}<path d=\"{}\" {style}/>\n</g>", open_grid(), pen.data());
}

/// Path data under construction.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pen {
    data: String,
    at: [i64; 2],
    start: [i64; 2],
    command: char,
}

impl Pen {
    /// Moves to the start of a new subpath.
    pub(crate) fn go(&mut self, p: Point) {
        self.put('m', &[p]);
        self.start = self.at;
    }

    /// Draws a line, or with two or three points a Bézier curve of degree two or three.
    pub(crate) fn draw(&mut self, points: &[Point]) {
        self.put(['l', 'q', 'c'][points.len().clamp(1, 3) - 1], points);
    }

    /// Closes the subpath.
    pub(crate) fn close(&mut self) {
        self.data.push('z');
        self.command = 'z';
        self.at = self.start;
    }

    /// Draws a polygon.
    pub(crate) fn polygon(&mut self, corners: &[Point]) {
        for (k, corner) in corners.iter().enumerate() {
            if k == 0 { self.go(*corner) } else { self.draw(&[*corner]) }
        }
        self.close();
    }

    fn put(&mut self, command: char, points: &[Point]) {
        // A repeated command may be omitted, and so may an `l` after an `m`.
        let implied = command != 'm' && (self.command == command || (self.command == 'm' && command == 'l'));
        if !implied {
            self.data.push(command);
        }
        self.command = command;
        let mut first = !implied;
        let mut end = self.at;
        for p in points {
            end = p.map(|x| (x * GRID).round() as i64);
            for (to, from) in end.iter().zip(&self.at) {
                let by = to - from;
                if !first && by >= 0 {
                    self.data.push(' ');
                }
                first = false;
                self.data.push_str(&by.to_string());
            }
        }
        self.at = end;
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.data.is_empty()
    }

    /// The content of a path's `d`.
    pub(crate) fn data(&self) -> &str {
        &self.data
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_and_without_drift() {
        let mut pen = Pen::default();
        pen.go([1.0, 2.0]);
        pen.draw(&[[1.5, 1.0]]);
        pen.draw(&[[1.5, 3.0]]);
        pen.close();
        pen.go([0.0, 0.0]);
        pen.draw(&[[1.0, 0.0], [2.0, -1.0]]);
        assert_eq!(pen.data(), "m20 40 10-20 0 40zm-20-40q20 0 40-20");
        // Rounding errors of a thousand steps of a third of the grid do not add up.
        let mut pen = Pen::default();
        pen.go([0.0, 0.0]);
        (1..=1000).for_each(|i| pen.draw(&[[f64::from(i) / 60.0, 0.0]]));
        assert_eq!(pen.at, [333, 0]);
    }
}
