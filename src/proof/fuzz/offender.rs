//! What the shader was given where it failed.

use crate::scene::TextureSlot;
use crate::shader::types::{DisneyUniform, Light, MaterialUniform};
use serde::Serialize;
use std::fmt;

/// One evaluation in full.
#[derive(Debug, Clone, Serialize)]
pub struct Offender {
    pub evaluation: u32,
    /// Names and their numbers, as text: JSON has neither NaN nor infinity.
    pub values: Vec<(String, Vec<String>)>,
}

/// What follows material, light and texels in `Case` of `shaders/proof/fuzz.wgsl`, four numbers each.
const TAIL: [&str; 8] =
    ["viewer", "position_in_world", "normal", "tangent", "color", "front_facing", "radiance", "stored"];

/// Size of `Case`.
pub(super) const CASE_BYTES: usize = size_of::<MaterialUniform>()
    + size_of::<Light>()
    + size_of::<DisneyUniform>()
    + 16 * (TextureSlot::ALL.len() + TAIL.len());

impl Offender {
    /// From the bytes of a `Case`.
    pub(super) fn read(evaluation: u32, bytes: &[u8]) -> Self {
        let floats: Vec<f32> = bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect();
        let (material, rest) = floats.split_at(size_of::<MaterialUniform>() / 4);
        let (light, rest) = rest.split_at(size_of::<Light>() / 4);
        let (disney, rest) = rest.split_at(size_of::<DisneyUniform>() / 4);
        let mut values = fields("material", MaterialUniform::FIELDS, material);
        values.extend(fields("light", Light::FIELDS, light));
        values.extend(fields("disney", DisneyUniform::FIELDS, disney));
        let texels = TextureSlot::ALL.iter().map(|slot| format!("{}_texel", slot.name()));
        let names = texels.chain(TAIL.iter().map(|name| (*name).to_owned()));
        values.extend(names.zip(rest.chunks_exact(4)).map(|(name, value)| (name, texts(value))));
        Self { evaluation, values }
    }
}

/// The fields of a struct that lies in `floats`, without its padding and the transforms that no proof sets.
fn fields(name: &str, fields: &[(&'static str, usize)], floats: &[f32]) -> Vec<(String, Vec<String>)> {
    let ends = fields.iter().skip(1).map(|(_, offset)| offset / 4).chain([floats.len()]);
    let with_ends =
        fields.iter().zip(ends).filter(|((field, _), _)| !field.starts_with("pad") && *field != "uv_transforms");
    with_ends.map(|((field, start), end)| (format!("{name}.{field}"), texts(&floats[start / 4..end]))).collect()
}

fn texts(values: &[f32]) -> Vec<String> {
    values.iter().map(|value| format!("{value:e}")).collect()
}

impl fmt::Display for Offender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "evaluation {}", self.evaluation)?;
        self.values.iter().try_for_each(|(name, value)| write!(f, ", {name} = {}", value.join(" ")))
    }
}
