//! Kinds of schemes, built from the table of `carom-time`, where each scheme declares its
//! parameters next to its formula.

use std::ops::Bound;
use std::sync::LazyLock;

use carom_time::{KINDS, KindInfo, Parameter};

use super::Kind::{Choice, Number};
use super::{Key, Range, Table, Variants, key};

const FORCES: Key = key(
    "forces",
    Choice(&["average-forces", "average-state"], &[]),
    "What is averaged over the step with α_f: the forces (eq. 15), or the state at which they are evaluated.",
)
.default("\"average-forces\"");

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
        let key = key(parameter.key, Number(range), parameter.meaning);
        let example = parameter.example;
        if kind.sets.len() > 1 { key.optional(example) } else { key.example(example) }
    };
    let keys: Vec<Key> =
        kind.parameters().into_iter().map(number).chain(kind.is_alpha().then_some(FORCES)).collect();
    super::table(format!("scheme \"{}\"", kind.name).leak(), kind.summary, keys.leak())
}
