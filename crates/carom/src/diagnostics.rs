//! Messages about cases with the line they are about, as the command prints them.

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Element, Group, Level, Origin, Renderer, Snippet};
use carom_run::case::{CaseError, Diagnostic};

/// Everything wrong with a case, with place, reason and what to try.
pub fn text(error: &CaseError, in_colour: bool) -> String {
    match error {
        CaseError::Wrong(found) => {
            found.iter().map(|found| rendered(found, in_colour)).collect::<Vec<_>>().join("\n\n")
        }
        CaseError::Refused { .. } => plain(&error.to_string(), &[], in_colour),
    }
}

/// A message without a place, and notes with their names.
pub fn plain(what: &str, more: &[(&str, &str)], in_colour: bool) -> String {
    let mut group = Group::with_title(Level::ERROR.primary_title(what));
    for (name, text) in more.iter().filter(|(_, text)| !text.is_empty()) {
        group = group.element(Level::NOTE.with_name(Some(*name)).message(*text));
    }
    renderer(in_colour).render(&[group])
}

fn renderer(in_colour: bool) -> Renderer {
    if in_colour { Renderer::styled().decor_style(DecorStyle::Unicode) } else { Renderer::plain() }
}

fn rendered(found: &Diagnostic, in_colour: bool) -> String {
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
    renderer(in_colour).render(&[group])
}
