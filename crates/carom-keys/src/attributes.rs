//! Reads the attributes `keys` and `key`, and the doc comments, of a type that derives `Keys`.

use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Attribute, Expr, ExprLit, Ident, Lit, Meta, Path, Token};

/// An entry `name = value` of an attribute, or a value alone.
struct Entry {
    name: Option<Ident>,
    value: Expr,
}

impl Parse for Entry {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        if input.peek(Ident) && input.peek2(Token![=]) {
            let name = input.parse()?;
            input.parse::<Token![=]>()?;
            return Ok(Self { name: Some(name), value: input.parse()? });
        }
        Ok(Self { name: None, value: input.parse()? })
    }
}

/// The entries of all attributes of this name; none without such an attribute.
fn entries(attributes: &[Attribute], name: &str) -> syn::Result<Option<Vec<Entry>>> {
    let mut found = None;
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident(name)) {
        let entries = attribute.parse_args_with(Punctuated::<Entry, Token![,]>::parse_terminated)?;
        found.get_or_insert_with(Vec::new).extend(entries);
    }
    Ok(found)
}

/// The attributes of a struct, enum or variant that describes a table.
#[derive(Default)]
pub(crate) struct Container {
    pub(crate) doc: String,
    /// Name in messages.
    pub(crate) name: String,
    /// Dimension of the cases that may have the table.
    pub(crate) dimension: Option<Expr>,
    /// Planned keys.
    pub(crate) later: Vec<Expr>,
    /// The key whose value selects the table, and its meaning.
    pub(crate) tag: String,
    pub(crate) tag_doc: String,
    /// Whether a table is read even where some of its keys cannot be.
    pub(crate) lenient: bool,
    /// Whether a variant has no tag.
    pub(crate) untagged: bool,
}

impl Container {
    pub(crate) fn of(attributes: &[Attribute]) -> syn::Result<Self> {
        let mut container = Self { doc: doc(attributes), ..Self::default() };
        for Entry { name, value } in entries(attributes, "keys")?.unwrap_or_default() {
            match (name.map(|name| name.to_string()).as_deref(), value) {
                (Some("name"), value) => container.name = text(&value)?,
                (Some("tag"), value) => container.tag = text(&value)?,
                (Some("tag_doc"), value) => container.tag_doc = text(&value)?,
                (Some("dimension"), value) => container.dimension = Some(value),
                (Some("later"), Expr::Array(list)) => container.later = list.elems.into_iter().collect(),
                (None, Expr::Path(path)) if path.path.is_ident("untagged") => container.untagged = true,
                (None, Expr::Path(path)) if path.path.is_ident("lenient") => container.lenient = true,
                (_, value) => return Err(syn::Error::new_spanned(value, "no such entry of `keys`")),
            }
        }
        Ok(container)
    }
}

/// The attributes of a field that is a key.
#[derive(Default)]
pub(crate) struct Key {
    pub(crate) doc: String,
    pub(crate) kind: Option<Expr>,
    pub(crate) name: Option<String>,
    /// Entries copied into the description of the key, as TOML or words.
    pub(crate) described: Vec<(Ident, Expr)>,
    pub(crate) default: Option<Expr>,
    pub(crate) paper: Option<Expr>,
    pub(crate) optional: Option<Expr>,
    pub(crate) with: Option<Path>,
    pub(crate) flatten: bool,
    /// Whether the field states only whether the key is given.
    pub(crate) given: bool,
    /// Whether the key must be given, though the type of the field has a default.
    pub(crate) required: bool,
}

impl Key {
    /// Reads the attributes `key` of a field; none if it has none.
    pub(crate) fn of(attributes: &[Attribute]) -> syn::Result<Option<Self>> {
        let Some(entries) = entries(attributes, "key")? else { return Ok(None) };
        let mut key = Self { doc: doc(attributes), ..Self::default() };
        for Entry { name, value } in entries {
            match (name, value) {
                (None, Expr::Path(path)) if path.path.is_ident("flatten") => key.flatten = true,
                (None, Expr::Path(path)) if path.path.is_ident("given") => key.given = true,
                (None, Expr::Path(path)) if path.path.is_ident("required") => key.required = true,
                (None, value) => key.kind = Some(value),
                (Some(name), Expr::Path(path)) if name == "with" => key.with = Some(path.path),
                (Some(name), value) if name == "name" => key.name = Some(text(&value)?),
                (Some(name), value) if name == "default" => key.default = Some(value),
                (Some(name), value) if name == "paper" => key.paper = Some(value),
                (Some(name), value) if name == "optional" => key.optional = Some(value),
                (Some(name), value) => key.described.push((name, value)),
            }
        }
        Ok(Some(key))
    }
}

/// Text of the doc comment, as one line.
pub(crate) fn doc(attributes: &[Attribute]) -> String {
    let line = |attribute: &Attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => text(&pair.value).ok(),
        _ => None,
    };
    let lines: Vec<String> = attributes.iter().filter_map(line).map(|line| line.trim().to_owned()).collect();
    lines.join(" ").trim().to_owned()
}

/// Whether serde writes the words of an enum in snake case.
pub(crate) fn is_snake(attributes: &[Attribute]) -> bool {
    let says = |attribute: &&Attribute| {
        let Meta::List(list) = &attribute.meta else { return false };
        list.path.is_ident("serde") && list.tokens.to_string().contains("snake_case")
    };
    attributes.iter().any(|attribute| says(&attribute))
}

fn text(value: &Expr) -> syn::Result<String> {
    match value {
        Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) => Ok(text.value()),
        value => Err(syn::Error::new_spanned(value, "this must be a text in quotes")),
    }
}
