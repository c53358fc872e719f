//! Images and samplers of materials, each made once.

use super::UploadError;
use super::mips::{self, Role};
use super::packing::with_red_of;
use crate::frame::Drawables;
use crate::gpu::{Staging, formats};
use crate::scene::{AlphaMode, Image, Material, Pixels, Sampler, Scene, Texture, TextureSlot, Wrap};
use crate::shader::{MaterialFeatures, SceneFeatures};
use crate::threads::*;
use std::collections::{BTreeSet, HashMap};

/// What tells a texture from others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct TextureKey {
    /// Index into the scene's images.
    image: usize,
    /// Another image, of the same layout, whose R it has in place of its own.
    red: Option<usize>,
    role: Role,
    /// Whether it has smaller levels.
    mipmapped: bool,
}

impl TextureKey {
    fn levels(self, scene: &Scene, max_side: u32) -> Vec<mips::Level> {
        let image = &scene.images[self.image];
        let packed = self.red.map(|red| with_red_of(image, &scene.images[red]));
        mips::chain(packed.as_ref().unwrap_or(image), self.role, self.mipmapped, max_side)
    }
}

/// Textures of a host, by the images of the scene that they stand for.
pub type HostTextures = HashMap<usize, wgpu::TextureView>;

/// The levels of all textures that a scene draws with, made on all cores. They share the texels of the scene's images.
#[derive(Debug)]
pub struct TextureLevels {
    levels: HashMap<TextureKey, Vec<mips::Level>>,
    of_host: HostTextures,
}

impl TextureLevels {
    /// For a device that allows textures of `max_side` texels.
    pub fn of(scene: &Scene, max_side: u32) -> Self {
        let drawables = Drawables::new(scene, SceneFeatures::of(scene));
        let keys: BTreeSet<TextureKey> = drawables
            .draws
            .iter()
            .flat_map(|drawable| textures_of(scene, &scene.materials[drawable.material], &drawable.material_features))
            .collect();
        let keys: Vec<TextureKey> = keys.into_iter().collect();
        let levels = keys.par_iter().map(|&key| (key, key.levels(scene, max_side))).collect();
        Self { levels, of_host: HostTextures::new() }
    }

    /// With the textures that are [`Pixels::OfHost`].
    pub fn with_host_textures(self, of_host: HostTextures) -> Self {
        Self { of_host, ..self }
    }
}

/// The textures that draws of a material with `features` read, in the order of their bindings.
pub(super) fn textures_of(scene: &Scene, material: &Material, features: &MaterialFeatures) -> Vec<TextureKey> {
    let texture = |slot| Some(scene.textures[material.texture(slot)?.texture]);
    let occlusion = texture(TextureSlot::Occlusion).filter(|_| features.packed_occlusion);
    let key = |slot, Texture { image, sampler }: Texture| {
        let red = occlusion.filter(|_| slot == TextureSlot::MetallicRoughness).map(|texture| texture.image);
        TextureKey {
            image,
            red: red.filter(|&red| red != image),
            role: role(slot, material),
            mipmapped: sampler.mip_linear.is_some(),
        }
    };
    features.textures().filter_map(|(slot, _)| Some(key(slot, texture(slot)?))).collect()
}

fn role(slot: TextureSlot, material: &Material) -> Role {
    match slot {
        TextureSlot::Normal => Role::Normal,
        TextureSlot::BaseColor if material.alpha_mode != AlphaMode::Opaque => Role::ColorWithCoverage,
        slot if slot.is_srgb() => Role::Color,
        _ => Role::Data,
    }
}

/// Textures and samplers by what tells them apart.
#[derive(Debug)]
pub(super) struct TextureCache {
    levels: HashMap<TextureKey, Vec<mips::Level>>,
    pub(super) of_host: HostTextures,
    views: HashMap<TextureKey, wgpu::TextureView>,
    samplers: HashMap<Sampler, wgpu::Sampler>,
    pub(super) bytes: u64,
    pub(super) warnings: Vec<String>,
}

impl TextureCache {
    pub(super) fn new(levels: TextureLevels) -> Self {
        let TextureLevels { levels, of_host } = levels;
        Self { levels, of_host, views: HashMap::new(), samplers: HashMap::new(), bytes: 0, warnings: Vec::new() }
    }

    /// Lets go of levels that nothing has used.
    pub(super) fn forget_levels(&mut self) {
        self.levels.clear();
    }

    /// The image `index` of the scene in one role, uploaded at its first use.
    pub(super) fn view(
        &mut self,
        staging: &mut Staging<'_>,
        scene: &Scene,
        key: TextureKey,
    ) -> Result<wgpu::TextureView, UploadError> {
        let image = &scene.images[key.image];
        if matches!(image.pixels, Pixels::OfHost) {
            return self.of_host(staging.device, key);
        }
        if let Some(view) = self.views.get(&key) {
            return Ok(view.clone());
        }
        let max_side = staging.device.limits().max_texture_dimension_2d;
        if image.width.max(image.height) > max_side {
            let (Image { width, height, .. }, TextureKey { image, .. }) = (image, key);
            let message = format!("image {image} is {width} x {height}; this device draws it at {max_side} at most");
            self.warnings.push(message);
        }
        let levels = self.levels.remove(&key);
        let levels = levels.unwrap_or_else(|| key.levels(scene, max_side));
        let texture = upload(staging, image, key.role, levels);
        self.bytes += (0..texture.mip_level_count())
            .map(|level| u64::from((texture.width() >> level).max(1)) * u64::from((texture.height() >> level).max(1)))
            .sum::<u64>()
            * u64::from(texture.format().block_copy_size(None).unwrap_or(0));
        let view = texture.create_view(&Default::default());
        self.views.insert(key, view.clone());
        Ok(view)
    }

    fn of_host(
        &self,
        device: &wgpu::Device,
        TextureKey { image, role, .. }: TextureKey,
    ) -> Result<wgpu::TextureView, UploadError> {
        if role == Role::Normal {
            // Ours are moved by half a step, see `formats::NORMAL_TEXTURE`.
            return Err(UploadError::HostTexture { image, what: "a normal map" });
        }
        let view = self.of_host.get(&image).cloned().ok_or(UploadError::NoHostTexture { image })?;
        let sampled = view.texture().format().sample_type(None, Some(device.features()));
        if sampled != Some(wgpu::TextureSampleType::Float { filterable: true }) {
            return Err(UploadError::HostTexture { image, what: "a texture that this device filters" });
        }
        Ok(view)
    }

    pub(super) fn sampler(&mut self, device: &wgpu::Device, sampler: Sampler) -> wgpu::Sampler {
        self.samplers.entry(sampler).or_insert_with(|| device.create_sampler(&descriptor(sampler))).clone()
    }
}

fn descriptor(sampler: Sampler) -> wgpu::SamplerDescriptor<'static> {
    let filter = |linear| if linear { wgpu::FilterMode::Linear } else { wgpu::FilterMode::Nearest };
    let address = |wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::MirroredRepeat => wgpu::AddressMode::MirrorRepeat,
        Wrap::ClampToEdge => wgpu::AddressMode::ClampToEdge,
    };
    let mipmap_filter = match sampler.mip_linear {
        Some(true) => wgpu::MipmapFilterMode::Linear,
        _ => wgpu::MipmapFilterMode::Nearest,
    };
    wgpu::SamplerDescriptor {
        label: Some("material"),
        address_mode_u: address(sampler.wrap_u),
        address_mode_v: address(sampler.wrap_v),
        mag_filter: filter(sampler.mag_linear),
        min_filter: filter(sampler.min_linear),
        mipmap_filter,
        // 0.25 keeps the choice between the two filters: a clamp at 0 would make every sample a magnification.
        lod_max_clamp: if sampler.mip_linear.is_some() { 32.0 } else { 0.25 },
        ..Default::default()
    }
}

/// Uploads the levels, each of which is let go when it is staged.
fn upload(staging: &mut Staging<'_>, image: &Image, role: Role, levels: Vec<mips::Level>) -> wgpu::Texture {
    let format = match image.pixels {
        Pixels::Rgba16(_) => formats::DEEP_TEXTURE,
        Pixels::Rgba8(_) if role == Role::Normal => formats::NORMAL_TEXTURE,
        Pixels::Rgba8(_) if role.is_srgb() => formats::COLOR_TEXTURE,
        Pixels::Rgba8(_) | Pixels::OfHost => formats::DATA_TEXTURE,
    };
    let texture = staging.device.create_texture(&wgpu::TextureDescriptor {
        label: image.name.as_deref(),
        size: wgpu::Extent3d { width: levels[0].width, height: levels[0].height, depth_or_array_layers: 1 },
        mip_level_count: levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (index, level) in levels.into_iter().enumerate() {
        staging.write(&texture, index as u32, &level.bytes.into_codes());
    }
    texture
}
