//! JSON Schema (draft 2020-12) of the study file, for editors: its own keys, and those of the case
//! wherever a value is set.

use carom_run::case;
use serde_json::{Map, Value, json};

use carom_record::study::design::Goal;

use crate::file::{ARM, CLAIM, FINE, KEYS};

/// The schema of a study file.
pub fn schema() -> Value {
    let text = |doc: &str| json!({ "type": "string", "description": doc });
    let one_of = |doc: &str, words: &[&str]| json!({ "enum": words, "description": doc });
    let set = |values: Map<String, Value>, doc: &str| json!({ "type": "object", "description": doc, "patternProperties": values, "additionalProperties": false });
    let list = |(pattern, schema)| (pattern, json!({ "type": "array", "minItems": 1, "items": schema }));
    let set_doc = "Values of the case that this arm replaces: \"time.step\" = 1e-3, \"body.cylinder.element\" = \"T6\".";
    let expects = || json!({ "type": "array", "items": case::expectation() });
    let arm = [
        text("Its name in tables, figures and claims."),
        text("Another case file, relative to the study, instead of the study's."),
        set(case::changes(), set_doc),
        expects(),
        one_of(
            "In a design of matched steps: this method gets, level by level, the step at which it costs what `cost_of` does, as an explicit scheme must.",
            &["cost"],
        ),
    ];
    let claim =
        [text("A statement, in words."), text("What decides it: 'METRIC of \"ARM\" > METRIC of \"ARM\"'.")];
    let study = [
        text("Title of the page."),
        text("The case file, relative to this one."),
        set(case::changes(), "Values of the case that all arms and the computed reference replace."),
        one_of(
            "What makes the arms comparable: they are methods then, each run at every one of `steps`, or at the step at which it costs what the method `cost_of` costs there.",
            &["matched-step", "matched-cost"],
        ),
        json!({ "type": "array", "minItems": 1, "items": { "type": "number", "exclusiveMinimum": 0 }, "description": "Falling time steps of the levels of a design; the case's own step if left out." }),
        text(
            "The method whose cost the others are given, with matched cost or `match = \"cost\"`; the first if left out.",
        ),
        one_of("What arms are ranked by.", &Goal::NAMES.map(|(name, ..)| name)),
        json!({ "type": "number", "exclusiveMinimum": 0, "description": "The error that is good enough, 0.05 if left out." }),
        text(
            "The arm others are compared with, \"exact\" for the formulas of [exact], or \"fine\" to have a fine one computed.",
        ),
        object(
            "The computed reference.",
            &FINE,
            [
                set(
                    case::changes(),
                    "Values of the case it replaces; Chung and Hulbert's scheme with ρ∞ = 0.1 if it names no scheme.",
                ),
                json!({ "type": "integer", "minimum": 1, "description": "Its step is the smallest of the study over this, 8 if left out." }),
            ],
            &[],
        ),
        json!({ "type": "array", "items": object("A simulation.", &ARM, arm, &["name"]) }),
        set(case::changes().into_iter().map(list).collect(), "Lists of values; their product adds arms."),
        json!({ "type": "array", "items": object("A statement, confirmed or denied.", &CLAIM, claim, &CLAIM) }),
        expects(),
    ];
    let mut schema = object("Many runs of one case, compared.", &KEYS, study, &["case"]);
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!("Carom study");
    schema
}

fn object<const N: usize>(doc: &str, keys: &[&str; N], values: [Value; N], required: &[&str]) -> Value {
    let properties: Map<String, Value> = keys.iter().map(|k| (*k).to_owned()).zip(values).collect();
    json!({
        "type": "object", "description": doc, "properties": properties, "required": required, "additionalProperties": false
    })
}
