//! Which material of a furnace does not send back all of the light, and why.

use super::compare::at_most;
use super::words::{material, plain, vector};
use super::{Finding, Ingredients, MaterialIngredients, Moved, list_of_faults};
use crate::scene::Input;

/// The share of the light that a surface returns.
pub(super) const RETURNED: &str = "furnace";

/// Less than this of an input takes nothing that could be seen.
const SAME: f64 = 1e-3;

/// One finding for each material whose mean or spread is further from 1 than `within`, most of the picture first.
pub(in crate::cli::test) fn findings_in_furnace(of: &Ingredients, within: f64) -> Vec<Finding> {
    let mut found = list_of_faults(of);
    let mut materials: Vec<&MaterialIngredients> = of.materials.iter().collect();
    materials.sort_by_key(|of| std::cmp::Reverse(of.pixels));
    found.extend(materials.into_iter().filter_map(|of| in_furnace(of, within)));
    if found.is_empty() {
        found.push(Finding {
            moved: Moved::Geometry,
            material: None,
            quantities: Vec::new(),
            text: "every material returns all of the light but in single pixels, such as edges of triangles".into(),
        });
    }
    at_most(found)
}

fn in_furnace(of: &MaterialIngredients, within: f64) -> Option<Finding> {
    let (mean, spread) =
        of.quantity(RETURNED).map_or(([0.0; 3], [0.0; 3]), |quantity| (quantity.mean, quantity.spread));
    let is_near = mean.iter().zip(spread).all(|(mean, spread)| (mean - 1.0).abs() + spread <= within);
    if is_near {
        return None;
    }
    let lobes = of.quantities.iter().filter_map(|quantity| {
        let lobe = quantity.name.strip_prefix("ibl-")?;
        Some(format!("{lobe} {}", vector(&quantity.mean)))
    });
    let lobes: Vec<String> = lobes.collect();
    let made_of = if lobes.is_empty() { String::new() } else { format!(" ({})", lobes.join(", ")) };
    let causes = causes(of);
    let (moved, why) = match causes.is_empty() {
        true => (Moved::Shading, "its inputs take nothing, so its shading does".to_owned()),
        false => (Moved::Material, causes.join(", ")),
    };
    let varies = spread.iter().any(|spread| *spread > SAME);
    let varying = if varies { format!(" +- {}", plain(spread.into_iter().fold(0.0, f64::max))) } else { String::new() };
    let share = vector(&mean) + &varying;
    let text = format!("{} returns {share} of the light{made_of}: {why}", material(&of.name));
    Some(Finding { moved, material: Some(of.name.clone()), quantities: vec![RETURNED.into()], text })
}

/// Inputs that take light or make some, in words.
fn causes(of: &MaterialIngredients) -> Vec<String> {
    let mean = |input: Input| of.quantity(input.name()).map_or([0.0; 3], |quantity| quantity.mean);
    let is_below = |values: [f64; 3]| values.iter().any(|value| *value < 1.0 - SAME);
    let [color, occlusion, emissive, alpha] =
        [Input::BaseColor, Input::Occlusion, Input::Emissive, Input::Alpha].map(mean);
    let causes = [
        (is_below(color), format!("its base-color of {} is not white", vector(&color))),
        (is_below(occlusion), format!("its occlusion of {} takes light", vector(&occlusion))),
        (emissive != [0.0; 3], format!("it emits {} cd/m2", vector(&emissive))),
        (is_below(alpha), format!("its alpha of {} lets light through", vector(&alpha))),
    ];
    causes.into_iter().filter(|(is_so, _)| *is_so).map(|(_, text)| text).collect()
}

#[cfg(test)]
mod tests {
    use super::super::Quantity;
    use super::*;

    fn said(changes: &[(&str, f64, f64)]) -> Vec<(Moved, String)> {
        let mut quantities: Vec<(&str, f64, f64)> = vec![
            ("base-color", 1.0, 0.0),
            ("occlusion", 1.0, 0.0),
            ("alpha", 1.0, 0.0),
            ("ibl-diffuse", 0.9, 0.0),
            ("ibl-specular", 0.1, 0.0),
            (RETURNED, 1.0, 0.0),
        ];
        quantities.retain(|(name, ..)| !changes.iter().any(|(other, ..)| name == other));
        let quantities = quantities.iter().chain(changes).map(|&(name, mean, spread)| Quantity {
            name: name.into(),
            mean: [mean; 3],
            spread: [spread; 3],
            sketch: None,
        });
        let paint = MaterialIngredients {
            name: "paint".into(),
            pixels: 10,
            measured: 10,
            center_px: [0.0; 2],
            textures: Vec::new(),
            quantities: quantities.collect(),
        };
        let of = Ingredients { size_px: [8, 8], scale: 1.0, lights: Vec::new(), materials: vec![paint], left_out: 0 };
        findings_in_furnace(&of, 0.005).into_iter().map(|finding| (finding.moved, finding.text)).collect()
    }

    #[test]
    fn what_takes_light_is_named() {
        let text = "material \"paint\" returns 0.900 of the light (ibl-specular".replace("ibl-", "");
        let found = said(&[(RETURNED, 0.9, 0.0), ("base-color", 0.9, 0.0), ("ibl-diffuse", 0.8, 0.0)]);
        assert!(found[0].0 == Moved::Material && found[0].1.starts_with(&text), "{found:?}");
        assert!(found[0].1.ends_with("diffuse 0.800): its base-color of 0.900 is not white"), "{found:?}");
        let found = said(&[(RETURNED, 1.0, 0.02)]);
        assert!(found[0].0 == Moved::Shading && found[0].1.contains("1.000 +- 0.020 of the light"), "{found:?}");
        assert!(found[0].1.ends_with("its inputs take nothing, so its shading does"), "{found:?}");
        let found = said(&[(RETURNED, 1.5, 0.0), ("emissive", 0.5, 0.0), ("occlusion", 0.5, 0.0), ("alpha", 0.5, 0.0)]);
        assert!(
            found[0].1.ends_with("takes light, it emits 0.500 cd/m2, its alpha of 0.500 lets light through"),
            "{found:?}"
        );
        assert_eq!(said(&[])[0].0, Moved::Geometry);
        let found = said(&[("nan", 0.25, 0.0)]);
        assert_eq!(
            found[0],
            (
                Moved::Fault,
                "material \"paint\": radiance is NaN in 25 % and infinite in 25 % and negative in 25 % of its pixels"
                    .into()
            )
        );
    }
}
