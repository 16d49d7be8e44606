//! `--set key=value`: replaces one value of the case before it is read. Keys are dotted paths; a
//! table of a list is addressed by its name (`body.cylinder.element=T6`). Values are TOML; a bare
//! word that is not TOML is a string.

use super::example::Names;
use super::problem::Diagnostic;
use super::suggest;
use super::tree::{self, Node, Origin, Value};

/// Applies the override `set`, which is source number `source` of the document.
pub(super) fn apply(root: &mut Node, set: &str, source: usize) -> Result<(), Box<Diagnostic>> {
    let wrong = |span: std::ops::Range<usize>, what: String, why: String, help: String| {
        Box::new(Diagnostic::at("--set", set, span, [what, why, help]))
    };
    let example = root.table().map_or_else(String::new, |case| Names::of(case).override_example());
    let Some((key, value)) = set.split_once('=') else {
        let why = "an override has the form key=value".to_owned();
        return Err(wrong(0..set.len(), "there is no `=`".to_owned(), why, example));
    };
    let keys = toml_edit::Key::parse(key).map_err(|e| {
        wrong(
            0..key.len(),
            "this is not a valid key".to_owned(),
            e.message().trim().replace('\n', "; "),
            example.clone(),
        )
    })?;
    let new = value_of(value, key.len() + 1, set, source)?;
    let here = Origin { source, span: 0..key.len() };

    let mut node = root;
    for (depth, key) in keys.iter().enumerate() {
        let key = key.get();
        let described = node.described();
        node = match &mut node.value {
            Value::Table(table) => table.given(key, &here, depth + 1 == keys.len()),
            Value::List(list) => {
                let names: Vec<String> =
                    list.iter().filter_map(|n| Some(n.table()?.get("name")?.text()?.to_owned())).collect();
                let found =
                    list.iter_mut().find(|n| n.table().and_then(|t| t.get("name")?.text()) == Some(key));
                found.ok_or_else(|| {
                    let list = keys[..depth].iter().map(toml_edit::Key::get).collect::<Vec<_>>().join(".");
                    if names.is_empty() {
                        let why = format!("no table of `{list}` has a `name`");
                        let help = format!(
                            "give the one that is meant name = \"{key}\" in the file, or replace the list as a whole: --set {list}=[…]"
                        );
                        return wrong(here.span.clone(), format!("no `{list}` is named `{key}`"), why, help);
                    }
                    let why = format!("the names are: {}", names.join(", "));
                    let help = suggest::nearest(key, names.iter().map(String::as_str)).map_or_else(
                        || "use one of them".to_owned(),
                        |name| format!("did you mean `{list}.{name}`?"),
                    );
                    wrong(here.span.clone(), format!("no `{list}` is named `{key}`"), why, help)
                })?
            }
            _ => {
                let before = keys[..depth].iter().map(toml_edit::Key::get).collect::<Vec<_>>().join(".");
                let why = format!("`{before}` is {described}");
                let help = format!("replace it as a whole: --set {before}=…");
                return Err(wrong(here.span, format!("`{before}` has no key `{key}`"), why, help));
            }
        };
    }
    *node = new;
    Ok(())
}

/// The value of an override, its spans counted from the start of `set`.
fn value_of(value: &str, start: usize, set: &str, source: usize) -> Result<Node, Box<Diagnostic>> {
    let span = start..set.len();
    let line = format!("v={value}\n");
    let shift = 2 - start as isize;
    match toml_edit::Document::parse(line.as_str()) {
        Ok(parsed) => match parsed.get("v") {
            Some(item) if parsed.len() == 1 => Ok(tree::node(item, source, shift, &span)),
            _ => Err(Box::new(Diagnostic::at("--set", set, span, several()))),
        },
        Err(error) if value.trim_start().starts_with(['{', '[', '"', '\'']) => {
            let mut found = Diagnostic::of_syntax("--set", &line, &error);
            set.clone_into(&mut found.quoted);
            found.column = (found.column as isize - shift).max(1) as usize;
            Err(Box::new(found))
        }
        Err(_) => {
            let value = Value::Text(value.trim().to_owned());
            Ok(Node { value, is_inline: false, origin: Origin { source, span } })
        }
    }
}

fn several() -> [String; 3] {
    [
        "this is more than one value".to_owned(),
        "an override sets one key".to_owned(),
        "repeat --set for each key".to_owned(),
    ]
}
