//! The materials of the well-known picture of the Disney BRDF: a row for each parameter, from 0 to 1.

use super::{Disney, Material};
use glam::Vec4;

/// A parameter, and the material that shows it at a value in [0, 1].
pub type Row = (&'static str, fn(value: f32) -> Material);

/// From top to bottom. The base colour of each shows the effect.
pub const ROWS: [Row; 10] = [
    ("subsurface", |subsurface| disney([0.66, 0.33, 0.23], 0.0, 0.6, Disney { subsurface, ..Disney::default() })),
    ("metallic", |metallic| disney([0.92, 0.60, 0.22], metallic, 0.25, Disney::default())),
    ("specular", |specular| disney([0.60, 0.05, 0.06], 0.0, 0.25, Disney { specular, ..Disney::default() })),
    ("specular_tint", |specular_tint| {
        disney([0.05, 0.22, 0.60], 0.0, 0.2, Disney { specular: 1.0, specular_tint, ..Disney::default() })
    }),
    ("perceptual_roughness", |perceptual_roughness| {
        disney([0.10, 0.32, 0.24], 0.0, perceptual_roughness, Disney { specular: 0.7, ..Disney::default() })
    }),
    ("anisotropic", |anisotropic| disney([0.86, 0.68, 0.50], 1.0, 0.4, Disney { anisotropic, ..Disney::default() })),
    ("sheen", |sheen| disney([0.07, 0.015, 0.10], 0.0, 0.9, Disney { specular: 0.2, sheen, ..Disney::default() })),
    ("sheen_tint", |sheen_tint| {
        disney([0.16, 0.02, 0.01], 0.0, 0.9, Disney { specular: 0.2, sheen: 1.0, sheen_tint, ..Disney::default() })
    }),
    ("clearcoat", |clearcoat| {
        disney([0.26, 0.012, 0.02], 0.2, 0.7, Disney { specular: 0.3, clearcoat, ..Disney::default() })
    }),
    ("clearcoat_gloss", |clearcoat_gloss| {
        let disney_only = Disney { specular: 0.3, clearcoat: 1.0, clearcoat_gloss, ..Disney::default() };
        disney([0.02, 0.035, 0.10], 0.2, 0.7, disney_only)
    }),
];

fn disney(base_color: [f32; 3], metallic: f32, perceptual_roughness: f32, disney: Disney) -> Material {
    let base_color = Vec4::new(base_color[0], base_color[1], base_color[2], 1.0);
    Material { base_color, metallic, perceptual_roughness, disney: Some(disney), ..Material::default() }
}
