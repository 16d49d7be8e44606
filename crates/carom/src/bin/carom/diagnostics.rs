//! Failures on standard error, with the line of the case file, in colour on a terminal.

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Element, Group, Level, Origin, Renderer, Snippet};
use carom::case::{CaseError, Diagnostic};
use serde_json::json;

use crate::exit::{Exit, Failure};
use crate::{console, out};

/// Prints a failure, with `json` also as an event on standard output; returns its exit code.
pub(crate) fn print(failure: &Failure, json: bool) -> Exit {
    let text = match failure {
        Failure::Case(CaseError::Wrong(found)) => found.iter().map(rendered).collect::<Vec<_>>().join("\n\n"),
        Failure::Argument { help, .. } => plain(&failure.to_string(), &[("try", help)]),
        Failure::Stopped { help, directory, page, .. } => {
            let place = directory.display();
            let note = if *page {
                format!(
                    "why and where: {place}/report.html; a smaller case that stops too: carom reduce {place}"
                )
            } else {
                format!("the last valid state is saved in {place}")
            };
            plain(&failure.to_string(), &[("note", &note), ("try", help)])
        }
        Failure::Case(CaseError::Refused { .. }) | Failure::System { .. } => plain(&failure.to_string(), &[]),
    };
    console::say(text);
    // The event of a run that stopped has been printed already.
    if json && !matches!(failure, Failure::Stopped { .. }) {
        let _ = out::event(&event(failure));
    }
    failure.exit()
}

/// `{ "event": "error", "exit": 2, "errors": [{ "what": …, "why": …, "try": …, "file": …, … }] }`;
/// lines and columns from 1, a line of 0 for a file as a whole.
fn event(failure: &Failure) -> serde_json::Value {
    let errors = match failure {
        Failure::Case(CaseError::Wrong(found)) => found.iter().map(placed).collect(),
        Failure::Argument { what, help } => vec![json!({ "what": what, "try": help })],
        other => vec![json!({ "what": other.to_string() })],
    };
    json!({ "event": "error", "exit": failure.exit() as u8, "errors": errors })
}

fn placed(found: &Diagnostic) -> serde_json::Value {
    json!({
        "what": found.what, "why": found.why, "try": found.help,
        "file": found.file, "line": found.line, "column": found.column, "length": found.length,
    })
}

fn renderer() -> Renderer {
    if console::in_colour() { Renderer::styled().decor_style(DecorStyle::Unicode) } else { Renderer::plain() }
}

fn rendered(found: &Diagnostic) -> String {
    let place: Element = if found.line == 0 {
        Origin::path(found.file.as_str()).into()
    } else {
        let byte =
            |column: usize| found.quoted.char_indices().nth(column).map_or(found.quoted.len(), |(i, _)| i);
        let span = byte(found.column - 1)..byte(found.column - 1 + found.length);
        let here = AnnotationKind::Primary.span(span);
        Snippet::source(found.quoted.as_str())
            .path(found.file.as_str())
            .line_start(found.line)
            .annotation(here)
            .into()
    };
    let mut group = Group::with_title(Level::ERROR.primary_title(found.what.as_str())).element(place);
    for (level, text) in
        [(Level::NOTE.with_name(Some("why")), &found.why), (Level::HELP.with_name(Some("try")), &found.help)]
    {
        if !text.is_empty() {
            group = group.element(level.message(text.as_str()));
        }
    }
    renderer().render(&[group])
}

fn plain(what: &str, more: &[(&str, &str)]) -> String {
    let mut group = Group::with_title(Level::ERROR.primary_title(what));
    for (name, text) in more.iter().filter(|(_, text)| !text.is_empty()) {
        group = group.element(Level::NOTE.with_name(Some(*name)).message(*text));
    }
    renderer().render(&[group])
}
