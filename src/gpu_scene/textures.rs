//! Images and samplers of materials, each made once.

use super::mips::{self, Role};
use crate::frame::Drawables;
use crate::gpu::formats;
use crate::scene::{AlphaMode, Image, Material, Pixels, Sampler, Scene, TextureSlot, Wrap};
use crate::shader::{MaterialFeatures, SceneFeatures};
use rayon::prelude::*;
use std::collections::{BTreeSet, HashMap};

/// A texture: the image, what its channels mean, and whether it has smaller levels.
pub(super) type TextureKey = (usize, Role, bool);

/// The levels of all textures that a scene draws with, made on all cores. They share the texels of the scene's images.
#[derive(Debug)]
pub struct TextureLevels {
    levels: HashMap<TextureKey, Vec<mips::Level>>,
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
        let levels = |&key: &TextureKey| (key, mips::chain(&scene.images[key.0], key.1, key.2, max_side));
        Self { levels: keys.par_iter().map(levels).collect() }
    }
}

/// The textures that draws of a material with `features` read, in the order of their bindings.
pub(super) fn textures_of(scene: &Scene, material: &Material, features: &MaterialFeatures) -> Vec<TextureKey> {
    let used = features.textures().filter_map(|(slot, _)| Some((slot, material.texture(slot)?.texture)));
    let key = |(slot, texture): (TextureSlot, usize)| {
        let texture = scene.textures[texture];
        (texture.image, role(slot, material), texture.sampler.mip_linear.is_some())
    };
    used.map(key).collect()
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
    levels: TextureLevels,
    views: HashMap<TextureKey, wgpu::TextureView>,
    samplers: HashMap<Sampler, wgpu::Sampler>,
    pub(super) bytes: u64,
    pub(super) warnings: Vec<String>,
}

impl TextureCache {
    pub(super) fn new(levels: TextureLevels) -> Self {
        Self { levels, views: HashMap::new(), samplers: HashMap::new(), bytes: 0, warnings: Vec::new() }
    }

    /// Lets go of levels that nothing has used.
    pub(super) fn forget_levels(&mut self) {
        self.levels.levels.clear();
    }

    /// The image `index` of the scene in one role, uploaded at its first use.
    pub(super) fn view(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        key: TextureKey,
    ) -> wgpu::TextureView {
        if let Some(view) = self.views.get(&key) {
            return view.clone();
        }
        let (index, role, mipmapped) = key;
        let image = &scene.images[index];
        let max_side = device.limits().max_texture_dimension_2d;
        if image.width.max(image.height) > max_side {
            let Image { width, height, .. } = image;
            let message = format!("image {index} is {width} x {height}; this device draws it at {max_side} at most");
            self.warnings.push(message);
        }
        let levels = self.levels.levels.remove(&key);
        let levels = levels.unwrap_or_else(|| mips::chain(image, role, mipmapped, max_side));
        let texture = upload(device, queue, image, role, &levels);
        // What is on its way is in memory once more, until the device has it and a later submission finds that.
        queue.submit([]);
        self.bytes += (0..texture.mip_level_count())
            .map(|level| u64::from((texture.width() >> level).max(1)) * u64::from((texture.height() >> level).max(1)))
            .sum::<u64>()
            * u64::from(texture.format().block_copy_size(None).unwrap_or(0));
        let view = texture.create_view(&Default::default());
        self.views.insert(key, view.clone());
        view
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

fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    image: &Image,
    role: Role,
    levels: &[mips::Level],
) -> wgpu::Texture {
    let format = match image.pixels {
        Pixels::Rgba16(_) => formats::DEEP_TEXTURE,
        Pixels::Rgba8(_) if role == Role::Normal => formats::NORMAL_TEXTURE,
        Pixels::Rgba8(_) if role.is_srgb() => formats::COLOR_TEXTURE,
        Pixels::Rgba8(_) => formats::DATA_TEXTURE,
    };
    let extent =
        |level: &mips::Level| wgpu::Extent3d { width: level.width, height: level.height, depth_or_array_layers: 1 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: image.name.as_deref(),
        size: extent(&levels[0]),
        mip_level_count: levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (index, level) in levels.iter().enumerate() {
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(level.bytes.len() as u32 / level.height),
            rows_per_image: None,
        };
        let target = wgpu::TexelCopyTextureInfo { mip_level: index as u32, ..texture.as_image_copy() };
        queue.write_texture(target, &level.bytes, layout, extent(level));
    }
    texture
}
