//! Line charts against a shared horizontal axis, one panel above the other.

use std::fmt::{Display, Write as _};

use maud::Render;
use serde_json::{Value, json};

use crate::axis::{Axis, range};
use crate::labels::unit_of;
use crate::scientific::{significant, without_zeros};
use crate::text::{self, Label};
use crate::trace::{ends_and_extremes, path};

/// Usual width of a figure.
pub(crate) const WIDTH: f64 = 720.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = 20.0;
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
    /// The name of the figure, by which the script of the page finds its numbers.
    pub(crate) name: &'a str,
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self { width: WIDTH, tracks: &[], time: false, name: "" }
    }
}

/// The opening of an SVG figure, with fonts and background so that it stands alone.
pub(crate) fn open(title: &str, width: f64, height: f64) -> String {
    opened("picture", title, width, height)
}

/// Opens a picture of a class: a dark page shows a `chart` in light colours on dark ground.
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

/// Space between panels, and the height of a line of the legend and of a row of events.
const GAP: f64 = 16.0;
const LINE: f64 = 18.0;
const ROW: f64 = 15.0;

/// A picture under construction.
struct Drawing<'a> {
    out: String,
    width: f64,
    x_axis: &'a Axis,
    /// Vertical extents of the panels and of the events.
    spans: Vec<[f64; 2]>,
}

impl Drawing<'_> {
    fn plot(&self) -> f64 {
        self.width - LEFT - RIGHT
    }

    fn x(&self, value: f64) -> f64 {
        LEFT + self.plot() * self.x_axis.position(value)
    }

    /// Shading, axis and curves of a panel below a height.
    fn panel(&mut self, panel: &Panel, axis: &Axis, top: f64, shades: &[(f64, f64)]) {
        let height = panel.height;
        let bottom = top + height;
        let plot = self.plot();
        let to_y = |y: f64| top + height * (1.0 - axis.position(y));
        let Axis { low, high, exponent, offset, .. } = axis;
        let _ = writeln!(
            self.out,
            "<g class=\"panel\" data-axis=\"{top:.1} {bottom:.1} {low:e} {high:e} {exponent} {offset:e}\">"
        );
        for (from, to) in shades {
            let [a, b] = [self.x(from.max(self.x_axis.low)), self.x(to.min(self.x_axis.high))];
            let _ = writeln!(
                self.out,
                "<rect class=\"shade\" data-span=\"{from:e} {to:e}\" x=\"{a:.1}\" y=\"{top:.1}\" width=\"{:.1}\" \
                 height=\"{height:.1}\" fill=\"#ececec\"/>",
                (b - a).max(0.6)
            );
        }
        self.out.push_str("<g class=\"grid\">\n");
        for (value, label) in &axis.ticks {
            let y = to_y(*value);
            let colour = if *value == 0.0 { "#999" } else { "#d8d8d8" };
            let line = format!("M{LEFT} {y:.1}h{plot}");
            let _ = writeln!(self.out, "<path d=\"{line}\" stroke=\"{colour}\" stroke-width=\"0.6\"/>");
            write_text(&mut self.out, LEFT - 8.0, y + 4.3, "text-anchor=\"end\"", label);
        }
        let _ = writeln!(
            self.out,
            "</g>\n<path d=\"M{LEFT} {top:.1}v{height:.1}h{plot}\" fill=\"none\" stroke=\"#222\" stroke-width=\"0.9\"/>"
        );
        for (k, (series, dashes)) in panel.series.iter().zip(dashes(panel)).enumerate() {
            let points = series.x.iter().zip(&series.y).map(|(&x, &y)| (self.x(x), to_y(y)));
            let class = format!("class=\"curve\" data-series=\"{k}\"");
            let color = series.color;
            if series.dotted {
                let points: Vec<(f64, f64)> = points.collect();
                marks(&mut self.out, points.into_iter(), color, &class);
                continue;
            }
            let d = path(points);
            let _ = writeln!(
                self.out,
                "<path {class} d=\"{d}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"1.5\" \
                 stroke-linejoin=\"round\"{dashes}/>"
            );
        }
        self.out.push_str("</g>\n");
        let label = axis.label(&panel.label, &panel.unit);
        let widest = axis.ticks.iter().map(|tick| text::width(&tick.1)).fold(0.0, f64::max) * FONT;
        let middle = top + 0.5 * height;
        write_turned(&mut self.out, &label, (LEFT - 8.0 - widest, middle), height + 24.0);
        self.spans.push([top, bottom]);
    }

    /// Ticks at the times of events, a row for each kind.
    fn tracks(&mut self, tracks: &[Track], top: f64) -> f64 {
        let plot = self.plot();
        let mut y = top;
        for track in tracks {
            y += ROW;
            let at = |t: &f64| format!("M{:.1} {:.1}v9", self.x(*t), y - 4.5);
            let mut d: Vec<String> = track.times.iter().filter(|t| t.is_finite()).map(at).collect();
            d.dedup();
            let _ = writeln!(
                self.out,
                "<path d=\"M{LEFT} {y:.1}h{plot}\" stroke=\"#d8d8d8\" stroke-width=\"0.6\"/>\n<path class=\"track\" \
                 data-top=\"{:.1}\" d=\"{}\" stroke=\"#000\" stroke-width=\"0.8\"/>",
                y - 4.5,
                d.concat()
            );
            let label = "text-anchor=\"end\" font-size=\"11\"";
            write_text(&mut self.out, LEFT - 6.0, y + 3.6, label, &track.label);
        }
        if tracks.is_empty() {
            return top;
        }
        self.spans.push([top + 6.0, y + 10.0]);
        y + 10.0
    }

    /// Ticks at the bottom of every panel, with labels at the last one; zooming replaces them.
    fn ticks(&mut self) {
        let bottoms: Vec<String> = self.spans.iter().map(|[_, bottom]| format!("{bottom:.1}")).collect();
        let last = self.spans.last().map_or(0.0, |span| span[1]);
        let _ = writeln!(self.out, "<g class=\"ticks\" data-bottoms=\"{}\">", bottoms.join(" "));
        for (value, label) in &self.x_axis.ticks {
            let x = self.x(*value);
            let marks = bottoms.iter().map(|y| format!("M{x:.1} {y}v5")).collect::<Vec<_>>().concat();
            let _ = writeln!(self.out, "<path d=\"{marks}\" stroke=\"#222\" stroke-width=\"0.8\"/>");
            tick_label(&mut self.out, x, last + 19.0, label, self.width);
        }
        self.out.push_str("</g>\n");
    }
}

/// The label of a tick of a horizontal axis, which ends before the right end of the picture.
pub(crate) fn tick_label(out: &mut String, x: f64, y: f64, label: &str, width: f64) {
    let half = 0.5 * text::width(label) * FONT;
    write_text(out, x.min(width - 2.0 - half), y, "text-anchor=\"middle\"", label);
}

impl Chart<'_> {
    /// The picture.
    pub(crate) fn draw(&self, options: &Options) -> String {
        let width = options.width;
        let plot = width - LEFT - RIGHT;
        let x_axis = Axis::new(self.x_range(), plot / 78.0, true);
        let y_axes = self.y_axes();
        let entries: Vec<Vec<String>> =
            self.panels.iter().zip(&y_axes).map(|(panel, axis)| entries(panel, axis, options.time)).collect();
        let rows: Vec<Vec<Vec<usize>>> = entries.iter().map(|entries| legend_rows(entries, plot)).collect();
        let below = if options.tracks.is_empty() { 0.0 } else { 10.0 + ROW * options.tracks.len() as f64 };
        let legends: f64 = rows.iter().map(|rows| GAP + rows.len() as f64 * LINE).sum();
        let panels: f64 = self.panels.iter().map(|panel| panel.height).sum();
        let out = opened("chart", self.title, width, legends + panels + 48.0 + below);
        let mut drawing = Drawing { out, width, x_axis: &x_axis, spans: Vec::new() };
        let mut y = 0.0;
        for (k, panel) in self.panels.iter().enumerate() {
            y += GAP;
            write_legend(&mut drawing.out, panel, &entries[k], &rows[k], y);
            y += rows[k].len() as f64 * LINE;
            drawing.panel(panel, &y_axes[k], y, &self.shades);
            y += panel.height;
        }
        y = drawing.tracks(options.tracks, y);
        drawing.ticks();
        if options.time {
            let ends = (drawing.x(x_axis.low), drawing.x(x_axis.high));
            let axis = time_axis(ends, &x_axis, &drawing.spans, options.name);
            drawing.out.push_str(&axis);
        }
        let (words, unit) = unit_of(&self.x_label);
        let middle = LEFT + 0.5 * plot;
        let label = x_axis.label(words, unit);
        write_text(&mut drawing.out, middle, y + 39.0, "text-anchor=\"middle\"", &label);
        drawing.out + "</svg>\n"
    }

    /// The numbers of a chart over time for the script of the page, thinned to what a screen shows.
    pub(crate) fn data(&self, tracks: &[Track]) -> Value {
        let lines = || self.panels.iter().flat_map(|panel| &panel.series).filter(|series| !series.dotted);
        let times = lines().map(|series| series.x).next().unwrap_or_default();
        let mut kept = vec![times.len() <= ROWS; times.len()];
        let block = times.len().div_ceil(ROWS / 8).max(1);
        for series in lines().filter(|series| series.y.len() == times.len()) {
            for from in (0..times.len()).step_by(block) {
                let rows = from..(from + block).min(times.len());
                ends_and_extremes(rows, |row| series.y[row]).into_iter().for_each(|row| kept[row] = true);
            }
        }
        let chosen = |list: &[f64]| -> Vec<Value> {
            list.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(x, _)| rounded(*x)).collect()
        };
        let all = |list: &[f64]| list.iter().map(|x| rounded(*x)).collect::<Vec<_>>();
        let series = |panel: &Panel, series: &Series| {
            let label = if series.label.is_empty() { &panel.label } else { &series.label };
            let mut data = json!({
                "label": Label(label).render().0, "unit": Label(&panel.unit).render().0, "color": series.color,
            });
            if series.x == times {
                data["y"] = json!(chosen(&series.y));
            } else {
                data["x"] = json!(all(series.x));
                data["y"] = json!(all(&series.y));
                data["dots"] = json!(series.dotted);
            }
            data
        };
        let panel = |panel: &Panel| panel.series.iter().map(|one| series(panel, one)).collect::<Vec<_>>();
        json!({
            "x_label": Label(&self.x_label).render().0, "x": times.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(x, _)| *x).collect::<Vec<_>>(),
            "panels": self.panels.iter().map(panel).collect::<Vec<_>>(),
            "tracks": tracks.iter().map(|track| &track.times).collect::<Vec<_>>(),
        })
    }
}

/// Largest number of rows of a chart in the page.
const ROWS: usize = 2400;

/// A number with six digits; null if it is not finite.
fn rounded(x: f64) -> Value {
    format!("{x:.5e}").parse::<f64>().map_or(Value::Null, |x| json!(x))
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
            // Integer quantities have ticks at integers only, of which an axis has at least two.
            let (low, high) = if whole && high == low { (low - 1.0, high + 1.0) } else { (low, high) };
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
pub(crate) fn time_axis((left, right): (f64, f64), axis: &Axis, spans: &[[f64; 2]], chart: &str) -> String {
    let low = axis.low;
    let high = axis.high;
    let exponent = axis.exponent;
    let offset = axis.offset;
    let spans: Vec<String> = spans.iter().map(|[top, bottom]| format!("{top:.1} {bottom:.1}")).collect();
    format!(
        "<g class=\"time\" data-chart=\"{chart}\" data-axis=\"{left:.2} {right:.2} {low:e} {high:e} {exponent} {offset:e}\" \
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

/// Points that are at least two pixels apart, as circles with a white edge.
pub(crate) fn dots(out: &mut String, points: impl Iterator<Item = (f64, f64)>, color: &str) {
    marks(out, points, color, "");
}

fn marks(out: &mut String, points: impl Iterator<Item = (f64, f64)>, color: &str, class: &str) {
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
            "<path {class} d=\"{d}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" \
             stroke-linecap=\"round\" vector-effect=\"non-scaling-stroke\"/>"
        );
    }
}

/// Entries of the legend of a panel: the names of its curves and, over time, the smallest and the
/// largest value in the units of the axis. Curves without a name, or with one for tables only, have
/// none of it; a curve alone without a name has its range.
fn entries(panel: &Panel, axis: &Axis, is_over_time: bool) -> Vec<String> {
    let entry = |series: &Series| {
        let name = if series.unlisted { "" } else { &series.label };
        let (low, high) = range(&series.y);
        let is_ranged =
            is_over_time && !series.dotted && low <= high && (!name.is_empty() || panel.series.len() == 1);
        if !is_ranged {
            return name.to_owned();
        }
        let is_count = axis.exponent == 0 && series.y.iter().all(|y| y.fract() == 0.0);
        let digits = |x: f64| {
            let text = significant(x / 10f64.powi(axis.exponent), 4);
            if is_count { without_zeros(&text).to_owned() } else { text }
        };
        let [low, high] = [low, high].map(digits);
        if name.is_empty() {
            return format!("{low} … {high}");
        }
        format!("{name}: {low} … {high}")
    };
    panel.series.iter().map(entry).collect()
}

fn entry_width(entry: &str) -> f64 {
    46.0 + text::width(entry) * FONT
}

/// Entries of the legend by line.
fn legend_rows(entries: &[String], width: f64) -> Vec<Vec<usize>> {
    let listed = entries.iter().enumerate().filter(|(_, entry)| !entry.is_empty());
    in_lines(listed.map(|(i, entry)| (i, entry_width(entry))), width)
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

fn write_legend(out: &mut String, panel: &Panel, entries: &[String], rows: &[Vec<usize>], top: f64) {
    let dashes = dashes(panel);
    for (line, row) in rows.iter().enumerate() {
        let mut x = LEFT + 6.0;
        let y = top + LINE * line as f64 + 5.0;
        for &i in row {
            let Series { color, dotted, .. } = panel.series[i];
            if dotted {
                dots(out, [4.0, 11.0, 18.0].map(|by| (x + by, y)).into_iter(), color);
            } else {
                let dashes = dashes[i];
                let _ = writeln!(
                    out,
                    "<path d=\"M{x:.1} {y:.1}h22\" stroke=\"{color}\" stroke-width=\"2\"{dashes}/>"
                );
            }
            write_text(out, x + 27.0, y + 4.3, "", &entries[i]);
            x += entry_width(&entries[i]);
        }
    }
}
