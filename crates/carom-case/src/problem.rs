//! Problems of a case: found by key path, shown with their line in the file.

use std::fmt;

/// A problem, located by the path of its key: `body[0].mesh.size`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Key path; tables of a list by index. Empty for the whole case.
    pub path: String,
    /// Whether the problem is the key itself rather than its value.
    pub at_key: bool,
    /// Bytes of the value's text to point at, if it is a formula.
    pub within: Option<Box<std::ops::Range<usize>>>,
    /// Message: what is wrong with the key or value.
    pub what: String,
    /// Reason why it is wrong.
    pub why: String,
    /// Suggested remedy; may be empty.
    pub help: String,
    /// Whether the system is the reason, such as a lack of memory, and not the case.
    pub system: bool,
}

impl Problem {
    /// A problem with the value at `path`.
    pub fn new(
        path: impl Into<String>,
        what: impl Into<String>,
        why: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self {
            path: path.into(),
            at_key: false,
            within: None,
            what: what.into(),
            why: why.into(),
            help: help.into(),
            system: false,
        }
    }

    /// Marks the problem as caused by the system, such as a lack of memory.
    #[must_use]
    pub fn of_system(self) -> Self {
        Self { system: true, ..self }
    }

    /// Points the problem at the key instead of its value.
    #[must_use]
    pub fn at_key(self) -> Self {
        Self { at_key: true, ..self }
    }

    /// Points the problem at a range of bytes in the text of its value.
    #[must_use]
    pub fn within(self, bytes: std::ops::Range<usize>) -> Self {
        Self { within: Some(Box::new(bytes)), ..self }
    }
}

/// Whether a path is that of a table, or of something in it.
pub(super) fn is_within(path: &str, table: &str) -> bool {
    path.strip_prefix(table).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// Everything wrong with a case. [`Document::diagnose_all`](crate::Document::diagnose_all) finds
/// the lines.
#[derive(Clone, Debug, Default, PartialEq, Eq, thiserror::Error)]
#[error("{}", one_by_one(.0))]
pub struct Problems(Vec<Problem>);

impl From<Vec<Problem>> for Problems {
    fn from(problems: Vec<Problem>) -> Self {
        Self(problems)
    }
}

impl std::ops::Deref for Problems {
    type Target = [Problem];

    fn deref(&self) -> &[Problem] {
        &self.0
    }
}

fn one_by_one(problems: &[Problem]) -> String {
    let one = |p: &Problem| {
        let parts = [("", &p.path), ("", &p.what), ("why: ", &p.why), ("try: ", &p.help)];
        let parts = parts.iter().filter(|(_, text)| !text.is_empty());
        parts.map(|(label, text)| format!("{label}{text}")).collect::<Vec<_>>().join("; ")
    };
    problems.iter().map(one).collect::<Vec<_>>().join("\n")
}

/// A problem with its place in a source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The case file as given, or `--set`.
    pub file: String,
    /// Line from 1; 0 if the file has no such place.
    pub line: usize,
    /// Column from 1, in characters.
    pub column: usize,
    /// The line as written.
    pub quoted: String,
    /// Number of characters marked, ≥ 1.
    pub length: usize,
    /// Message: what is wrong at this place.
    pub what: String,
    /// Why it is wrong.
    pub why: String,
    /// Suggested remedy; may be empty.
    pub help: String,
    /// Whether the system is the reason, and not the case.
    pub system: bool,
}

impl Diagnostic {
    /// A diagnostic about a file as a whole.
    pub fn of_file(
        file: &str,
        what: impl Into<String>,
        why: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        let what = what.into();
        let why = why.into();
        let help = help.into();
        Self {
            file: file.to_owned(),
            line: 0,
            column: 0,
            quoted: String::new(),
            length: 1,
            what,
            why,
            help,
            system: false,
        }
    }

    /// Places a message at a byte span of a text; only the first line of the span is quoted.
    pub(super) fn at(file: &str, text: &str, span: std::ops::Range<usize>, message: [String; 3]) -> Self {
        let start = floor(text, span.start);
        let first = text[..start].rfind('\n').map_or(0, |i| i + 1);
        let last = text[start..].find('\n').map_or(text.len(), |i| start + i);
        let end = floor(text, span.end).clamp(start, last);
        let [what, why, help] = message;
        Self {
            file: file.to_owned(),
            line: text[..start].matches('\n').count() + 1,
            column: text[first..start].chars().count() + 1,
            quoted: text[first..last].trim_end().to_owned(),
            length: text[start..end].trim_end().chars().count().max(1),
            what,
            why,
            help,
            system: false,
        }
    }

    /// A diagnostic for text that is not TOML.
    pub(super) fn of_syntax(file: &str, text: &str, error: &toml_edit::TomlError) -> Self {
        let cause = error.message().trim().replace('\n', "; ");
        let help =
            "see https://toml.io for the syntax: strings in quotes, lists in [ ], tables in { } on one line";
        let message = ["this is not TOML".to_owned(), cause, help.to_owned()];
        Self::at(file, text, error.span().unwrap_or(0..0), message)
    }
}

/// The character boundary at or before a byte offset.
fn floor(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|i| text.is_char_boundary(*i)).unwrap_or(0)
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line == 0 {
            write!(f, "{}: {}", self.file, self.what)?;
        } else {
            // Tabs are repeated, so that the caret stays below its column.
            let pad: String = self
                .quoted
                .chars()
                .take(self.column - 1)
                .map(|c| if c == '\t' { '\t' } else { ' ' })
                .collect();
            writeln!(f, "{}:{}:{}: {}", self.file, self.line, self.column, self.what)?;
            writeln!(f, "  {}", self.quoted)?;
            write!(f, "  {pad}{}", "^".repeat(self.length))?;
        }
        for (label, text) in [("why", &self.why), ("try", &self.help)] {
            if !text.is_empty() {
                write!(f, "\n{label}: {text}")?;
            }
        }
        Ok(())
    }
}

/// Why a case file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum CaseError {
    /// The case is wrong: every problem that could be found.
    #[error("{}", joined(.0))]
    Wrong(Vec<Diagnostic>),
    /// Input/output or system error.
    #[error("{path}: cannot be read: {source}")]
    Refused {
        /// The file as given.
        path: String,
        /// The error of the system.
        source: std::io::Error,
    },
}

impl CaseError {
    /// An error about a file as a whole.
    pub(super) fn of_file(
        file: &str,
        what: impl Into<String>,
        why: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self::Wrong(vec![Diagnostic::of_file(file, what, why, help)])
    }
}

fn joined(diagnostics: &[Diagnostic]) -> String {
    diagnostics.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n\n")
}

/// A computed number for a message: at most ten digits, so that 0.1 + 0.2 reads 0.3.
pub(super) fn rounded(x: f64) -> f64 {
    format!("{x:.9e}").parse().unwrap_or(x)
}
