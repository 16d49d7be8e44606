//! The schema has every key.

use carom_case::draft::Draft;
use carom_case::keys::{Key, Keys, Kind, Table, Variants};
use carom_case::schema;
use carom_case::schema::json_of;
use serde_json::json;

/// Calls `see` for every key of every table, once per place.
fn visit(spec: &'static Table, see: &mut dyn FnMut(&'static Table, &'static Key)) {
    for key in spec.keys {
        see(spec, key);
        match key.kind {
            Kind::Table(spec) | Kind::Tables(spec) | Kind::SideOr(spec) | Kind::FormulasOr(_, spec) => {
                visit(spec, see);
            }
            Kind::Variant(variants) => {
                let Variants { tables, or, .. } = variants();
                tables.iter().map(|(_, spec)| spec).chain(*or).for_each(|spec| visit(spec, see));
            }
            _ => {}
        }
    }
}

#[test]
fn defaults_and_examples_are_toml() {
    visit(&Draft::TABLE, &mut |spec, key| {
        let nested = matches!(key.kind, Kind::Table(_) | Kind::Tables(_));
        assert!(nested || json_of(key.example).is_some(), "{} {}: {:?}", spec.name, key.name, key.example);
        assert!(key.paper.is_none_or(|toml| json_of(toml).is_some()), "{} {}", spec.name, key.name);
        assert!(key.doc.ends_with('.'), "{} {}", spec.name, key.name);
    });
}

#[test]
fn schema_has_every_key_and_forbids_others() {
    let schema = schema();
    let text = schema.to_string();
    visit(&Draft::TABLE, &mut |_, key| {
        assert!(text.contains(&format!("\"{}\":", key.name)), "{}", key.name);
    });
    assert_eq!(schema["additionalProperties"], json!(false));
    assert_eq!(schema["required"], json!(["dimension", "material", "body", "time"]));
    let scheme = &schema["properties"]["time"]["properties"]["scheme"];
    let kinds: Vec<_> = scheme["oneOf"]
        .as_array()
        .unwrap()
        .iter()
        .map(|s| s["properties"]["kind"]["const"].clone())
        .collect();
    assert_eq!(kinds.len(), carom_time::KINDS.len());
    assert_eq!(scheme["oneOf"][4]["properties"]["rho_inf"]["maximum"], json!(1.0));
    let density = &schema["properties"]["material"]["items"]["properties"]["density"];
    assert_eq!(density["minimum"], json!(0.0));
    assert_eq!(
        schema["properties"]["contact"]["items"]["properties"]["persistency"]["default"],
        json!("project")
    );
}
