//! Typed values of one table, with its defaults. A value that is absent or of the wrong type is
//! `None`; `conform` has reported it.

use std::borrow::Cow;

use serde::de::DeserializeOwned;

use super::keys::{Default, Key};
use super::tree::{self, Node, Table};
use super::{FormulaSpec, Preset};

/// A table with the description of its keys.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) table: &'a Table,
    pub(super) keys: &'static [Key],
    pub(super) preset: Preset,
}

impl<'a> View<'a> {
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

    /// A word of a `Choice`, read as the enum variant that is serialised as this word.
    pub(super) fn choice<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        word(self.value(name)?.text()?)
    }

    pub(super) fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        self.value(name)?.list()?.iter().map(Node::number).collect()
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

/// A number or a string as a formula.
pub(super) fn formula(node: &Node) -> Option<FormulaSpec> {
    node.number()
        .map(FormulaSpec::Number)
        .or_else(|| node.text().map(|text| FormulaSpec::Text(text.to_owned())))
}
