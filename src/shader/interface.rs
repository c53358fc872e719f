//! WGSL that is written from features: vertex attributes, interpolants, and the texture reads of a material.

use super::features::{MaterialFeatures, Shading, VertexFeatures};
use crate::scene::TextureSlot;
use std::fmt::Write;

/// Binding of the material's uniform in its group.
pub const MATERIAL_UNIFORM_BINDING: u32 = 0;
/// First binding of the material's samplers; the textures follow the last of them.
pub const MATERIAL_SAMPLER_BINDING: u32 = 1;

/// Binding of the texture that is the `index`th in use, when `sampler_count` samplers are bound.
pub fn material_texture_binding(sampler_count: u32, index: usize) -> u32 {
    MATERIAL_SAMPLER_BINDING + sampler_count + index as u32
}

/// Binding of the Disney parameters; the table of the lobes' albedos is the next one. Both follow the last texture.
pub fn disney_binding(features: &MaterialFeatures) -> u32 {
    material_texture_binding(features.sampler_count(), features.textures().count())
}

/// One vertex attribute: its name and WGSL type. Its position in the list is its shader location.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Attribute {
    pub name: String,
    pub wgsl: &'static str,
}

/// The attributes of a draw, position first, in the order of their locations and vertex buffers.
pub fn attributes(vertex: &VertexFeatures) -> Vec<Attribute> {
    let mut attributes = vec![Attribute { name: "position".into(), wgsl: "vec3f" }];
    let optional =
        [(vertex.normal, "normal", "vec3f"), (vertex.tangent, "tangent", "vec4f"), (vertex.color, "color", "vec4f")];
    let present = optional.into_iter().filter(|(on, ..)| *on);
    attributes.extend(present.map(|(_, name, wgsl)| Attribute { name: name.into(), wgsl }));
    attributes.extend(vertex.uv_sets().map(|set| Attribute { name: format!("uv_{set}"), wgsl: "vec2f" }));
    attributes
}

/// The `<interface>` slot: `VertexIn`, `VertexOut`, `vertex_out` and `vertex_color`; and `placement`, which of the
/// instances that are drawn a `numbered` vertex is of.
pub(super) fn vertex_interface(vertex: &VertexFeatures, numbered: bool) -> String {
    let fields = |first: &str| {
        let attributes = attributes(vertex).into_iter().enumerate();
        attributes.fold(String::new(), |mut text, (location, attribute)| {
            let name = if location == 0 { first } else { &attribute.name };
            let _ = writeln!(text, "    @location({location}) {name}: {},", attribute.wgsl);
            text
        })
    };
    let mut text = format!(
        "struct VertexIn {{\n    @builtin(instance_index) instance: u32,\n{}}}\n\n\
         struct VertexOut {{\n    @builtin(position) @invariant position_in_clip: vec4f,\n{}{}}}\n\n",
        fields("position"),
        fields("position_in_world"),
        if numbered {
            format!("    @location({}) @interpolate(flat) placement: u32,\n", attributes(vertex).len())
        } else {
            String::new()
        }
    );
    text.push_str(&vertex_out(vertex, numbered));
    text.push_str(&vertex_color(vertex));
    if numbered {
        text.push_str("\nfn placement(v: VertexOut) -> u32 {\n    return v.placement;\n}\n");
    }
    text
}

fn vertex_out(vertex: &VertexFeatures, numbered: bool) -> String {
    let mut text = String::from(
        "fn vertex_out(in: VertexIn) -> VertexOut {\n\
         \x20   let instance = instances[visible_instances[in.instance]];\n\
         \x20   var out: VertexOut;\n\
         \x20   out.position_in_world = vec4f(in.position, 1.0) * instance.world_from_object;\n\
         \x20   out.position_in_clip = frame.clip_from_world * vec4f(out.position_in_world, 1.0);\n",
    );
    for Attribute { name, .. } in attributes(vertex).iter().skip(1) {
        let value = match name.as_str() {
            "normal" => "normalize_or(instance.normal_from_object * in.normal, vec3f(0.0))".to_owned(),
            "tangent" => "vec4f(normalize_or(vec4f(in.tangent.xyz, 0.0) * instance.world_from_object, vec3f(0.0)), \
                 in.tangent.w * instance.handedness)"
                .to_owned(),
            name => format!("in.{name}"),
        };
        let _ = writeln!(text, "    out.{name} = {value};");
    }
    if numbered {
        text.push_str("    out.placement = in.instance;\n");
    }
    text.push_str("    return out;\n}\n\n");
    text
}

/// `vertex_color`, for whatever declares `VertexOut`.
pub(super) fn vertex_color(vertex: &VertexFeatures) -> String {
    let color = if vertex.color { "v.color" } else { "vec4f(1.0)" };
    format!("fn vertex_color(v: VertexOut) -> vec4f {{\n    return {color};\n}}\n")
}

/// How texels are looked up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Gradients {
    /// From the neighbours in the picture.
    Implicit,
    /// `uv_N_dx` and `uv_N_dy` of the vertex: what its coordinates change by to the next pixel.
    Explicit,
}

/// The `<material>` slot: the uniform, and for every texture slot a function `NAME_texel` that is 1 without a texture.
pub(super) fn material_interface(material: &MaterialFeatures, gradients: Gradients) -> String {
    let samplers = material.sampler_count();
    let mut text = format!("@group(1) @binding({MATERIAL_UNIFORM_BINDING}) var<uniform> material: MaterialUniform;\n");
    for sampler in 0..samplers {
        let binding = MATERIAL_SAMPLER_BINDING + sampler;
        let _ = writeln!(text, "@group(1) @binding({binding}) var material_sampler_{sampler}: sampler;");
    }
    for (index, (slot, _)) in material.textures().enumerate() {
        let binding = material_texture_binding(samplers, index);
        let _ = writeln!(text, "@group(1) @binding({binding}) var {}_texture: texture_2d<f32>;", slot.name());
    }
    if material.shading == Shading::Disney {
        let binding = disney_binding(material);
        let _ = writeln!(text, "@group(1) @binding({binding}) var<uniform> disney: DisneyUniform;");
        if material.disney_table {
            let _ = writeln!(text, "@group(1) @binding({}) var disney_table: texture_2d<f32>;", binding + 1);
        }
    }
    for slot in TextureSlot::ALL {
        let name = slot.name();
        let value = match material.texture(slot) {
            // Along the tangent, at full strength.
            None if slot == TextureSlot::Anisotropy => "vec4f(1.0, 0.5, 1.0, 1.0)".to_owned(),
            None => "vec4f(1.0)".to_owned(),
            Some(texture) => {
                let uv = |suffix: &str, w: &str| {
                    let uv = format!("v.uv_{}{suffix}", texture.uv_set);
                    if !texture.transformed {
                        return uv;
                    }
                    let row = 2 * slot as usize;
                    let dot = |row: usize| format!("dot(material.uv_transforms[{row}].xyz, vec3f({uv}, {w}))");
                    format!("vec2f({}, {})", dot(row), dot(row + 1))
                };
                let (at, sampler) = (uv("", "1.0"), texture.sampler);
                match gradients {
                    Gradients::Implicit => format!("textureSample({name}_texture, material_sampler_{sampler}, {at})"),
                    Gradients::Explicit => {
                        let (dx, dy) = (uv("_dx", "0.0"), uv("_dy", "0.0"));
                        format!("textureSampleGrad({name}_texture, material_sampler_{sampler}, {at}, {dx}, {dy})")
                    }
                }
            }
        };
        let is_packed = slot == TextureSlot::Occlusion && material.packed_occlusion;
        let value = if is_packed { "metallic_roughness" } else { &value };
        let _ = writeln!(text, "{}", texel_function(slot, value));
    }
    text
}

/// What a texture slot reads at a point. That of occlusion is given the metallic-roughness texel, which it may be part of.
pub(crate) fn texel_function(slot: TextureSlot, value: &str) -> String {
    let beside = if slot == TextureSlot::Occlusion { ", metallic_roughness: vec4f" } else { "" };
    format!("\nfn {}_texel(v: VertexOut{beside}) -> vec4f {{\n    return {value};\n}}", slot.name())
}
