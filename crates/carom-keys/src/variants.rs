//! Enums: sets of words, and tables that depend on the value of one of their keys.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Attribute, DataEnum, Fields, Ident, LitStr};

use crate::attributes::{Container, doc, is_snake};
use crate::fields;

/// Code for an enum of unit variants: words in kebab case, or in snake case where serde writes them
/// so.
pub(crate) fn words(name: &Ident, attributes: &[Attribute], data: &DataEnum) -> syn::Result<TokenStream> {
    let separator = if is_snake(attributes) { '_' } else { '-' };
    let later = Container::of(attributes)?.later;
    let variants: Vec<&Ident> = data.variants.iter().map(|variant| &variant.ident).collect();
    let words: Vec<String> = variants.iter().map(|variant| word(variant, separator)).collect();
    let docs: Vec<String> = data.variants.iter().map(|variant| doc(&variant.attrs)).collect();
    Ok(quote! {
        impl #name {
            /// Names of the variants in case files, in their order.
            pub const WORDS: &[&str] = &[#(#words),*];

            /// Name in case files.
            pub fn word(self) -> &'static str {
                Self::WORDS[self as usize]
            }
        }
        impl ::carom_case::keys::Value for #name {
            const KIND: ::carom_case::keys::Kind =
                ::carom_case::keys::Kind::Choice(::carom_case::keys::Words {
                    now: Self::WORDS,
                    meanings: &[#(#docs),*],
                    later: &[#(#later),*],
                });
            fn of(node: &::carom_case::keys::Node, _: &::carom_case::keys::View<'_>) -> Option<Self> {
                match node.text()? {
                    #(#words => Some(Self::#variants),)*
                    _ => None,
                }
            }
        }
    })
}

/// An enum whose variants are tables, selected by the value of the key `tag`; one of them, a
/// struct, may have no tag, and is recognised by its first key.
pub(crate) fn tagged(name: &Ident, container: &Container, data: &DataEnum) -> syn::Result<TokenStream> {
    let Container { name: label, tag, tag_doc, .. } = container;
    let mut tables = Vec::new();
    let mut arms = Vec::new();
    let mut or_table = quote!(None);
    let mut or_read = quote!(None);
    for variant in &data.variants {
        let own = Container::of(&variant.attrs)?;
        let ident = &variant.ident;
        if let (true, Fields::Unnamed(of)) = (own.untagged, &variant.fields) {
            let ty = &of.unnamed[0].ty;
            or_table = quote!(Some(&<#ty as ::carom_case::keys::Keys>::TABLE));
            or_read = quote!(::carom_case::keys::Keys::read(v).map(Self::#ident));
            continue;
        }
        let word = LitStr::new(&word(ident, '-'), ident.span());
        let of = format!("{label} of {tag} \"{}\"", word.value());
        let table = fields::table(&of, &own, &variant.fields)?;
        let read = fields::read(&quote!(Self::#ident), false, &variant.fields)?;
        tables.push(quote!((#word, #table)));
        arms.push(quote!(Some(#word) => { #read }));
    }
    Ok(quote! {
        impl #name {
            /// Descriptions of the tables.
            pub fn variants() -> &'static ::carom_case::keys::Variants {
                const VARIANTS: ::carom_case::keys::Variants = ::carom_case::keys::Variants {
                    name: #label,
                    tag: #tag,
                    doc: #tag_doc,
                    tables: &[#(#tables),*],
                    or: #or_table,
                    dimension: None,
                };
                &VARIANTS
            }
        }
        impl ::carom_case::keys::Value for #name {
            const KIND: ::carom_case::keys::Kind = ::carom_case::keys::Kind::Variant(Self::variants);
            fn of(node: &::carom_case::keys::Node, v: &::carom_case::keys::View<'_>) -> Option<Self> {
                let v = &v.variant(node, Self::variants())?;
                match v.word() {
                    #(#arms)*
                    None => { #or_read }
                    _ => None,
                }
            }
        }
    })
}

/// Name of a variant in files: `HalfDisc` becomes `half-disc`.
fn word(variant: &Ident, separator: char) -> String {
    let mut word = String::new();
    for letter in variant.to_string().chars() {
        if letter.is_uppercase() && !word.is_empty() {
            word.push(separator);
        }
        word.extend(letter.to_lowercase());
    }
    word
}
