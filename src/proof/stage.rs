//! The forward shader without its pipeline: what a frame binds or interpolates is a private variable here, so that a
//! compute shader can set it and call any function of the model.

use super::ProofError;
use super::sources::SOURCES;
use crate::scene::{
    Geometry, Material, Primitive, Quality, Scene, Texture, TextureRef, TextureSlot, Topology, UvTransform,
};
use crate::shader::{
    ForwardFeatures, LightList, MaterialFeatures, SceneFeatures, ShaderSources, Slot, Slots, VertexFeatures,
    forward_slots, texel_function,
};
use glam::Vec3;
use std::fmt::Write;

/// Where the table of the Disney lobes is bound, which a frame has in its material's group.
pub(super) const DISNEY_TABLE: u32 = 9;

/// Files whose bindings become private variables.
const UNBOUND: [(&str, &str); 2] = [
    ("lighting/frame.wgsl", "var<private> frame: FrameUniform;\nvar<private> instances: array<Instance, 1>;\n"),
    ("lighting/lights.wgsl", "var<private> lights: array<Light, 1>;\n"),
];

/// A split-sum table that loses nothing: what is left of a lobe is its equation.
const LOSSLESS_DFG: (&str, &str) = (
    "lighting/dfg.wgsl",
    "fn dfg(perceptual_roughness: f32, cos_theta: f32) -> vec4f {\n    return vec4f(1.0, 0.0, 1.0, 0.0);\n}\n",
);

/// What every vertex interface offers, under the names that the generated one has.
const INTERFACE: &str = "\
struct VertexOut {
    position_in_world: vec3f,
    normal: vec3f,
    tangent: vec4f,
    color: vec4f,
}

fn vertex_color(v: VertexOut) -> vec4f {
    return v.color;
}
";

/// `sources` with the proofs' own files, and lights and frame as private variables.
pub(super) fn sources(sources: &ShaderSources) -> ShaderSources {
    let mut sources = sources.clone();
    for (path, text) in SOURCES.iter().chain(&UNBOUND) {
        sources.insert(path, (*text).to_owned());
    }
    sources
}

/// [`sources`] without any texture, and with alpha as small as one likes.
///
/// # Errors
/// When the shader's smallest alpha is not where it is looked for.
pub(super) fn sources_without_bindings(base: &ShaderSources) -> Result<ShaderSources, ProofError> {
    const LOBES: &str = "lighting/lobes.wgsl";
    let mut sources = sources(base);
    sources.insert(LOSSLESS_DFG.0, LOSSLESS_DFG.1.to_owned());
    let text = sources.get(LOBES).unwrap_or_default();
    let unclamped = text.replacen("const ALPHA_MIN: f32 = 1e-3;", "const ALPHA_MIN: f32 = 1e-6;", 1);
    if unclamped == text {
        return Err(ProofError::Row { row: LOBES.into(), reason: "declares no ALPHA_MIN of 1e-3".into() });
    }
    sources.insert(LOBES, unclamped);
    Ok(sources)
}

/// The slots of the forward shader, its interface and its material as private variables.
pub(super) fn slots(features: &ForwardFeatures) -> Slots {
    let mut slots = forward_slots(features);
    slots.insert("interface", Slot::Text(INTERFACE.to_owned()));
    slots.insert("material", Slot::Text(material()));
    slots
}

fn material() -> String {
    let count = TextureSlot::ALL.len();
    let mut text = format!(
        "var<private> material: MaterialUniform;\n\
         var<private> disney: DisneyUniform;\n\
         @group(0) @binding({DISNEY_TABLE}) var disney_table: texture_2d<f32>;\n\
         const TEXTURE_SLOTS: u32 = {count}u;\n\
         // What each texture slot reads.\nvar<private> texels: array<vec4f, TEXTURE_SLOTS>;\n"
    );
    for slot in TextureSlot::ALL {
        let index = slot as usize;
        // Normals are signed on the device (`gpu_scene::mips`).
        let read = if slot == TextureSlot::Normal { "(texels[SLOT] * 255.0 - 128.0) / 127.0" } else { "texels[SLOT]" };
        let read = read.replace("SLOT", &index.to_string());
        let _ = writeln!(text, "{}", texel_function(slot, &read));
    }
    text
}

/// Features of a lit material; every one of its texture slots is read.
pub(super) fn features(scene: SceneFeatures, material: Material) -> ForwardFeatures {
    let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::IDENTITY };
    of_material(scene, &Material { texture_slots: [Some(texture); TextureSlot::ALL.len()], ..material })
}

/// [`features`] with the normal of the vertices.
pub(super) fn features_without_normal_map(scene: SceneFeatures, material: &Material) -> ForwardFeatures {
    of_material(scene, material)
}

fn of_material(scene: SceneFeatures, material: &Material) -> ForwardFeatures {
    let primitive = Primitive {
        topology: Topology::Triangles,
        positions: Vec::new(),
        normals: Some(Vec::new()),
        tangents: Some(Vec::new()),
        uvs: Vec::new(),
        colors: Some(Vec::new()),
        indices: Vec::new(),
        material: 0,
    };
    // Whatever the numbers are: a search sets them.
    let material = &Material { emissive_nits: Vec3::ONE, specular: 0.5, ..material.clone() };
    let textures = vec![Texture { image: 0, sampler: Default::default() }];
    let of = Scene { textures, ..Default::default() };
    let material = MaterialFeatures::of(material, &primitive, &of, scene);
    let vertex = VertexFeatures::of(&material, &primitive);
    ForwardFeatures {
        scene,
        material,
        vertex,
        energy_compensation: true,
        geometry: Geometry::default(),
        quality: Quality::default(),
        term: None,
        topology: Topology::Triangles,
        channel: false,
    }
}

/// One bounce, one light: what a lobe is proven by.
pub(super) fn plain_metal() -> ForwardFeatures {
    let scene =
        SceneFeatures { punctual: true, light_list: LightList::All, environment: false, suns: 0, fresnel_tail: false };
    ForwardFeatures { energy_compensation: false, ..features(scene, Material::default()) }
}
