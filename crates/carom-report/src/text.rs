//! Text in SVG and HTML: labels with subscripts and superscripts, `σ_{yy}` and `kg·m/s^2`.

use std::fmt::Write as _;

use maud::{Markup, Render, html};

/// Text as the content of an SVG element; HTML is escaped by the templates.
pub(crate) fn escape(text: &str) -> String {
    // XML cannot represent the other control characters.
    let text = text.replace(|c: char| c.is_control() && !matches!(c, '\n' | '\t'), "\u{fffd}");
    text.render().into_string()
}

/// Words that are said on a condition only.
pub(crate) fn said_if(condition: bool, words: &'static str) -> &'static str {
    if condition { words } else { "" }
}

/// Vertical position of a piece of a label.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Level {
    Base,
    Sub,
    Super,
}

/// Splits a label into pieces. A `_` or `^` applies to the group in braces; `^` without braces
/// applies to the sign and digits that follow.
fn pieces(label: &str) -> Vec<(Level, String)> {
    let mut pieces = vec![(Level::Base, String::new())];
    let mut rest = label;
    while let Some(c) = rest.chars().next() {
        rest = &rest[c.len_utf8()..];
        let group = rest.strip_prefix('{').and_then(|r| r.split_once('}'));
        let digits = rest.len()
            - rest.trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '-' | '−')).len();
        match (c, group) {
            ('_' | '^', Some((inside, after))) => {
                let level = if c == '_' { Level::Sub } else { Level::Super };
                // A minus sign in an exponent.
                let inside =
                    if level == Level::Super { inside.replace('-', "−") } else { inside.to_owned() };
                pieces.extend([(level, inside), (Level::Base, String::new())]);
                rest = after;
            }
            ('^', None) if digits > 0 => {
                let digits_after = rest[..digits].replace('-', "−");
                pieces.extend([(Level::Super, digits_after), (Level::Base, String::new())]);
                rest = &rest[digits..];
            }
            _ => {
                if let Some((_, text)) = pieces.last_mut() {
                    text.push(c);
                }
            }
        }
    }
    pieces.retain(|(_, text)| !text.is_empty());
    pieces
}

/// A label as the content of an SVG `<text>` element.
pub(crate) fn svg(label: &str) -> String {
    let mut out = String::new();
    let mut raised = 0.0;
    for (level, text) in pieces(label) {
        let (to, size) = match level {
            Level::Base => (0.0, ""),
            Level::Sub => (0.28, " font-size=\"75%\""),
            Level::Super => (-0.36, " font-size=\"75%\""),
        };
        // `dy` also moves all text that follows. Its unit is the font size of the tspan, which is
        // 0.75 of that of the label in small pieces.
        let scale = if size.is_empty() { 1.0 } else { 0.75 };
        let dy = (to - raised) / scale;
        raised = to;
        if dy == 0.0 && size.is_empty() {
            out.push_str(&escape(&text));
        } else {
            let _ = write!(out, "<tspan dy=\"{dy:.3}em\"{size}>{}</tspan>", escape(&text));
        }
    }
    out
}

/// A label as HTML.
pub(crate) struct Label<'a>(pub(crate) &'a str);

impl Render for Label<'_> {
    fn render(&self) -> Markup {
        // `ρ∞ = 0.1` stays in one line.
        let together = self.0.replace(" = ", "\u{a0}=\u{a0}");
        html! {
            @for (level, text) in pieces(&together) {
                @match level {
                    Level::Base => (text),
                    Level::Sub => sub { (text) },
                    Level::Super => sup { (text) },
                }
            }
        }
    }
}

/// A sentence as HTML: text between backticks is code, the rest a label.
pub(crate) struct Prose<'a>(pub(crate) &'a str);

impl Render for Prose<'_> {
    fn render(&self) -> Markup {
        html! {
            @for (i, part) in self.0.split('`').enumerate() {
                @if i % 2 == 1 { code { (Code(part)) } } @else { (Label(part)) }
            }
        }
    }
}

/// Code of which options such as `--set` are not broken after their hyphens.
struct Code<'a>(&'a str);

impl Render for Code<'_> {
    fn render(&self) -> Markup {
        html! {
            @for (i, word) in self.0.split(' ').enumerate() {
                @if i > 0 { " " }
                @if word.starts_with("--") { span.option { (word) } } @else { (word) }
            }
        }
    }
}

/// A message of the program as prose: a minus sign before digits, and quotation marks.
pub(crate) fn typeset(message: &str) -> String {
    let mut out = String::with_capacity(message.len());
    let mut before = ' ';
    let mut open = false;
    let mut characters = message.chars().peekable();
    while let Some(c) = characters.next() {
        let digit = characters.peek().is_some_and(char::is_ascii_digit);
        out.push(match c {
            '"' => {
                open = !open;
                if open { '“' } else { '”' }
            }
            '-' if digit && matches!(before, ' ' | 'e' | '(' | '[') => '−',
            c => c,
        });
        before = c;
    }
    out
}

/// Width of a character in units of the font size, as in DejaVu Sans, the widest of the fonts that
/// a figure may be shown in.
fn advance(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | 'I' | 'J' | '|' => 0.30,
        ' ' | '.' | ',' | ':' | ';' | '\'' => 0.33,
        'f' | 't' | 'r' | '(' | ')' | '[' | ']' | '/' | '-' | '·' => 0.40,
        's' | 'z' | 'c' | '"' => 0.54,
        'w' | '=' | '+' | '−' | '∞' | '<' | '>' | '≤' | '≥' | '×' | '~' | '_' => 0.84,
        'm' | 'M' | 'W' | '%' | '…' | '@' => 0.98,
        'A'..='Z' => 0.70,
        _ => 0.63,
    }
}

/// Width of a label in units of the font size, for layout.
pub(crate) fn width(label: &str) -> f64 {
    let piece = |(level, text): (Level, String)| {
        let size = if level == Level::Base { 1.0 } else { 0.75 };
        text.chars().map(advance).sum::<f64>() * size
    };
    pieces(label).into_iter().map(piece).sum()
}

/// A label shortened to a width in units of the font size: a part of its middle is left out, since
/// names of variants differ at either end.
pub(crate) fn fitted(label: &str, most: f64) -> String {
    if width(label) <= most {
        return label.to_owned();
    }
    let characters: Vec<char> = label.chars().collect();
    let cut = |kept: usize| -> String {
        let front = kept.div_ceil(2);
        let back = kept / 2;
        let end = &characters[characters.len() - back..];
        characters[..front].iter().chain(&['…']).chain(end).collect()
    };
    let fits = |kept: &usize| width(&cut(*kept)) <= most;
    (0..characters.len()).rev().find(fits).map_or_else(String::new, cut)
}

/// A label in lines of at most this width in units of the font size, broken after spaces and, in
/// long formulas, after operators, never within a subscript or superscript.
pub(crate) fn broken(label: &str, most: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut depth = 0;
    let mut piece = String::new();
    let mut after = label.chars().peekable();
    while let Some(c) = after.next() {
        piece.push(c);
        depth += i32::from(c == '{') - i32::from(c == '}');
        // `ρ∞ = 0.1` stays together.
        let equals = c == ' ' && (piece.ends_with("= ") || after.peek() == Some(&'='));
        let ends = depth == 0 && !equals && matches!(c, ' ' | ',' | '+' | '-' | '*' | '/' | '(');
        if !ends && after.peek().is_some() {
            continue;
        }
        let line = lines.last().map_or("", String::as_str);
        let joined = format!("{line}{piece}");
        if line.is_empty() || width(joined.trim_end()) <= most {
            lines.pop();
            lines.push(joined);
        } else {
            lines.push(piece);
        }
        piece = String::new();
    }
    lines.iter().map(|line| line.trim_end().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_typeset() {
        let text = typeset("body \"block\": cell 0: J = -1.029e-3 in step-2 [-1, 2]");
        assert_eq!(text, "body “block”: cell 0: J = −1.029e−3 in step-2 [−1, 2]");
    }

    #[test]
    fn labels() {
        let html = |label: &str| Label(label).render().into_string();
        assert_eq!(html("σ_{yy} at <B>"), "σ<sub>yy</sub> at &lt;B&gt;");
        assert_eq!(html("kg·m/s^2"), "kg·m/s<sup>2</sup>");
        assert_eq!(html("10^-3 a_b ^ {x"), "10<sup>−3</sup> a_b ^ {x");
        let prose = Prose("Data: σ_{yy} in `a_{b}`.").render().into_string();
        assert_eq!(prose, "Data: σ<sub>yy</sub> in <code>a_{b}</code>.");
        let text = svg("σ_{yy} (Pa)");
        assert_eq!(
            text,
            "σ<tspan dy=\"0.373em\" font-size=\"75%\">yy</tspan><tspan dy=\"-0.280em\"> (Pa)</tspan>"
        );
    }

    #[test]
    fn long_labels_lose_their_middle() {
        assert_eq!(fitted("abc", 9.0), "abc");
        let cut = fitted("chung-hulbert 0.6, step = 0.001875", 10.0);
        assert!(cut.starts_with("chung-") && cut.ends_with("1875") && width(&cut) <= 10.0, "{cut}");
    }

    #[test]
    fn long_labels_are_broken() {
        assert_eq!(broken("u_{x} = 0", 9.0), ["u_{x} = 0"]);
        assert_eq!(broken("generalised α, ρ∞ = 0.1", 9.0), ["generalised α,", "ρ∞ = 0.1"]);
        let formula = "floor.top: u_{y} = 0.5*(1-cos(2*pi*t/0.25))*exp(-t/0.125)*X^2";
        let lines = broken(formula, 12.0);
        assert!(lines.len() > 2 && lines.iter().all(|line| width(line) <= 12.0), "{lines:?}");
        assert_eq!(lines.concat().replace(' ', ""), formula.replace(' ', ""));
    }

    #[test]
    fn escapes() {
        assert_eq!(escape("<a b=\"y\">&\u{0}"), "&lt;a b=&quot;y&quot;&gt;&amp;\u{fffd}");
    }
}
