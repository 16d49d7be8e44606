//! Line charts against a shared horizontal axis, one panel above the other.

use std::fmt::{Display, Write as _};

use crate::axis::{Axis, range};
use crate::labels::unit_of;
use crate::text;
use crate::trace::path;

/// Usual width of a figure.
pub(crate) const WIDTH: f64 = 720.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 14.0;
const FONT: f64 = 13.0;

/// A curve.
#[derive(Default)]
pub(crate) struct Series<'a> {
    pub(crate) label: String,
    pub(crate) color: &'static str,
    pub(crate) x: &'a [f64],
    pub(crate) y: Vec<f64>,
    /// Whether its points are drawn, instead of lines between them.
    pub(crate) dotted: bool,
    /// Whether its label is for tables only.
    pub(crate) unlisted: bool,
}

/// Curves with one vertical axis.
pub(crate) struct Panel<'a> {
    pub(crate) label: String,
    pub(crate) unit: String,
    pub(crate) height: f64,
    pub(crate) series: Vec<Series<'a>>,
}

/// Panels with a common horizontal axis.
pub(crate) struct Chart<'a> {
    pub(crate) title: &'a str,
    pub(crate) x_label: String,
    /// Shaded intervals of x.
    pub(crate) shades: Vec<(f64, f64)>,
    pub(crate) panels: Vec<Panel<'a>>,
}

/// Times of events of one kind, drawn as ticks.
pub(crate) struct Track {
    pub(crate) label: String,
    pub(crate) times: Vec<f64>,
}

/// Options of the drawing.
#[derive(Clone, Copy)]
pub(crate) struct Options<'a> {
    /// Width in pixels.
    pub(crate) width: f64,
    /// Events below the panels.
    pub(crate) tracks: &'a [Track],
    /// Whether x is the time of the run, along which the cursor of the animation moves.
    pub(crate) time: bool,
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self { width: WIDTH, tracks: &[], time: false }
    }
}

/// The opening of an SVG figure, with fonts and background so that it stands alone.
pub(crate) fn open(title: &str, width: f64, height: f64) -> String {
    opened("picture", title, width, height)
}

/// The same of a class: a dark page shows a `chart` in light colours on dark ground.
pub(crate) fn opened(class: &str, title: &str, width: f64, height: f64) -> String {
    format!(
        "<svg class=\"{class}\" xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"0 \
         0 {width:.0} {height:.0}\" \
         role=\"img\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\" \
         font-size=\"{FONT}\" fill=\"#222\">\n\
         <title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        text::escape(title)
    )
}

/// A text element; `extra` holds further attributes.
pub(crate) fn write_text(out: &mut String, x: f64, y: f64, extra: &str, label: &str) {
    let _ = writeln!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" {extra}>{}</text>", text::svg(label));
}

/// A text element turned upwards around its middle, as the label of a vertical axis.
pub(crate) fn turned(out: &mut String, (x, y): (impl Display, f64), extra: &str, label: &str) {
    let at = format!("text-anchor=\"middle\"{extra} transform=\"translate({x} {y:.1}) rotate(-90)\"");
    write_text(out, 0.0, 0.0, &at, label);
}

impl Chart<'_> {
    /// The picture.
    pub(crate) fn draw(&self, options: &Options) -> String {
        const GAP: f64 = 16.0;
        const ROW: f64 = 15.0;
        let width = options.width;
        let plot = width - LEFT - RIGHT;
        let below = if options.tracks.is_empty() { 0.0 } else { 10.0 + ROW * options.tracks.len() as f64 };
        let x_axis = Axis::new(self.x_range(), plot / 78.0, true);
        let rows: Vec<Vec<Vec<usize>>> = self.panels.iter().map(|p| legend_rows(p, plot)).collect();
        let tops = rows.iter().map(|r| GAP + r.len() as f64 * 18.0);
        let height = tops.zip(&self.panels).map(|(top, p)| top + p.height).sum::<f64>() + 48.0 + below;
        let mut out = opened("chart", self.title, width, height);
        let to_x = |x: f64| LEFT + plot * x_axis.position(x);
        let y_axes = self.y_axes();
        let mut y0 = 0.0;
        let (mut bottoms, mut spans) = (Vec::new(), Vec::new());
        for ((panel, rows), y_axis) in self.panels.iter().zip(&rows).zip(&y_axes) {
            y0 += GAP;
            write_legend(&mut out, panel, rows, y0);
            y0 += rows.len() as f64 * 18.0;
            let h = panel.height;
            let to_y = |y: f64| y0 + h * (1.0 - y_axis.position(y));
            let window = window(y0 - 2.0, h + 4.0, plot);
            out.push_str(&window);
            for (a, b) in &self.shades {
                let (a, b) = (to_x(a.max(x_axis.low)), to_x(b.min(x_axis.high)));
                let _ = writeln!(
                    out,
                    "<rect x=\"{a:.1}\" y=\"{y0:.1}\" width=\"{:.1}\" height=\"{h:.1}\" fill=\"#ececec\"/>",
                    (b - a).max(0.6)
                );
            }
            out.push_str("</svg>\n");
            for (value, label) in &y_axis.ticks {
                let y = to_y(*value);
                let colour = if *value == 0.0 { "#999" } else { "#d8d8d8" };
                let _ = writeln!(
                    out,
                    "<path d=\"M{LEFT} {y:.1}h{plot}\" stroke=\"{colour}\" stroke-width=\"0.6\"/>"
                );
                write_text(&mut out, LEFT - 8.0, y + 4.3, "text-anchor=\"end\"", label);
            }
            let bottom = y0 + h;
            bottoms.push(bottom);
            spans.push([y0, bottom]);
            let _ = writeln!(
                out,
                "<path d=\"M{LEFT} {y0:.1}v{h:.1}h{plot}\" fill=\"none\" stroke=\"#222\" \
                 stroke-width=\"0.9\"/>"
            );
            out.push_str(&window);
            for (series, dashes) in panel.series.iter().zip(dashes(panel)) {
                let points = series.x.iter().zip(&series.y).map(|(&x, &y)| (to_x(x), to_y(y)));
                let color = series.color;
                if series.dotted {
                    dots(&mut out, points, color);
                    continue;
                }
                let d = path(points);
                let _ = writeln!(
                    out,
                    "<path d=\"{d}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"1.5\" \
                     stroke-linejoin=\"round\" vector-effect=\"non-scaling-stroke\"{dashes}/>"
                );
            }
            out.push_str("</svg>\n");
            let label = y_axis.label(&panel.label, &panel.unit);
            let widest = y_axis.ticks.iter().map(|tick| text::width(&tick.1)).fold(0.0, f64::max) * FONT;
            let left = LEFT - 8.0 - widest;
            write_turned(&mut out, &label, (left, y0 + 0.5 * h), h + 24.0);
            y0 = bottom;
        }
        let above = y0;
        for track in options.tracks {
            y0 += ROW;
            // A tick at an end of the axis stays within its window.
            let at =
                |t: &f64| format!("M{:.1} {:.1}v9", to_x(*t).clamp(LEFT + 0.6, LEFT + plot - 0.6), y0 - 4.5);
            let mut d: Vec<String> = track.times.iter().filter(|t| t.is_finite()).map(at).collect();
            d.dedup();
            let _ = writeln!(
                out,
                "<path d=\"M{LEFT} {y0:.1}h{plot}\" stroke=\"#d8d8d8\" stroke-width=\"0.6\"/>\n{}<path \
                 d=\"{}\" stroke=\"#000\" stroke-width=\"0.8\" vector-effect=\"non-scaling-stroke\"/></svg>",
                window(y0 - 6.0, 12.0, plot),
                d.concat()
            );
            write_text(&mut out, LEFT - 6.0, y0 + 3.6, "text-anchor=\"end\" font-size=\"11\"", &track.label);
        }
        if !options.tracks.is_empty() {
            y0 += 10.0;
            bottoms.push(y0);
            spans.push([above + 6.0, y0]);
        }
        ticks(&mut out, &x_axis, &bottoms, &to_x);
        y0 += 23.0;
        if options.time {
            out.push_str(&time_axis((to_x(x_axis.low), to_x(x_axis.high)), &x_axis, &spans));
        }
        let (words, unit) = unit_of(&self.x_label);
        let x_label = x_axis.label(words, unit);
        write_text(&mut out, LEFT + 0.5 * plot, y0 + 16.0, "text-anchor=\"middle\"", &x_label);
        out.push_str("</svg>\n");
        out
    }
}

/// Place of the second line of such a label; exponents need room above it.
const SECOND: f64 = 28.5;

/// The label of a vertical axis whose tick labels begin at `left`: where it is too long and there
/// is room for it, its unit has a line of its own; what is still too long is smaller.
fn write_turned(out: &mut String, label: &str, (left, middle): (f64, f64), room: f64) {
    let is_long = text::width(label) * FONT > room && left > SECOND + 3.0;
    let lines: Vec<&str> = match label.rsplit_once(" (") {
        Some((words, _)) if is_long => vec![words, &label[words.len() + 1..]],
        _ => vec![label],
    };
    for (k, line) in lines.iter().enumerate() {
        let size = FONT.min(room / text::width(line).max(1e-9));
        let x = if lines.len() == 1 { 14.0 } else { [10.5, SECOND][k.min(1)] };
        turned(out, (x, middle), &format!(" font-size=\"{size:.1}\""), line);
    }
}

impl Chart<'_> {
    /// The range of x, with room for a point at its end.
    fn x_range(&self) -> (f64, f64) {
        let all = || self.panels.iter().flat_map(|p| &p.series);
        let (low, high) = range(all().flat_map(|s| s.x));
        let dotted = range(all().filter(|s| s.dotted).flat_map(|s| s.x));
        let room = 0.008 * (high - low);
        let [before, after] = [dotted.0 < low + room, dotted.1 > high - room].map(f64::from);
        (low - before * room, high + after * room)
    }

    /// The vertical axes. Those of one unit have one power of ten where that leaves few decimals:
    /// their quantities are compared.
    fn y_axes(&self) -> Vec<Axis> {
        let axis = |panel: &Panel| {
            let (low, high) = range(panel.series.iter().flat_map(|s| &s.y));
            let whole = panel.series.iter().flat_map(|s| &s.y).all(|y| y.fract() == 0.0);
            // Integer quantities have ticks at integers only.
            let most = if whole { (high - low).max(1.0) } else { f64::INFINITY };
            Axis::new((low, high), (panel.height / 42.0).max(2.0).min(most), false)
        };
        let axes: Vec<Axis> = self.panels.iter().map(axis).collect();
        let largest = |unit: &str| {
            let alike = self.panels.iter().zip(&axes).filter(|(panel, _)| panel.unit == unit);
            alike.map(|(_, axis)| axis.exponent).max().unwrap_or(0)
        };
        let common = |(panel, axis): (&Panel, &Axis)| {
            if panel.unit.is_empty() { axis.clone() } else { axis.clone().in_units_of(largest(&panel.unit)) }
        };
        self.panels.iter().zip(&axes).map(common).collect()
    }
}

/// Curves closer than this share of the range of their panel cover each other.
const CLOSE: f64 = 0.006;

/// The style of every curve of a panel: dashed where it would cover an earlier one throughout.
fn dashes(panel: &Panel) -> Vec<&'static str> {
    let (low, high) = range(panel.series.iter().flat_map(|s| &s.y));
    let covers = |a: &Series, b: &Series| {
        let close = |(x, y): (&f64, &f64)| (x - y).abs() <= CLOSE * (high - low);
        !a.dotted && !b.dotted && a.y.len() == b.y.len() && a.x == b.x && a.y.iter().zip(&b.y).all(close)
    };
    let style = |(k, series): (usize, &Series)| {
        let covered = panel.series[..k].iter().filter(|earlier| covers(series, earlier)).count();
        ["", " stroke-dasharray=\"7 6\"", " stroke-dasharray=\"2 11\""][covered.min(2)]
    };
    panel.series.iter().enumerate().map(style).collect()
}

/// The mark of an axis of time, along which the animation moves a line: left and right end, and top
/// and bottom of each part of the line.
pub(crate) fn time_axis((left, right): (f64, f64), axis: &Axis, spans: &[[f64; 2]]) -> String {
    let (low, high, exponent, offset) = (axis.low, axis.high, axis.exponent, axis.offset);
    let spans: Vec<String> = spans.iter().map(|[top, bottom]| format!("{top:.1} {bottom:.1}")).collect();
    format!(
        "<g class=\"time\" data-axis=\"{left:.2} {right:.2} {low:e} {high:e} {exponent} {offset:e}\" \
         data-spans=\"{}\"/>\n",
        spans.join(" ")
    )
}

/// The ground of a map, on which its brightest and its darkest colours stand out.
pub(crate) fn ground(out: &mut String, [x, y, width, height]: [f64; 4]) {
    let _ = writeln!(
        out,
        "<rect class=\"open\" x=\"{x}\" y=\"{y:.1}\" width=\"{width}\" height=\"{height}\" fill=\"#e2e2e2\"/>"
    );
}

/// The opening of the part of a panel that zooming stretches: a window on the same coordinates.
fn window(y: f64, height: f64, plot: f64) -> String {
    format!(
        "<svg class=\"window\" x=\"{LEFT}\" y=\"{y:.1}\" width=\"{plot}\" height=\"{height:.1}\" \
         viewBox=\"{LEFT} {y:.1} {plot} {height:.1}\" preserveAspectRatio=\"none\">\n"
    )
}

/// Ticks at the bottom of every panel, with labels at the last one; zooming replaces them.
fn ticks(out: &mut String, axis: &Axis, bottoms: &[f64], to_x: &dyn Fn(f64) -> f64) {
    let places: Vec<String> = bottoms.iter().map(|y| format!("{y:.1}")).collect();
    let _ = writeln!(out, "<g class=\"ticks\" data-bottoms=\"{}\">", places.join(" "));
    for (value, label) in &axis.ticks {
        let x = to_x(*value);
        let marks = places.iter().map(|y| format!("M{x:.1} {y}v5")).collect::<Vec<_>>().concat();
        let _ = writeln!(out, "<path d=\"{marks}\" stroke=\"#222\" stroke-width=\"0.8\"/>");
        if let Some(bottom) = bottoms.last() {
            write_text(out, x, bottom + 19.0, "text-anchor=\"middle\"", label);
        }
    }
    out.push_str("</g>\n");
}

/// Points that are at least two pixels apart, as circles with a white edge.
pub(crate) fn dots(out: &mut String, points: impl Iterator<Item = (f64, f64)>, color: &str) {
    let mut d = String::new();
    let mut last = (f64::NEG_INFINITY, 0.0);
    for (x, y) in points.filter(|p| p.0.is_finite() && p.1.is_finite()) {
        if (x - last.0).hypot(y - last.1) >= 2.0 {
            let _ = write!(d, "M{x:.1} {y:.1}h0");
            last = (x, y);
        }
    }
    for (color, width) in [("#fff", 6.4), (color, 4.4)] {
        let _ = writeln!(
            out,
            "<path d=\"{d}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" \
             stroke-linecap=\"round\" vector-effect=\"non-scaling-stroke\"/>"
        );
    }
}

fn entry_width(series: &Series) -> f64 {
    46.0 + text::width(&series.label) * FONT
}

/// Entries of the legend by line; curves without a label, or with one for tables only, have none.
fn legend_rows(panel: &Panel, width: f64) -> Vec<Vec<usize>> {
    let listed = panel.series.iter().enumerate().filter(|(_, s)| !s.label.is_empty() && !s.unlisted);
    in_lines(listed.map(|(i, series)| (i, entry_width(series))), width)
}

/// Numbers of entries in lines of a width, from the width of each.
pub(crate) fn in_lines(entries: impl Iterator<Item = (usize, f64)>, width: f64) -> Vec<Vec<usize>> {
    let mut lines: Vec<Vec<usize>> = Vec::new();
    let mut used = f64::INFINITY;
    for (i, needed) in entries {
        if used + needed > width {
            lines.push(Vec::new());
            used = 0.0;
        }
        used += needed;
        if let Some(line) = lines.last_mut() {
            line.push(i);
        }
    }
    lines
}

fn write_legend(out: &mut String, panel: &Panel, rows: &[Vec<usize>], top: f64) {
    let dashes = dashes(panel);
    for (line, row) in rows.iter().enumerate() {
        let (mut x, y) = (LEFT + 6.0, top + 18.0 * line as f64 + 5.0);
        for (series, dashes) in row.iter().map(|&i| (&panel.series[i], dashes[i])) {
            if series.dotted {
                let places = [4.0, 11.0, 18.0].map(|by| (x + by, y));
                dots(out, places.into_iter(), series.color);
            } else {
                let _ = writeln!(
                    out,
                    "<path d=\"M{x:.1} {y:.1}h22\" stroke=\"{}\" stroke-width=\"2\"{dashes}/>",
                    series.color
                );
            }
            write_text(out, x + 27.0, y + 4.3, "", &series.label);
            x += entry_width(series);
        }
    }
}
