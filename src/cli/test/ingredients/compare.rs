//! What has moved between two pictures, from their ingredients.

use super::gather::{FAULTS, FROM_LIGHTS, FROM_SURROUNDINGS, SURROUNDINGS};
use super::moves::{Class, Move, class, is_in_motion, moves};
use super::words::{material, said, shares_at_fault, shift};
use super::{Finding, Ingredients, MaterialIngredients, Moved, Quantity, TextureHash};

/// More findings than these are counted.
const MOST: usize = 12;

/// A material that is seen in both pictures.
struct Both<'a> {
    then: &'a MaterialIngredients,
    now: &'a MaterialIngredients,
    moves: Vec<Move>,
}

/// What has moved, causes before what follows from them; never nothing.
pub(in crate::cli::test) fn findings(then: &Ingredients, now: &Ingredients) -> Vec<Finding> {
    if then.size_px != now.size_px {
        return vec![Finding::unknown("pictures of other sizes are not compared by what they are made of")];
    }
    let (both, mut found) = paired(then, now);
    let is_new = |both: &&Both<'_>| !both.of(Class::Fault).is_empty();
    let mut all: Vec<Finding> =
        both.iter().filter(is_new).filter_map(|both| fault(both.now, both.now.quantity(FAULTS)?)).collect();
    found.extend(geometry(&both, now.scale, found.is_empty()));
    all.append(&mut found);
    let others = other_lights(then, now);
    all.extend(both.iter().filter_map(|both| inputs(both, &others)));
    all.extend(lights(&others, &both));
    // Geometry and inputs explain the light of their own material alone.
    all.extend(both.iter().filter_map(|both| shading(both, &others)));
    if all.is_empty() {
        all.push(Finding {
            moved: Moved::Display,
            material: None,
            quantities: Vec::new(),
            text:
                "geometry, materials, lights and all parts of the light are the same: what comes after them has moved \
                   (antialiasing, background, exposure, tone map, encoding)"
                    .into(),
        });
    }
    at_most(all)
}

/// The first of them, and how many more there are.
pub(super) fn at_most(mut all: Vec<Finding>) -> Vec<Finding> {
    if all.len() > MOST {
        let more = all.len() - MOST + 1;
        all.truncate(MOST - 1);
        all.push(Finding::unknown(format!("and {more} more findings like these")));
    }
    all
}

/// Materials that are seen in both, most of the picture first, and findings of those that are seen in one.
fn paired<'a>(then: &'a Ingredients, now: &'a Ingredients) -> (Vec<Both<'a>>, Vec<Finding>) {
    let mut left: Vec<&MaterialIngredients> = then.materials.iter().collect();
    let (mut both, mut found) = (Vec::new(), Vec::new());
    let in_dark = then.lights.is_empty() || now.lights.is_empty();
    for now in &now.materials {
        // Of equal names the first is the first again.
        match left.iter().position(|then| then.name == now.name) {
            Some(place) => {
                let then = left.remove(place);
                both.push(Both { then, now, moves: moves(then, now, in_dark) });
            }
            // It may be among those of which nothing was kept.
            None if then.left_out > 0 => {}
            None => found.push(seen(now, "is seen, and was not")),
        }
    }
    if now.left_out == 0 {
        found.extend(left.iter().map(|gone| seen(gone, "was seen, and is not")));
    }
    both.sort_by_key(|both| std::cmp::Reverse(both.now.pixels));
    (both, found)
}

fn seen(of: &MaterialIngredients, what: &str) -> Finding {
    finding(Moved::Geometry, of, &[], format!("{} {what}", material(&of.name)))
}

fn finding(moved: Moved, of: &MaterialIngredients, moves: &[&Move], text: String) -> Finding {
    let quantities = moves.iter().map(|found| found.name.clone()).collect();
    Finding { moved, material: Some(of.name.clone()), quantities, text }
}

impl Both<'_> {
    fn of(&self, wanted: Class) -> Vec<&Move> {
        self.moves.iter().filter(|found| class(&found.name) == wanted).collect()
    }

    fn is_in_motion(&self) -> bool {
        is_in_motion(self.then, self.now)
    }

    /// Textures that are gone, new or of another content, in words.
    fn textures(&self) -> Vec<String> {
        let in_slot = |of: &MaterialIngredients, slot: &str| of.textures.iter().any(|texture| texture.slot == slot);
        let [then, now] = [&self.then.textures, &self.now.textures];
        let new = now.iter().filter(|texture| !then.contains(texture)).map(|TextureHash { slot, .. }| {
            if in_slot(self.then, slot) { format!("another {slot} texture") } else { format!("a {slot} texture now") }
        });
        let gone = then.iter().filter(|texture| !in_slot(self.now, &texture.slot));
        new.chain(gone.map(|texture| format!("no {} texture any more", texture.slot))).collect()
    }

    /// Light that has moved, but for that of lights which are not as they were.
    fn light(&self, others: &[OtherLight<'_>]) -> Vec<&Move> {
        let mut moves = self.of(Class::Light);
        moves.retain(|found| !others.iter().any(|other| found.name.starts_with(other.prefix())));
        moves
    }

    /// Whether what the light is made from has moved.
    fn has_cause(&self) -> bool {
        let has = |wanted| !self.of(wanted).is_empty();
        self.is_in_motion() || has(Class::Geometry) || has(Class::Input) || has(Class::Fault)
    }
}

fn list(moves: &[&Move]) -> String {
    moves.iter().map(|found| said(found)).collect::<Vec<_>>().join(", ")
}

/// Radiance that is at fault, by the shares of a material's pixels; none where there is no fault.
pub(super) fn fault(of: &MaterialIngredients, shares: &Quantity) -> Option<Finding> {
    let name = material(&of.name);
    (shares.mean != [0.0; 3]).then(|| Finding {
        moved: Moved::Fault,
        material: Some(of.name.clone()),
        quantities: vec![FAULTS.into()],
        text: format!("{name}: {}", shares_at_fault(&shares.mean)),
    })
}

/// What is elsewhere in the picture; one finding where all of it has gone the same way.
fn geometry(both: &[Both<'_>], scale: f64, all_are_seen: bool) -> Vec<Finding> {
    let moving: Vec<&Both<'_>> = both.iter().filter(|both| both.is_in_motion()).collect();
    let shift_of = |both: &Both<'_>| [0, 1].map(|axis| (both.now.center_px[axis] - both.then.center_px[axis]) * scale);
    let mut found = Vec::new();
    let first = moving.first().map(|first| shift_of(first));
    let goes_along = |both: &&Both<'_>| {
        let [then, now] = [both.then.pixels, both.now.pixels].map(f64::from);
        let along = first.is_some_and(|first| first.iter().zip(shift_of(both)).all(|(a, b)| (a - b).abs() < 0.1));
        along && (now / then - 1.0).abs() < 0.02
    };
    let is_one = all_are_seen && moving.len() == both.len() && moving.iter().all(goes_along);
    if let Some(by) = first.filter(|_| is_one) {
        let text = format!("all that is seen has moved by {}: the camera, or the model as a whole", shift(by));
        found.push(Finding { moved: Moved::Geometry, material: None, quantities: Vec::new(), text });
    } else {
        found.extend(moving.iter().map(|both| {
            let [then, now] = [both.then.pixels, both.now.pixels].map(|pixels| f64::from(pixels) * scale * scale);
            let name = material(&both.now.name);
            let by = shift(shift_of(both));
            let text = format!("{name}: seen in {now:.0} pixels instead of {then:.0}, in the mean {by}");
            finding(Moved::Geometry, both.now, &[], text)
        }));
    }
    let in_place = both.iter().map(|both| (both, both.of(Class::Geometry))).filter(|(_, moves)| !moves.is_empty());
    found.extend(in_place.map(|(both, moves)| {
        finding(Moved::Geometry, both.now, &moves, format!("{}: {}", material(&both.now.name), list(&moves)))
    }));
    found
}

/// What shading reads of the material, and the light that follows from it.
fn inputs(both: &Both<'_>, others: &[OtherLight<'_>]) -> Option<Finding> {
    let (moves, textures) = (both.of(Class::Input), both.textures());
    if moves.is_empty() && textures.is_empty() {
        return None;
    }
    let mut text: Vec<String> = moves.iter().map(|found| said(found)).chain(textures).collect();
    let lights = both.light(others);
    if !lights.is_empty() {
        text.push(format!("and so {}", list(&lights)));
    }
    Some(finding(Moved::Material, both.now, &moves, format!("{}: {}", material(&both.now.name), text.join(", "))))
}

/// Light that has moved though nothing else of the material has.
fn shading(both: &Both<'_>, others: &[OtherLight<'_>]) -> Option<Finding> {
    let lights = both.light(others);
    if lights.is_empty() || both.has_cause() {
        return None;
    }
    let text = format!(
        "{}: {}; its inputs and the lights are the same, so its shading is not",
        material(&both.now.name),
        list(&lights)
    );
    Some(finding(Moved::Shading, both.now, &lights, text))
}

/// A light that is not as it was: gone, new or another.
struct OtherLight<'a> {
    then: Option<&'a String>,
    now: Option<&'a String>,
}

impl OtherLight<'_> {
    /// How the names of its parts of the light begin.
    fn prefix(&self) -> &'static str {
        let is_environment = self.then.or(self.now).is_some_and(|light| light.starts_with(SURROUNDINGS));
        if is_environment { FROM_SURROUNDINGS } else { FROM_LIGHTS }
    }
}

/// Lights that are not as they were; of one kind the first that is gone has become the first that is new.
fn other_lights<'a>(then: &'a Ingredients, now: &'a Ingredients) -> Vec<OtherLight<'a>> {
    let mut gone: Vec<&String> = then.lights.iter().collect();
    let is_new = |light: &&String| match gone.iter().position(|other| other == light) {
        Some(place) => {
            gone.remove(place);
            false
        }
        None => true,
    };
    let new: Vec<&String> = now.lights.iter().filter(is_new).collect();
    let kind = |light: &String| light.split(' ').next().map(str::to_owned);
    let mut others = Vec::new();
    for now in new {
        let place = gone.iter().position(|then| kind(then) == kind(now));
        others.push(OtherLight { then: place.map(|place| gone.remove(place)), now: Some(now) });
    }
    others.extend(gone.into_iter().map(|then| OtherLight { then: Some(then), now: None }));
    others
}

fn lights(others: &[OtherLight<'_>], both: &[Both<'_>]) -> Vec<Finding> {
    let finding = |other: &OtherLight<'_>| {
        let mut quantities: Vec<String> = Vec::new();
        for found in both.iter().flat_map(|both| both.of(Class::Light)) {
            if found.name.starts_with(other.prefix()) && !quantities.contains(&found.name) {
                quantities.push(found.name.clone());
            }
        }
        let what = match (other.then, other.now) {
            (Some(then), Some(now)) => format!("{now}, instead of {then}"),
            (Some(then), None) => format!("no longer there: {then}"),
            (None, now) => format!("not there before: {}", now.map_or("", String::as_str)),
        };
        let follows =
            if quantities.is_empty() { String::new() } else { format!("; with it {}", quantities.join(", ")) };
        Finding { moved: Moved::Lights, material: None, quantities, text: format!("{what}{follows}") }
    };
    others.iter().map(finding).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quantity(name: &str, value: f64) -> Quantity {
        Quantity { name: name.into(), mean: [value; 3], spread: [0.0; 3], sketch: None }
    }

    fn material(name: &str, quantities: &[(&str, f64)]) -> MaterialIngredients {
        MaterialIngredients {
            name: name.into(),
            pixels: 100,
            measured: 80,
            center_px: [32.0, 16.0],
            textures: vec![TextureHash { slot: "normal".into(), hash: "0f".into() }],
            quantities: quantities.iter().map(|(name, value)| quantity(name, *value)).collect(),
        }
    }

    const PAINT: [(&str, f64); 7] = [
        ("coverage", 1.0),
        ("depth", 2.0),
        ("position", 1.0),
        ("perceptual-roughness", 0.5),
        ("alphas", 0.25),
        ("ibl-diffuse", 1.0),
        ("ibl-specular", 0.5),
    ];

    fn picture() -> Ingredients {
        Ingredients {
            size_px: [64, 32],
            scale: 2.0,
            lights: vec!["environment neutral".into(), "point light A".into(), "point light B".into()],
            materials: vec![material("paint", &PAINT), material("paint", &PAINT), material("glass", &PAINT)],
            left_out: 0,
        }
    }

    /// What is said once a change has been made.
    fn said(change: impl Fn(&mut Ingredients)) -> Vec<(Moved, String)> {
        let (then, mut now) = (picture(), picture());
        change(&mut now);
        findings(&then, &now).into_iter().map(|finding| (finding.moved, finding.text)).collect()
    }

    fn set(of: &mut MaterialIngredients, name: &str, value: f64) {
        let place = of.quantities.iter().position(|quantity| quantity.name == name).unwrap();
        of.quantities[place] = quantity(name, value);
    }

    #[test]
    fn causes_are_told_and_what_follows_is_not() {
        let found = said(|now| {
            let paint = &mut now.materials[1];
            set(paint, "perceptual-roughness", 0.6);
            set(paint, "alphas", 0.36);
            set(paint, "ibl-specular", 0.4);
        });
        let text = "material \"paint\": perceptual-roughness 0.500 -> 0.600, and so ibl-specular -20 %";
        assert_eq!(found, [(Moved::Material, text.into())]);
        // Alphas alone are another matter.
        let found = said(|now| set(&mut now.materials[0], "alphas", 0.3));
        assert_eq!(found, [(Moved::Material, "material \"paint\": alphas 0.250 -> 0.300".into())]);
        let found = said(|now| set(&mut now.materials[0], "ibl-diffuse", 1.2));
        assert!(
            found.len() == 1 && found[0].0 == Moved::Shading && found[0].1.contains("ibl-diffuse +20 %"),
            "{found:?}"
        );
        let found = said(|now| now.materials[2].textures.clear());
        assert_eq!(found, [(Moved::Material, "material \"glass\": no normal texture any more".into())]);
    }

    #[test]
    fn little_is_nothing() {
        assert_eq!(said(|_| {})[0].0, Moved::Display);
        assert_eq!(said(|now| set(&mut now.materials[0], "alphas", 0.2502))[0].0, Moved::Display);
        let faint = |now: &mut Ingredients| now.materials[0].quantities.push(quantity("direct-specular", 1e-3));
        assert_eq!(said(faint)[0].0, Moved::Display);
    }

    #[test]
    fn lights_are_told_with_their_own_light() {
        let found = said(|now| {
            now.lights = vec!["environment neutral".into(), "point light C".into()];
            set(&mut now.materials[0], "ibl-diffuse", 0.5);
            now.materials[0].quantities.push(quantity("direct-diffuse", 0.7));
        });
        let texts: Vec<&str> = found.iter().map(|(_, text)| text.as_str()).collect();
        assert!(texts[0].starts_with("point light C, instead of point light A; with it direct-diffuse"), "{texts:?}");
        assert!(texts[1].starts_with("no longer there: point light B"), "{texts:?}");
        // The environment has not changed: what it lights has.
        assert!(found[2].0 == Moved::Shading && texts[2].contains("ibl-diffuse -50 %"), "{texts:?}");
        let dark = said(|now| {
            now.lights.clear();
            now.materials.iter_mut().for_each(|material| set(material, "perceptual-roughness", 1.0));
        });
        assert!(dark.len() == 3 && dark.iter().all(|(moved, _)| *moved == Moved::Lights), "{dark:?}");
    }

    #[test]
    fn geometry_is_of_one_material_or_of_all() {
        let right = |of: &mut MaterialIngredients| of.center_px[0] += 0.5;
        let found = said(|now| now.materials.iter_mut().for_each(right));
        assert!(found.len() == 1 && found[0].1.contains("moved by +1.00 pixels to the right"), "{found:?}");
        let found = said(|now| right(&mut now.materials[2]));
        assert!(found.len() == 1 && found[0].1.starts_with("material \"glass\": seen in 400 pixels"), "{found:?}");
        let found = said(|now| set(&mut now.materials[2], "position", 1.5));
        assert_eq!(found, [(Moved::Geometry, "material \"glass\": position 1.000 -> 1.500 m".into())]);
        let found = said(|now| drop(now.materials.remove(2)));
        assert_eq!(found, [(Moved::Geometry, "material \"glass\" was seen, and is not".into())]);
        let found = said(|now| now.materials[0].name = "varnish".into());
        assert_eq!(found.len(), 2, "{found:?}");
    }

    #[test]
    fn what_is_not_ours_is_not_compared() {
        assert_eq!(said(|now| now.size_px = [32, 32])[0].0, Moved::Unknown);
        // Materials that are gone may be among those of which nothing is kept.
        let found = said(|now| {
            now.left_out = 1;
            now.materials.remove(2);
        });
        assert_eq!(found[0].0, Moved::Display);
        let many = said(|now| {
            let some = |index| MaterialIngredients { name: format!("m{index}"), ..material("", &PAINT) };
            now.materials.extend((0..30).map(some));
        });
        assert!(many.len() == MOST && many[MOST - 1].1.contains("and 19 more"), "{many:?}");
    }
}
