//! A scheme and its parameters, from the case or from the command line.

use std::cell::RefCell;

use super::SchemeSpec;
use super::conform;
use super::document::Document;
use super::keys::{self, View};
use super::problem::{CaseError, Diagnostic};
use super::spec::scheme;

/// A scheme by its kind and parameters `key=value`, as `carom explain` takes them.
pub fn read_scheme(kind: &str, parameters: &[String]) -> Result<SchemeSpec, CaseError> {
    let line = |parameter: &String| {
        let (key, value) =
            parameter.split_once('=').map_or((parameter.trim(), ""), |(k, v)| (k.trim(), v.trim()));
        // A word needs no quotes on the command line.
        let value = value.parse().unwrap_or_else(|_| toml_edit::Value::from(value));
        format!("{key} = {}", value.to_string().trim())
    };
    if let Some(parameter) = parameters.iter().find(|parameter| !parameter.contains('=')) {
        let what = format!("`{parameter}` is not a parameter");
        let why = "parameters are written KEY=VALUE";
        let help = "write for example rho_inf=0.1";
        return Err(CaseError::of_file("carom explain", what, why, help));
    }
    let kind_line = format!("kind = {}", toml_edit::Value::from(kind));
    let text = std::iter::once(kind_line).chain(parameters.iter().map(line)).collect::<Vec<_>>().join("\n");
    let read = || {
        let document = Document::parse("arguments", &text, &[])?;
        let problems = RefCell::new(conform::variant(document.root(), keys::schemes()));
        let view = View::of_keys(document.root(), &[], &problems).one_of(document.root(), keys::schemes());
        let spec = view.and_then(|view| scheme(&view));
        let problems = problems.take();
        spec.filter(|_| problems.is_empty()).ok_or_else(|| document.diagnose_all(&problems))
    };
    read().map_err(|error| match error {
        CaseError::Wrong(found) => {
            CaseError::Wrong(found.into_iter().map(|d| as_given(d, kind, parameters)).collect())
        }
        refused @ CaseError::Refused { .. } => refused,
    })
}

/// A diagnostic of a line `key = value`, placed in the words as they were given.
fn as_given(found: Diagnostic, kind: &str, parameters: &[String]) -> Diagnostic {
    let words: Vec<&str> = std::iter::once(kind).chain(parameters.iter().map(String::as_str)).collect();
    let Some((before, word)) = found.line.checked_sub(1).and_then(|i| Some((&words[..i], *words.get(i)?)))
    else {
        return found;
    };
    let (key, value) = word.split_once('=').map_or(("", word), |(key, value)| (key.trim_end(), value));
    let value = if key.is_empty() { word } else { value.trim() };
    let (start, marked) =
        if found.column == 1 && !key.is_empty() { (0, key) } else { (word.len() - value.len(), value) };
    let column = before.iter().map(|word| word.chars().count() + 1).sum::<usize>()
        + word.get(..start).unwrap_or_default().chars().count()
        + 1;
    let length = marked.chars().count().max(1);
    Diagnostic { line: 1, column, length, quoted: words.join(" "), ..found }
}
