//! Kinds of schemes, built from the table of `carom-time`, where each scheme declares its
//! parameters next to its formula.

use std::ops::Bound;
use std::sync::LazyLock;

use carom_time::{KINDS, KindInfo, Parameter};

use super::Kind::{Choice, Number};
use super::{Default, Key, Range, Table, Variants, Words};

const FORCES: Key = Key {
    name: "forces",
    kind: Choice(Words::plain(&["average-forces", "average-state"])),
    doc: "What is averaged over the step with α_f: the forces (eq. 15), or the state at which they are evaluated.",
    default: Default::Is("\"average-forces\""),
    example: "\"average-forces\"",
    ..Key::NONE
};

/// Time integrators.
pub fn schemes() -> &'static Variants {
    // Built once per process, so it may be leaked.
    static SCHEMES: LazyLock<Variants> = LazyLock::new(|| Variants {
        name: "scheme",
        tag: "kind",
        doc: "Published name of the integrator.",
        tables: KINDS.iter().map(|kind| (kind.name, table(kind))).collect::<Vec<_>>().leak(),
        or: None,
        dimension: None,
    });
    &SCHEMES
}

fn table(kind: &KindInfo) -> Table {
    let number = |parameter: &Parameter| {
        let end = |bound| match bound {
            Bound::Included(x) => Some((x, true)),
            Bound::Excluded(x) => Some((x, false)),
            Bound::Unbounded => None,
        };
        let range = Range { low: end(parameter.range.0), high: end(parameter.range.1) };
        let default = if kind.sets.len() > 1 { Default::Absent } else { Default::Required };
        let Parameter { key: name, meaning: doc, example, .. } = *parameter;
        Key { name, kind: Number(range), doc, default, example, ..Key::NONE }
    };
    let keys: Vec<Key> =
        kind.parameters().into_iter().map(number).chain(kind.is_alpha().then_some(FORCES)).collect();
    Table {
        name: format!("scheme \"{}\"", kind.name).leak(),
        doc: kind.summary,
        keys: keys.leak(),
        later: &[],
        dimension: None,
    }
}
