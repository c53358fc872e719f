//! WGSL that shows a channel: where each input of shading is found, and the numbers that the frame's uniform asks by.

use super::features::{ForwardFeatures, MaterialFeatures, Shading, VertexFeatures};
use crate::scene::{Channel, Component, Components, Input, LightSource, Number};
use std::fmt::Write;

/// Numbers of the channels that are not inputs; those are numbered by their order.
const PUNCTUAL: u32 = 100;
const LIGHT: u32 = 101;
const ENVIRONMENT: u32 = 102;
const SKY: u32 = 103;
const SUN: u32 = 104;
const NAN: u32 = 105;
const LIGHT_COUNT: u32 = 106;
const UV_CHECKER: u32 = 107;
const DRAWN: u32 = 108;
const PLACEMENT: u32 = 109;
const DEPTH_BITS: u32 = 110;

/// `channel`, `channel_index` and `channel_components` of the frame's uniform.
pub fn channel_uniform(channel: Channel) -> [u32; 3] {
    match channel {
        Channel::Input(input) => [input as u32, 0, 0],
        Channel::Radiance { source, components } => {
            let (number, index) = match source {
                LightSource::Punctual => (PUNCTUAL, 0),
                LightSource::Light(index) => (LIGHT, index),
                LightSource::Environment => (ENVIRONMENT, 0),
                LightSource::Sky => (SKY, 0),
                LightSource::Sun(index) => (SUN, index),
            };
            [number, index, components.bits()]
        }
        Channel::LightCount => [LIGHT_COUNT, 0, 0],
        Channel::UvChecker => [UV_CHECKER, 0, 0],
        // The environment is another then.
        Channel::Furnace => [ENVIRONMENT, 0, Components::ALL.bits()],
        // What is drawn where is for the pipelines to say.
        Channel::Overdraw | Channel::Wireframe => [DRAWN, 0, 0],
        Channel::Nan => [NAN, 0, 0],
        Channel::Digits(Number::Placement) => [PLACEMENT, 0, 0],
        Channel::Digits(Number::DepthBits) => [DEPTH_BITS, 0, 0],
    }
}

/// The `<channels>` slot: the numbers, and `channel`, which finds what they stand for.
pub(super) fn channels(features: &ForwardFeatures) -> String {
    let mut text = String::from("#import <radiance_channel>\n#import \"channel/checker.wgsl\"\n\n");
    let numbers = [
        ("PUNCTUAL", PUNCTUAL),
        ("LIGHT", LIGHT),
        ("ENVIRONMENT", ENVIRONMENT),
        ("SKY", SKY),
        ("SUN", SUN),
        ("NAN", NAN),
        ("LIGHT_COUNT", LIGHT_COUNT),
        ("UV_CHECKER", UV_CHECKER),
        ("DRAWN", DRAWN),
        ("PLACEMENT", PLACEMENT),
        ("DEPTH_BITS", DEPTH_BITS),
    ];
    // Writing to a String cannot fail.
    for (name, number) in numbers {
        let _ = writeln!(text, "const CHANNEL_{name}: u32 = {number}u;");
    }
    text.push_str(
        "\nfn channel(v: VertexOut, surface: Surface, facet_normal: vec3f, front_facing: bool) -> vec3f {\n    \
         switch asked.x {\n",
    );
    for input in Input::ALL {
        let value = expression(input, &features.material, &features.vertex);
        let _ = writeln!(text, "        case {}u: {{\n            return {value};\n        }}", input as u32);
    }
    let checker = features
        .vertex
        .uv_sets()
        .next()
        .map_or("hatched(v.position_in_clip.xy)".into(), |set| format!("checker(v.uv_{set})"));
    let _ = writeln!(text, "        case CHANNEL_UV_CHECKER: {{\n            return {checker};\n        }}");
    text.push_str(
        "        case CHANNEL_DRAWN: {\n            return vec3f(1.0);\n        }\n        \
         case CHANNEL_NAN: {\n            return faults(shade(surface, v.position_in_world));\n        }\n        \
         case CHANNEL_PLACEMENT: {\n            return digits(placement(v));\n        }\n        \
         case CHANNEL_DEPTH_BITS: {\n            return digits(depth_bits(v.position_in_world));\n        }\n        \
         default: {\n            return radiance_channel(surface, v.position_in_world);\n        }\n    }\n}\n\n",
    );
    text.push_str(FAULTS);
    text.push_str(DIGITS);
    text
}

/// The `<components>` slot: the bits of the BRDF's components, and those that a picture of one term shows.
pub(super) fn components(of_term: Components) -> String {
    let mut text = format!("const TERM_COMPONENTS: u32 = {}u;\n", of_term.bits());
    for component in Component::ALL {
        let name = component.name().to_uppercase().replace(' ', "_");
        // Writing to a String cannot fail.
        let _ = writeln!(text, "const COMPONENT_{name}: u32 = {}u;", component as u32);
    }
    text
}

/// Bits, not comparisons: compilers may assume that there is no NaN.
const FAULTS: &str = "\
fn faults(radiance: vec3f) -> vec3f {
    let bits = bitcast<vec3u>(radiance);
    let magnitude = bits & vec3u(0x7fffffffu);
    let infinite = magnitude == vec3u(0x7f800000u);
    let no_number = magnitude > vec3u(0x7f800000u);
    let negative = (bits > vec3u(0x80000000u)) & !no_number;
    return select(vec3f(0.0), vec3f(1.0), vec3<bool>(any(no_number), any(infinite), any(negative)));
}
";

/// Whole numbers below 2048 are half floats.
const DIGITS: &str = "
fn digits(number: u32) -> vec3f {
    return vec3f(vec3u(number, number >> 11u, number >> 22u) & vec3u(2047u));
}

fn depth_bits(position_in_world: vec3f) -> u32 {
    let clip = frame.clip_from_world * vec4f(position_in_world, 1.0);
    return bitcast<u32>(clip.z / clip.w);
}
";

/// Whether a shader with these features knows an input as the reference renderer does: what cannot change a pixel is not
/// read.
pub fn channel_is_read(input: Input, material: &MaterialFeatures, vertex: &VertexFeatures) -> bool {
    let lit = material.shading.is_lit();
    match input {
        Input::BaseColor | Input::Alpha => lit || material.shading == Shading::Unlit,
        Input::Emissive => material.shading != Shading::Unlit,
        Input::Metallic | Input::PerceptualRoughness | Input::Alphas | Input::F0 | Input::Occlusion => lit,
        Input::Normal | Input::VertexNormal | Input::NoV => lit,
        Input::Tangent => lit && (vertex.tangent || material.anisotropic),
        Input::Uv => vertex.uv_sets().next().is_some(),
        Input::GeometricNormal | Input::Position | Input::Depth => true,
    }
}

/// Where a shader with these features has an input, as a vec3f; zero where it has none.
fn expression(input: Input, material: &MaterialFeatures, vertex: &VertexFeatures) -> String {
    let lit = |value: &str| if material.shading.is_lit() { value.to_owned() } else { "vec3f(0.0)".into() };
    match input {
        Input::BaseColor => "surface.base_color".into(),
        Input::Metallic => "vec3f(surface.metallic)".into(),
        Input::PerceptualRoughness => "vec3f(surface.perceptual_roughness)".into(),
        Input::Alphas => lit(match (material.shading, material.anisotropic) {
            (Shading::Disney, _) => "vec3f(make_lobes(surface).alpha_x, make_lobes(surface).alpha_y, 0.0)",
            (_, true) => "vec3f(make_lobes(surface).shape.alpha_t, make_lobes(surface).shape.alpha, 0.0)",
            (_, false) => "vec3f(vec2f(make_lobes(surface).shape.alpha), 0.0)",
        }),
        Input::F0 => lit(match material.shading {
            Shading::Disney => "make_lobes(surface).F0",
            _ => {
                "mix(min(surface.dielectric_F0 * surface.specular_color, vec3f(1.0)) * surface.specular, \
                 surface.base_color, surface.metallic)"
            }
        }),
        Input::Occlusion => "vec3f(surface.occlusion)".into(),
        Input::Emissive => "surface.emissive".into(),
        Input::Alpha => "vec3f(surface.alpha)".into(),
        Input::Normal => lit("surface.n"),
        Input::VertexNormal => lit("face_viewer(normalize_or(v.normal, surface.v), front_facing)"),
        Input::GeometricNormal => "facet_normal".into(),
        Input::Tangent => match material.shading {
            Shading::Disney => "surface.t".into(),
            _ if material.anisotropic => "surface.tangents.t".into(),
            _ if vertex.tangent => "normalize_or(v.tangent.xyz, vec3f(0.0))".into(),
            _ => "vec3f(0.0)".into(),
        },
        Input::Uv => vertex.uv_sets().next().map_or("vec3f(0.0)".into(), |set| format!("vec3f(v.uv_{set}, 0.0)")),
        Input::Position => "v.position_in_world".into(),
        Input::Depth => "vec3f((frame.clip_from_world * vec4f(v.position_in_world, 1.0)).zw, 0.0)".into(),
        Input::NoV => lit("vec3f(make_lobes(surface).NoV)"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_channel_has_a_number_of_its_own() {
        let sources = [
            LightSource::Punctual,
            LightSource::Light(3),
            LightSource::Environment,
            LightSource::Sky,
            LightSource::Sun(1),
        ];
        let radiance = sources.map(|source| Channel::Radiance { source, components: Components::SPECULAR });
        let inputs = Input::ALL.map(Channel::Input);
        let all: Vec<[u32; 3]> = inputs
            .into_iter()
            .chain(radiance)
            .chain([Channel::LightCount, Channel::UvChecker, Channel::Overdraw, Channel::Nan])
            .chain([Number::Placement, Number::DepthBits].map(Channel::Digits))
            .map(channel_uniform)
            .collect();
        assert_eq!(all.iter().map(|uniform| uniform[0]).collect::<BTreeSet<_>>().len(), all.len());
        assert_eq!(channel_uniform(radiance[1]), [LIGHT, 3, Components::SPECULAR.bits()]);
    }
}
