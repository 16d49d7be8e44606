//! Keys of a file in words, for `carom explain KEY`, from the tables that the reader and the schema
//! use.

use std::fmt;

use serde::Serialize;

use crate::draft::Draft;
use crate::keys::{Default, Key, Keys, Kind, Table};
use crate::suggest;

/// Width of lines of text.
const WIDTH: usize = 96;

/// A key of a file: its meaning, values, default and example.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExplainedKey {
    /// Names of the tables and of the key, joined by dots: `contact.enforcement`.
    pub key: String,
    /// Tables that have this key: `[[contact]]`, `scheme "hht"`.
    pub tables: Vec<&'static str>,
    /// Meaning.
    pub meaning: &'static str,
    /// Admissible values, in words.
    pub values: String,
    /// Words that are admissible values, with their meanings.
    pub words: Vec<Described>,
    /// Keys of the table that is the value, with their meanings.
    pub keys: Vec<Described>,
    /// Physical unit; empty if none.
    pub unit: &'static str,
    /// Whether the key must be given.
    pub required: bool,
    /// Default value as TOML; none if there is no default or a computed one.
    pub default: Option<&'static str>,
    /// Default value as TOML with `preset = "paper"`, where it differs.
    pub paper: Option<&'static str>,
    /// Example value as TOML; may be empty.
    pub example: &'static str,
    /// Key that replaces this one: only one of them may be given; empty if none.
    pub unless: &'static str,
    /// Dimension of the cases that may have the table; none if all may.
    pub dimension: Option<usize>,
    /// Values planned for later versions.
    pub later: Vec<&'static str>,
}

/// A word or key with its meaning.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Described {
    /// The word or key, as in files.
    pub name: &'static str,
    /// Meaning; empty if the key explains the word.
    pub meaning: &'static str,
}

/// Keys of a case file, and of files with the keys of more tables, by a path such as
/// `newton.tolerance`, or by its last names alone, in any table. Tables that say the same of a key
/// are given together. Or a word such as `hencky`, by the keys of which it is a value, with its
/// meaning alone. Empty if there is neither.
pub fn explained(path: &str, more: &[&'static Table]) -> Vec<ExplainedKey> {
    let all = every_key(more);
    let parts: Vec<&str> = path.split('.').collect();
    let at_path = |key: &&ExplainedKey| is_at(&key.key, &parts);
    let end = format!(".{path}");
    let by_name = |key: &&ExplainedKey| key.key.ends_with(&end);
    let mut found: Vec<_> = all.iter().filter(at_path).collect();
    if found.is_empty() {
        found = all.iter().filter(by_name).collect();
    }
    let of_word: Vec<ExplainedKey> = all.iter().filter_map(|key| key.of_word(path)).collect();
    if found.is_empty() {
        found = of_word.iter().collect();
    }
    let mut merged: Vec<ExplainedKey> = Vec::new();
    for key in found {
        let same = |known: &&mut ExplainedKey| {
            let tables = known.tables.clone();
            **known == ExplainedKey { tables, ..key.clone() }
        };
        if let Some(known) = merged.iter_mut().find(same) {
            let other = key.tables.iter().filter(|&name| !known.tables.contains(name));
            let other: Vec<_> = other.copied().collect();
            known.tables.extend(other);
        } else {
            merged.push(key.clone());
        }
    }
    merged
}

/// Meaning of a misspelt path of [`explained`], or of one of these words: `did you mean …?`, or
/// where all keys are listed.
pub fn similar_key(path: &str, more: &[&'static Table], words: &[&str]) -> String {
    let all = every_key(more);
    let keys = || all.iter().map(|key| key.key.as_str());
    let beside = path.rsplit_once('.').and_then(|(table, name)| {
        let of_table = |key: &&str| key.rsplit_once('.').is_some_and(|(other, _)| other == table);
        let near = suggest::nearest(name, keys().filter(of_table).map(last_name))?;
        Some(format!("{table}.{near}"))
    });
    let names = keys().map(last_name).filter(|_| !path.contains('.'));
    let near = suggest::nearest(path, keys().chain(words.iter().copied()));
    let near = near.or_else(|| suggest::nearest(path, names)).map(str::to_owned);
    beside.or(near).map_or_else(
        || "`carom explain` lists the schemes, and `carom schema` all keys".to_owned(),
        |name| format!("did you mean `{name}`?"),
    )
}

fn last_name(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// Whether names lead to a key. Between a list of tables and a key of theirs there may be the name
/// of one of them: `contact.strike.enforcement`.
fn is_at(key: &str, parts: &[&str]) -> bool {
    let names: Vec<&str> = key.split('.').collect();
    let is_named = parts.len() == names.len() + 1 && names.len() > 1;
    names == parts || is_named && names[0] == parts[0] && names[1..] == parts[2..]
}

/// All keys of a case and of more tables, and of the tables below them.
fn every_key(more: &[&'static Table]) -> Vec<ExplainedKey> {
    let mut all = Vec::new();
    add_keys(&Draft::TABLE, "", &mut all);
    more.iter().for_each(|table| add_keys(table, "", &mut all));
    all
}

/// Adds the keys of a table; `before` is the path to it.
fn add_keys(table: &'static Table, before: &str, all: &mut Vec<ExplainedKey>) {
    for key in table.keys {
        let path = format!("{before}{}", key.name);
        all.push(ExplainedKey::of(&path, key, table));
        if let Kind::Variant(variants) = key.kind {
            let variants = variants();
            let tag = Key { name: variants.tag, doc: variants.doc, ..Key::NONE };
            let words: Vec<_> =
                variants.tables.iter().map(|(name, table)| Described { name, meaning: table.doc }).collect();
            let names: Vec<_> = words.iter().map(|word| word.name).collect();
            all.push(ExplainedKey {
                tables: vec![variants.name],
                values: format!("one of {}", names.join(", ")),
                words,
                ..ExplainedKey::of(&format!("{path}.{}", tag.name), &tag, table)
            });
        }
        for below in tables(&key.kind) {
            add_keys(below, &format!("{path}."), all);
        }
    }
}

/// The tables that a value of this kind may be.
fn tables(kind: &Kind) -> Vec<&'static Table> {
    match kind {
        Kind::Table(table)
        | Kind::Tables(table)
        | Kind::SideOr(table)
        | Kind::FormulasOr(_, table)
        | Kind::Rotation(table) => vec![table],
        Kind::Variant(variants) => {
            let variants = variants();
            variants.tables.iter().map(|(_, table)| table).chain(variants.or).collect()
        }
        _ => Vec::new(),
    }
}

impl ExplainedKey {
    /// The key with one of its words alone; none if the word is no value of it.
    fn of_word(&self, word: &str) -> Option<Self> {
        let words: Vec<Described> = self.words.iter().filter(|known| known.name == word).copied().collect();
        (!words.is_empty()).then(|| Self { words, ..self.clone() })
    }

    fn of(path: &str, key: &Key, table: &'static Table) -> Self {
        let mut later = Vec::new();
        let mut words = Vec::new();
        if let Kind::Choice(choice) = key.kind {
            later.extend(choice.later);
            let meanings = choice.meanings.iter().copied().chain(std::iter::repeat(""));
            words.extend(choice.now.iter().zip(meanings).map(|(&name, meaning)| Described { name, meaning }));
        }
        if let Kind::Choices(choices) = key.kind {
            words.extend(choices.iter().map(|&name| Described { name, meaning: "" }));
        }
        later.extend(Some(key.later).filter(|later| !later.is_empty()));
        let keys = match key.kind {
            Kind::Table(table) | Kind::Tables(table) | Kind::SideOr(table) => table.keys,
            _ => &[],
        };
        Self {
            key: path.to_owned(),
            tables: vec![table.name],
            meaning: key.doc,
            values: key.kind.described(table.dimension),
            words,
            keys: keys
                .iter()
                .map(|key| Described { name: key.name, meaning: first_sentence(key.doc) })
                .collect(),
            unit: key.unit,
            required: matches!(key.default, Default::Required),
            default: if let Default::Is(toml) = key.default { Some(toml) } else { None },
            paper: key.paper,
            example: key.example,
            unless: key.unless,
            dimension: table.dimension,
            later,
        }
    }
}

fn first_sentence(text: &str) -> &str {
    text.split_inclusive(". ").next().unwrap_or(text).trim_end()
}

impl fmt::Display for ExplainedKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}   in {}", self.key, self.tables.join(", "))?;
        writeln!(f, "{}", wrapped(self.meaning, "  "))?;
        let mut facts = Vec::new();
        let meanings: Vec<_> = self.words.iter().filter(|word| !word.meaning.is_empty()).collect();
        facts.push((
            "values",
            if meanings.is_empty() { self.values.clone() } else { "one of the following words".to_owned() },
        ));
        facts.push(("unit", self.unit.to_owned()));
        let default = self.default.map(str::to_owned);
        let without = if !self.required {
            "none, or as the text says"
        } else if self.unless.is_empty() {
            "none: the key is required"
        } else {
            "none: the key is required unless another one replaces it"
        };
        facts.push(("default", default.unwrap_or_else(|| without.to_owned())));
        facts.push(("with preset = \"paper\"", self.paper.unwrap_or_default().to_owned()));
        let name = last_name(&self.key);
        let example =
            if self.example.is_empty() { String::new() } else { format!("{name} = {}", self.example) };
        facts.push(("example", example));
        facts.push(("not with", self.unless.to_owned()));
        facts.push(("dimension", self.dimension.map_or_else(String::new, |n| n.to_string())));
        facts.push(("planned", self.later.join(", ")));
        for (name, fact) in facts.iter().filter(|(_, fact)| !fact.is_empty()) {
            writeln!(f, "\n{name}\n{}", wrapped(fact, "  "))?;
            if *name == "values" {
                list(f, meanings.iter().copied())?;
            }
        }
        if !self.keys.is_empty() {
            writeln!(f, "\nkeys")?;
            list(f, self.keys.iter())?;
        }
        Ok(())
    }
}

/// Names, each with its meaning on the lines below.
fn list<'a>(f: &mut fmt::Formatter<'_>, named: impl Iterator<Item = &'a Described>) -> fmt::Result {
    for Described { name, meaning } in named {
        writeln!(f, "  {name}\n{}", wrapped(meaning, "      "))?;
    }
    Ok(())
}

/// A text in lines that begin with blanks.
fn wrapped(text: &str, blanks: &str) -> String {
    let mut lines = Vec::new();
    let mut line = blanks.to_owned();
    for word in text.split_whitespace() {
        let is_begun = line.len() > blanks.len();
        if is_begun && line.chars().count() + word.chars().count() >= WIDTH {
            lines.push(std::mem::replace(&mut line, blanks.to_owned()));
        } else if is_begun {
            line.push(' ');
        }
        line.push_str(word);
    }
    lines.push(line);
    lines.join("\n")
}
