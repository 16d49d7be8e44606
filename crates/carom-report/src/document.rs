//! Elements that the pages share: the frame of a document, figures, links and lists.

use maud::{DOCTYPE, Markup, PreEscaped, Render, html};

use crate::figure::Figure;
use crate::stacked::with_headings;
use crate::text::{Label, Prose};

/// A self-contained page; `style` is added to the style sheet of all pages.
pub(crate) fn document(title: &str, style: &str, body: &Markup) -> String {
    framed(title, style, "", &html! { h1 { (title) } (body) })
}

/// A self-contained page of a class, whose body has its heading.
pub(crate) fn framed(title: &str, style: &str, class: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width";
                title { (title) }
                style { (PreEscaped(include_str!("page.css"))) (PreEscaped(style)) }
            }
            body class=(class) { (body) }
        }
    };
    with_headings(&page.into_string())
}

/// A figure, of which `i` come before, with its caption and links to its files.
pub(crate) fn figure((i, figure): (usize, &Figure)) -> Markup {
    let table = figure.table.as_ref().map(|_| "csv");
    let endings = std::iter::once("svg").chain(table);
    let links = endings.map(|ending| file(&format!("figures/{}.{ending}", figure.name)));
    html! {
        figure {
            div.drawing { (figure.pictures()) }
            (figure.key)
            figcaption {
                b { "Figure " (i + 1) "." } " " (Prose(&figure.caption)) " "
                span.small { "(" (joined(links, ", ")) ")" }
            }
        }
    }
}

/// A link to a file beside the page.
pub(crate) fn file(path: &str) -> Markup {
    html! { a href=(path) { (path) } }
}

/// Items with a separator between them.
pub(crate) fn joined(items: impl IntoIterator<Item = impl Render>, separator: impl Render) -> Markup {
    html! {
        @for (i, item) in items.into_iter().enumerate() {
            @if i > 0 { (separator) }
            (item)
        }
    }
}

/// Items set as code, with a separator between them.
pub(crate) fn codes(items: &[impl Render], separator: impl Render) -> Markup {
    joined(items.iter().map(|item| html! { code { (item) } }), separator)
}

/// An expected value with minus signs in place of hyphens.
pub(crate) fn minus(expected: &str) -> String {
    expected.replace('-', "−")
}

/// A number in the given format, which makes a label, or a dash where there is none.
pub(crate) fn labelled(x: Option<f64>, format: impl Fn(f64) -> String) -> Markup {
    Label(&or_dash(x, format)).render()
}

/// A number in the given format, or a dash where there is none.
pub(crate) fn or_dash(x: Option<f64>, format: impl Fn(f64) -> String) -> String {
    x.map_or_else(|| "–".to_owned(), format)
}
