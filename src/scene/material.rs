//! Surface appearance: metallic-roughness parameters and the textures that modulate them.

use super::Disney;
use glam::{Mat3, Vec2, Vec3, Vec4};

/// How the alpha of the base colour is used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    Opaque,
    /// Below `cutoff` nothing is drawn, at or above it the surface is opaque.
    Mask { cutoff: f32 },
    /// Alpha is coverage; drawn back to front.
    Blend,
}

/// Offset, rotation and scale of texture coordinates (KHR_texture_transform):
/// uv' = translate(offset) * rotate(rotation_rad) * scale(scale) * uv.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UvTransform {
    pub offset: Vec2,
    /// Counter-clockwise in the extension's sense (v points down).
    pub rotation_rad: f32,
    pub scale: Vec2,
}

impl UvTransform {
    pub const IDENTITY: Self = Self { offset: Vec2::ZERO, rotation_rad: 0.0, scale: Vec2::ONE };

    /// The 3x3 matrix that takes (u, v, 1) to the transformed (u', v', 1).
    pub fn matrix(&self) -> Mat3 {
        let (sin, cos) = self.rotation_rad.sin_cos();
        Mat3::from_cols(
            Vec3::new(cos * self.scale.x, -sin * self.scale.x, 0.0),
            Vec3::new(sin * self.scale.y, cos * self.scale.y, 0.0),
            self.offset.extend(1.0),
        )
    }
}

/// A texture as a material uses it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureRef {
    /// Index into [`super::Scene::textures`].
    pub texture: usize,
    /// Index into [`super::Primitive::uvs`]; present in every primitive that has this material.
    pub uv_set: u32,
    pub transform: UvTransform,
}

/// The texture slots of a material.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TextureSlot {
    /// RGBA, sRGB.
    BaseColor,
    /// G: perceptual roughness, B: metallic. Linear.
    MetallicRoughness,
    /// Tangent-space normal, linear, 0.5 is zero.
    Normal,
    /// R, linear.
    Occlusion,
    /// RGB, sRGB.
    Emissive,
    /// A: specular weight, linear.
    Specular,
    /// RGB, sRGB.
    SpecularColor,
    /// RG: direction in tangent space, 0.5 is zero; B: strength. Linear.
    Anisotropy,
}

impl TextureSlot {
    pub const ALL: [Self; 8] = [
        Self::BaseColor,
        Self::MetallicRoughness,
        Self::Normal,
        Self::Occlusion,
        Self::Emissive,
        Self::Specular,
        Self::SpecularColor,
        Self::Anisotropy,
    ];

    /// Whether the colour channels of this slot are stored in sRGB.
    pub fn is_srgb(self) -> bool {
        matches!(self, Self::BaseColor | Self::Emissive | Self::SpecularColor)
    }

    /// The name of the slot in shaders and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::BaseColor => "base_color",
            Self::MetallicRoughness => "metallic_roughness",
            Self::Normal => "normal",
            Self::Occlusion => "occlusion",
            Self::Emissive => "emissive",
            Self::Specular => "specular",
            Self::SpecularColor => "specular_color",
            Self::Anisotropy => "anisotropy",
        }
    }
}

/// The Fresnel curve of a material's metal part. F0 is the base colour in all of them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum MetalFresnel {
    /// F0 + (1 - F0) (1 - cos)^5 (Schlick 1994).
    #[default]
    Schlick,
    /// Schlick's curve less `a` cos (1 - cos)^6 a channel (Lazanyi and Szirmay-Kalos 2005).
    Lazanyi { a: Vec3 },
    /// Exact, from the complex index of refraction `n` + i `k` a channel. `a` is Lazanyi's parameter fitted to it, which
    /// serves where the curve is integrated.
    Conductor { n: Vec3, k: Vec3, a: Vec3 },
}

impl MetalFresnel {
    /// The F82 tint (Kutz et al. 2021): Schlick's curve bent so that it passes through `f82` at 82 degrees, where the
    /// cosine is 1/7. It is Lazanyi's curve with another parameter.
    pub fn f82(f0: Vec3, f82: Vec3) -> Self {
        let cos = 1.0_f32 / 7.0;
        let schlick = f0 + (Vec3::ONE - f0) * (1.0 - cos).powi(5);
        Self::Lazanyi { a: (schlick - f82) / (cos * (1.0 - cos).powi(6)) }
    }
}

/// Parameters of a glTF 2.0 metallic-roughness material with
/// KHR_materials_{anisotropy, emissive_strength, ior, specular, unlit}.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    pub name: Option<String>,
    /// Linear Rec.709 and alpha, each in [0, 1].
    pub base_color: Vec4,
    /// In [0, 1].
    pub metallic: f32,
    /// In [0, 1]; alpha of the NDF is its square.
    pub perceptual_roughness: f32,
    /// Scale of the x and y of the normal texture.
    pub normal_scale: f32,
    /// In [0, 1]; 0 ignores the occlusion texture.
    pub occlusion_strength: f32,
    /// Linear Rec.709, times the emissive strength; cd/m2.
    pub emissive_nits: Vec3,
    /// Index of refraction: 1 or above, or 0 for the fully reflecting interface of KHR_materials_ior.
    pub ior: f32,
    /// Weight of the dielectric specular lobe, in [0, 1].
    pub specular: f32,
    /// Tint of the dielectric F0, 0 or above.
    pub specular_color: Vec3,
    /// In [0, 1]; along the tangent, alpha of the NDF grows to 1 with its square. Needs tangents.
    pub anisotropy_strength: f32,
    /// Turns the direction of anisotropy from the tangent toward the bitangent.
    pub anisotropy_rotation_rad: f32,
    pub metal_fresnel: MetalFresnel,
    pub alpha_mode: AlphaMode,
    pub double_sided: bool,
    /// The base colour is the radiance; no light is evaluated.
    pub unlit: bool,
    /// The Disney BRDF in place of the standard lobes. `ior`, `specular` and `specular_color` have no effect then.
    pub disney: Option<Disney>,
    /// Textures by slot; read them through [`Material::texture`].
    pub texture_slots: [Option<TextureRef>; TextureSlot::ALL.len()],
}

impl Material {
    pub fn texture(&self, slot: TextureSlot) -> Option<&TextureRef> {
        self.texture_slots[slot as usize].as_ref()
    }

    pub fn set_texture(&mut self, slot: TextureSlot, texture: Option<TextureRef>) {
        self.texture_slots[slot as usize] = texture;
    }

    /// The slots that hold a texture.
    pub fn textures(&self) -> impl Iterator<Item = (TextureSlot, &TextureRef)> {
        TextureSlot::ALL.into_iter().filter_map(|slot| Some((slot, self.texture(slot)?)))
    }

    /// Whether the texture of a slot can change a pixel, whatever the geometry and the light.
    pub fn samples(&self, slot: TextureSlot) -> bool {
        let lit = !self.unlit;
        // Disney's parameters for the dielectric reflection have no textures.
        let lit_standard = lit && self.disney.is_none();
        let is_metal = self.metallic == 1.0 && self.texture(TextureSlot::MetallicRoughness).is_none();
        match slot {
            TextureSlot::BaseColor => true,
            TextureSlot::MetallicRoughness | TextureSlot::Normal => lit,
            TextureSlot::Occlusion => lit && self.occlusion_strength > 0.0,
            TextureSlot::Emissive => lit && self.emissive_nits != Vec3::ZERO,
            TextureSlot::Specular | TextureSlot::SpecularColor => lit_standard && self.specular > 0.0 && !is_metal,
            TextureSlot::Anisotropy => lit_standard && self.anisotropy_strength > 0.0,
        }
    }

    /// F0 of the dielectric interface to air before tint and weight: ((ior - 1) / (ior + 1))^2, in [0, 1].
    pub fn dielectric_f0(&self) -> f32 {
        ((self.ior - 1.0) / (self.ior + 1.0)).powi(2)
    }
}

impl Default for Material {
    /// The default material of glTF 2.0.
    fn default() -> Self {
        Self {
            name: None,
            base_color: Vec4::ONE,
            metallic: 1.0,
            perceptual_roughness: 1.0,
            normal_scale: 1.0,
            occlusion_strength: 1.0,
            emissive_nits: Vec3::ZERO,
            ior: 1.5,
            specular: 1.0,
            specular_color: Vec3::ONE,
            anisotropy_strength: 0.0,
            anisotropy_rotation_rad: 0.0,
            metal_fresnel: MetalFresnel::Schlick,
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            disney: None,
            texture_slots: [None; TextureSlot::ALL.len()],
        }
    }
}
