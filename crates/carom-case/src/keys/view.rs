//! A table with the description of its keys, as its reader sees it. A value that is absent or of
//! the wrong type is `None`; `conform` has reported it.

use std::borrow::Cow;
use std::cell::RefCell;
use std::path::Path;

use carom_solid::Element;

use super::{Default as KeyDefault, Key, Kind, Table as Description, Variants};
use crate::problem::Problem;
use crate::tree::{self, Node, Table};

/// A table of keys, derived from a struct.
pub trait Keys: Sized {
    /// Description of the table: its keys and their meanings.
    const TABLE: Description;

    /// Reads a table of this description; none if a key is missing or has no value of its type,
    /// which is reported elsewhere.
    fn read(v: &View<'_>) -> Option<Self>;
}

/// A value of a key.
pub trait Value: Sized {
    /// Kind of value of a key whose field has this type, unless the key states another.
    const KIND: Kind;
    /// Kind of value of a key whose field is a list of this type.
    const LIST: Kind = Kind::Vector;

    /// Reads the value at the place `v`; none if it has another type, which is reported elsewhere.
    fn of(node: &Node, v: &View<'_>) -> Option<Self>;

    /// The value of an optional key that is not given.
    fn absent(_: &View<'_>) -> Option<Self> {
        None
    }
}

/// A table with the description of its keys.
#[derive(Clone)]
pub struct View<'a> {
    pub(crate) table: &'a Table,
    pub(crate) keys: &'static [Key],
    /// The key whose value selected these keys; empty if none did.
    pub(crate) tag: &'static str,
    /// Whether the defaults are those of the preset `paper`.
    pub(crate) is_paper: bool,
    /// Dimension of the case, if it is known.
    pub(crate) dimension: Option<usize>,
    /// Cell type of the body whose mesh is read, if it is known.
    pub(crate) element: Option<Element>,
    /// Materials by physical group of the body whose mesh is read, if they are given.
    pub(crate) materials: Option<&'a Table>,
    /// Where relative paths of files start.
    pub(crate) folder: &'a Path,
    /// Path of the table; empty for the whole document.
    pub(crate) path: String,
    /// Problems reported while the document is read.
    pub(crate) problems: &'a RefCell<Vec<Problem>>,
}

impl<'a> View<'a> {
    pub(crate) const EMPTY: &'static Table = &Table(Vec::new());

    /// View of a table that is no part of a document, with these keys.
    pub(crate) fn of_keys(
        table: &'a Table,
        keys: &'static [Key],
        problems: &'a RefCell<Vec<Problem>>,
    ) -> Self {
        Self {
            table,
            keys,
            tag: "",
            is_paper: false,
            dimension: None,
            element: None,
            materials: None,
            folder: Path::new(""),
            path: String::new(),
            problems,
        }
    }

    /// View of a table with these keys, at the same place.
    pub(crate) fn inside(&self, table: &'a Table, keys: &'static [Key]) -> Self {
        Self { table, keys, tag: "", ..self.clone() }
    }

    /// View of a table at the same place with the one of several descriptions that fits it; none if
    /// none does.
    pub(crate) fn one_of(&self, table: &'a Table, variants: &Variants) -> Option<Self> {
        let tag = if variants.has_other(table) { "" } else { variants.tag };
        let spec = variants.of(table)?;
        let dimension = variants.dimension.or(self.dimension);
        // A table of another dimension has been reported.
        let fits = spec.dimension.is_none() || dimension.is_none() || spec.dimension == dimension;
        fits.then(|| Self { tag, dimension, ..self.inside(table, spec.keys) })
    }

    /// View of a value that must be a table of one of several descriptions.
    #[doc(hidden)]
    pub fn variant(&self, node: &'a Node, variants: &Variants) -> Option<Self> {
        self.one_of(node.table()?, variants)
    }

    /// The word that selected the description of this table.
    #[doc(hidden)]
    pub fn word(&self) -> Option<&'a str> {
        self.table.get(self.tag)?.text()
    }

    /// View at the place of an element of a list.
    pub(crate) fn element(&self, i: usize) -> Self {
        Self { path: format!("{}[{i}]", self.path), ..self.clone() }
    }

    /// View at the place of a key.
    pub(crate) fn place(&self, key: &str) -> Self {
        Self { path: self.path_of(key), ..self.clone() }
    }

    /// View of the table of a key, or of an empty one with all defaults if it is not given.
    pub fn at(&self, name: &str) -> Option<Self> {
        let table = self.table.get(name).map_or(Some(Self::EMPTY), Node::table)?;
        let keys = match self.key(name)?.kind {
            Kind::Table(spec) | Kind::SideOr(spec) | Kind::FormulasOr(_, spec) | Kind::Rotation(spec) => {
                spec.keys
            }
            Kind::Variant(variants) => return self.place(name).one_of(table, variants()),
            _ => &[],
        };
        Some(self.place(name).inside(table, keys))
    }

    /// Reads every table of a list, which is empty if it is not given; none if the value is no
    /// list.
    pub fn each<T>(&self, name: &str, mut read: impl FnMut(&Self) -> Option<T>) -> Option<Vec<Option<T>>> {
        let keys = match self.key(name)?.kind {
            Kind::Tables(spec) => spec.keys,
            _ => &[],
        };
        let list = self.table.get(name).map_or(Some(&[][..]), Node::list)?.iter().enumerate();
        let place = self.place(name);
        Some(list.map(|(i, node)| read(&place.element(i).inside(node.table()?, keys))).collect())
    }

    fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    fn path_of(&self, key: &str) -> String {
        let dot = if self.path.is_empty() || key.is_empty() { "" } else { "." };
        format!("{}{dot}{key}", self.path)
    }

    /// A problem with the value of a key.
    pub(crate) fn problem(
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
    pub fn wrong<T>(
        &self,
        key: &str,
        what: impl Into<String>,
        why: impl Into<String>,
        help: impl Into<String>,
    ) -> Option<T> {
        self.report(self.problem(key, what, why, help))
    }

    /// As [`Self::wrong`], but points at the key instead of its value.
    pub fn wrong_key<T>(
        &self,
        key: &str,
        what: impl Into<String>,
        why: impl Into<String>,
        help: impl Into<String>,
    ) -> Option<T> {
        self.report(self.problem(key, what, why, help).at_key())
    }

    /// Reports a problem; returns `None`, in place of the value that cannot be read.
    pub(crate) fn report<T>(&self, problem: Problem) -> Option<T> {
        self.problems.borrow_mut().push(problem);
        None
    }

    /// Whether a problem that satisfies `is` has been reported.
    pub(crate) fn has_problem(&self, is: impl Fn(&Problem) -> bool) -> bool {
        self.problems.borrow().iter().any(is)
    }

    /// Whether the table has a key that its description lacks: a misspelt key is reported once, not
    /// as a missing one too.
    pub fn has_unknown_key(&self) -> bool {
        self.table.0.iter().any(|entry| entry.key != self.tag && self.key(&entry.key).is_none())
    }

    /// Node of a key: the given one, or that of the default.
    pub(crate) fn value(&self, name: &str) -> Option<Cow<'a, Node>> {
        if let Some(node) = self.table.get(name) {
            return Some(Cow::Borrowed(node));
        }
        let key = self.key(name)?;
        let paper = key.paper.filter(|_| self.is_paper);
        let toml = match key.default {
            KeyDefault::Is(toml) => paper.unwrap_or(toml),
            _ => paper?,
        };
        let parsed = toml_edit::Document::parse(format!("v = {toml}")).ok()?;
        Some(Cow::Owned(tree::node(parsed.get("v")?, 0, 0, &(0..0))))
    }

    /// The value of a key, or its default.
    #[doc(hidden)]
    pub fn get<T: Value>(&self, name: &str) -> Option<T> {
        let v = self.place(name);
        match self.value(name) {
            Some(node) => T::of(&node, &v),
            None if matches!(self.key(name)?.default, KeyDefault::Required) => None,
            None => T::absent(&v),
        }
    }

    /// Values of the case that the table of a key sets, with the dotted paths of their keys; empty
    /// if the key is not given.
    pub fn changes(&self, name: &str) -> Option<Vec<(String, toml_edit::Value)>> {
        self.table.get(name).map_or(Some(Vec::new()), changes)
    }

    /// Values of the case that each table of a list sets, with the dotted paths of their keys;
    /// empty if the list is not given.
    pub fn lists_of_changes(&self, name: &str) -> Option<Vec<Vec<(String, toml_edit::Value)>>> {
        let list = self.table.get(name).map_or(Some(&[][..]), Node::list)?;
        list.iter().map(changes).collect()
    }

    /// The value of a key as TOML on one line.
    pub fn toml(&self, name: &str) -> Option<toml_edit::Value> {
        self.table.get(name).map(Node::toml)
    }

    /// A vector, zero if it is not given.
    pub(crate) fn vector(&self, name: &str) -> Option<Vec<f64>> {
        if self.has(name) { self.get(name) } else { Some(vec![0.0; self.dimension?]) }
    }

    /// Whether a key is given.
    pub fn has(&self, name: &str) -> bool {
        self.table.get(name).is_some()
    }
}

fn changes(node: &Node) -> Option<Vec<(String, toml_edit::Value)>> {
    Some(node.table()?.flat().into_iter().map(|(key, node)| (key, node.toml())).collect())
}
