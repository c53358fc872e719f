//! What a view says to the shaders.

use crate::frame::clip_from_origin;
use crate::gpu_scene::GpuScene;
use crate::math::blur::mean_cosine;
use crate::math::color::linear_from_srgb;
use crate::scene::{Background, Channel, LightSource, Projection, ToneMap, View};
use crate::shader::channel_uniform;
use crate::shader::types::{BackgroundUniform, DisplayUniform, FrameUniform};
use glam::{DMat3, DVec2, DVec3, DVec4};

/// What a view says to every draw of radiance into a depth buffer of our own.
pub(super) fn frame_uniform(scene: &GpuScene, view: &View) -> FrameUniform {
    let origin_in_world = scene.drawables.origin_in_world;
    let viewer: DVec4 = match view.camera.projection {
        Projection::Perspective { .. } => (view.camera.position_in_world() - origin_in_world).extend(1.0),
        Projection::Orthographic { .. } => (-view.camera.forward_in_world()).extend(0.0),
    };
    let lights = scene.lights.as_ref();
    let channel = view.channel.map(|channel| match (channel, lights) {
        // Lights are numbered as the scene has them.
        (Channel::Radiance { source: LightSource::Light(light), components }, Some(lights)) => {
            Channel::Radiance { source: LightSource::Light(lights.place(light)), components }
        }
        (other, _) => other,
    });
    let [channel, channel_index, channel_components] = channel.map_or([0; 3], channel_uniform);
    FrameUniform {
        clip_from_world: clip_from_origin(view, origin_in_world).to_cols_array_2d(),
        viewer: viewer.as_vec4().to_array(),
        light_count: lights.map_or(0, |lights| lights.lit()),
        channel,
        channel_index,
        channel_components,
        exposure: exposure(view),
        ..Default::default()
    }
}

/// The ray direction is affine in the picture plane, so three corners of it give the whole map.
pub(super) fn background_uniform(view: &View, environment_from_world: DMat3, radiance_scale: f32) -> BackgroundUniform {
    let (camera, size) = (&view.camera, view.size_px.as_dvec2());
    let direction = |ndc: DVec2| {
        let pixel = DVec2::new((ndc.x + 1.0) * 0.5, (1.0 - ndc.y) * 0.5) * size;
        let along: DVec3 = camera.ray(pixel, view.size_px).1;
        environment_from_world * (along / along.dot(camera.forward_in_world()))
    };
    let center = direction(DVec2::ZERO);
    let direction_from_ndc = DMat3::from_cols(direction(DVec2::X) - center, direction(DVec2::Y) - center, center);
    BackgroundUniform {
        direction_from_ndc: [direction_from_ndc.x_axis, direction_from_ndc.y_axis, direction_from_ndc.z_axis]
            .map(|column| column.extend(0.0).as_vec4().to_array()),
        radiance_scale,
        exposure: exposure(view),
        perceptual_roughness: view.background_blur,
        sun_scale: (0.25 / mean_cosine(f64::from(view.background_blur).powi(2))) as f32,
    }
}

pub(super) fn display_uniform(view: &View) -> DisplayUniform {
    let background = match view.background {
        Background::Color(color) => {
            let linear = color.to_array().map(|channel| linear_from_srgb(f64::from(channel)) as f32);
            [linear[0], linear[1], linear[2], 1.0]
        }
        Background::Environment | Background::Transparent => [0.0; 4],
    };
    DisplayUniform { background, exposure: exposure(view), ..Default::default() }
}

/// What radiance is multiplied with before the tone map.
fn exposure(view: &View) -> f32 {
    if view.tone_map == ToneMap::None { 1.0 } else { view.exposure_ev.exp2() }
}
