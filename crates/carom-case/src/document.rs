//! A case file as text: parsed, with the overrides of `--set` applied, and with the place of every
//! key path.

use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::overrides;
use super::problem::{CaseError, Diagnostic, Problem};
use super::suggest;
use super::tree::{self, Node, Origin, Table, Value};
use super::unit::{Labels, bare};

/// Largest size of a case file in bytes.
const LARGEST: u64 = 10_000_000;

/// A parsed case file with its overrides applied.
#[derive(Clone, Debug)]
pub struct Document {
    /// Name and text of each source: the file first, then the overrides.
    sources: Vec<(String, String)>,
    root: Node,
}

/// Path of a `.toml` file with a similar name, in the folder of a file that does not exist.
fn beside(path: &Path) -> Option<PathBuf> {
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let names =
        std::fs::read_dir(folder).ok()?.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut names: Vec<String> =
        names.filter_map(|name| Some(name.strip_suffix(".toml")?.to_owned())).collect();
    names.sort_unstable();
    let near = suggest::nearest(path.file_stem()?.to_str()?, names.iter().map(String::as_str))?;
    Some(path.with_file_name(format!("{near}.toml")))
}

/// The diagnostic of text that is not TOML: about the unit, where a number with a unit is the
/// reason.
fn without_unit(name: &str, text: &str, error: &toml_edit::TomlError) -> Diagnostic {
    let found = Diagnostic::of_syntax(name, text, error);
    let line = text.lines().nth(found.line.saturating_sub(1)).unwrap_or_default();
    let Some((key, value)) = bare(line) else { return found };
    // The units of a case whose lines of this kind are left out.
    let rest: Vec<&str> = text.lines().filter(|line| bare(line).is_none()).collect();
    let labels = toml_edit::Document::parse(rest.join("\n")).ok().and_then(|parsed| {
        let root = tree::node(parsed.as_item(), 0, 0, &(0..0));
        root.table().map(Labels::of)
    });
    let key = key.rsplit('.').next().unwrap_or(key);
    let help = labels.unwrap_or_default().advice(key, None, value);
    let why = format!("a value is a number or a text in quotes, and `{value}` is neither");
    Diagnostic { why, help: help.unwrap_or_default(), ..found }
}

impl Document {
    /// Reads a file and applies overrides `key=value`, in their order.
    pub fn open(path: &Path, sets: &[String]) -> Result<Self, CaseError> {
        let name = path.display().to_string();
        let unreadable = |source: std::io::Error| {
            if source.kind() != std::io::ErrorKind::NotFound {
                return CaseError::Refused { path: name.clone(), source };
            }
            let (why, help) = match beside(path) {
                Some(near) => {
                    let help = format!("did you mean {}?", near.display());
                    ("its folder has one with a similar name", help)
                }
                None if path.is_absolute() => {
                    ("no file or directory has this path", "check the path".to_owned())
                }
                None => {
                    let help = "check the path and the working directory".to_owned();
                    ("relative paths are resolved from the working directory", help)
                }
            };
            CaseError::of_file(&name, "there is no such file", why, help)
        };
        let facts = std::fs::metadata(path).map_err(unreadable)?;
        if facts.is_dir() {
            let why = "a case or a study is a single TOML file";
            let help = "give the path of the .toml file inside it";
            return Err(CaseError::of_file(&name, "this is a directory", why, help));
        }
        let file = std::fs::File::open(path).map_err(unreadable)?;
        Self::read_from(&name, file, sets)
    }

    /// Reads a stream (`name` stands for the file in messages) and applies overrides `key=value`,
    /// in their order. A stream without an end is an error.
    pub fn read_from(name: &str, stream: impl Read, sets: &[String]) -> Result<Self, CaseError> {
        let mut bytes = Vec::new();
        let read = stream.take(LARGEST + 1).read_to_end(&mut bytes);
        read.map_err(|source| CaseError::Refused { path: name.to_owned(), source })?;
        if bytes.len() as u64 > LARGEST {
            let why = format!("a case file has at most {LARGEST} bytes");
            let help = "give the path of the .toml file of the case";
            return Err(CaseError::of_file(name, "the file is too large to be a case", why, help));
        }
        let text = String::from_utf8(bytes).map_err(|e| {
            let at = e.utf8_error().valid_up_to();
            let why = format!("byte {} is not valid UTF-8, and TOML files are UTF-8 text", at + 1);
            let help = "give the path of the .toml file of the case, or save it as UTF-8";
            CaseError::of_file(name, "the file is not text", why, help)
        })?;
        Self::parse(name, &text, sets)
    }

    /// Parses a text (`name` stands for the file in messages) and applies overrides `key=value`, in
    /// their order.
    pub fn parse(name: &str, text: &str, sets: &[String]) -> Result<Self, CaseError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let wrong = |diagnostic| CaseError::Wrong(vec![diagnostic]);
        let parsed = toml_edit::Document::parse(text).map_err(|e| wrong(without_unit(name, text, &e)))?;
        if parsed.as_table().is_empty() && sets.is_empty() {
            let why = "a case needs at least `dimension`, a [[material]], a [[body]] and [time]";
            let help = "start from a template: carom new";
            return Err(CaseError::of_file(name, "the case is empty", why, help));
        }
        let root = tree::node(parsed.as_item(), 0, 0, &(0..0));
        let mut document = Self { sources: vec![(name.to_owned(), text.to_owned())], root };
        for set in sets {
            document.sources.push(("--set".to_owned(), set.clone()));
            let source = document.sources.len() - 1;
            overrides::apply(&mut document.root, set, source).map_err(|d| wrong(*d))?;
        }
        Ok(document)
    }

    /// Name of the file as given.
    pub fn name(&self) -> &str {
        &self.sources[0].0
    }

    /// The overrides `key=value`, in their order.
    pub fn sets(&self) -> Vec<String> {
        self.sources[1..].iter().map(|(_, text)| text.clone()).collect()
    }

    /// The file's text.
    pub fn text(&self) -> &str {
        &self.sources[0].1
    }

    /// The names of the tables of a list, in their order; empty where there is none.
    pub fn names(&self, list: &str) -> Vec<String> {
        let Some(Value::List(tables)) = self.root().get(list).map(|node| &node.value) else {
            return Vec::new();
        };
        let name = |node: &Node| Some(node.table()?.get("name")?.text()?.to_owned());
        tables.iter().map(|node| name(node).unwrap_or_default()).collect()
    }

    pub(super) fn root(&self) -> &Table {
        const EMPTY: &Table = &Table(Vec::new());
        self.root.table().unwrap_or(EMPTY)
    }

    /// Whether the file has a key of a study (many runs of one case).
    pub fn is_study(&self) -> bool {
        self.study_key().is_some()
    }

    /// Whether the file has this key at its top level.
    pub fn has(&self, key: &str) -> bool {
        self.root().get(key).is_some()
    }

    /// The first key found that only a study has; none in a case.
    pub(super) fn study_key(&self) -> Option<&'static str> {
        ["case", "arm", "grid"].into_iter().find(|key| self.has(key))
    }

    /// Finds the line that a problem is about; a key that was not written is reported at its
    /// nearest parent.
    pub fn diagnose(&self, problem: &Problem) -> Diagnostic {
        let message = [problem.what.clone(), problem.why.clone(), problem.help.clone()];
        let found = match self.origin(&problem.path, problem.at_key) {
            Some(origin) => {
                let (name, text) = &self.sources[origin.source];
                let span = match &problem.within {
                    Some(bytes) => part_of_text(text, &origin.span, bytes),
                    None => origin.span,
                };
                Diagnostic::at(name, text, span, message)
            }
            None => Diagnostic::of_file(self.name(), &problem.what, &problem.why, &problem.help),
        };
        Diagnostic { system: problem.system, ..found }
    }

    /// Finds the lines of all problems, sorted by place: those in the file, then those in
    /// overrides.
    pub fn diagnose_all(&self, problems: &[Problem]) -> CaseError {
        let mut found: Vec<_> = problems.iter().map(|p| self.diagnose(p)).collect();
        found.sort_by_key(|d| (d.file != self.name(), d.line, d.column));
        found.dedup();
        CaseError::Wrong(found)
    }

    fn origin(&self, path: &str, at_key: bool) -> Option<Origin> {
        let mut node = &self.root;
        let mut found = None;
        for segment in segments(path) {
            let (next, place) = match (&node.value, segment) {
                (Value::Table(table), Segment::Key(key)) => {
                    let Some(entry) = table.entry(&key) else { break };
                    // The span of a table with a header is that header.
                    (&entry.node, if at_key { &entry.origin } else { &entry.node.origin })
                }
                (Value::List(list), Segment::Index(i)) => {
                    let Some(node) = list.get(i) else { break };
                    (node, &node.origin)
                }
                _ => break,
            };
            node = next;
            found = Some(place.clone());
        }
        found
    }
}

/// Span in the source of some bytes of a string value; `value` is the span of the string with its
/// quotes. The whole string where escapes may have moved the bytes.
fn part_of_text(source: &str, value: &Range<usize>, bytes: &Range<usize>) -> Range<usize> {
    let raw = source.get(value.clone()).unwrap_or_default();
    if raw.contains('\\') || raw.starts_with("\"\"\"") || raw.starts_with("'''") {
        return value.clone();
    }
    let start =
        value.start + if raw.starts_with(['"', '\'']) { 1 } else { raw.len() - raw.trim_start().len() };
    start + bytes.start..start + bytes.end
}

enum Segment {
    Key(String),
    Index(usize),
}

/// The segments of a path such as `body[0].mesh."odd key"`.
fn segments(path: &str) -> Vec<Segment> {
    let mut found = Vec::new();
    let mut remaining = path;
    while !remaining.is_empty() {
        if let Some(after) = remaining.strip_prefix('[') {
            let (index, after) = after.split_once(']').unwrap_or((after, ""));
            found.extend(index.parse().map(Segment::Index));
            remaining = after;
        } else if let Some(after) = remaining.strip_prefix('"') {
            let (key, after) = after.split_once('"').unwrap_or((after, ""));
            found.push(Segment::Key(key.to_owned()));
            remaining = after;
        } else {
            let end = remaining.find(['.', '[']).unwrap_or(remaining.len());
            found.push(Segment::Key(remaining[..end].to_owned()));
            remaining = &remaining[end..];
        }
        remaining = remaining.strip_prefix('.').unwrap_or(remaining);
    }
    found
}

/// The path of a key inside the table at `path`.
pub(super) fn joined(path: &str, key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-');
    let key = if bare { key.to_owned() } else { format!("\"{key}\"") };
    if path.is_empty() { key } else { format!("{path}.{key}") }
}
