//! JSON Schema (draft 2020-12) of the study file, for editors: its own keys, and the keys of the
//! case where values are set.

use carom_run::case;
use serde_json::{Map, Value, json};

use carom_record::study::design::Goal;

use crate::file::{ARM, CLAIM, ENSEMBLE, FINE, KEYS};

/// The schema of a study file.
pub fn schema() -> Value {
    let text = |doc: &str| json!({ "type": "string", "description": doc });
    let one_of = |doc: &str, words: &[&str]| json!({ "enum": words, "description": doc });
    let set = |values: Map<String, Value>, doc: &str| json!({ "type": "object", "description": doc, "patternProperties": values, "additionalProperties": false });
    let list = |(pattern, schema)| (pattern, json!({ "type": "array", "minItems": 1, "items": schema }));
    let set_doc = "Values of the case that this arm replaces: \"time.step\" = 1e-3, \"body.cylinder.element\" = \"T6\".";
    let expects = || json!({ "type": "array", "items": case::expectation() });
    let arm = [
        text("Name in tables, figures and claims."),
        text("Case file of this arm, relative to the study file, instead of that of the study."),
        set(case::changes(), set_doc),
        expects(),
        one_of(
            "In a design of matched steps: at every level, this method has the step at which its cost equals that of `cost_of`; meant for explicit schemes.",
            &["cost"],
        ),
    ];
    let claim = [
        text("The claim, in words."),
        text("The comparison that decides it: 'METRIC of \"ARM\" > METRIC of \"ARM\"'."),
    ];
    let study = [
        text("Title of the page."),
        text("The case file, relative to the study file."),
        set(case::changes(), "Values of the case that all arms and the computed reference replace."),
        one_of(
            "How the arms are made comparable: as methods, each run at every one of `steps` (matched-step), or at the steps at which its cost equals that of the method `cost_of` (matched-cost).",
            &["matched-step", "matched-cost"],
        ),
        json!({ "type": "array", "minItems": 1, "items": { "type": "number", "exclusiveMinimum": 0 }, "description": "Decreasing time steps of the levels of a design. Default: the step of the case." }),
        text(
            "The method whose cost the others are matched to, with matched cost or `match = \"cost\"`. Default: the first one.",
        ),
        one_of("Goal by which the arms are ranked.", &Goal::NAMES.map(|(name, ..)| name)),
        json!({ "type": "number", "exclusiveMinimum": 0, "description": "Required accuracy: the largest acceptable error. Default: 0.05." }),
        text(
            "The arm that the others are compared with, \"exact\" for the formulas of [exact], or \"fine\" for a computed reference.",
        ),
        object(
            "The computed reference.",
            &FINE,
            [
                set(
                    case::changes(),
                    "Values of the case that it replaces. Default scheme: that of Chung and Hulbert with ρ∞ = 0.1.",
                ),
                json!({ "type": "integer", "minimum": 1, "description": "Factor by which its step is smaller than the smallest one of the study. Default: 8." }),
                factors(
                    "Factors by which its meshes are finer than that of the case, one for each run, the coarsest first; the steps shrink by the same factors, down to the finest one. Default: three steps, each half of the one before, on the given mesh.",
                ),
            ],
            &[],
        ),
        object(
            "Every arm is run several times, with all combinations of these changes; claims and rankings are then medians with intervals.",
            &ENSEMBLE,
            [
                json!({ "type": "integer", "minimum": 1, "maximum": 100, "description": "Number of phases: shifts of the instants of the steps by 0, 1/n, … of a step (time.phase). Default: 1." }),
                json!({ "type": "boolean", "description": "Whether every run is repeated with secondary and primary sides swapped. Default: false." }),
                factors("Factors by which all meshes are refined; the first one is 1. Default: [1]."),
                json!({ "type": "array", "items": set(case::changes(), "Values of the case."), "description": "Changes of the case with each of which every run is repeated; an arm that sets one of their keys itself is not. Default: []." }),
            ],
            &[],
        ),
        json!({ "type": "array", "items": object("An arm: one variant of the case that is simulated.", &ARM, arm, &["name"]) }),
        set(case::changes().into_iter().map(list).collect(), "Lists of values; every combination is an arm."),
        json!({ "type": "array", "items": case::measured() }),
        json!({ "type": "array", "items": object("A claim about the arms, confirmed or refuted by a comparison.", &CLAIM, claim, &CLAIM) }),
        expects(),
    ];
    let mut schema = object("A comparison of many runs of one case.", &KEYS, study, &[]);
    // The case of the study is not needed where every arm has its own.
    let own = json!({ "properties": { "arm": { "items": { "required": ["case"] } } }, "required": ["arm"], "not": { "required": ["grid"] } });
    schema["anyOf"] = json!([{ "required": ["case"] }, own]);
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!("Carom study");
    schema
}

fn factors(doc: &str) -> Value {
    json!({ "type": "array", "minItems": 1, "items": { "type": "number", "minimum": 1, "maximum": 64 }, "description": doc })
}

fn object<const N: usize>(doc: &str, keys: &[&str; N], values: [Value; N], required: &[&str]) -> Value {
    let properties: Map<String, Value> = keys.iter().map(|k| (*k).to_owned()).zip(values).collect();
    json!({
        "type": "object", "description": doc, "properties": properties, "required": required, "additionalProperties": false
    })
}
