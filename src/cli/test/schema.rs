//! `docs/report.schema.json` says what `report.json` holds: it is checked against reports, and reports against it.

use super::ingredients::{Finding, Ingredients, MaterialIngredients, Quantity, TextureHash};
use super::report::tests::example;
use super::report::{Blobs, PartReport, SCHEMA, SuiteReport};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;

const PUBLISHED: &str = include_str!("../../../docs/report.schema.json");

/// What the value has that the schema does not allow, by JSON pointers. Of JSON Schema 2020-12 it knows what is used here,
/// and panics at the rest.
fn offences(root: &Value, schema: &Value, value: &Value, place: &str, found: &mut Vec<String>) {
    let mut offend = |reason: String| found.push(format!("{place}: {reason}"));
    for (keyword, wanted) in schema.as_object().unwrap() {
        match keyword.as_str() {
            "$schema" | "$id" | "$defs" | "title" | "description" => {}
            "type" => {
                let allowed = wanted.as_array().cloned().unwrap_or_else(|| vec![wanted.clone()]);
                if !allowed.iter().any(|name| is_a(value, name.as_str().unwrap())) {
                    offend(format!("{value} is no {wanted}"));
                }
            }
            "const" if value != wanted => offend(format!("{value} is not {wanted}")),
            "enum" if !wanted.as_array().unwrap().contains(value) => offend(format!("{value} is none of {wanted}")),
            "const" | "enum" => {}
            "minimum" if value.as_f64().is_some_and(|number| number < wanted.as_f64().unwrap()) => {
                offend(format!("{value} is below {wanted}"));
            }
            "minimum" => {}
            "required" => {
                let has = |name: &Value| value.get(name.as_str().unwrap()).is_some() || !value.is_object();
                wanted
                    .as_array()
                    .unwrap()
                    .iter()
                    .filter(|name| !has(name))
                    .for_each(|name| offend(format!("no {name}")));
            }
            "additionalProperties" => {
                assert_eq!(wanted, false);
                let known = schema["properties"].as_object().unwrap();
                let is_unknown = |name: &&String| !known.contains_key(*name);
                let names = value.as_object().into_iter().flat_map(Map::keys);
                names.filter(is_unknown).for_each(|name| offend(format!("{name} is unknown")));
            }
            _ => {}
        }
    }
    let known = "$schema $id $defs title description type const enum minimum required additionalProperties properties \
                 items $ref";
    let unknown = schema.as_object().unwrap().keys().find(|keyword| !known.split_whitespace().any(|k| k == *keyword));
    assert_eq!(unknown, None, "this checker does not know the keyword");
    for (name, schema) in schema.get("properties").and_then(Value::as_object).into_iter().flatten() {
        if let Some(value) = value.get(name) {
            offences(root, schema, value, &format!("{place}/{name}"), found);
        }
    }
    if let (Some(schema), Some(items)) = (schema.get("items"), value.as_array()) {
        for (index, item) in items.iter().enumerate() {
            offences(root, schema, item, &format!("{place}/{index}"), found);
        }
    }
    if let Some(reference) = schema.get("$ref").and_then(Value::as_str)
        && !value.is_null()
    {
        let target = root.pointer(reference.strip_prefix('#').unwrap()).unwrap();
        offences(root, target, value, place, found);
    }
}

fn is_a(value: &Value, kind: &str) -> bool {
    match kind {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        other => panic!("{other} is no type"),
    }
}

fn check(value: &Value) -> Vec<String> {
    let schema: Value = serde_json::from_str(PUBLISHED).unwrap();
    let mut found = Vec::new();
    offences(&schema, &schema, value, "", &mut found);
    found
}

/// With something in every field.
fn full() -> SuiteReport {
    let mut report = example();
    report.part = Some(PartReport { scheme: "hash".into(), number: 1, of: 2, cases: 9 });
    let hash = || Some("0f".repeat(32));
    for case in &mut report.cases {
        case.blobs = Blobs { actual: hash(), golden: hash(), difference: hash(), heat_map: hash() };
        case.golden_provenance = case.provenance.clone();
        case.moved = vec![Finding::unknown("a reason")];
        case.ingredients = Some(ingredients());
    }
    report
}

fn ingredients() -> Ingredients {
    let quantity = |sketch| Quantity { name: "metallic".into(), mean: [0.5; 3], spread: [0.1; 3], sketch };
    let texture = TextureHash { slot: "base_color".into(), hash: "0f".repeat(8) };
    let material = MaterialIngredients {
        name: "paint".into(),
        pixels: 12,
        measured: 6,
        center_px: [3.5, 4.0],
        textures: vec![texture],
        quantities: vec![quantity(None), quantity(Some([1.0; 16]))],
    };
    Ingredients { size_px: [8, 8], scale: 2.0, lights: vec!["a lamp".into()], materials: vec![material], left_out: 3 }
}

/// Pointers of all fields of the value, with the items of an array taken together.
fn fields(value: &Value, place: &str, found: &mut BTreeSet<String>) {
    for (name, value) in value.as_object().into_iter().flatten() {
        found.insert(format!("{place}/{name}"));
        fields(value, &format!("{place}/{name}"), found);
    }
    for item in value.as_array().into_iter().flatten() {
        fields(item, place, found);
    }
}

/// The same of what the schema describes.
fn described(root: &Value, schema: &Value, place: &str, found: &mut BTreeSet<String>) {
    for (name, schema) in schema.get("properties").and_then(Value::as_object).into_iter().flatten() {
        found.insert(format!("{place}/{name}"));
        described(root, schema, &format!("{place}/{name}"), found);
    }
    if let Some(items) = schema.get("items") {
        described(root, items, place, found);
    }
    if let Some(reference) = schema.get("$ref").and_then(Value::as_str) {
        described(root, root.pointer(reference.strip_prefix('#').unwrap()).unwrap(), place, found);
    }
}

#[test]
fn reports_are_what_the_schema_says() {
    for report in [example(), full()] {
        let value: Value = serde_json::from_str(&report.json().unwrap()).unwrap();
        assert_eq!(check(&value), Vec::<String>::new());
    }
    let schema: Value = serde_json::from_str(PUBLISHED).unwrap();
    assert_eq!(schema["properties"]["schema"]["const"], SCHEMA);
}

#[test]
fn the_schema_says_all_that_reports_have_and_no_more() {
    let schema: Value = serde_json::from_str(PUBLISHED).unwrap();
    let (mut says, mut has) = (BTreeSet::new(), BTreeSet::new());
    described(&schema, &schema, "", &mut says);
    fields(&serde_json::to_value(full()).unwrap(), "", &mut has);
    assert_eq!(says, has);
}

#[test]
fn what_is_no_report_is_found() {
    type Damage = (&'static str, fn(&mut Value), &'static str);
    let damages: [Damage; 6] = [
        ("another layout", |report| report["schema"] = json!("specula-test/0"), "/schema"),
        ("no cases", |report| drop(report.as_object_mut().unwrap().remove("cases")), "no \"cases\""),
        ("a further field", |report| report["cases"][0]["speed"] = json!(1), "/cases/0: speed is unknown"),
        ("another state", |report| report["cases"][1]["status"] = json!("fine"), "/cases/1/status"),
        ("text for a number", |report| report["cases"][1]["metrics"][0]["limit"] = json!("1"), "metrics/0/limit"),
        ("a line before the first", |report| report["cases"][2]["line"] = json!(0), "/cases/2/line"),
    ];
    for (what, damage, place) in damages {
        let mut report = serde_json::to_value(full()).unwrap();
        damage(&mut report);
        let found = check(&report);
        assert!(found.len() == 1 && found[0].contains(place), "{what}: {found:?}");
    }
}
