//! Values of keys by their Rust types.

use std::collections::BTreeMap;
use std::path::PathBuf;

use carom_record::Norm;
use carom_record::study::design::{self, Goal};
use carom_solid::Element;
use carom_time::ForceRule;
use serde::de::DeserializeOwned;

use super::view::{Keys, Value, View};
use super::{ANY, Kind, Node, Words};
use crate::spec::FormulaSpec;

impl<T: Keys> Value for T {
    const KIND: Kind = Kind::Table(&T::TABLE);
    const LIST: Kind = Kind::Tables(&T::TABLE);

    fn of(node: &Node, v: &View<'_>) -> Option<Self> {
        T::read(&v.inside(node.table()?, T::TABLE.keys))
    }

    fn absent(v: &View<'_>) -> Option<Self> {
        T::read(&v.inside(View::EMPTY, T::TABLE.keys))
    }
}

/// An optional value: none where the key is absent or has a value of another type, so that the rest
/// of the table can still be read.
impl<T: Value> Value for Option<T> {
    const KIND: Kind = T::KIND;
    const LIST: Kind = T::LIST;

    fn of(node: &Node, v: &View<'_>) -> Option<Self> {
        Some(T::of(node, v))
    }

    fn absent(_: &View<'_>) -> Option<Self> {
        Some(None)
    }
}

impl<T: Value> Value for Vec<T> {
    const KIND: Kind = T::LIST;

    fn of(node: &Node, v: &View<'_>) -> Option<Self> {
        node.list()?.iter().enumerate().map(|(i, node)| T::of(node, &v.element(i))).collect()
    }

    fn absent(_: &View<'_>) -> Option<Self> {
        Some(Self::new())
    }
}

impl Value for BTreeMap<String, String> {
    const KIND: Kind = Kind::NamesByGroup;

    fn of(node: &Node, _: &View<'_>) -> Option<Self> {
        let entries = node.table()?.0.iter();
        entries.map(|entry| Some((entry.key.clone(), entry.node.text()?.to_owned()))).collect()
    }

    fn absent(_: &View<'_>) -> Option<Self> {
        Some(Self::new())
    }
}

impl<T: Value, const N: usize> Value for [T; N] {
    const KIND: Kind = T::LIST;

    fn of(node: &Node, v: &View<'_>) -> Option<Self> {
        Vec::of(node, v)?.try_into().ok()
    }
}

/// The field of a key whose value is read into another field.
impl Value for () {
    const KIND: Kind = Kind::Text;

    fn of(_: &Node, _: &View<'_>) -> Option<Self> {
        Some(())
    }

    fn absent(_: &View<'_>) -> Option<Self> {
        Some(())
    }
}

impl Value for f64 {
    const KIND: Kind = Kind::Number(ANY);

    fn of(node: &Node, _: &View<'_>) -> Option<Self> {
        node.number()
    }
}

impl Value for usize {
    const KIND: Kind = Kind::Count(0);
    const LIST: Kind = Kind::Counts(1);

    fn of(node: &Node, _: &View<'_>) -> Option<Self> {
        node.count()
    }
}

impl Value for bool {
    const KIND: Kind = Kind::Truth;

    fn of(node: &Node, _: &View<'_>) -> Option<Self> {
        node.flag()
    }
}

impl Value for String {
    const KIND: Kind = Kind::Text;
    const LIST: Kind = Kind::Sides;

    fn of(node: &Node, _: &View<'_>) -> Option<Self> {
        node.text().map(str::to_owned)
    }
}

/// The absolute path of a file, which is given relative to the folder of the document.
impl Value for PathBuf {
    const KIND: Kind = Kind::Text;

    fn of(node: &Node, v: &View<'_>) -> Option<Self> {
        let joined = v.folder.join(node.text()?);
        Some(std::path::absolute(&joined).unwrap_or(joined))
    }
}

/// A number, or a text as a formula.
impl Value for FormulaSpec {
    const KIND: Kind = Kind::Formula(super::IN_TIME);
    const LIST: Kind = Kind::Formulas(super::IN_TIME);

    fn of(node: &Node, _: &View<'_>) -> Option<Self> {
        let text = || node.text().map(|text| Self::Text(text.to_owned()));
        node.number().map(Self::Number).or_else(text)
    }
}

/// The enum variant that serde writes as this word.
pub(crate) fn word<T: DeserializeOwned>(word: &str) -> Option<T> {
    serde_json::from_value(serde_json::Value::String(word.to_owned())).ok()
}

/// Implements `Value` for enums of other crates by their words.
macro_rules! words {
    ($($name:ty: $words:expr;)*) => {$(
        impl Value for $name {
            const KIND: Kind = Kind::Choice(Words::plain($words));

            fn of(node: &Node, _: &View<'_>) -> Option<Self> {
                word(node.text()?)
            }
        }
    )*};
}

words! {
    Element: &["L2", "L3", "L4", "T3", "T6", "T10", "Q4", "Q9", "Tet4", "Tet10", "Tet20", "Hex8", "Hex27"];
    ForceRule: &["average-forces", "average-state"];
    Norm: &["max", "rms"];
    design::Kind: &["matched-step", "matched-cost"];
    Goal: &["energy", "force", "stress", "friction", "trajectory", "cost"];
}
