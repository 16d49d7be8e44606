//! Checks a value against what its key may have: type, range, choice, formula.

use super::Check;
use crate::FormulaSpec;
use crate::document::joined;
use crate::keys::word as word_of;
use crate::keys::{self, Default, Key, Kind, Range};
use crate::problem::Problem;
use crate::suggest;
use crate::tree::{Node, Value};

impl Check {
    /// Adds all problems of a value, and of the tables in it.
    pub(super) fn value(&mut self, node: &Node, key: &Key, path: &str) {
        match (&key.kind, &node.value) {
            (Kind::Text | Kind::Side | Kind::SideOr(_), Value::Text(_))
            | (Kind::NumberOrFalse(_), Value::Flag(false))
            | (Kind::Changes, Value::Table(_))
            | (Kind::Truth, Value::Flag(_)) => {}
            (Kind::Name, Value::Text(name)) => self.name(name, key, path),
            (Kind::Choice(words), Value::Text(word)) => {
                let known = words.now.contains(&word.as_str());
                let now = if known { words.now.to_vec() } else { self.of_dimension(words.now) };
                if words.later.contains(&word.as_str()) {
                    self.planned(word, key, &now, path);
                } else {
                    self.choice(word, key, &now, path);
                }
            }
            (Kind::Choices(words), Value::List(list)) if !list.is_empty() => {
                self.each(list, path, |check, node, path| match node.text() {
                    Some(word) => check.choice(word, key, words, path),
                    None => check.wrong(node, key, path),
                });
            }
            (Kind::Number(range) | Kind::NumberOrFalse(range), Value::Integer(_) | Value::Float(_)) => {
                self.number(node, range, key, path);
            }
            (Kind::Count(least), Value::Integer(n)) => self.count(*n, *least, node, key, path),
            (Kind::Counts(least), Value::Integer(n)) if self.dimension == Some(1) => {
                self.count(*n, *least, node, key, path);
            }
            (Kind::Counts(least), Value::List(list))
                if self.dimension.map_or([2, 3].contains(&list.len()), |d| d == list.len()) =>
            {
                self.each(list, path, |check, node, path| match node.value {
                    Value::Integer(n) => check.count(n, *least, node, key, path),
                    _ => check.wrong(node, key, path),
                });
            }
            (Kind::Direction, Value::Text(word)) if ["x", "y", "z"].contains(&word.as_str()) => {}
            (Kind::Vector | Kind::Direction, Value::List(list)) if self.has_dimension(list.len()) => {
                self.numbers(list, &keys::ANY, key, path);
            }
            (Kind::Angular, Value::List(list)) if self.has_dimension(3) && list.len() == 3 => {
                self.numbers(list, &keys::ANY, key, path);
            }
            (Kind::Angular | Kind::Rotation(_), Value::Integer(_) | Value::Float(_))
                if self.dimension != Some(3) =>
            {
                self.number(node, &keys::ANY, key, path);
            }
            (Kind::Rotation(spec), Value::Table(table)) if self.has_dimension(3) => {
                self.table(table, spec, path);
            }
            (Kind::Numbers(range), Value::List(list))
                if !list.is_empty() || matches!(key.default, Default::Is("[]")) =>
            {
                self.numbers(list, range, key, path);
            }
            (Kind::Points(least), Value::List(list)) if list.len() >= *least => {
                self.each(list, path, |check, node, path| match &node.value {
                    Value::List(point) if point.len() == 2 => check.numbers(point, &keys::ANY, key, path),
                    _ => check.wrong(node, key, path),
                });
            }
            (Kind::ByColumn, Value::Table(table)) => {
                for entry in &table.0 {
                    self.formula(&entry.node, &["t"], key, &joined(path, &entry.key));
                }
            }
            (Kind::NamesByGroup, Value::Table(table)) if !table.0.is_empty() => {
                for entry in table.0.iter().filter(|entry| entry.node.text().is_none()) {
                    let had = entry.node.described();
                    let what =
                        format!("`{}` of `{}` must be a name in quotes, not {had}", entry.key, key.name);
                    let help = format!("write for example `{} = \"rubber\"`", entry.key);
                    self.add(&joined(path, &entry.key), what, key.meaning(), help);
                }
            }
            (Kind::Formula(variables), _) => self.formula(node, variables, key, path),
            (Kind::Formulas(variables) | Kind::FormulasOr(variables, _), Value::List(list))
                if self.has_dimension(list.len()) =>
            {
                self.each(list, path, |check, node, path| check.formula(node, variables, key, path));
            }
            (Kind::Between, Value::Text(word)) if word == "all" => {}
            (Kind::Sides | Kind::Between, Value::List(list)) if !list.is_empty() => {
                self.each(list, path, |check, node, path| match node.text() {
                    Some(_) => {}
                    None => check.wrong(node, key, path),
                });
            }
            (Kind::Table(spec) | Kind::SideOr(spec) | Kind::FormulasOr(_, spec), Value::Table(table)) => {
                self.table(table, spec, path);
            }
            (Kind::Tables(spec), Value::List(list))
                if !list.is_empty() || matches!(key.default, Default::Absent) =>
            {
                self.each(list, path, |check, node, path| match node.table() {
                    Some(table) => check.table(table, spec, path),
                    None => check.wrong(node, key, path),
                });
            }
            (Kind::ChangeLists, Value::List(list)) => {
                self.each(list, path, |check, node, path| {
                    check.value(node, &Key { kind: Kind::Changes, ..*key }, path);
                });
            }
            (Kind::Grid, Value::Table(table)) => {
                for (name, node) in table.flat() {
                    if node.list().is_none_or(<[Node]>::is_empty) {
                        let what = format!("`{name}` must be a list of values, not {}", node.described());
                        let help = format!("write for example `grid = {}`", key.example);
                        self.add(&format!("{path}.\"{name}\""), what, key.meaning(), help);
                    }
                }
            }
            (Kind::Variant(variants), Value::Table(table)) => {
                let variants = variants();
                let outside = self.dimension;
                self.dimension = variants.dimension.or(outside);
                self.variant(table, variants, path);
                self.dimension = outside;
            }
            _ => self.wrong(node, key, path),
        }
    }

    /// Checks every value of a list at its path.
    fn each(&mut self, list: &[Node], path: &str, mut check: impl FnMut(&mut Self, &Node, &str)) {
        for (i, node) in list.iter().enumerate() {
            check(self, node, &format!("{path}[{i}]"));
        }
    }

    /// Whether the dimension of the case is this one, or unknown.
    fn has_dimension(&self, dimension: usize) -> bool {
        self.dimension.is_none_or(|d| d == dimension)
    }

    /// The words without names of elements whose dimension is not that of the case.
    fn of_dimension<'w>(&self, words: &[&'w str]) -> Vec<&'w str> {
        let here = |word: &&&str| match (self.dimension, word_of::<carom_solid::Element>(word)) {
            (Some(dimension), Some(element)) => element.dimension() == dimension,
            _ => true,
        };
        words.iter().filter(here).copied().collect()
    }

    /// Reports a word that is planned for a later version; `now` are the words allowed today.
    fn planned(&mut self, word: &str, key: &Key, now: &[&str], path: &str) {
        let what = format!("`{} = \"{word}\"` is not supported yet", key.name);
        let why = format!("\"{word}\" is planned for a later version of Carom");
        self.add(path, what, why, format!("use one of: {}", suggest::list(now.iter().copied())));
    }

    /// Reports a word that is none of the words `now`.
    pub(super) fn choice(&mut self, word: &str, key: &Key, now: &[&str], path: &str) {
        if now.contains(&word) {
            return;
        }
        let what = format!("`{}` cannot be \"{word}\"", key.name);
        let mut why = key.meaning();
        let is_explained = matches!(key.kind, Kind::Choice(words) if !words.meanings.is_empty());
        if !is_explained && suggest::nearest(word, now.iter().copied()).is_some() {
            why = format!("{why} Allowed values: {}", suggest::list(now.iter().copied()));
        }
        self.add(path, what, why, suggest::help(word, now.iter().copied()));
    }

    fn name(&mut self, name: &str, key: &Key, path: &str) {
        let bad = |c: char| c.is_whitespace() || c.is_control() || "./\\,\"'[]".contains(c);
        if name.is_empty() || name.contains(bad) {
            let what = format!("{name:?} is not a valid name");
            let why = "names are part of the names of columns and sides (`name.side`), so they may not contain dots, blanks, slashes, commas, quotes or brackets";
            let good: String = name.chars().map(|c| if bad(c) { '_' } else { c }).collect();
            let good = if good.is_empty() { key.example.to_owned() } else { format!("\"{good}\"") };
            self.add(path, what, why.to_owned(), format!("write `{} = {good}`", key.name));
        }
    }

    fn number(&mut self, node: &Node, range: &Range, key: &Key, path: &str) {
        let Some(x) = node.number() else { return };
        if !x.is_finite() {
            let what = format!("`{}` is {x}", key.name);
            let why = format!("all numbers of a case must be finite. {}", key.meaning());
            self.add(path, what, why, format!("write {}", key.kind.described(self.dimension)));
        } else if !range.contains(x) {
            let is_list = matches!(key.kind, Kind::Numbers(_));
            let subject = if is_list { "every number of " } else { "" };
            let what = format!("{subject}`{}` must be {}, not {x}", key.name, range.described());
            let example =
                || format!("write for example `{} = {}`", key.name, self.names.example(key, self.dimension));
            // Zero or less of a positive number is a default that is not known, or an attempt to
            // switch something off.
            let is_off = x <= 0.0 && range.low == Some((0.0, false));
            let help = if is_list {
                example()
            } else if is_off && matches!(key.kind, Kind::NumberOrFalse(_)) {
                format!("`{} = false` switches it off; or {}", key.name, example())
            } else if is_off && matches!(key.default, keys::Default::Is(_)) {
                example()
            } else if x < 0.0 && range.contains(-x) {
                // A sign is easily lost, or of another convention.
                format!("did you mean `{} = {}`?", key.name, -x)
            } else if let Some(near) = range.value_next_to(x) {
                format!("write for example `{} = {near}`", key.name)
            } else {
                example()
            };
            self.add(path, what, key.meaning(), help);
        }
    }

    fn numbers(&mut self, list: &[Node], range: &Range, key: &Key, path: &str) {
        self.each(list, path, |check, node, path| match node.number() {
            Some(_) => check.number(node, range, key, path),
            None => check.wrong(node, key, path),
        });
    }

    fn formula(&mut self, node: &Node, variables: &'static [&'static str], key: &Key, path: &str) {
        match &node.value {
            Value::Integer(_) | Value::Float(_) => self.number(node, &keys::ANY, key, path),
            Value::Text(text) => {
                let variables = keys::variables(variables, self.dimension.unwrap_or(3));
                // Whether it is given is checked when the model is built.
                if FormulaSpec::Text(text.clone()).function().is_some() && may_be_given(path) {
                    return;
                }
                if let Err(error) = carom_formula::Formula::parse(text, &variables) {
                    // `there is no function …: did you mean …?`
                    let (wrong, help) = error.message.split_once(": ").map_or_else(
                        || {
                            let example = self.names.example(key, self.dimension);
                            (error.message.as_str(), format!("write for example `{} = {example}`", key.name))
                        },
                        |(wrong, help)| (wrong, help.to_owned()),
                    );
                    let what = format!("the formula of `{}`: {wrong}", key.name);
                    let why = format!("it is a formula in the variables {}", variables.join(", "));
                    self.found.problems.push(Problem::new(path, what, why, help).within(error.at));
                }
            }
            _ => self.wrong(node, key, path),
        }
    }

    fn count(&mut self, n: i64, least: usize, node: &Node, key: &Key, path: &str) {
        if usize::try_from(n).is_ok_and(|n| n >= least) {
            return;
        }
        let what = format!("`{}` must be a whole number ≥ {least}, not {}", key.name, node.described());
        let help = if n.checked_neg().and_then(|n| usize::try_from(n).ok()).is_some_and(|n| n >= least) {
            format!("did you mean {}?", -n)
        } else {
            format!("write for example `{} = {}`", key.name, self.names.example(key, self.dimension))
        };
        self.add(path, what, key.meaning(), help);
    }

    fn wrong(&mut self, node: &Node, key: &Key, path: &str) {
        let wanted = key.kind.described(self.dimension);
        let later =
            !key.later.is_empty() && matches!(node.value, Value::Table(_) | Value::Text(_) | Value::List(_));
        let mut what = format!("`{}` must be {wanted}, not {}", key.name, node.described());
        let mut why = key.meaning();
        if later {
            why = format!("{why} A later version of Carom will also accept {}", key.later);
        }
        if matches!(key.kind, Kind::Tables(_)) && matches!(node.value, Value::Table(_)) {
            what = format!("`{}` must be a list of tables, not a single table", key.name);
        }
        let help = match key.kind {
            Kind::Variant(variants)
                if let Some(word) = node.text().filter(|word| variants().table(word).is_some()) =>
            {
                let table = variants().table(word).map_or(&[][..], |table| table.keys);
                let required = table.iter().filter(|key| matches!(key.default, Default::Required));
                let required = required.map(|key| format!(", {} = {}", key.name, key.example));
                let required: String = required.collect();
                format!("write `{} = {{ {} = \"{word}\"{required} }}`", key.name, variants().tag)
            }
            Kind::Sides if let Some(side) = node.text().filter(|text| text.contains('.')) => {
                format!("write `{} = [\"{side}\"]`", key.name)
            }
            Kind::Tables(table) if key.example.is_empty() => {
                format!("write its header in double brackets: {}", table.name)
            }
            Kind::Number(_) | Kind::NumberOrFalse(_)
                if let Some(advice) =
                    node.text().and_then(|text| self.labels.advice(key.name, Some(key.unit), text)) =>
            {
                advice
            }
            Kind::Vector if self.dimension == Some(1) => {
                format!("write one number in brackets, for example `{} = [0.0]`", key.name)
            }
            _ => format!("write for example `{} = {}`", key.name, self.names.example(key, self.dimension)),
        };
        self.add(path, what, why, help);
    }
}

/// Whether the value at this path may be a function of a program: a load or the motion of a
/// support.
fn may_be_given(path: &str) -> bool {
    path.starts_with("load[") || (path.starts_with("support[") && path.contains("].move."))
}
