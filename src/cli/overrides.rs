//! `--override`: numbers of materials set from the command line.

use super::error::CliError;
use super::glob::matches;
use crate::math::color::linear_from_srgb;
use crate::scene::{Disney, Material, Scene, TextureSlot};
use glam::Vec3;

/// Applies every `NAME.PARAMETER=VALUE` in order. NAME is a material's name or index, `*` stands for any text.
///
/// A value replaces the texture of its slot too: what is asked for is what is seen. Metallic and perceptual roughness
/// share a texture, and either replaces it. A `disney.*` parameter makes a Disney material of one that is none.
///
/// # Errors
/// One line with the override and what is wrong: no such material, no such parameter, or a value out of range.
pub(super) fn apply(scene: &mut Scene, overrides: &[String]) -> Result<(), CliError> {
    overrides.iter().try_for_each(|text| {
        apply_one(scene, text).map_err(|problem| CliError::Usage(format!("--override \"{text}\": {problem}")))
    })
}

fn apply_one(scene: &mut Scene, text: &str) -> Result<(), String> {
    let form = "expected NAME.PARAMETER=VALUE, such as \"*.disney.sheen=0.5\"";
    let (path, value) = text.split_once('=').ok_or(form)?;
    let (pattern, parameter) = path.rsplit_once('.').ok_or(form)?;
    let (pattern, parameter) = match pattern.strip_suffix(".disney") {
        Some(pattern) => (pattern, format!("disney.{parameter}")),
        None => (pattern, parameter.to_owned()),
    };
    let mut found = false;
    for (index, material) in scene.materials.iter_mut().enumerate() {
        if matches(pattern, material.name.as_deref().unwrap_or_default()) || pattern == index.to_string() {
            set(material, &parameter, value)?;
            found = true;
        }
    }
    if found { Ok(()) } else { Err(unknown_material(scene, pattern)) }
}

fn unknown_material(scene: &Scene, pattern: &str) -> String {
    let names: Vec<&str> = scene.materials.iter().filter_map(|material| material.name.as_deref()).take(8).collect();
    let count = scene.materials.len();
    format!("no material is called `{pattern}`; there are {count}, among them {}", names.join(", "))
}

/// Sets one parameter. Leaves the material as it was on an error.
fn set(material: &mut Material, parameter: &str, value: &str) -> Result<(), String> {
    if let Some(name) = parameter.strip_prefix("disney.") {
        let mut disney = material.disney.unwrap_or_default();
        let names = || format!("no parameter is called disney.{name}; there are {}", Disney::NAMES.join(", "));
        *disney.parameter_mut(name).ok_or_else(names)? = number(value, 0.0, 1.0)?;
        material.disney = Some(disney);
        return Ok(());
    }
    let slot = match parameter {
        "base_color" => {
            material.base_color = color(value)?.extend(material.base_color.w);
            TextureSlot::BaseColor
        }
        "metallic" => {
            material.metallic = number(value, 0.0, 1.0)?;
            TextureSlot::MetallicRoughness
        }
        "perceptual_roughness" => {
            material.perceptual_roughness = number(value, 0.0, 1.0)?;
            TextureSlot::MetallicRoughness
        }
        "specular" => {
            material.specular = number(value, 0.0, 1.0)?;
            TextureSlot::Specular
        }
        "specular_color" => {
            material.specular_color = color(value)?;
            TextureSlot::SpecularColor
        }
        "ior" => {
            material.ior = number(value, 1.0, f32::MAX)?;
            return Ok(());
        }
        _ => {
            return Err(format!(
                "no parameter is called `{parameter}`; there are base_color, metallic, perceptual_roughness, \
                 specular, specular_color, ior, and disney.{}",
                Disney::NAMES.join(", disney.")
            ));
        }
    };
    material.set_texture(slot, None);
    Ok(())
}

fn number(text: &str, least: f32, most: f32) -> Result<f32, String> {
    let range = if most == f32::MAX { format!("from {least} up") } else { format!("from {least} to {most}") };
    let value = text.trim().parse().ok().filter(|value: &f32| (least..=most).contains(value));
    value.ok_or_else(|| format!("`{text}` is not a number {range}"))
}

/// `#rrggbb` in sRGB, or three linear numbers in [0, 1].
fn color(text: &str) -> Result<Vec3, String> {
    if let Some(digits) = text.strip_prefix('#') {
        let code = Some(digits).filter(|digits| digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit()));
        let code = code.and_then(|digits| u32::from_str_radix(digits, 16).ok());
        let [_, r, g, b] = code.ok_or_else(|| format!("`{text}` is not a colour #rrggbb"))?.to_be_bytes();
        return Ok(Vec3::from_array([r, g, b].map(|code| linear_from_srgb(f64::from(code) / 255.0) as f32)));
    }
    let channels = text.split(',').map(|part| number(part, 0.0, 1.0)).collect::<Result<Vec<f32>, String>>()?;
    let channels: [f32; 3] = channels.try_into().map_err(|_| format!("`{text}` is neither #rrggbb nor r,g,b"))?;
    Ok(Vec3::from_array(channels))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{TextureRef, UvTransform};

    fn scene() -> Scene {
        let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::IDENTITY };
        let material = |name: &str| {
            let mut material = Material { name: Some(name.to_owned()), ..Material::default() };
            material.set_texture(TextureSlot::MetallicRoughness, Some(texture));
            material.set_texture(TextureSlot::BaseColor, Some(texture));
            material
        };
        Scene { materials: vec![material("Helmet"), material("Glass.front"), material("Glass")], ..Scene::default() }
    }

    fn applied(text: &str) -> Result<Vec<Material>, String> {
        let mut scene = scene();
        apply(&mut scene, &[text.to_owned()]).map_err(|error| error.to_string())?;
        Ok(scene.materials)
    }

    #[test]
    fn values_replace_numbers_and_their_textures() {
        let materials = applied("Helmet.perceptual_roughness=0.3").unwrap();
        assert_eq!(materials[0].perceptual_roughness, 0.3);
        assert_eq!(materials[0].texture(TextureSlot::MetallicRoughness), None);
        assert!(materials[0].texture(TextureSlot::BaseColor).is_some());
        assert_eq!(materials[1..], scene().materials[1..]);
        let materials = applied("1.base_color=#ff0000").unwrap();
        assert_eq!(materials[1].base_color.truncate(), Vec3::X);
        assert_eq!(applied("Helmet.base_color=0.1,0.2,0.3").unwrap()[0].base_color.y, 0.2);
    }

    #[test]
    fn names_may_have_dots_and_stars() {
        let metals = |text| applied(text).unwrap().iter().map(|material| material.metallic).collect::<Vec<_>>();
        assert_eq!(metals("Glass.front.metallic=0"), [1.0, 0.0, 1.0]);
        assert_eq!(metals("Glass*.metallic=0"), [1.0, 0.0, 0.0]);
        assert_eq!(metals("*.metallic=0.5"), [0.5; 3]);
        assert_eq!(metals("*l*s*.metallic=0"), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn a_disney_parameter_makes_a_disney_material() {
        let materials = applied("Glass.disney.sheen=0.5").unwrap();
        assert_eq!(materials[2].disney, Some(Disney { sheen: 0.5, ..Disney::default() }));
        assert_eq!(materials[0].disney, None);
    }

    #[test]
    fn mistakes_are_named() {
        for (text, problem) in [
            ("Visor.metallic=1", "no material is called `Visor`; there are 3, among them Helmet, Glass.front, Glass"),
            ("Helmet.shininess=1", "no parameter is called `shininess`"),
            ("*.disney.gloss=1", "no parameter is called disney.gloss"),
            ("*.metallic=2", "`2` is not a number from 0 to 1"),
            ("*.metallic=NaN", "`NaN` is not a number"),
            ("*.disney.sheen=", "`` is not a number"),
            ("*.ior=0.5", "from 1 up"),
            ("*.base_color=#12345", "`#12345` is not a colour"),
            ("*.base_color=1,2", "`2` is not a number from 0 to 1"),
            ("*.base_color=1,0", "neither #rrggbb nor r,g,b"),
            ("metallic=1", "expected NAME.PARAMETER=VALUE"),
            ("*.metallic", "expected NAME.PARAMETER=VALUE"),
        ] {
            let error = applied(text).unwrap_err();
            assert!(error.contains(problem) && error.contains(text) && !error.contains('\n'), "{text}: {error}");
        }
    }
}
