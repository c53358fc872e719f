//! WGSL put together from the files in `shaders/`: only what a draw needs, one concern a file.
//!
//! A file names others with `#import "brdf/d_ggx.wgsl"`, or a *slot* with `#import <punctual>`: what fills the slot
//! is chosen from [`ForwardFeatures`] and friends, so that a scene without a feature has neither its code nor its
//! bindings. Slots are filled with a file or with text generated here from Rust declarations.

mod channels;
mod compose;
mod features;
mod interface;
mod layout;
mod modules;
mod pulled;
mod sources;
pub mod types;

pub use channels::{channel_is_read, channel_uniform};
pub use compose::{Composed, ShaderError, Slot, Slots, compose};
pub use features::{
    Alpha, FEW_LIGHTS, ForwardFeatures, FresnelFeature, LightList, MaterialFeatures, SceneFeatures, Shading,
    TextureUse, VertexFeatures, material_samplers,
};
#[cfg(feature = "cli")]
pub(crate) use interface::texel_function;
pub use interface::{
    Attribute, MATERIAL_SAMPLER_BINDING, MATERIAL_UNIFORM_BINDING, attributes, disney_binding, material_texture_binding,
};
pub use modules::{
    Backdrop, DisplayFeatures, TargetLight, background_module, background_module_into, covered_module, deferred_module,
    display_module, forward_module, forward_module_into, forward_slots, over_module, present_module, visibility_module,
};
pub use pulled::{OVER_SAMPLES_BINDING, PULLED_ROW_TEXELS, SEEN_SAMPLES_BINDING, Seen, texels_per_vertex};
#[cfg(feature = "cli")]
pub(crate) use sources::embedded;
pub use sources::{SOURCES, ShaderSources};

/// Makes a wgpu module of composed WGSL, with errors at the original file and line.
pub fn create_module(
    device: &wgpu::Device,
    label: &str,
    composed: &Composed,
) -> Result<wgpu::ShaderModule, ShaderError> {
    let module = composed.parse()?;
    Ok(device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(module)),
    }))
}
