//! The shaders that are searched, and the textures that they read.

use super::super::{ProofError, stage};
use crate::bake::environment;
use crate::gpu::{Gpu, bindings};
use crate::gpu_scene::{GpuEnvironment, SharedTextures};
use crate::progress::Silent;
use crate::renderer::shared_textures;
use crate::scene::{AlphaMode, Environment, EnvironmentImage, Material};
use crate::shader::{ForwardFeatures, SceneFeatures, Shading};
use glam::Vec3;

/// A forward shader that is searched for faults. A feature joins by a line in [`FUZZED`].
#[derive(Debug, Clone, Copy)]
pub struct FuzzedShader {
    pub name: &'static str,
    pub features: fn() -> ForwardFeatures,
    /// Radiance of the sun in the environment.
    pub environment_nits: f32,
}

const LIT: SceneFeatures = SceneFeatures { punctual: true, environment: true };
const BY_LIGHTS: SceneFeatures = SceneFeatures { punctual: true, environment: false };

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
        name: "unlit",
        features: || stage::features(BY_LIGHTS, Material { unlit: true, ..Default::default() }),
        environment_nits: 0.0,
    },
];

/// What a fuzzed shader binds in group 0, as a frame would.
pub(super) struct Resources {
    features: ForwardFeatures,
    shared: SharedTextures,
    environment: GpuEnvironment,
}

impl Resources {
    pub(super) fn new(gpu: &Gpu, features: ForwardFeatures, sun_nits: f32) -> Result<Self, ProofError> {
        let sky = Environment::new(sun(sun_nits));
        let maps = environment::bake(&sky.image, &Default::default(), &Silent);
        let environment = GpuEnvironment::new(&gpu.device, &gpu.queue, &sky, &maps)
            .map_err(|error| ProofError::Row { row: "fuzz".into(), reason: error.to_string() })?;
        Ok(Self { features, shared: shared_textures(&gpu.device, &gpu.queue), environment })
    }

    /// The bindings that the shader has.
    pub(super) fn entries(&self) -> Vec<(u32, wgpu::BindingResource<'_>)> {
        let mut entries = Vec::new();
        if self.features.material.shading == Shading::Lit {
            entries.extend([
                (bindings::FRAME_DFG, wgpu::BindingResource::TextureView(&self.shared.dfg)),
                (bindings::FRAME_SAMPLER, wgpu::BindingResource::Sampler(&self.shared.clamp_sampler)),
            ]);
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
