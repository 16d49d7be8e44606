//! Typed values of one table, with its defaults. A value that is absent or of the wrong type is
//! `None`; `conform` has reported it.

use std::borrow::Cow;
use std::cell::RefCell;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use super::keys::{Default, Key, Kind};
use super::problem::Problem;
use super::tree::{self, Node, Table};
use super::{FormulaSpec, Preset};

/// A table with the description of its keys.
#[derive(Clone)]
pub(super) struct View<'a> {
    pub(super) table: &'a Table,
    pub(super) keys: &'static [Key],
    pub(super) preset: Preset,
    /// Where relative paths of files start.
    pub(super) folder: &'a Path,
    /// Path of the table; empty for the whole document.
    pub(super) path: String,
    /// What its readers report.
    pub(super) problems: &'a RefCell<Vec<Problem>>,
}

impl<'a> View<'a> {
    /// A table that stands alone.
    pub(super) fn of_keys(
        table: &'a Table,
        keys: &'static [Key],
        problems: &'a RefCell<Vec<Problem>>,
    ) -> Self {
        let (preset, folder, path) = (Preset::Default, Path::new(""), String::new());
        Self { table, keys, preset, folder, path, problems }
    }

    /// The table of a key, or an empty one with all defaults if it is not given. Which keys a
    /// variant has, its reader knows.
    pub(super) fn at(&self, name: &str) -> Option<Self> {
        const EMPTY: &Table = &Table(Vec::new());
        let table = self.table.get(name).map_or(Some(EMPTY), Node::table)?;
        Some(self.within(name, table, self.path_of(name)))
    }

    /// Reads every table of a list, which may be absent; `None` if it is something else.
    pub(super) fn each<T>(
        &self,
        name: &str,
        mut read: impl FnMut(&Self) -> Option<T>,
    ) -> Option<Vec<Option<T>>> {
        let list = self.table.get(name).map_or(Some(&[][..]), Node::list)?.iter().enumerate();
        let path = |i: usize| format!("{}[{i}]", self.path_of(name));
        Some(list.map(|(i, node)| read(&self.within(name, node.table()?, path(i)))).collect())
    }

    fn within(&self, name: &str, table: &'a Table, path: String) -> Self {
        let keys = match self.keys.iter().find(|key| key.name == name).map(|key| key.kind) {
            Some(
                Kind::Table(spec)
                | Kind::Tables(spec)
                | Kind::SideOr(spec)
                | Kind::FormulasOr(_, spec)
                | Kind::Rotation(spec),
            ) => spec.keys,
            _ => &[],
        };
        Self { table, keys, path, ..self.clone() }
    }

    fn path_of(&self, key: &str) -> String {
        let dot = if self.path.is_empty() || key.is_empty() { "" } else { "." };
        format!("{}{dot}{key}", self.path)
    }

    /// A problem with the value of a key.
    pub(super) fn problem(
        &self,
        key: &str,
        what: impl Into<String>,
        why: impl Into<String>,
        help: impl Into<String>,
    ) -> Problem {
        Problem::new(self.path_of(key), what, why, help)
    }

    /// Reports a problem with the value of a key, or with the whole table if the key is empty, in
    /// place of what would have been read.
    pub(super) fn wrong<T>(
        &self,
        key: &str,
        what: impl Into<String>,
        why: impl Into<String>,
        help: impl Into<String>,
    ) -> Option<T> {
        self.report(self.problem(key, what, why, help))
    }

    /// Reports any problem, likewise.
    pub(super) fn report<T>(&self, problem: Problem) -> Option<T> {
        self.problems.borrow_mut().push(problem);
        None
    }

    /// Whether such a problem has been reported.
    pub(super) fn has_problem(&self, is: impl Fn(&Problem) -> bool) -> bool {
        self.problems.borrow().iter().any(is)
    }

    /// Whether it has a key that is none of its own: a misspelt key is reported once, not as a
    /// missing one too.
    pub(super) fn has_unknown_key(&self) -> bool {
        self.table.0.iter().any(|entry| !self.keys.iter().any(|key| key.name == entry.key))
    }

    /// The given value, or its default.
    pub(super) fn value(&self, name: &str) -> Option<Cow<'a, Node>> {
        if let Some(node) = self.table.get(name) {
            return Some(Cow::Borrowed(node));
        }
        let key = self.keys.iter().find(|k| k.name == name)?;
        let paper = key.paper.filter(|_| self.preset == Preset::Paper);
        let toml = match key.default {
            Default::Is(toml) => paper.unwrap_or(toml),
            _ => paper?,
        };
        let parsed = toml_edit::Document::parse(format!("v = {toml}")).ok()?;
        Some(Cow::Owned(tree::node(parsed.get("v")?, 0, 0, &(0..0))))
    }

    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.value(name)?.number()
    }

    pub(super) fn count(&self, name: &str) -> Option<usize> {
        self.value(name)?.count()
    }

    pub(super) fn text(&self, name: &str) -> Option<String> {
        self.value(name)?.text().map(str::to_owned)
    }

    /// The absolute path of a file.
    pub(super) fn file(&self, name: &str) -> Option<PathBuf> {
        let joined = self.folder.join(self.text(name)?);
        Some(std::path::absolute(&joined).unwrap_or(joined))
    }

    /// A word of a `Choice`, read as the enum variant that is serialised as this word.
    pub(super) fn choice<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        word(self.value(name)?.text()?)
    }

    pub(super) fn flag(&self, name: &str) -> Option<bool> {
        self.value(name)?.flag()
    }

    pub(super) fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        numbers(&*self.value(name)?)
    }

    /// Points of the plane.
    pub(super) fn points(&self, name: &str) -> Option<Vec<[f64; 2]>> {
        let pair = |node: &Node| numbers(node)?.try_into().ok();
        self.value(name)?.list()?.iter().map(pair).collect()
    }

    /// A vector, zero if it is not given.
    pub(super) fn vector(&self, name: &str, dimension: usize) -> Option<Vec<f64>> {
        if self.has(name) { self.numbers(name) } else { Some(vec![0.0; dimension]) }
    }

    pub(super) fn texts(&self, name: &str) -> Option<Vec<String>> {
        self.value(name)?.list()?.iter().map(|n| n.text().map(str::to_owned)).collect()
    }

    pub(super) fn formula(&self, name: &str) -> Option<FormulaSpec> {
        formula(&*self.value(name)?)
    }

    pub(super) fn formulas(&self, name: &str) -> Option<Vec<FormulaSpec>> {
        self.value(name)?.list()?.iter().map(formula).collect()
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.table.get(name).is_some()
    }
}

/// The enum variant serialised as this word.
pub(super) fn word<T: DeserializeOwned>(word: &str) -> Option<T> {
    serde_json::from_value(serde_json::Value::String(word.to_owned())).ok()
}

/// A list of numbers.
fn numbers(node: &Node) -> Option<Vec<f64>> {
    node.list()?.iter().map(Node::number).collect()
}

/// A number or a string as a formula.
pub(super) fn formula(node: &Node) -> Option<FormulaSpec> {
    node.number()
        .map(FormulaSpec::Number)
        .or_else(|| node.text().map(|text| FormulaSpec::Text(text.to_owned())))
}
