//! Checks the keys of every table of a document against the tables of keys: unknown, missing, given
//! with another that replaces it. Their values: `conform/value.rs`.

use super::document::{Document, joined};
use super::example::Names;
use super::keys::{self, Default, Key, Kind, Variants};
use super::problem::Problem;
use super::suggest;
use super::tree::{Node, Table};
use super::unit::Labels;

mod value;

/// Problems of the keys and values of a document, each compared with its description.
#[derive(Default)]
pub(super) struct Conformity {
    pub(super) problems: Vec<Problem>,
    /// Paths of the tables that have an unknown key, perhaps a misspelt one.
    pub(super) misspelt: Vec<String>,
}

/// Compares a document with the keys of its tables.
pub(super) fn file(document: &Document, root: &'static keys::Table) -> Conformity {
    let dimension = document.root().get("dimension").and_then(Node::count).filter(|d| (1..=3).contains(d));
    let mut check = Check {
        dimension,
        names: Names::of(document.root()),
        labels: Labels::of(document.root()),
        root: Some(root),
        found: Conformity::default(),
    };
    check.table(document.root(), root, "");
    check.found
}

/// Compares a single table with the descriptions of its variants, without a document around it.
pub(super) fn variant(table: &Table, variants: &Variants) -> Vec<Problem> {
    let mut check = Check::default();
    check.variant(table, variants, "");
    check.found.problems
}

#[derive(Default)]
struct Check {
    dimension: Option<usize>,
    names: Names,
    labels: Labels,
    /// Description of the whole file, in which an unknown key of one table may belong to another.
    root: Option<&'static keys::Table>,
    found: Conformity,
}

/// The keys a table may have.
struct Spec<'a> {
    name: &'a str,
    tag: Option<&'a str>,
    keys: Vec<&'a Key>,
    later: &'a [&'a str],
}

impl<'a> Spec<'a> {
    /// Keys of a table as described; `tag` is the key whose value selected the table, if one did.
    fn of(table: &'a keys::Table, tag: Option<&'a str>) -> Self {
        Self { name: table.name, tag, keys: table.keys.iter().collect(), later: table.later }
    }
}

impl Check {
    fn add(&mut self, path: &str, what: String, why: String, help: String) {
        self.found.problems.push(Problem::new(path, what, why, help));
    }

    fn keys(&mut self, table: &Table, spec: &Spec, path: &str) {
        let mut meant = Vec::new();
        for entry in &table.0 {
            let here = joined(path, &entry.key);
            if let Some(key) = spec.keys.iter().find(|k| k.name == entry.key) {
                self.value(&entry.node, key, &here);
            } else if spec.later.contains(&entry.key.as_str()) {
                let what = format!("`{}` is not supported yet", entry.key);
                let why = format!("`{}` of {} is planned for a later version of Carom", entry.key, spec.name);
                self.found.problems.push(Problem::new(here, what, why, "leave it out").at_key());
            } else if spec.tag != Some(entry.key.as_str()) {
                let (problem, near) = self.unknown(&entry.key, table, spec, here);
                self.found.problems.push(problem);
                meant.extend(near);
                self.found.misspelt.push(path.to_owned());
            }
        }
        let required = spec.keys.iter().copied().filter(|k| matches!(k.default, Default::Required));
        let missing: Vec<_> =
            required.filter(|k| table.get(k.name).is_none() && !meant.contains(&k.name)).collect();
        let replaced =
            |k: &Key| !k.unless.is_empty() && (table.get(k.unless).is_some() || meant.contains(&k.unless));
        for key in spec.keys.iter().filter(|k| replaced(k) && table.get(k.name).is_some()) {
            let what = format!("`{}` is given with `{}`", key.name, key.unless);
            let why = format!("`{}` takes its place", key.unless);
            self.found
                .problems
                .push(Problem::new(joined(path, key.name), what, why, "leave one of them out").at_key());
        }
        let missing: Vec<_> = missing.into_iter().filter(|k| !replaced(k)).collect();
        if spec.tag.is_some() && missing.len() > 1 {
            self.missing_together(&missing, spec, path);
        } else {
            missing.iter().for_each(|key| self.missing(key.name, key, spec.name, path));
        }
    }

    /// Reports missing parameters of one scheme or shape together, as one problem.
    fn missing_together(&mut self, keys: &[&Key], spec: &Spec, path: &str) {
        let names: Vec<_> = keys.iter().map(|key| format!("`{}`", key.name)).collect();
        let meanings: Vec<_> = keys.iter().map(|key| format!("{}: {}", key.name, key.meaning())).collect();
        let examples: Vec<_> = keys
            .iter()
            .map(|key| format!("`{} = {}`", key.name, self.names.example(key, self.dimension)))
            .collect();
        let what = format!("{} has no {}", spec.name, and(&names));
        let help = format!("add for example {}", and(&examples));
        let why = format!("they are required. {}", meanings.join(" "));
        self.found.problems.push(Problem::new(path, what, why, help).at_key());
    }

    fn missing(&mut self, name: &str, key: &Key, table: &str, path: &str) {
        let help = match key.kind {
            Kind::Tables(table) => format!("add a table {}", table.name),
            Kind::Table(table) if path.is_empty() => format!("add a table {}", table.name),
            _ => format!("add `{name} = {}`", self.names.example(key, self.dimension)),
        };
        let help = if key.example.is_empty() { help } else { format!("{help}, for example") };
        let what = format!("{table} needs `{name}`");
        let why = format!("`{name}` is required. {}", key.meaning());
        self.found
            .problems
            .push(Problem::new(path, what, why, help.trim_end_matches(", for example")).at_key());
    }

    fn table(&mut self, table: &Table, spec: &keys::Table, path: &str) {
        self.keys(table, &Spec::of(spec, None), path);
    }

    fn variant(&mut self, table: &Table, variants: &Variants, path: &str) {
        let tag = variants.tag;
        if let Some(spec) =
            variants.or.filter(|spec| spec.keys.iter().take(1).any(|k| table.get(k.name).is_some()))
        {
            return self.table(table, spec, path);
        }
        let named = table.get(tag).map(|node| node.text().ok_or(node));
        if let Some(Ok(word)) = named
            && let Some(spec) = variants.table(word)
        {
            if let (Some(needs), Some(dimension)) = (spec.dimension, self.dimension)
                && needs != dimension
            {
                let fits = |(_, table): &&(&str, keys::Table)| table.dimension == Some(dimension);
                let other = variants.tables.iter().find(fits).map_or("", |(word, _)| word);
                let what = format!("the {tag} \"{word}\" has dimension {needs}");
                let why = format!("the case has dimension = {dimension}");
                let help = format!("use for example {tag} = \"{other}\"");
                return self.add(&joined(path, tag), what, why, help);
            }
            return self.keys(table, &Spec::of(spec, Some(tag)), path);
        }
        let or = variants.or.filter(|_| named.is_none());
        // The tag is missing or wrong: any key of any variant is known, none is required.
        let before = self.found.problems.len();
        let keys = variants.tables.iter().map(|(_, t)| t).chain(or).flat_map(|t| t.keys).collect();
        let spec = Spec { name: variants.name, tag: Some(tag), keys, later: &[] };
        for entry in table.0.iter().filter(|e| e.key != tag && !spec.keys.iter().any(|k| k.name == e.key)) {
            let (problem, _) = self.unknown(&entry.key, table, &spec, joined(path, &entry.key));
            self.found.problems.push(problem);
        }
        let here = joined(path, tag);
        match named {
            Some(Ok(word)) => {
                let now: Vec<_> = variants.tables.iter().map(|(word, _)| *word).collect();
                let key = Key { name: tag, doc: variants.doc, ..Key::NONE };
                self.choice(word, &key, &now, &here);
            }
            Some(Err(node)) => {
                let what = format!("`{tag}` must be a string in quotes, not {}", node.described());
                self.add(&here, what, variants.doc.to_owned(), format!("use one of: {}", words(variants)));
            }
            None if self.found.problems[before..]
                .iter()
                .any(|p| meant(p, tag) || or.is_some_and(|t| meant(p, t.keys[0].name))) => {}
            None => {
                let what = format!("{} has no `{tag}`", variants.name);
                let or = or
                    .and_then(|t| t.keys.first())
                    .map_or_else(String::new, |k| format!("; or give `{}`", k.name));
                let help = format!("use one of: {}{or}", words(variants));
                self.found.problems.push(Problem::new(path, what, variants.doc, help));
            }
        }
    }
}

impl Check {
    /// The problem of an unknown key, and the key of its table that was probably meant.
    fn unknown<'a>(
        &self,
        word: &str,
        table: &Table,
        spec: &Spec<'a>,
        path: String,
    ) -> (Problem, Option<&'a str>) {
        let all = || spec.tag.into_iter().chain(spec.keys.iter().map(|k| k.name));
        // A key that is present already is not a likely suggestion, unless it may occur several
        // times.
        let several =
            |name: &str| spec.keys.iter().any(|k| k.name == name && matches!(k.kind, Kind::Tables(_)));
        let free = all().filter(|k| table.get(k).is_none() || several(k)).chain(spec.later.iter().copied());
        let mut homes = self.root.map_or_else(Vec::new, |root| homes(root, word));
        homes.dedup();
        let near = suggest::nearest(word, free)
            .or_else(|| suggest::nearest(word, all()).filter(|_| homes.is_empty()));
        let is_of_case = homes.first().is_some_and(|home| *home == "the case");
        let above = if is_of_case { "; keys of the case stand above its first [table]" } else { "" };
        let elsewhere = format!("`{word}` is a key of {}{above}", homes.join(", "));
        let help = match (near, homes.is_empty()) {
            (Some(near), true) => format!("did you mean `{near}`?"),
            (Some(near), false) => format!("did you mean `{near}`? ({elsewhere})"),
            (None, false) => elsewhere,
            (None, true) => "leave it out, or list all keys with `carom schema`".to_owned(),
        };
        let mut keys: Vec<_> = all().collect();
        let mut seen = std::collections::HashSet::new();
        keys.retain(|k| seen.insert(*k));
        let why = format!("the keys of {} are: {}", spec.name, keys.join(", "));
        (Problem::new(path, format!("unknown key `{word}` in {}", spec.name), why, help).at_key(), near)
    }
}

/// Whether the remedy of a problem names this key.
fn meant(problem: &Problem, key: &str) -> bool {
    problem.help.contains(&format!("`{key}`"))
}

/// Joins words as in `a, b and c`.
fn and(words: &[String]) -> String {
    match words.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        _ => words.concat(),
    }
}

fn words(variants: &Variants) -> String {
    suggest::list(variants.tables.iter().map(|(word, _)| *word))
}

/// Names of the tables, in `root` and below, that have this key.
fn homes(root: &'static keys::Table, word: &str) -> Vec<&'static str> {
    fn visit(table: &'static keys::Table, word: &str, found: &mut Vec<&'static str>) {
        if table.key(word).is_some() {
            found.push(table.name);
        }
        for key in table.keys {
            match key.kind {
                Kind::Table(table) | Kind::Tables(table) | Kind::SideOr(table) | Kind::Rotation(table) => {
                    visit(table, word, found);
                }
                Kind::Variant(variants) if variants().tag == word => found.push(variants().name),
                Kind::Variant(variants) => {
                    let variants = variants();
                    let all = variants.tables.iter().map(|(_, t)| t).chain(variants.or);
                    found.extend(all.filter(|t| t.key(word).is_some()).map(|t| t.name));
                }
                _ => {}
            }
        }
    }
    let mut found = Vec::new();
    visit(root, word, &mut found);
    found
}
