//! WGSL for the deferred pass, which fetches vertices by itself: the same `VertexOut` as in the forward pass, read from
//! textures that hold it in the world, and interpolated here.

use super::features::VertexFeatures;
use super::interface::{Attribute, attributes, vertex_color};
use std::fmt::{self, Write};

/// Binding of what the visibility pass has left, wherever it is read.
pub const SEEN_SAMPLES_BINDING: u32 = 3;
/// Binding of what was drawn over that.
pub const OVER_SAMPLES_BINDING: u32 = 4;

/// What shading in a pass of its own reads of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Seen {
    /// Samples a pixel.
    pub samples: u32,
    /// Whether anything was drawn over what is shaded.
    pub under: bool,
}

/// Width of the textures that vertices and triangles are fetched from, texels.
pub const PULLED_ROW_TEXELS: u32 = 4096;

/// How many texels of four floats one vertex takes.
pub fn texels_per_vertex(vertex: &VertexFeatures) -> u32 {
    attributes(vertex).iter().map(components).sum::<u32>().div_ceil(4)
}

/// The `<interface>` slot: as that of the forward pass, and `pulled_vertex` and `interpolated`. Numbers are never asked for:
/// no frame that shows a channel is deferred.
pub(super) fn vertex_interface(vertex: &VertexFeatures, numbered: bool) -> String {
    let attributes = attributes(vertex);
    let mut text = format!("const PULLED_ROW_TEXELS: u32 = {PULLED_ROW_TEXELS}u;\n\n");
    text.push_str("struct VertexOut {\n    position_in_clip: vec4f,\n    position_in_world: vec3f,\n");
    for Attribute { name, wgsl } in &attributes[1..] {
        let _ = writeln!(text, "    {name}: {wgsl},");
        if is_coordinate(name) {
            let _ = writeln!(text, "    {name}_dx: {wgsl},\n    {name}_dy: {wgsl},");
        }
    }
    text.push_str("}\n\n");
    text.push_str(&vertex_color(vertex));
    text.push_str(&pulled_vertex(&attributes, texels_per_vertex(vertex)));
    text.push_str(&interpolated(&attributes));
    if numbered {
        text.push_str("\nfn placement(v: VertexOut) -> u32 {\n    return 0u;\n}\n");
    }
    text
}

/// Texture coordinates come with what they change by to the next pixel.
fn is_coordinate(name: &str) -> bool {
    name.starts_with("uv_")
}

fn components(attribute: &Attribute) -> u32 {
    match attribute.wgsl {
        "vec2f" => 2,
        "vec3f" => 3,
        _ => 4,
    }
}

fn pulled_vertex(attributes: &[Attribute], texels: u32) -> String {
    let mut text = String::from("\nfn pulled_vertex(index: u32) -> VertexOut {\n    var v: VertexOut;\n");
    let _ = writeln!(text, "    let first = pulled.first_vertex + index * {texels}u;");
    for texel in 0..texels {
        let _ =
            writeln!(text, "    let texel_{texel} = textureLoad(pulled_vertices, pulled_texel(first + {texel}u), 0);");
    }
    let mut float = 0;
    for attribute in attributes {
        let Attribute { name, wgsl } = attribute;
        let field = if float == 0 { "position_in_world" } else { name };
        let floats: Vec<String> = (float..float + components(attribute))
            .map(|k| format!("texel_{}.{}", k / 4, ["x", "y", "z", "w"][k as usize % 4]))
            .collect();
        let _ = writeln!(text, "    v.{field} = {wgsl}({});", floats.join(", "));
        float += components(attribute);
    }
    text.push_str(
        "    v.position_in_clip = frame.clip_from_world * vec4f(v.position_in_world, 1.0);\n    return v;\n}\n",
    );
    text
}

fn interpolated(attributes: &[Attribute]) -> String {
    let mut text = String::from(
        "\nfn interpolated(a: VertexOut, b: VertexOut, c: VertexOut, w: Barycentrics) -> VertexOut {\n    var v: VertexOut;\n",
    );
    let mut line = |field: &str, from: &str, weights: &str| {
        let sum = format!("a.{from} * {weights}.x + b.{from} * {weights}.y + c.{from} * {weights}.z");
        let _ = writeln!(text, "    v.{field} = {sum};");
    };
    line("position_in_world", "position_in_world", "w.here");
    for Attribute { name, .. } in &attributes[1..] {
        line(name, name, "w.here");
        if is_coordinate(name) {
            line(&format!("{name}_dx"), name, "w.dx");
            line(&format!("{name}_dy"), name, "w.dy");
        }
    }
    text.push_str("    return v;\n}\n");
    text
}

/// Where the samples of a pixel are: as Vulkan, Direct3D and Metal have them by default. For numbers that are not listed,
/// the middle stands for all.
fn sample_places(samples: u32) -> Vec<[f32; 2]> {
    match samples {
        4 => vec![[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]],
        _ => vec![[0.5, 0.5]; samples as usize],
    }
}

impl fmt::Display for Seen {
    /// For names of modules.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.samples, if self.under { ".under" } else { "" })
    }
}

/// The `<seen>` slot: what the visibility pass has left, `SAMPLES` of it a pixel, and where those are. It is bound in
/// `group`.
pub(super) fn seen(seen: Seen, group: u32) -> String {
    let Seen { samples, under } = seen;
    let (texture, last) = fetched(samples);
    let places: Vec<String> = sample_places(samples).iter().map(|[x, y]| format!("vec2f({x:?}, {y:?})")).collect();
    let mut text = if under { over(samples, group) } else { format!("const SAMPLES: u32 = {samples}u;\n\n") };
    let number = if under { "select(0u, stored.x, transmitted(pixel, sample) > 0.0)" } else { "stored.x" };
    let _ = write!(
        text,
        "const SAMPLE_PLACES = array<vec2f, SAMPLES>({});\n\n\
         @group({group}) @binding({SEEN_SAMPLES_BINDING}) var seen_samples: {texture}<u32>;\n\n\
         // Number of the draw, 0 where there is none, and of its triangle.\n\
         fn seen(pixel: vec2i, sample: u32) -> vec2u {{\n    let stored = textureLoad(seen_samples, pixel, {last});\n    \
         return vec2u({number}, stored.z | stored.w << 16u);\n}}\n",
        places.join(", ")
    );
    text
}

/// The `<over>` slot: what was drawn over, `SAMPLES` of it a pixel, and what passes through. It is bound in `group`.
pub(super) fn over(samples: u32, group: u32) -> String {
    let (texture, last) = fetched(samples);
    format!(
        "const SAMPLES: u32 = {samples}u;\n\n\
         @group({group}) @binding({OVER_SAMPLES_BINDING}) var over_samples: {texture}<f32>;\n\n\
         fn over(pixel: vec2i, sample: u32) -> vec4f {{\n    return textureLoad(over_samples, pixel, {last});\n}}\n\n\
         fn transmitted(pixel: vec2i, sample: u32) -> f32 {{\n    return 1.0 - over(pixel, sample).w;\n}}\n\n"
    )
}

/// Type of a texture of so many samples, and what its texels are fetched by beside their place.
fn fetched(samples: u32) -> (&'static str, &'static str) {
    if samples > 1 { ("texture_multisampled_2d", "sample") } else { ("texture_2d", "0") }
}
