//! Variants of materials.

use super::builder::*;
use crate::import::{Choice, ImportOptions, Imported, model_from_slice};
use serde_json::{Value, json};

/// Two primitives of the first of three materials; `mappings` are those of the first primitive.
fn asset(mappings: &Value) -> Asset {
    let mut asset = Asset::triangle();
    for name in ["plain", "gold", "glass"] {
        asset.push("materials", json!({ "name": name }));
    }
    let first = &mut asset.json["meshes"][0]["primitives"];
    first[0]["material"] = json!(0);
    let second = first[0].clone();
    first[0]["extensions"] = json!({ "KHR_materials_variants": { "mappings": mappings } });
    first.as_array_mut().unwrap().push(second);
    asset.json["extensionsUsed"] = json!(["KHR_materials_variants"]);
    asset.json["extensionsRequired"] = json!(["KHR_materials_variants"]);
    asset.json["extensions"] =
        json!({ "KHR_materials_variants": { "variants": [{ "name": "a" }, { "name": "b" }, { "name": "a" }] } });
    asset
}

fn import(asset: &Asset, variant: Option<Choice>) -> Result<Imported, String> {
    let options = ImportOptions { variant, ..ImportOptions::default() };
    model_from_slice(&asset.glb(), "model", None, &options).map_err(|error| error.to_string())
}

fn materials(imported: &Imported) -> Vec<usize> {
    imported.scene.meshes[0].primitives.iter().map(|primitive| primitive.material).collect()
}

#[test]
fn the_chosen_variant_gives_the_materials() {
    let asset = asset(&json!([{ "material": 1, "variants": [2] }, { "material": 2, "variants": [1], "name": "x" }]));
    let chosen = |variant| import(&asset, variant).unwrap();
    let named = |name: &str| Some(Choice::Name(name.into()));
    assert_eq!(chosen(None).variant_names, ["a", "b", "a"]);
    assert!(chosen(None).warnings.is_empty());
    assert_eq!(materials(&chosen(None)), [0, 0]);
    assert_eq!(materials(&chosen(named("b"))), [2, 0]);
    // Of two of one name the first, which this primitive does not know.
    assert_eq!(materials(&chosen(named("a"))), [0, 0]);
    assert_eq!(materials(&chosen(Some(Choice::Index(2)))), [1, 0]);
    let error = import(&asset, named("c")).unwrap_err();
    let expected = "variants: has no variant \"c\"; choose one of: \"a\", \"b\", \"a\"";
    assert!(error.starts_with("model: /extensions/KHR_materials_variants/") && error.ends_with(expected), "{error}");
    let error = import(&Asset::triangle(), Some(Choice::Index(0))).unwrap_err();
    assert!(error.contains("has no variant 0; choose none"), "{error}");
}

#[test]
fn mappings_that_refer_to_nothing_are_refused_whatever_is_chosen() {
    let place = "/meshes/0/primitives/0/extensions/KHR_materials_variants";
    for (mappings, expected) in [
        (json!([{ "material": 3, "variants": [0] }]), format!("{place}/mappings/0/material: refers to /materials/3")),
        (
            json!([{ "material": 0, "variants": [0, 9] }]),
            format!("{place}/mappings/0/variants/1: refers to /extensions/KHR_materials_variants/variants/9"),
        ),
        (json!([{ "material": -1, "variants": [] }]), format!("{place}/mappings/0/material")),
        (json!([{ "variants": [0] }]), format!("{place}/mappings/0")),
    ] {
        let error = import(&asset(&mappings), None).unwrap_err();
        assert!(error.contains(&expected) && !error.contains('\n'), "{mappings}: {error}");
    }
}

#[test]
fn of_two_materials_of_one_variant_the_first_counts() {
    let twice = asset(&json!([{ "material": 1, "variants": [1] }, { "material": 2, "variants": [1] }]));
    let imported = import(&twice, Some(Choice::Index(1))).unwrap();
    assert_eq!(materials(&imported), [1, 0]);
    assert!(imported.warnings[0].to_string().contains("mappings/1/variants/0: this variant has a material"));
}
