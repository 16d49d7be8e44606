//! Derive macros of the tables of case and study files: a struct with its doc comments and the
//! attributes `#[key(…)]` of its fields is the description of a table and its reader
//! (`carom_case::keys::Keys`); an enum of unit variants is a set of words, and one with fields a
//! table that depends on the value of one of its keys (`carom_case::keys::Value`).
//!
//! ```text
//! /// A contact pair: two sides that may come into contact.        meaning of the table
//! #[derive(Keys)]
//! #[keys(name = "[[contact]]", later = ["passes", "normals"])]     name in messages; planned keys
//! struct ContactSpec {
//!     /// Stiffness of the springs.                                meaning of the key
//!     #[key(Number(POSITIVE), unit = "", default = "10.0")]         values, if the type does not say
//!     stiffness: f64,
//! ```
//!
//! Entries of `key`: `name`, where it is not that of the field; `unit`; `example`, as TOML;
//! `default` and `paper`, the default under `preset = "paper"`, as TOML; `optional`, an example of
//! a key without which the field has the default of its type; `later`, other values that are
//! planned; `unless`, the key that takes its place; `with`, a function that reads the field from
//! the table; `given`, for a field that says only whether the key is given; `flatten`, for the keys
//! of another struct in the same table; `required`, for a key that must be given though the type of
//! its field has a default. A table that is `lenient` is read even where some of its keys cannot
//! be; their fields have the defaults of their types. A field without `key` is no key, and gets the
//! default of its type.

mod attributes;
mod fields;
mod variants;

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Data, DeriveInput, Fields, parse_macro_input};

use attributes::Container;

/// Implements `Keys` for a struct, and `Value` for an enum.
#[proc_macro_derive(Keys, attributes(keys, key))]
pub fn derive(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    expanded(&input).unwrap_or_else(|error| error.to_compile_error()).into()
}

fn expanded(input: &DeriveInput) -> syn::Result<TokenStream> {
    let container = Container::of(&input.attrs)?;
    let name = &input.ident;
    match &input.data {
        Data::Struct(data) => {
            let table = fields::table(&container.name, &container, &data.fields)?;
            let read = fields::read(&quote!(Self), container.lenient, &data.fields)?;
            Ok(quote! {
                impl ::carom_case::keys::Keys for #name {
                    const TABLE: ::carom_case::keys::Table = #table;
                    fn read(v: &::carom_case::keys::View<'_>) -> Option<Self> { #read }
                }
            })
        }
        Data::Enum(data) if data.variants.iter().all(|variant| matches!(variant.fields, Fields::Unit)) => {
            variants::words(name, &input.attrs, data)
        }
        Data::Enum(data) => variants::tagged(name, &container, data),
        Data::Union(_) => Err(syn::Error::new_spanned(name, "a union has no keys")),
    }
}
