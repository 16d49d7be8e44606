//! Text in SVG and HTML: escaping, and labels with subscripts and superscripts, `σ_{yy}` and
//! `kg·m/s^2`.

use std::fmt::Write as _;

use maud::{Markup, Render, html};

/// Text as the content of an SVG element.
pub(crate) fn escape(text: &str) -> String {
    // XML has no way to write the other control characters.
    let text = text.replace(|c: char| c.is_control() && !matches!(c, '\n' | '\t'), "\u{fffd}");
    text.render().into_string()
}

/// Where a piece of a label stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Level {
    Base,
    Sub,
    Super,
}

/// Pieces of a label. A `_` or `^` takes the group in braces; `^` without braces takes the sign and
/// digits that follow.
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
                pieces.extend([(level, inside.to_string()), (Level::Base, String::new())]);
                rest = after;
            }
            ('^', None) if digits > 0 => {
                pieces.extend([(Level::Super, rest[..digits].to_string()), (Level::Base, String::new())]);
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

/// A label as the content of an SVG `<text>`.
pub(crate) fn svg(label: &str) -> String {
    let mut out = String::new();
    let mut raised = 0.0;
    for (level, text) in pieces(label) {
        let (to, size) = match level {
            Level::Base => (0.0, ""),
            Level::Sub => (0.28, " font-size=\"75%\""),
            Level::Super => (-0.36, " font-size=\"75%\""),
        };
        // `dy` moves the pen for good, in units of the tspan's own size: 0.75 of the label's for
        // the small ones.
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
        html! {
            @for (level, text) in pieces(self.0) {
                @match level {
                    Level::Base => (text),
                    Level::Sub => sub { (text) },
                    Level::Super => sup { (text) },
                }
            }
        }
    }
}

/// A label's width in units of the font size, roughly: good enough to put legends side by side.
pub(crate) fn width(label: &str) -> f64 {
    let piece = |(level, text): (Level, String)| {
        let size = if level == Level::Base { 1.0 } else { 0.75 };
        text.chars()
            .map(|c| if matches!(c, 'i' | 'l' | '.' | ',' | ' ' | 't' | 'f' | '|') { 0.3 } else { 0.58 })
            .sum::<f64>()
            * size
    };
    pieces(label).into_iter().map(piece).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels() {
        let html = |label: &str| Label(label).render().into_string();
        assert_eq!(html("σ_{yy} at <B>"), "σ<sub>yy</sub> at &lt;B&gt;");
        assert_eq!(html("kg·m/s^2"), "kg·m/s<sup>2</sup>");
        assert_eq!(html("10^-3 a_b ^ {x"), "10<sup>-3</sup> a_b ^ {x");
        let text = svg("σ_{yy} (Pa)");
        assert_eq!(
            text,
            "σ<tspan dy=\"0.373em\" font-size=\"75%\">yy</tspan><tspan dy=\"-0.280em\"> (Pa)</tspan>"
        );
    }

    #[test]
    fn escapes() {
        assert_eq!(escape("<a b=\"y\">&\u{0}"), "&lt;a b=&quot;y&quot;&gt;&amp;\u{fffd}");
    }
}
