//! TOML values, each with its place in the source: byte spans into one of the document's sources.

use std::ops::Range;

use toml_edit::{Item, TableLike};

/// Where a value was written: in the case file (source 0) or in the n-th override (source n).
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Origin {
    pub(crate) source: usize,
    pub(crate) span: Range<usize>,
}

/// A value and its place.
#[derive(Clone, Debug)]
pub struct Node {
    pub(crate) value: Value,
    /// Whether the value is a table in braces.
    pub(crate) is_inline: bool,
    pub(crate) origin: Origin,
}

/// TOML's values.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(String),
    Integer(i64),
    Float(f64),
    Flag(bool),
    Date(String),
    List(Vec<Node>),
    Table(Table),
}

/// Keys in the order in which they were written.
#[derive(Clone, Debug, Default)]
pub struct Table(pub(crate) Vec<Entry>);

/// A key with its value.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) origin: Origin,
    pub(crate) node: Node,
}

impl Table {
    pub(crate) fn entry(&self, key: &str) -> Option<&Entry> {
        self.0.iter().find(|e| e.key == key)
    }

    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        self.entry(key).map(|e| &e.node)
    }

    /// The value of a key that is given at `origin`, as a whole (`replaced`) or in part; added as
    /// an empty table if it is not there.
    pub(crate) fn given(&mut self, key: &str, origin: &Origin, replaced: bool) -> &mut Node {
        let found = self.0.iter().position(|e| e.key == key);
        let at = found.unwrap_or_else(|| {
            let node =
                Node { value: Value::Table(Self::default()), is_inline: false, origin: origin.clone() };
            self.0.push(Entry { key: key.to_owned(), origin: origin.clone(), node });
            self.0.len() - 1
        });
        if replaced {
            self.0[at].origin = origin.clone();
        }
        &mut self.0[at].node
    }
}

impl Table {
    /// Values of the table with the dotted paths of their keys; a table in braces counts as one
    /// value.
    pub(crate) fn flat(&self) -> Vec<(String, &Node)> {
        let mut found = Vec::new();
        for entry in &self.0 {
            match &entry.node.value {
                Value::Table(inner) if !entry.node.is_inline => {
                    let below = inner.flat().into_iter();
                    found.extend(below.map(|(key, node)| (format!("{}.{key}", entry.key), node)));
                }
                _ => found.push((entry.key.clone(), &entry.node)),
            }
        }
        found
    }
}

impl Node {
    /// The value as TOML on one line, tables in braces.
    pub(crate) fn toml(&self) -> toml_edit::Value {
        match &self.value {
            Value::Text(text) => text.into(),
            Value::Integer(n) => (*n).into(),
            Value::Float(x) => (*x).into(),
            Value::Flag(flag) => (*flag).into(),
            Value::Date(date) => date.parse().unwrap_or_else(|_| date.into()),
            Value::List(list) => list.iter().map(Self::toml).collect(),
            Value::Table(table) => table.0.iter().map(|entry| (&*entry.key, entry.node.toml())).collect(),
        }
    }

    pub(crate) fn flag(&self) -> Option<bool> {
        if let Value::Flag(flag) = self.value { Some(flag) } else { None }
    }

    pub(crate) fn table(&self) -> Option<&Table> {
        if let Value::Table(table) = &self.value { Some(table) } else { None }
    }

    pub(crate) fn list(&self) -> Option<&[Node]> {
        if let Value::List(list) = &self.value { Some(list) } else { None }
    }

    #[doc(hidden)]
    pub fn text(&self) -> Option<&str> {
        if let Value::Text(text) = &self.value { Some(text) } else { None }
    }

    /// A number, integer or not.
    pub(crate) fn number(&self) -> Option<f64> {
        match self.value {
            Value::Float(x) => Some(x),
            Value::Integer(n) => Some(n as f64),
            _ => None,
        }
    }

    pub(crate) fn count(&self) -> Option<usize> {
        if let Value::Integer(n) = self.value { usize::try_from(n).ok() } else { None }
    }

    /// Description for messages.
    pub(crate) fn described(&self) -> String {
        match &self.value {
            Value::Text(text) if text.chars().count() <= 40 => format!("the string {text:?}"),
            Value::Text(_) => "a string".to_owned(),
            Value::Integer(n) => format!("the integer {n}"),
            Value::Float(x) => format!("the number {x:?}"),
            Value::Flag(flag) => format!("`{flag}`"),
            Value::Date(date) => format!("the date {date}"),
            Value::List(list) => format!("a list of {} values", list.len()),
            Value::Table(_) => "a table".to_owned(),
        }
    }
}

/// Converts what `toml_edit` parsed; `shift` is subtracted from its spans (the text in front of an
/// override's value).
pub(crate) fn node(item: &Item, source: usize, shift: isize, fallback: &Range<usize>) -> Node {
    let span = item.span().map_or_else(|| fallback.clone(), |span| shifted(&span, shift));
    let value = match item {
        Item::Value(value) => self::value(value, source, shift, &span),
        Item::Table(table) => Value::Table(self::table(table, source, shift, &span)),
        Item::ArrayOfTables(tables) => {
            let one = |table: &toml_edit::Table| {
                let span = table.span().map_or_else(|| span.clone(), |span| shifted(&span, shift));
                Node {
                    value: Value::Table(self::table(table, source, shift, &span)),
                    is_inline: false,
                    origin: Origin { source, span },
                }
            };
            Value::List(tables.iter().map(one).collect())
        }
        Item::None => Value::Table(Table::default()),
    };
    Node { value, is_inline: is_inline(item.as_value()), origin: Origin { source, span } }
}

fn is_inline(value: Option<&toml_edit::Value>) -> bool {
    value.and_then(toml_edit::Value::as_inline_table).is_some_and(|table| !table.is_dotted())
}

fn value(value: &toml_edit::Value, source: usize, shift: isize, span: &Range<usize>) -> Value {
    match value {
        toml_edit::Value::String(text) => Value::Text(text.value().clone()),
        toml_edit::Value::Integer(n) => Value::Integer(*n.value()),
        toml_edit::Value::Float(x) => Value::Float(*x.value()),
        toml_edit::Value::Boolean(flag) => Value::Flag(*flag.value()),
        toml_edit::Value::Datetime(date) => Value::Date(date.value().to_string()),
        toml_edit::Value::Array(list) => {
            let one = |value: &toml_edit::Value| {
                let span = value.span().map_or_else(|| span.clone(), |span| shifted(&span, shift));
                let is_inline = is_inline(Some(value));
                Node {
                    value: self::value(value, source, shift, &span),
                    is_inline,
                    origin: Origin { source, span },
                }
            };
            Value::List(list.iter().map(one).collect())
        }
        toml_edit::Value::InlineTable(table) => Value::Table(self::table(table, source, shift, span)),
    }
}

fn table(table: &dyn TableLike, source: usize, shift: isize, around: &Range<usize>) -> Table {
    let entry = |(name, item): (&str, &Item)| {
        let key = table.key(name).and_then(toml_edit::Key::span);
        let key = key.map_or_else(|| around.clone(), |span| shifted(&span, shift));
        let node = node(item, source, shift, &key);
        Entry { key: name.to_owned(), origin: Origin { source, span: key }, node }
    };
    Table(table.iter().map(entry).collect())
}

fn shifted(span: &Range<usize>, shift: isize) -> Range<usize> {
    span.start.saturating_add_signed(-shift)..span.end.saturating_add_signed(-shift)
}
