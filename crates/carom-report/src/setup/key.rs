//! The key beside the drawing of a case: colours, symbols and numbers.

use std::collections::HashSet;
use std::fmt::Write as _;

use serde_json::Value;

use super::drawing::{KEY, PRIMARY, SECONDARY, SUPPORT_LINES, SUPPORTS, Setup};
use super::forces::{COLOR, written};
use super::words::{gravity_and_velocity, law_name, plane_in_words};
use crate::bodies::fill_space;
use crate::chart::write_text;
use crate::figure::NARROW;
use crate::labels::given_amount;
use crate::place::fill;
use crate::scientific::given;
use crate::symbols::{arrow, guides, motion, plus, probe_mark, rollers, wall};
use crate::text;
use crate::values::{is_in_space, list, text as word, texts, tuple, unit, vector};

/// The smallest size of letters in pixels.
const SMALLEST: f64 = 11.0;

/// The key of a height in its place, beside the drawing or, in a narrow window, below it; and width
/// and height of the figure.
pub(super) fn placed(key: String, lines: f64, narrow: bool, [beside, below]: [f64; 2]) -> (String, [f64; 2]) {
    if narrow {
        let key = format!("<g transform=\"translate(0 {below:.1})\">\n{key}</g>\n");
        return (key, [NARROW, below + lines + 8.0]);
    }
    (key, [beside + KEY, below.max(lines + 8.0)])
}

/// A symbol, which may be empty, and what is said of it.
type Line = (String, String);

fn without_symbol(words: String) -> Line {
    (String::new(), words)
}

impl Setup<'_> {
    /// Draws the key and returns its height.
    pub(super) fn key(&self, out: &mut String, left: f64) -> f64 {
        let case = self.case();
        let of = |key: &str, lines: &dyn Fn((usize, &Value)) -> Vec<Line>| -> Vec<Line> {
            list(case, key).iter().enumerate().flat_map(lines).collect()
        };
        let plane = plane_in_words(case, unit(case, "length"));
        let sections = [
            ("Bodies", of("bodies", &|body| self.body(body))),
            ("Model", plane.into_iter().map(without_symbol).collect()),
            ("Materials", of("materials", &|(_, material)| self.material(material))),
            ("Supports", of("supports", &|support| vec![self.support(support)])),
            ("Loads", self.forces_in_words().into_iter().map(load).collect()),
            ("Contact", of("contacts", &|(_, contact)| self.contact(contact))),
            ("Probes", of("probes", &|(_, probe)| vec![self.probe(probe)])),
        ];
        let mut y = 8.0;
        let mut line = |swatch: &str, content: &str, bold: bool| {
            y += if bold { 7.0 } else { 0.0 } + 18.0;
            if !swatch.is_empty() {
                let _ = writeln!(out, "<g transform=\"translate({left:.1} {:.1})\">{swatch}</g>", y - 4.5);
            }
            let (x, extra) =
                (if bold { left } else { left + 30.0 }, if bold { "font-weight=\"bold\"" } else { "" });
            // Smaller where it is wider than the key, and in several lines where it were too small.
            let room = KEY - 12.0 - (x - left);
            for (k, part) in text::broken(content, room / SMALLEST).iter().enumerate() {
                let size = (room / text::width(part).max(1e-9)).min(13.0);
                y += if k == 0 { 0.0 } else { 15.0 };
                write_text(out, x, y, &format!("font-size=\"{size:.1}\" {extra}"), part);
            }
        };
        for (title, lines) in sections.iter().filter(|(_, lines)| !lines.is_empty()) {
            line("", title, true);
            lines.iter().for_each(|(swatch, content)| line(swatch, content, false));
        }
        y + 12.0
    }

    fn body(&self, (k, body): (usize, &Value)) -> Vec<Line> {
        let (name, element, material) = (word(body, "name"), word(body, "element"), word(body, "material"));
        let block = self.block(name);
        let nodes = block.map_or(0, |b| b.connectivity.iter().collect::<HashSet<_>>().len());
        let cells = block.map_or(0, |b| b.cells().count());
        let of = if material == name { "material " } else { "" };
        let words = format!("{name}: {of}{material}, {cells} {element} cells, {nodes} nodes");
        let moved = gravity_and_velocity(body, unit(self.case(), "length"), unit(self.case(), "time"));
        std::iter::once((filled(fill(k), "#222"), words))
            .chain(moved.into_iter().map(without_symbol))
            .collect()
    }

    fn material(&self, m: &Value) -> Vec<Line> {
        let (length, mass, stress) =
            (unit(self.case(), "length"), unit(self.case(), "mass"), self.fields.unit("stress"));
        let real = |key| m.get(key).and_then(Value::as_f64);
        let density = real("density").map_or(String::new(), given);
        let mut lines = vec![
            format!("{}: {}", word(m, "name"), law_name(word(m, "law"))),
            format!("ρ = {density} {mass}/{length}^3"),
        ];
        if let (Some(lambda), Some(shear)) = (real("lambda"), real("mu")) {
            // The manifest has Lamé's constants; μ is the coefficient of friction here.
            let poisson = lambda / (2.0 * (lambda + shear));
            let young = 2.0 * shear * (1.0 + poisson);
            lines.push(format!("E = {}, ν = {}", given_amount(young, stress), given(poisson)));
            let [lambda, shear] = [lambda, shear].map(|x| given_amount(x, stress));
            lines.push(format!("λ = {lambda}, G = {shear}"));
        }
        lines.into_iter().map(without_symbol).collect()
    }

    fn support(&self, (k, support): (usize, &Value)) -> Line {
        let fixed = Self::directions(support).len() + usize::from(Self::is_held_across(support));
        let on: Vec<&str> = texts(support, "on").collect();
        let mut swatch = String::new();
        let ends = [([0.0, -3.0], [0.0, 1.0]), ([20.0, -3.0], [0.0, 1.0])];
        let is_guided = || on.iter().flat_map(|side| self.walks(side)).any(|w| Self::is_guided(support, &w));
        if fill_space(self.fields) {
            swatch = filled(SUPPORTS[k % SUPPORTS.len()], SUPPORT_LINES[k % SUPPORT_LINES.len()]);
        } else if let Some(axis) = Self::moved_axis(support).filter(|_| !self.flat) {
            motion(&mut swatch, &[([10.0, 0.0], axis), ([10.0, 0.0], axis)], axis);
        } else if fixed > 1 || self.flat {
            wall(&mut swatch, &ends, 0.0);
        } else if is_guided() {
            guides(&mut swatch, &ends, [1.0, 0.0]);
        } else {
            rollers(&mut swatch, &ends.map(|(p, n)| (plus(p, -3.0, n), n)));
        }
        (swatch, format!("{}: {}", on.join(", "), self.support_in_words(support)))
    }

    fn contact(&self, contact: &Value) -> Vec<Line> {
        let bar = |color: &str| format!("<path d=\"M0 0h20\" stroke=\"{color}\" stroke-width=\"3.2\"/>");
        let side = contact.pointer("/primary/side").and_then(Value::as_str);
        let mut shapes = ["circle", "cylinder", "polyline", "surface"].into_iter();
        let shape = shapes.find(|shape| contact.pointer(&format!("/primary/{shape}")).is_some());
        let in_space = is_in_space(self.case());
        let shape = shape.map(|shape| if in_space && shape == "circle" { "sphere" } else { shape });
        let rigid = format!("rigid {}", shape.unwrap_or("plane"));
        let (secondary, primary) = (word(contact, "secondary"), side.unwrap_or(&rigid));
        // The sides are not coloured in the drawing of bodies in space.
        let mut lines = if fill_space(self.fields) {
            vec![without_symbol(format!("secondary: {secondary}, primary: {primary}"))]
        } else {
            vec![
                (bar(SECONDARY), format!("{secondary} (secondary)")),
                (bar(PRIMARY), format!("{primary} (primary)")),
            ]
        };
        let (length, time) = (unit(self.case(), "length"), unit(self.case(), "time"));
        let motion = motion_in_words(contact, length, &self.with_time());
        lines.extend(motion.into_iter().chain(friction_in_words(contact, length, time)).map(without_symbol));
        lines
    }

    fn probe(&self, probe: &Value) -> Line {
        let (at, length) = (tuple(&vector(probe.get("at"))), unit(self.case(), "length"));
        let words = format!("{}: {} at {at} {length}", word(probe, "name"), word(probe, "body"));
        (probe_mark([10.0, 0.0]), words)
    }
}

fn load(words: String) -> Line {
    let mut swatch = String::new();
    arrow(&mut swatch, [0.0, 0.0], [20.0, 0.0], COLOR);
    (swatch, words)
}

/// The symbol of what has a colour.
fn filled(fill: &str, line: &str) -> String {
    format!("<rect y=\"-5\" width=\"20\" height=\"11\" fill=\"{fill}\" stroke=\"{line}\"/>")
}

/// How a rigid primary moves.
fn motion_in_words(contact: &Value, length: &str, with_time: &str) -> Option<String> {
    let given = contact.pointer("/motion/prescribed")?;
    let moved = list(given, "moves").iter().filter_map(|m| {
        let [axis, formula] = m.as_array()?.as_slice() else { return None };
        let axis = ["u_{x}", "u_{y}", "u_{z}"].get(axis.as_u64()? as usize)?;
        Some(format!("{axis} = {} {length}", written(formula)))
    });
    let turned = given.get("rotate").and_then(|turn| Some(format!("angle = ({})°", written(turn.get(0)?))));
    let words: Vec<String> = moved.chain(turned).collect();
    (!words.is_empty()).then(|| words.join(", ") + with_time)
}

/// The coefficients of friction.
fn friction_in_words(contact: &Value, length: &str, time: &str) -> Option<String> {
    let given = |key: &str| contact.get("friction")?.get(key).filter(|value| !value.is_null()).map(written);
    let coefficient = format!("friction μ = {}", given("mu")?);
    let dynamic = given("mu_dynamic").map(|mu| format!("sliding {mu}"));
    let decay = given("decay").map(|decay| format!("decay {decay} {time}/{length}"));
    let words: Vec<String> = std::iter::once(coefficient).chain(dynamic).chain(decay).collect();
    Some(words.join(", "))
}
