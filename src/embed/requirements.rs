//! What a host should ask of its adapter.

use super::EmbedError;
use crate::gpu::formats::Precision;
use crate::gpu::{usable_features, usable_limits};

/// What Specula would use of an adapter. Nothing of it goes beyond what every WebGPU device has, except for `features` and
/// for larger textures and buffers, which it does without where they are missing.
#[derive(Debug, Clone, PartialEq)]
pub struct Requirements {
    /// Of the features that are used when they are there, those that the adapter has.
    pub features: wgpu::Features,
    pub limits: wgpu::Limits,
    /// Those that it does not have.
    pub degraded: Vec<Degraded>,
}

/// A feature that is missing, and what is done without it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Degraded {
    pub feature: wgpu::Features,
    pub instead: &'static str,
}

const WITHOUT: [(wgpu::Features, &str); 6] = [
    (wgpu::Features::TEXTURE_FORMAT_16BIT_NORM, "tables are half floats: an error of 1e-4 instead of 4e-5"),
    (wgpu::Features::PRIMITIVE_INDEX, "every frame takes the forward path"),
    (wgpu::Features::FLOAT32_BLENDABLE, "radiance is stored in half floats"),
    (wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES, "float targets have one sample a pixel"),
    (wgpu::Features::POLYGON_MODE_LINE, "no view of edges"),
    (wgpu::Features::TIMESTAMP_QUERY, "frames are timed by the processor's clock"),
];

impl Requirements {
    /// For targets of a precision; hosts that bring targets of their own take [`Precision::Half`].
    ///
    /// # Errors
    /// [`EmbedError::Device`] where the adapter cannot run Specula at all.
    pub fn for_adapter(adapter: &wgpu::Adapter, precision: Precision) -> Result<Self, EmbedError> {
        let vertex_storage = adapter.get_downlevel_capabilities().flags.contains(wgpu::DownlevelFlags::VERTEX_STORAGE);
        if !vertex_storage {
            return Err(EmbedError::Device("vertex shaders cannot read storage buffers".to_owned()));
        }
        check_limits(&adapter.limits())?;
        Ok(Self::of(adapter.features(), &adapter.limits(), precision))
    }

    fn of(features: wgpu::Features, limits: &wgpu::Limits, precision: Precision) -> Self {
        let wanted = usable_features(precision);
        let missing = |(feature, _): &(wgpu::Features, &str)| wanted.contains(*feature) && !features.contains(*feature);
        Self {
            features: features & wanted,
            limits: usable_limits(limits),
            degraded: WITHOUT
                .into_iter()
                .filter(missing)
                .map(|(feature, instead)| Degraded { feature, instead })
                .collect(),
        }
    }

    /// As a device is asked for.
    pub fn device_descriptor(&self) -> wgpu::DeviceDescriptor<'static> {
        wgpu::DeviceDescriptor {
            required_features: self.features,
            required_limits: self.limits.clone(),
            ..Default::default()
        }
    }

    /// Whether a device that a host has opened for its own needs can be rendered with.
    ///
    /// # Errors
    /// [`EmbedError::Device`] names the limit that is too small.
    pub fn check(device: &wgpu::Device) -> Result<(), EmbedError> {
        check_limits(&device.limits())
    }
}

fn check_limits(limits: &wgpu::Limits) -> Result<(), EmbedError> {
    let mut first = None;
    let needed = wgpu::Limits::downlevel_defaults();
    needed.check_limits_with_fail_fn(limits, true, |name, needed, allowed| {
        first.get_or_insert_with(|| format!("{name} must be {needed}, the device allows {allowed}"));
    });
    first.map_or(Ok(()), |what| Err(EmbedError::Device(what)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_named_with_what_is_done_instead() {
        let all = usable_features(Precision::Float);
        let limits = wgpu::Limits::default();
        assert_eq!(Requirements::of(all, &limits, Precision::Float).degraded, []);
        let without = Requirements::of(wgpu::Features::empty(), &limits, Precision::Float);
        assert_eq!((without.features, without.degraded.len()), (wgpu::Features::empty(), WITHOUT.len()));
        // Targets of half floats need less.
        assert_eq!(Requirements::of(wgpu::Features::empty(), &limits, Precision::Half).degraded.len(), 4);
        let unnamed = all - WITHOUT.iter().fold(wgpu::Features::empty(), |named, (feature, _)| named | *feature);
        assert_eq!(unnamed, wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS, "they come with the other timestamps");
    }

    #[test]
    fn limits_that_are_too_small_are_named() {
        let few = wgpu::Limits { max_storage_buffers_per_shader_stage: 1, ..Default::default() };
        let error = check_limits(&few).unwrap_err().to_string();
        assert!(error.contains("max_storage_buffers_per_shader_stage must be 4, the device allows 1"), "{error}");
        assert_eq!(check_limits(&wgpu::Limits::default()), Ok(()));
    }
}
