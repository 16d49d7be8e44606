//! What the pages have in common: a document that needs nothing but itself, figures with numbers
//! and captions, lists in a sentence.

use maud::{DOCTYPE, Markup, PreEscaped, Render, html};

use crate::text::Label;

/// A page; `style` is added to the style of all pages.
pub(crate) fn document(title: &str, style: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width";
                title { (title) }
                style { (PreEscaped(include_str!("page.css"))) (PreEscaped(style)) }
            }
            body { h1 { (title) } (body) }
        }
    };
    page.into_string()
}

/// A figure with its number, its caption and links to its files.
pub(crate) fn figure(number: usize, name: &str, endings: &[&str], caption: &str, svg: &str) -> Markup {
    let links = endings.iter().map(|ending| file(&format!("figures/{name}.{ending}")));
    html! {
        figure {
            (PreEscaped(svg))
            figcaption {
                b { "Figure " (number) "." } " " (Label(caption)) " "
                span.small { "(" (joined(links, ", ")) ")" }
            }
        }
    }
}

/// A link to a file beside the page.
pub(crate) fn file(path: &str) -> Markup {
    html! { a href=(path) { (path) } }
}

/// Pieces with something between them.
pub(crate) fn joined(pieces: impl IntoIterator<Item = impl Render>, between: impl Render) -> Markup {
    html! {
        @for (i, piece) in pieces.into_iter().enumerate() {
            @if i > 0 { (between) }
            (piece)
        }
    }
}

/// What is known of a number, or a dash.
pub(crate) fn or_dash(x: Option<f64>, written: impl Fn(f64) -> String) -> String {
    x.map_or_else(|| "–".to_owned(), written)
}
