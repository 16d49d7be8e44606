//! Failures on standard error: with the line of the case they come from, in colour on a terminal.

use std::io::{self, IsTerminal, Write};

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Element, Group, Level, Origin, Renderer, Snippet};
use carom::case::{CaseError, Diagnostic};

use crate::exit::{Exit, Failure};

/// Tells a failure; returns the exit code that belongs to it.
pub(crate) fn tell(failure: &Failure) -> Exit {
    let text = match failure {
        Failure::Case(CaseError::Wrong(found)) => found.iter().map(rendered).collect::<Vec<_>>().join("\n\n"),
        Failure::Argument { help, .. } => plain(&failure.to_string(), &[("try", help)]),
        Failure::Stopped { help, directory, .. } => {
            let kept = format!("the last good state is kept in {}", directory.display());
            plain(&failure.to_string(), &[("note", &kept), ("try", help)])
        }
        Failure::Case(CaseError::Refused { .. }) | Failure::Refused { .. } => {
            plain(&failure.to_string(), &[])
        }
    };
    // Nobody is left to tell if standard error is closed.
    let _ = writeln!(io::stderr().lock(), "{text}");
    failure.exit()
}

fn renderer() -> Renderer {
    let colour = io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    if colour { Renderer::styled().decor_style(DecorStyle::Unicode) } else { Renderer::plain() }
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
