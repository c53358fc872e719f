//! What the host says of the pass that a frame is drawn in.

use super::RenderError;
use crate::gpu::formats;
use crate::gpu::pipeline::DepthTarget;
use crate::passes::ForwardTarget;
use crate::scene::{Background, Camera, Projection, View};
use crate::shader::{DisplayFeatures, TargetLight};
use glam::{Mat4, Vec4};
use wgpu::{TextureFormatFeatureFlags, TextureUsages};

/// What the colour attachment of a pass is to hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Output {
    /// Linear radiance in cd/m2, multiplied with coverage.
    #[default]
    Radiance,
    /// Display light by the exposure and the tone map of the view, multiplied with coverage; with the sRGB transfer unless
    /// the format applies it. Blended surfaces are mixed after the tone map, as everything else in such a pass is.
    Display,
}

/// A pass of the host, as its pipelines have to know it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassFormat {
    pub color: wgpu::TextureFormat,
    /// Samples a pixel of all attachments.
    pub samples: u32,
    /// Format and direction of the depth buffer; `None` where the pass has none.
    pub depth: Option<DepthTarget>,
    /// Distance of the host's far plane, metres, for perspective cameras; `None` where it is at infinity. Orthographic
    /// cameras have one of their own.
    pub far_m: Option<f64>,
    pub output: Output,
}

impl PassFormat {
    /// Radiance as our own passes have it: half floats, and reversed depth to infinity.
    pub fn own(samples: u32) -> Self {
        Self {
            color: formats::Precision::Half.hdr_format(),
            samples,
            depth: Some(DepthTarget::OWN),
            far_m: None,
            output: Output::Radiance,
        }
    }

    /// What the forward pipelines of a view are made for.
    ///
    /// # Errors
    /// Where a device cannot draw into such a pass, or the view asks for what cannot be had in it.
    pub(super) fn forward_target(&self, device: &wgpu::Device, view: &View) -> Result<ForwardTarget, RenderError> {
        let Some(depth) = self.depth else { return Err(RenderError::NeedsOwnPass { feature: "a depth test" }) };
        if matches!(view.background, Background::Color(_)) {
            return Err(RenderError::NeedsOwnPass { feature: "a background colour" });
        }
        if view.channel.is_some() && self.output == Output::Display {
            return Err(RenderError::Pass("a channel is numbers, and the pass is for display light".to_owned()));
        }
        self.check_color(device)?;
        self.check_depth(device, depth)?;
        self.check_far(&view.camera)?;
        let light = match self.output {
            Output::Radiance => TargetLight::Radiance,
            Output::Display => TargetLight::Display(DisplayFeatures {
                tone_map: view.tone_map,
                encode_srgb: !formats::encodes_srgb(self.color),
            }),
        };
        Ok(ForwardTarget { format: self.color, samples: self.samples, depth, light })
    }

    fn check_color(&self, device: &wgpu::Device) -> Result<(), RenderError> {
        let format = self.color;
        check_features(device, "the colour format", format)?;
        let is_float =
            matches!(format.sample_type(None, Some(device.features())), Some(wgpu::TextureSampleType::Float { .. }));
        let sure = format.guaranteed_format_features(device.features());
        let blends = sure.flags.contains(TextureFormatFeatureFlags::BLENDABLE);
        let renders = sure.allowed_usages.contains(TextureUsages::RENDER_ATTACHMENT) && blends;
        // What an adapter can do beyond what all can is known to it, and not to its device.
        let asks_adapter = device.features().contains(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);
        if !is_float || !(renders || asks_adapter) {
            return Err(RenderError::Pass(format!("colours cannot be blended in {format:?} on this device")));
        }
        if !(asks_adapter || sure.flags.sample_count_supported(self.samples)) {
            return Err(RenderError::Pass(format!("{format:?} has no {} samples a pixel", self.samples)));
        }
        Ok(())
    }

    fn check_depth(&self, device: &wgpu::Device, depth: DepthTarget) -> Result<(), RenderError> {
        let format = depth.format;
        check_features(device, "the depth format", format)?;
        if format.has_depth_aspect() {
            return Ok(());
        }
        Err(RenderError::Pass(format!("{format:?} has no depth")))
    }

    fn check_far(&self, camera: &Camera) -> Result<(), RenderError> {
        match self.far_m {
            Some(far_m) if far_m.is_nan() || far_m <= camera.near_m => {
                Err(RenderError::Pass(format!("the far plane at {far_m} m is not beyond the near one")))
            }
            _ => Ok(()),
        }
    }

    /// Clip space as the host's depth buffer has it, from our own, in which the depth of a point at a distance d is near / d.
    pub(super) fn clip(&self, camera: &Camera, own: Mat4) -> Mat4 {
        let reversed = self.depth.is_none_or(|depth| depth.reversed);
        // The depth is a linear function of what is divided by w, z and w itself.
        let (scale, offset) = match (camera.projection, self.far_m) {
            (Projection::Perspective { .. }, Some(far_m)) if far_m.is_finite() => {
                let beyond = far_m - camera.near_m;
                (far_m / beyond, -camera.near_m / beyond)
            }
            _ => (1.0, 0.0),
        };
        let (scale, offset) = if reversed { (scale, offset) } else { (-scale, 1.0 - offset) };
        if (scale, offset) == (1.0, 0.0) {
            return own;
        }
        let (z, w) = (own.row(2).as_dvec4(), own.row(3).as_dvec4());
        let depth: Vec4 = (scale * z + offset * w).as_vec4();
        Mat4::from_cols(own.row(0), own.row(1), depth, own.row(3)).transpose()
    }
}

fn check_features(device: &wgpu::Device, what: &str, format: wgpu::TextureFormat) -> Result<(), RenderError> {
    let missing = format.required_features() - device.features();
    if missing.is_empty() {
        return Ok(());
    }
    Err(RenderError::Pass(format!("{what} {format:?} needs the features {missing:?}")))
}
