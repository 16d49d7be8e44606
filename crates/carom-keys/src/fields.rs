//! The keys of the fields of a struct, or of a variant, and how they are read.

use proc_macro2::TokenStream;
use quote::quote;
use syn::ext::IdentExt;
use syn::{Field, Fields, Type};

use crate::attributes::{Container, Key};

/// Code of the description of a table, a `carom_case::keys::Table`.
pub(crate) fn table(name: &str, container: &Container, fields: &Fields) -> syn::Result<TokenStream> {
    let mut own = Vec::new();
    // The keys of other structs stand where their field does.
    let mut groups = Vec::new();
    for field in fields {
        let Some(key) = Key::of(&field.attrs)? else { continue };
        if key.flatten {
            let ty = &field.ty;
            let before = std::mem::take(&mut own);
            groups.push(quote!(&[#(#before),*]));
            groups.push(quote!(<#ty as ::carom_case::keys::Keys>::TABLE.keys));
        } else {
            own.push(described(field, &key));
        }
    }
    let own = quote!(&[#(#own),*]);
    let keys = if groups.is_empty() {
        own
    } else {
        quote!({
            const GROUPS: &[&[::carom_case::keys::Key]] = &[#(#groups,)* #own];
            const ALL: [::carom_case::keys::Key; ::carom_case::keys::count(GROUPS)] =
                ::carom_case::keys::joined(GROUPS);
            &ALL
        })
    };
    let doc = &container.doc;
    let later = &container.later;
    let dimension =
        container.dimension.as_ref().map_or_else(|| quote!(None), |dimension| quote!(Some(#dimension)));
    Ok(quote!(::carom_case::keys::Table { name: #name, doc: #doc, keys: #keys, later: &[#(#later),*],
        dimension: #dimension,
    }))
}

/// Code of the description of a key, a `carom_case::keys::Key`.
fn described(field: &Field, key: &Key) -> TokenStream {
    let Key { doc, kind, described, default, paper, optional, .. } = key;
    let name = name(field, key);
    let ty = &field.ty;
    let of_type = || quote!(<#ty as ::carom_case::keys::Value>::KIND);
    let kind = kind.as_ref().map_or_else(of_type, |kind| quote!(#kind));
    let (entries, values): (Vec<_>, Vec<_>) = described.iter().cloned().unzip();
    let example = default.as_ref().or(optional.as_ref()).map(|toml| quote!(example: #toml,));
    let paper = paper.as_ref().map(|toml| quote!(paper: Some(#toml),));
    let default = match default {
        Some(toml) => quote!(Is(#toml)),
        None if optional.is_some() || is_option(&field.ty) && !key.required => quote!(Absent),
        None => quote!(Required),
    };
    quote!(::carom_case::keys::Key {
        name: #name,
        kind: #kind,
        doc: #doc,
        default: ::carom_case::keys::Default::#default,
        #example
        #paper
        #(#entries: #values,)*
        ..::carom_case::keys::Key::NONE
    })
}

/// Code that reads a struct, or a variant, from the table `v`.
pub(crate) fn read(path: &TokenStream, lenient: bool, fields: &Fields) -> syn::Result<TokenStream> {
    let mut names = Vec::new();
    let mut values = Vec::new();
    for field in fields {
        names.push(&field.ident);
        values.push(match Key::of(&field.attrs)? {
            None => quote!(Some(::core::default::Default::default())),
            // None of an option is the same, whether it is absent or wrong.
            Some(Key { with: Some(with), .. }) if is_option(&field.ty) => quote!(Some(#with(v))),
            Some(Key { with: Some(with), .. }) => quote!(#with(v)),
            Some(Key { flatten: true, .. }) => quote!(::carom_case::keys::Keys::read(v)),
            Some(key) => {
                let name = name(field, &key);
                if key.given { quote!(Some(v.has(#name))) } else { quote!(v.get(#name)) }
            }
        });
    }
    let or_none = if lenient { quote!(.unwrap_or_default()) } else { quote!(?) };
    // Every field is read before one of them fails, so that everything wrong is reported.
    Ok(quote! {
        #(let #names = #values;)*
        Some(#path { #(#names: #names #or_none),* })
    })
}

fn name(field: &Field, key: &Key) -> String {
    let own = || field.ident.as_ref().map(|ident| ident.unraw().to_string());
    key.name.clone().or_else(own).unwrap_or_default()
}

fn is_option(ty: &Type) -> bool {
    matches!(ty, Type::Path(path) if path.path.segments.last().is_some_and(|last| last.ident == "Option"))
}
