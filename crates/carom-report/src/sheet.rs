//! The sheet of a figure of several instants: pictures at the same scale side by side, with letters
//! and times, a scale bar, and a colour bar.

use std::fmt::Write as _;

use crate::again::{Rectangle, again, once};
use crate::axis::{Axis, round_step};
use crate::bands::Bands;
use crate::chart::{open, write_text};
use crate::figure::NARROW;
use crate::pen::Point;
use crate::symbols::scale_bar;
use crate::text;

/// Usual width of a sheet; one of half of it has half as many columns.
const SHEET: f64 = 940.0;
/// Room for the colour bar, between pictures, and for a heading.
const BAR: f64 = 96.0;
/// Room for the label of a colour bar.
const ROOM: f64 = 78.0;
const GAP: f64 = 14.0;
/// Least scale of a picture that is shown again, relative to the first one.
const ALIKE: f64 = 0.7;
/// Greatest height of a colour bar.
const TALLEST: f64 = 420.0;
const LINE: f64 = 30.0;

/// Content of a colour bar: bands, whether values lie below and above them, quantity and unit.
#[derive(Clone, Copy)]
pub(crate) struct Legend<'a> {
    pub(crate) bands: &'a Bands,
    pub(crate) cut: [bool; 2],
    pub(crate) label: &'a str,
    pub(crate) unit: &'a str,
}

/// A figure under construction.
pub(crate) struct Sheet {
    pub(crate) out: String,
    /// Left, right, bottom, top of every picture in units of length.
    frame: [f64; 4],
    /// Pixels per unit of length.
    pub(crate) scale: f64,
    columns: usize,
    width: f64,
    /// Height in pixels, without and with what is below the pictures.
    pub(crate) pictures: f64,
    height: f64,
}

impl Sheet {
    /// A sheet of a width for a number of pictures, with `foot` pixels below them.
    fn new(title: &str, count: usize, frame: [f64; 4], (width, foot): (f64, f64)) -> Self {
        let [x0, x1, y0, y1] = frame;
        let aspect = (x1 - x0) / (y1 - y0).max(1e-12 * (x1 - x0).abs()).max(f64::MIN_POSITIVE);
        let most = if aspect < 1.3 {
            5
        } else if aspect < 2.6 {
            3
        } else {
            1
        };
        let most = if width < SHEET { most / 2 } else { most };
        let columns = count.min(most).max(1);
        let cell_width = (width - BAR - 8.0) / columns as f64;
        let scale = ((cell_width - GAP) / (x1 - x0)).min(460.0 / (y1 - y0));
        let pictures = count.div_ceil(columns) as f64 * ((y1 - y0) * scale + LINE + GAP);
        let height = pictures + foot;
        Self { out: open(title, width, height), frame, scale, columns, width, pictures, height }
    }

    /// The broad and the narrow sheet of pictures with headings, of which `draw` draws one. The
    /// narrow one shows those of the broad one again, unless their lines would become too thin.
    pub(crate) fn pair<'a>(
        title: &str,
        headings: impl ExactSizeIterator<Item = &'a str>,
        frame: [f64; 4],
        foot: f64,
        draw: impl Fn(&mut Self, usize),
    ) -> [Self; 2] {
        let [mut broad, mut narrow] =
            [SHEET, NARROW].map(|width| Self::new(title, headings.len(), frame, (width, foot)));
        let is_alike = narrow.scale > ALIKE * broad.scale;
        for (k, heading) in headings.enumerate() {
            broad.heading(k, heading);
            narrow.heading(k, heading);
            let before = broad.out.len();
            draw(&mut broad, k);
            if is_alike {
                let name = format!("picture-{k}");
                let content = broad.out.split_off(before);
                once(&mut broad.out, &name, "picture", &content);
                let [from, to] = [&broad, &narrow].map(|sheet| sheet.picture(k));
                again(&mut narrow.out, &name, from, to);
            } else {
                draw(&mut narrow, k);
            }
        }
        [broad, narrow]
    }

    /// Left end of the room of picture `k`, and top of the picture.
    fn corner(&self, k: usize) -> Point {
        let row = (self.frame[3] - self.frame[2]) * self.scale + LINE + GAP;
        [8.0 + (k % self.columns) as f64 * self.cell_width(), (k / self.columns) as f64 * row + LINE]
    }

    fn cell_width(&self) -> f64 {
        (self.width - BAR - 8.0) / self.columns as f64
    }

    /// The rectangle of picture `k`.
    pub(crate) fn picture(&self, k: usize) -> Rectangle {
        let size = [self.frame[1] - self.frame[0], self.frame[3] - self.frame[2]].map(|s| s * self.scale);
        let [left, top] = self.corner(k);
        [left + 0.5 * (self.cell_width() - GAP - size[0]), top, size[0], size[1]]
    }

    /// The map from units of length to pixels in picture `k`.
    pub(crate) fn map(&self, k: usize) -> impl Fn(Point) -> Point + use<> {
        let [left, top, ..] = self.picture(k);
        let frame = self.frame;
        let scale = self.scale;
        move |p| [left + (p[0] - frame[0]) * scale, top + (frame[3] - p[1]) * scale]
    }

    /// Letter and time of picture `k`.
    fn heading(&mut self, k: usize, time: &str) {
        let [room, top] = self.corner(k);
        let left = self.picture(k)[0].min(room + 0.5 * self.cell_width() - 50.0);
        let letter = char::from(b'a' + (k % 25) as u8);
        let _ = writeln!(
            self.out,
            "<text x=\"{left:.1}\" y=\"{:.1}\"><tspan font-weight=\"bold\">({letter})</tspan> {}</text>",
            top - 11.0,
            text::svg(time)
        );
    }

    /// Adds a scale bar of a round length and the colour bar.
    pub(crate) fn finish(mut self, legend: &Legend, length: &str) -> String {
        let size = round_step(self.frame[1] - self.frame[0], 3.0);
        let y = self.height - 22.0;
        scale_bar(&mut self.out, [8.0, y - 3.0], size * self.scale, (size, length));
        // Not longer than what is compared with it needs.
        let bottom = (self.height - 50.0).min(LINE + TALLEST);
        color_bar(&mut self.out, legend, self.width - BAR + 18.0, (LINE, bottom));
        self.out.push_str("</svg>\n");
        self.out
    }
}

/// Vertical colour bar with ticks, and an arrow at an end beyond which there are values.
pub(crate) fn color_bar(out: &mut String, legend: &Legend, x: f64, (top, bottom): (f64, f64)) {
    let Legend { bands, cut, label, unit } = *legend;
    let top = top + 22.0;
    let width = 15.0;
    let h = (bottom - top) / bands.count as f64;
    let mut arrow = |end: f64, tip: f64, band: usize| {
        let color = bands.color(band);
        let _ = writeln!(
            out,
            "<path d=\"M{x:.1} {end:.1}h{width}l-7.5 {tip}z\" fill=\"{color}\" stroke=\"#222\" \
             stroke-width=\"0.7\"/>"
        );
    };
    if cut[1] {
        arrow(top, -11.0, bands.count - 1);
    }
    if cut[0] {
        arrow(bottom, 11.0, 0);
    }
    for band in 0..bands.count {
        let y = bottom - (band + 1) as f64 * h;
        let _ = writeln!(
            out,
            "<rect x=\"{x:.1}\" y=\"{y:.2}\" width=\"{width}\" height=\"{:.2}\" fill=\"{}\"/>",
            h + 0.3,
            bands.color(band)
        );
    }
    let _ = writeln!(
        out,
        "<rect x=\"{x:.1}\" y=\"{top:.1}\" width=\"{width}\" height=\"{:.1}\" fill=\"none\" stroke=\"#222\" \
         stroke-width=\"0.7\"/>",
        bottom - top
    );
    if bands.is_zero() {
        write_text(out, x + width + 7.0, 0.5 * (top + bottom) + 4.3, "", "≈ 0");
        write_text(out, x - 2.0, top - 20.0, "", label);
        return;
    }
    let axis = Axis::new((bands.low, bands.high), 6.0, true);
    for (value, tick) in &axis.ticks {
        let y = bottom - (bottom - top) * axis.position(*value);
        let _ =
            writeln!(out, "<path d=\"M{:.1} {y:.1}h4\" stroke=\"#222\" stroke-width=\"0.8\"/>", x + width);
        write_text(out, x + width + 7.0, y + 4.3, "", tick);
    }
    let label = axis.label(label, unit);
    // Further left, then smaller, where it is wider than the bar with its ticks.
    let wide = 13.0 * text::width(&label);
    let left = (wide - ROOM).clamp(0.0, 14.0);
    let size = (ROOM + left).min(wide) / text::width(&label).max(1e-9);
    write_text(out, x - 2.0 - left, top - 20.0, &format!("font-size=\"{size:.1}\""), &label);
}
