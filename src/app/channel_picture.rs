//! Channels as pictures that people can read: debug views of the window and of `render --debug-view`.

use crate::math::color::srgb_from_linear;
use crate::metrics::heat::heat;
use crate::reference::color::display;
use crate::scene::{Background, Channel, Input, Projection, RadianceImage, View};
use glam::{DVec3, Vec3, Vec4};

/// How the numbers of a channel become colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Scale {
    /// Radiance: exposed, tone-mapped and encoded as any other picture.
    Radiance,
    /// Linear light in [0, 1], sRGB-encoded.
    Color,
    /// Numbers in [0, 1], as they are.
    Number,
    /// [-1, 1], as normal maps have it.
    Direction,
    /// What follows the point.
    Fraction,
    /// From the least to the most that is seen.
    Range,
    /// The same, but the least is white.
    RangeInverted,
    /// Numbers in [0, 1], as they are; what is larger, magenta.
    Share,
    /// Colours of heat, up to [`LAYERS_MAX`].
    Layers,
}

/// From so many layers on all look the same.
const LAYERS_MAX: f32 = 8.0;
/// A share of light that is larger is more than half floats and 8 bits have rounded up.
const SHARE_MAX: f32 = 1.004;

fn scale(channel: Channel) -> Scale {
    match channel {
        Channel::Radiance { .. } => Scale::Radiance,
        Channel::LightCount | Channel::Digits(_) => Scale::Range,
        Channel::Nan | Channel::UvChecker | Channel::Wireframe => Scale::Number,
        Channel::Furnace => Scale::Share,
        Channel::Overdraw => Scale::Layers,
        Channel::Input(input) => match input {
            Input::BaseColor | Input::F0 => Scale::Color,
            Input::Emissive => Scale::Radiance,
            Input::Metallic
            | Input::PerceptualRoughness
            | Input::Alphas
            | Input::Occlusion
            | Input::Alpha
            | Input::NoV => Scale::Number,
            Input::Normal | Input::VertexNormal | Input::GeometricNormal | Input::Tangent => Scale::Direction,
            Input::Uv => Scale::Fraction,
            Input::Position => Scale::Range,
            Input::Depth => Scale::RangeInverted,
        },
    }
}

/// The channel in the units in which it is reported: depth becomes metres along the line of sight.
pub fn in_units(channel: Channel, image: RadianceImage, view: &View) -> RadianceImage {
    if channel != Channel::Input(Input::Depth) {
        return image;
    }
    let camera = &view.camera;
    let depth_m = |z: f32, w: f32| match camera.projection {
        Projection::Perspective { .. } => w,
        Projection::Orthographic { .. } => (camera.far_m - f64::from(z) * (camera.far_m - camera.near_m)) as f32,
    };
    // An edge holds a mean of pairs, multiplied with its coverage.
    let metres = |texel: &Vec4| {
        let depth = if texel.w > 0.0 { texel.w * depth_m(texel.x / texel.w, texel.y / texel.w) } else { 0.0 };
        Vec3::splat(depth).extend(texel.w)
    };
    RadianceImage { texels: image.texels.iter().map(metres).collect(), ..image }
}

/// The channel, in its units, as 8-bit RGBA with straight alpha.
pub fn picture(channel: Channel, image: &RadianceImage, view: &View) -> Vec<u8> {
    let scale = scale(channel);
    let (least, most) = range(image);
    let color = |texel: &Vec4| {
        let value = texel.truncate() / texel.w;
        match scale {
            Scale::Radiance => {
                let opaque = View { background: Background::Transparent, ..view.clone() };
                let [r, g, b, _] = display(&opaque, value.as_dvec3().extend(1.0));
                DVec3::new(r, g, b).map(srgb_from_linear).as_vec3()
            }
            Scale::Color => value.as_dvec3().clamp(DVec3::ZERO, DVec3::ONE).map(srgb_from_linear).as_vec3(),
            Scale::Number => value,
            Scale::Direction => 0.5 * value + 0.5,
            Scale::Fraction => value - value.floor(),
            Scale::Share if value.max_element() > SHARE_MAX => Vec3::new(1.0, 0.0, 1.0),
            Scale::Share => value,
            Scale::Layers => Vec3::from(heat(f64::from(value.x / LAYERS_MAX)).map(f32::from)) / 255.0,
            Scale::Range => (value - least) / (most - least).max(Vec3::splat(f32::MIN_POSITIVE)),
            Scale::RangeInverted => (most - value) / (most - least).max(Vec3::splat(f32::MIN_POSITIVE)),
        }
    };
    let pixel = |texel: &Vec4| {
        let coverage = texel.w.clamp(0.0, 1.0);
        let color = if coverage > 0.0 { color(texel) } else { Vec3::ZERO };
        match view.background {
            Background::Color(behind) => behind.lerp(color, coverage).extend(1.0),
            Background::Transparent | Background::Environment => color.extend(coverage),
        }
    };
    let codes = |texel: &Vec4| pixel(texel).to_array().map(|value| (value.clamp(0.0, 1.0) * 255.0).round() as u8);
    image.texels.iter().flat_map(codes).collect()
}

/// The least and the most of each number where surfaces are.
fn range(image: &RadianceImage) -> (Vec3, Vec3) {
    let covered = image.texels.iter().filter(|texel| texel.w > 0.0).map(|texel| texel.truncate() / texel.w);
    covered.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::framing::default_view;
    use crate::scene::{Camera, Scene};
    use glam::UVec2;

    fn view(projection: Projection, background: Background) -> View {
        let camera = Camera::look_at(DVec3::Z, DVec3::ZERO, DVec3::Y, projection, 1.0, 9.0);
        View { camera, background, ..default_view(&Scene::default(), UVec2::ONE) }
    }

    fn image(texels: &[[f32; 4]]) -> RadianceImage {
        RadianceImage {
            width: texels.len() as u32,
            height: 1,
            texels: texels.iter().copied().map(Vec4::from_array).collect(),
        }
    }

    #[test]
    fn depths_are_metres_under_either_projection() {
        let depth = Channel::Input(Input::Depth);
        let half_covered = image(&[[0.25, 2.0, 0.0, 0.5], [0.0; 4]]);
        let orthographic = view(Projection::Orthographic { height_m: 1.0 }, Background::Transparent);
        assert_eq!(in_units(depth, half_covered.clone(), &orthographic).texels[0], Vec4::new(2.5, 2.5, 2.5, 0.5));
        let perspective = view(Projection::Perspective { fov_y_rad: 1.0 }, Background::Transparent);
        let metres = in_units(depth, half_covered, &perspective);
        assert_eq!(metres.texels, [Vec4::new(2.0, 2.0, 2.0, 0.5), Vec4::ZERO]);
    }

    #[test]
    fn numbers_become_colours() {
        let view = view(Projection::Perspective { fov_y_rad: 1.0 }, Background::Color(Vec3::ONE));
        let shown = |name: &str, texels: &[[f32; 4]]| picture(Channel::by_name(name).unwrap(), &image(texels), &view);
        assert_eq!(shown("metallic", &[[0.2, 0.2, 0.2, 1.0]]), [51, 51, 51, 255]);
        assert_eq!(shown("metallic", &[[0.0, 0.0, 0.0, 0.0]]), [255; 4]);
        assert_eq!(shown("metallic", &[[0.0, 0.0, 0.0, 0.6]]), [102, 102, 102, 255]);
        assert_eq!(shown("normal", &[[0.0, -1.0, 1.0, 1.0]]), [128, 0, 255, 255]);
        assert_eq!(shown("uv", &[[-0.2, 1.4, 0.0, 1.0]]), [204, 102, 0, 255]);
        assert_eq!(shown("base-color", &[[0.5, 0.0, 1.0, 1.0]]), [188, 0, 255, 255]);
        assert_eq!(shown("furnace", &[[1.002, 0.5, 0.0, 1.0]]), [255, 128, 0, 255]);
        assert_eq!(shown("furnace", &[[1.01, 0.5, 0.0, 1.0]]), [255, 0, 255, 255]);
        let layers = shown("overdraw", &[[1.0; 4], [2.0, 2.0, 2.0, 1.0], [8.0, 8.0, 8.0, 1.0], [9.0, 9.0, 9.0, 1.0]]);
        assert!(layers[0] < layers[4] && layers[4] < layers[8] && layers[8..12] == layers[12..], "{layers:?}");
        let depths = shown("depth", &[[2.0, 2.0, 2.0, 1.0], [4.0, 4.0, 4.0, 1.0], [3.0, 3.0, 3.0, 1.0]]);
        assert_eq!([depths[0], depths[4], depths[8]], [255, 0, 128]);
    }
}
