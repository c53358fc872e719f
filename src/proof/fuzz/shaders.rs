//! The shaders that are searched, and the textures that they read.

use super::super::{ProofError, stage};
use crate::bake::{disney, environment};
use crate::gpu::{Gpu, Staging, Uploads, bindings};
use crate::gpu_scene::{GpuEnvironment, SharedTextures};
use crate::progress::Silent;
use crate::renderer::{shared_textures, table};
use crate::scene::{AlphaMode, Disney, Environment, EnvironmentImage, Geometry, Material, MetalFresnel, Quality};
use crate::shader::{ForwardFeatures, FresnelFeature, LightList, SceneFeatures, Shading};
use glam::Vec3;

/// A forward shader that is searched for faults. A feature joins by a line in [`FUZZED`].
#[derive(Debug, Clone, Copy)]
pub struct FuzzedShader {
    pub name: &'static str,
    pub features: fn() -> ForwardFeatures,
    /// Radiance of the sun in the environment.
    pub environment_nits: f32,
}

const LIT: SceneFeatures =
    SceneFeatures { punctual: true, light_list: LightList::All, environment: true, suns: 1, fresnel_tail: true };
const BY_LIGHTS: SceneFeatures =
    SceneFeatures { punctual: true, light_list: LightList::All, environment: false, suns: 0, fresnel_tail: false };

/// All that are searched.
pub const FUZZED: &[FuzzedShader] = &[
    FuzzedShader {
        name: "normal-mapped, lights and environment",
        features: || stage::features(LIT, Material { double_sided: true, ..Default::default() }),
        environment_nits: 1e5,
    },
    FuzzedShader {
        name: "blended, environment of 1e30",
        features: || stage::features(LIT, Material { alpha_mode: AlphaMode::Blend, ..Default::default() }),
        environment_nits: 1e30,
    },
    FuzzedShader {
        name: "vertex normals, single scattering",
        features: || ForwardFeatures {
            energy_compensation: false,
            ..stage::features_without_normal_map(BY_LIGHTS, &Material::default())
        },
        environment_nits: 0.0,
    },
    FuzzedShader {
        name: "anisotropic, Lazanyi's Fresnel",
        features: || {
            let metal_fresnel = MetalFresnel::Lazanyi { a: Vec3::ONE };
            stage::features(LIT, Material { anisotropy_strength: 1.0, metal_fresnel, ..Default::default() })
        },
        environment_nits: 1e5,
    },
    FuzzedShader {
        name: "conductor, separable Smith",
        features: || {
            let metal_fresnel = MetalFresnel::Conductor { n: Vec3::ONE, k: Vec3::ONE, a: Vec3::ONE };
            ForwardFeatures {
                geometry: Geometry::SmithSeparable,
                quality: Quality::High,
                ..stage::features(LIT, Material { metal_fresnel, ..Default::default() })
            }
        },
        environment_nits: 1e5,
    },
    FuzzedShader {
        name: "anisotropic, the lecture's geometry",
        features: || ForwardFeatures {
            geometry: Geometry::SchlickLecture,
            ..stage::features(BY_LIGHTS, Material { anisotropy_strength: 1.0, ..Default::default() })
        },
        environment_nits: 0.0,
    },
    FuzzedShader {
        name: "Disney",
        features: || {
            let disney = Some(Disney { anisotropic: 0.5, ..Default::default() });
            stage::features(LIT, Material { disney, ..Default::default() })
        },
        environment_nits: 1e5,
    },
    FuzzedShader {
        name: "unlit",
        features: || stage::features(BY_LIGHTS, Material { unlit: true, ..Default::default() }),
        environment_nits: 0.0,
    },
];

/// What a fuzzed shader binds in group 0, as a frame would.
pub(super) struct Resources {
    features: ForwardFeatures,
    shared: SharedTextures,
    disney_table: wgpu::TextureView,
    environment: GpuEnvironment,
}

impl Resources {
    pub(super) fn new(gpu: &Gpu, features: ForwardFeatures, sun_nits: f32) -> Result<Self, ProofError> {
        let sky = Environment::new(sun(sun_nits));
        let maps = environment::bake(&sky.image, &Default::default(), &Silent);
        let (device, queue) = (&gpu.device, &gpu.queue);
        let environment = GpuEnvironment::new(&mut Staging::new(device, queue, Uploads::Queued), &sky, &maps, None)
            .map_err(|error| ProofError::Row { row: "fuzz".into(), reason: error.to_string() })?;
        let disney_table = table(&disney::TABLE).upload(device, queue);
        Ok(Self { features, shared: shared_textures(device, queue), disney_table, environment })
    }

    /// The bindings that the shader has.
    pub(super) fn entries(&self) -> Vec<(u32, wgpu::BindingResource<'_>)> {
        let mut entries = Vec::new();
        let features = &self.features;
        if features.material.shading == Shading::Lit {
            entries.push((bindings::FRAME_DFG, wgpu::BindingResource::TextureView(&self.shared.dfg)));
        }
        if features.material.fresnel != FresnelFeature::Schlick {
            let tail = wgpu::BindingResource::TextureView(&self.shared.fresnel_tail);
            entries.push((bindings::FRAME_FRESNEL_TAIL, tail));
        }
        if features.material.disney_table {
            entries.push((stage::DISNEY_TABLE, wgpu::BindingResource::TextureView(&self.disney_table)));
        }
        if features.material.shading.is_lit() {
            entries.push((bindings::FRAME_SAMPLER, wgpu::BindingResource::Sampler(&self.shared.clamp_sampler)));
            if self.features.reads_taps() {
                entries.push((bindings::FRAME_TAPS, wgpu::BindingResource::TextureView(&self.shared.taps)));
            }
            if self.features.scene.environment {
                entries.extend([
                    (bindings::FRAME_ENVIRONMENT, self.environment.uniform.as_entire_binding()),
                    (bindings::FRAME_ATLAS, wgpu::BindingResource::TextureView(&self.environment.atlas)),
                ]);
            }
        }
        entries
    }
}

/// One bright texel in the dark: its harmonics ring below zero on the other side.
fn sun(nits: f32) -> EnvironmentImage {
    let (width, height) = (32, 16);
    let mut texels = vec![Vec3::ZERO; (width * height) as usize];
    texels[5 * width as usize + 9] = Vec3::new(1.0, 0.9, 0.5) * nits;
    EnvironmentImage { width, height, texels }
}
