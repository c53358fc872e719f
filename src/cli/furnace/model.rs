//! Surfaces from the materials of a model.

use super::{Subject, SurfaceKind};
use crate::cli::error::CliError;
use crate::cli::subject::load_model;
use crate::import::ImportOptions;
use crate::math::color::linear_from_srgb;
use crate::reference::bsdf::{Anisotropy, SurfaceMaterial, dielectric_reflectance};
use crate::scene::{Material, Pixels, Scene, TextureSlot};
use glam::{DVec3, DVec4, Vec4Swizzles};
use std::path::Path;

/// Every material of the model: its factors alone and, if it is textured, the corners of what the textures hold, in the
/// parts that no triangle shows too. Vertex colours are left out: they only darken.
pub(super) fn subjects(path: &Path) -> Result<Vec<Subject>, CliError> {
    let imported = load_model(path, &ImportOptions::default())?;
    for warning in &imported.warnings {
        eprintln!("specula: warning: {warning}");
    }
    let scene = &imported.scene;
    let mut subjects = Vec::new();
    for (index, material) in scene.materials.iter().enumerate() {
        let name = material.name.clone().unwrap_or_else(|| format!("material {index}"));
        if material.unlit {
            eprintln!("specula: {name} is unlit: it reflects nothing, and is left out");
        } else {
            subjects.extend(of_material(scene, material, &name));
        }
    }
    if subjects.is_empty() {
        return Err(CliError::Usage(format!("{}: no material reflects light", path.display())));
    }
    Ok(subjects)
}

/// Least and greatest RGBA of a slot's texture, decoded; 1 without one.
fn extent(scene: &Scene, material: &Material, slot: TextureSlot) -> [DVec4; 2] {
    let Some(texture) = material.texture(slot) else { return [DVec4::ONE; 2] };
    let image = &scene.images[scene.textures[texture.texture].image];
    let decode = |value: DVec4| {
        let color = if slot.is_srgb() { value.xyz().map(linear_from_srgb) } else { value.xyz() };
        color.extend(value.w)
    };
    let extent = match &image.pixels {
        Pixels::Rgba8(data) => channels_extent(data).map(|extent| extent / 255.0),
        Pixels::Rgba16(data) => channels_extent(data).map(|extent| extent / 65535.0),
        Pixels::OfHost => [DVec4::ZERO, DVec4::ONE],
    };
    extent.map(decode)
}

/// Least and greatest of each of four interleaved channels.
fn channels_extent<T: Copy + Ord + Default + Into<f64>>(data: &[T]) -> [DVec4; 2] {
    let Some(first) = data.first_chunk::<4>() else { return [DVec4::ONE; 2] };
    let (mut least, mut greatest) = (*first, *first);
    for texel in data.chunks_exact(4) {
        for channel in 0..4 {
            least[channel] = least[channel].min(texel[channel]);
            greatest[channel] = greatest[channel].max(texel[channel]);
        }
    }
    [least, greatest].map(|texel| DVec4::from(texel.map(Into::into)))
}

fn of_material(scene: &Scene, material: &Material, name: &str) -> Vec<Subject> {
    let extent = |slot| extent(scene, material, slot);
    let [least, greatest] = extent(TextureSlot::MetallicRoughness);
    let corner = |what: &str, texture: [DVec4; 4]| {
        let [metallic_roughness, base_color, specular, specular_color] = texture;
        let unit = |value: DVec3| value.clamp(DVec3::ZERO, DVec3::ONE);
        let weight = (f64::from(material.specular) * specular.w).clamp(0.0, 1.0);
        let tint = material.specular_color.as_dvec3() * specular_color.xyz();
        let (dielectric_f0, dielectric_f90) = dielectric_reflectance(f64::from(material.ior), weight, tint);
        let surface = SurfaceMaterial {
            base_color: unit(material.base_color.as_dvec4().xyz() * base_color.xyz()),
            metallic: (f64::from(material.metallic) * metallic_roughness.z).clamp(0.0, 1.0),
            perceptual_roughness: (f64::from(material.perceptual_roughness) * metallic_roughness.y).clamp(0.0, 1.0),
            dielectric_f0,
            dielectric_f90,
            metal_fresnel: material.metal_fresnel,
            anisotropy: (material.anisotropy_strength > 0.0).then(|| Anisotropy {
                tangent: DVec3::X,
                bitangent: DVec3::Y,
                strength: material.anisotropy_strength.into(),
            }),
        };
        let label = format!("{what}: r {:.3}, metallic {:.3}", surface.perceptual_roughness, surface.metallic);
        Subject { group: name.to_owned(), label, surface: SurfaceKind::Standard(surface) }
    };
    let mut subjects = vec![corner("factors", [DVec4::ONE; 4])];
    let brightest =
        [TextureSlot::BaseColor, TextureSlot::Specular, TextureSlot::SpecularColor].map(|slot| extent(slot)[1]);
    for y in [least.y, greatest.y] {
        for z in [least.z, greatest.z] {
            let texel = DVec4::new(1.0, y, z, 1.0);
            let textured = corner("textured", [texel, brightest[0], brightest[1], brightest[2]]);
            if !subjects.iter().any(|other| same_surface(other, &textured)) {
                subjects.push(textured);
            }
        }
    }
    subjects
}

fn same_surface(a: &Subject, b: &Subject) -> bool {
    matches!((&a.surface, &b.surface), (SurfaceKind::Standard(a), SurfaceKind::Standard(b)) if a == b)
}

#[cfg(test)]
mod tests {
    use super::super::check;
    use super::*;
    use crate::import::tests::samples::model as model_file;
    use crate::scene::{Image, Sampler, Texture, TextureRef, UvTransform};

    fn textured() -> (Scene, Material) {
        let image = |texels: [[u8; 4]; 2]| Image {
            name: None,
            width: 2,
            height: 1,
            pixels: Pixels::Rgba8(texels.concat().into()),
        };
        let scene = Scene {
            images: vec![image([[0, 51, 0, 255], [9, 255, 102, 255]]), image([[255, 0, 55, 255], [0, 55, 0, 0]])],
            textures: (0..2).map(|image| Texture { image, sampler: Sampler::default() }).collect(),
            ..Scene::default()
        };
        let mut material = Material { perceptual_roughness: 0.5, ..Material::default() };
        let texture = |texture| Some(TextureRef { texture, uv_set: 0, transform: UvTransform::IDENTITY });
        material.set_texture(TextureSlot::MetallicRoughness, texture(0));
        material.set_texture(TextureSlot::BaseColor, texture(1));
        (scene, material)
    }

    #[test]
    fn textures_are_checked_at_their_corners() {
        let (scene, material) = textured();
        let found: Vec<SurfaceMaterial> = of_material(&scene, &material, "m")
            .into_iter()
            .filter_map(|subject| match subject.surface {
                SurfaceKind::Standard(surface) => Some(surface),
                SurfaceKind::Disney(_) | SurfaceKind::Lobe(_) => None,
            })
            .collect();
        let parameters = |surface: &SurfaceMaterial| (surface.perceptual_roughness, surface.metallic);
        let corners: Vec<_> = found.iter().map(parameters).collect();
        assert_eq!(corners, [(0.5, 1.0), (0.1, 0.0), (0.1, 0.4), (0.5, 0.0), (0.5, 0.4)]);
        assert_eq!(found[0].base_color, DVec3::ONE);
        let decoded = linear_from_srgb(55.0 / 255.0);
        assert!((found[1].base_color - DVec3::new(1.0, decoded, decoded)).length() < 1e-12);
        assert!((found[1].dielectric_f0 - 0.04).abs().max_element() < 1e-7);
    }

    #[test]
    fn corners_that_are_the_same_are_checked_once() {
        assert_eq!(of_material(&Scene::default(), &Material::default(), "m").len(), 1);
    }

    #[test]
    fn the_helmet_obeys_the_laws() {
        let Some(path) = model_file("DamagedHelmet.glb") else { return };
        let checked = check(subjects(&path).unwrap(), true, 2e-3).unwrap();
        assert!(checked.len() > 1);
        for one in checked {
            assert_eq!(one.violations, [], "{:?}", one.subject);
        }
    }
}
