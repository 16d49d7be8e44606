//! JSON Schema (draft 2020-12) of the case file, for editors, generated from the table of keys.

use serde_json::{Map, Value, json};

use super::draft::Draft;
use super::keys::{Default, Key, Keys, Kind, Range, Table, Variants};

/// The schema of a case file.
pub fn schema() -> Value {
    schema_of(&Draft::TABLE, "Carom case")
}

/// The schema of a file with the keys of a table.
pub fn schema_of(file: &Table, title: &str) -> Value {
    let mut schema = table(file, None);
    schema.insert("$schema".into(), json!("https://json-schema.org/draft/2020-12/schema"));
    schema.insert("title".into(), json!(title));
    Value::Object(schema)
}

/// A table of values of the case.
fn overrides(values: &Map<String, Value>) -> Value {
    json!({ "type": "object", "patternProperties": values, "additionalProperties": false })
}

/// Schemas of the values that an override may set, by a pattern for the key: `time.step`,
/// `body.NAME.element`.
fn changes() -> Map<String, Value> {
    let mut found = Vec::new();
    paths(&Draft::TABLE, "^", &mut found);
    let mut schemas = Map::new();
    for (pattern, schema) in found {
        // A key with different meanings in different variants takes the values of all of them.
        let known = schemas.entry(pattern).or_insert_with(|| json!({ "anyOf": [] }));
        if let Some(list) = known["anyOf"].as_array_mut().filter(|list| !list.contains(&schema)) {
            list.push(schema);
        }
    }
    schemas
}

/// Every key at every depth; `before` is the pattern of its parents.
fn paths(spec: &Table, before: &str, found: &mut Vec<(String, Value)>) {
    for key in spec.keys {
        let name = format!("{before}{}", key.name);
        found.push((format!("{name}$"), property(key)));
        match key.kind {
            Kind::Table(spec) | Kind::SideOr(spec) | Kind::Rotation(spec) => {
                paths(spec, &format!("{name}\\."), found);
            }
            Kind::Tables(spec) => paths(spec, &format!("{name}\\.[^.]+\\."), found),
            Kind::Variant(variants) => {
                let variants = variants();
                let before = format!("{name}\\.");
                let values: Vec<_> = variants.tables.iter().map(|(value, _)| value).collect();
                found.push((format!("{before}{}$", variants.tag), json!({ "enum": values })));
                let tables = variants.tables.iter().map(|(_, spec)| spec).chain(variants.or);
                tables.for_each(|spec| paths(spec, &before, found));
            }
            _ => {}
        }
    }
}

fn table(spec: &Table, tag: Option<(&str, &str, &str)>) -> Map<String, Value> {
    let mut properties = Map::new();
    let mut required = Vec::new();
    if let Some((name, value, doc)) = tag {
        properties.insert(name.into(), json!({ "const": value, "description": doc }));
        required.push(name);
    }
    for key in spec.keys {
        properties.insert(key.name.into(), property(key));
        if matches!(key.default, Default::Required) && key.unless.is_empty() {
            required.push(key.name);
        }
    }
    let mut schema = Map::new();
    schema.insert("type".into(), json!("object"));
    schema.insert("description".into(), json!(spec.doc));
    schema.insert("properties".into(), Value::Object(properties));
    schema.insert("required".into(), json!(required));
    schema.insert("additionalProperties".into(), json!(false));
    let replaced: Vec<&Key> = spec.keys.iter().filter(|key| !key.unless.is_empty()).collect();
    if let Some(key) = replaced.first() {
        let names: Vec<&str> = replaced.iter().map(|key| key.name).collect();
        if replaced.iter().any(|key| matches!(key.default, Default::Required)) {
            schema.insert("oneOf".into(), json!([{ "required": [key.unless] }, { "required": names }]));
        } else {
            schema.insert("not".into(), json!({ "required": [key.unless, key.name] }));
        }
    }
    schema
}

fn property(key: &Key) -> Value {
    let mut schema = values(&key.kind);
    let paper = key.paper.map_or_else(String::new, |toml| format!(" With preset = \"paper\": {toml}."));
    schema.insert("description".into(), json!(format!("{}{paper}", key.meaning())));
    if matches!(key.kind, Kind::Tables(_)) && !matches!(key.default, Default::Absent) {
        schema.insert("minItems".into(), json!(1));
    }
    if matches!(key.kind, Kind::Numbers(_)) && !matches!(key.default, Default::Is("[]")) {
        schema.insert("minItems".into(), json!(1));
    }
    if let Default::Is(toml) = key.default
        && let Some(default) = json_of(toml)
    {
        schema.insert("default".into(), default);
    } else if let Some(example) = json_of(key.example) {
        schema.insert("examples".into(), json!([example]));
    }
    Value::Object(schema)
}

fn values(kind: &Kind) -> Map<String, Value> {
    let side = json!({ "type": "string", "pattern": "^[^.]+\\.[^.]+$" });
    let schema = match kind {
        Kind::Text => json!({ "type": "string" }),
        Kind::Name => json!({ "type": "string", "pattern": "^[^\\s./\\\\,\"'\\[\\]]+$" }),
        Kind::Choice(words) => json!({ "type": "string", "enum": words.now }),
        Kind::Choices(words) => json!({ "type": "array", "minItems": 1, "items": { "enum": words } }),
        Kind::Number(range) => Value::Object(number(range)),
        Kind::NumberOrFalse(range) => json!({ "oneOf": [number(range), { "const": false }] }),
        Kind::ByColumn => {
            json!({ "type": "object", "additionalProperties": { "type": ["number", "string"] } })
        }
        Kind::NamesByGroup => {
            json!({ "type": "object", "minProperties": 1, "additionalProperties": { "type": "string" } })
        }
        Kind::Truth => json!({ "type": "boolean" }),
        Kind::Count(least) => json!({ "type": "integer", "minimum": least }),
        Kind::Counts(least) => {
            json!({ "type": "array", "minItems": 2, "maxItems": 3, "items": { "type": "integer", "minimum": least } })
        }
        Kind::Vector => {
            json!({ "type": "array", "minItems": 1, "maxItems": 3, "items": { "type": "number" } })
        }
        Kind::Direction => json!({ "oneOf": [
            { "enum": ["x", "y", "z"] },
            { "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 }
        ] }),
        Kind::Angular => json!({ "oneOf": [
            { "type": "number" },
            { "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 }
        ] }),
        Kind::Rotation(spec) => json!({ "oneOf": [{ "type": "number" }, table(spec, None)] }),
        Kind::Numbers(range) => json!({ "type": "array", "items": number(range) }),
        Kind::Points(least) => {
            let point =
                json!({ "type": "array", "minItems": 2, "maxItems": 2, "items": { "type": "number" } });
            json!({ "type": "array", "minItems": least, "items": point })
        }
        Kind::Formula(_) => formula(),
        Kind::Formulas(_) => formulas(),
        Kind::FormulasOr(_, spec) => json!({ "oneOf": [formulas(), table(spec, None)] }),
        Kind::Side => side,
        Kind::Sides => json!({ "type": "array", "minItems": 1, "items": side }),
        Kind::Between => json!({ "oneOf": [
            { "const": "all" },
            { "type": "array", "minItems": 1, "items": { "type": "string" } },
        ] }),
        Kind::SideOr(spec) => json!({ "oneOf": [side, table(spec, None)] }),
        Kind::Changes => overrides(&changes()),
        Kind::ChangeLists => json!({ "type": "array", "items": overrides(&changes()) }),
        Kind::Grid => {
            let list =
                |(pattern, schema)| (pattern, json!({ "type": "array", "minItems": 1, "items": schema }));
            overrides(&changes().into_iter().map(list).collect())
        }
        Kind::Table(spec) => Value::Object(table(spec, None)),
        Kind::Tables(spec) => json!({ "type": "array", "items": table(spec, None) }),
        Kind::Variant(variants) => one_of(variants()),
    };
    if let Value::Object(schema) = schema { schema } else { Map::new() }
}

fn formula() -> Value {
    json!({ "type": ["number", "string"] })
}

fn formulas() -> Value {
    json!({ "type": "array", "minItems": 1, "maxItems": 3, "items": formula() })
}

fn one_of(variants: &Variants) -> Value {
    let one = |(value, spec): &(&str, Table)| table(spec, Some((variants.tag, value, variants.doc)));
    let or = variants.or.map(|spec| table(spec, None));
    json!({ "oneOf": variants.tables.iter().map(one).chain(or).collect::<Vec<_>>() })
}

fn number(range: &Range) -> Map<String, Value> {
    let mut schema = Map::new();
    schema.insert("type".into(), json!("number"));
    if let Some((low, closed)) = range.low {
        schema.insert(if closed { "minimum" } else { "exclusiveMinimum" }.into(), json!(low));
    }
    if let Some((high, closed)) = range.high {
        schema.insert(if closed { "maximum" } else { "exclusiveMaximum" }.into(), json!(high));
    }
    schema
}

/// A TOML value as JSON.
pub fn json_of(toml: &str) -> Option<Value> {
    let mut table: Map<String, Value> = toml_edit::de::from_str(&format!("v = {toml}")).ok()?;
    table.remove("v")
}
