//! Every struct that crosses to the GPU.
//!
//! Positions are relative to the scene's origin (its centre), so that a model far from the world's origin keeps its
//! precision in f32.
#![expect(non_snake_case, reason = "equation symbols keep their case in both languages")]

use super::layout::gpu_struct;

gpu_struct! {
    /// What one view needs in every draw.
    pub struct FrameUniform {
        clip_from_world: mat4x4f,
        /// Perspective: camera position and 1. Orthographic: unit vector toward the viewer and 0.
        viewer: vec4f,
        light_count: u32,
        /// Of a channel in place of the radiance, see `scene::Channel`: what it is, which light, and the components of the BRDF as bits.
        channel: u32,
        channel_index: u32,
        channel_components: u32,
        /// Factor before the tone map, where the target holds display light.
        exposure: f32,
        pad_0: f32,
        pad_1: f32,
        pad_2: f32,
    }
}

gpu_struct! {
    /// One placed mesh.
    pub struct Instance {
        /// Rows of the affine transform: position_in_world = vec4f(position, 1) * world_from_object.
        world_from_object: mat3x4f,
        /// Inverse transpose up to a positive factor, from cofactors: turns normals right under any scale.
        normal_from_object: mat3x3f,
        /// -1 where the transform mirrors, else 1: the sign of the bitangent turns with it.
        handedness: f32,
        pad_0: f32,
        pad_1: f32,
        pad_2: f32,
    }
}

gpu_struct! {
    /// A point, spot or directional light.
    pub struct Light {
        /// Position and w = 1, or for a directional light the unit vector toward it and w = 0.
        position: vec3f,
        w: f32,
        /// cd, or lux for a directional light.
        intensity: vec3f,
        /// 1/m^2; 0 without a range.
        inverse_range_squared: f32,
        /// Unit vector along the light's axis, away from it.
        direction: vec3f,
        spot_scale: f32,
        spot_offset: f32,
        pad_0: f32,
        pad_1: f32,
        pad_2: f32,
    }
}

gpu_struct! {
    /// From a point of the scene to its cluster, and what no cluster lists.
    pub struct ClusterUniform {
        /// To clip space with x and y in tiles, from the left and from below.
        tiles_from_world: mat4x4f,
        /// The slice of a point is the logarithm of its w times the first, plus its z times the second, plus the third.
        slice_per_octave: f32,
        slice_per_clip_z: f32,
        slice_bias: f32,
        /// Lights that reach everything; they come first.
        unbounded: u32,
        columns: u32,
        rows: u32,
        slices: u32,
        pad_0: u32,
    }
}

gpu_struct! {
    /// The environment as shading reads it.
    pub struct EnvironmentUniform {
        /// Premultiplied coefficients, see `scene::EnvironmentMaps`, times the intensity.
        irradiance_over_pi: [vec4f; 9],
        /// Of the atlas: the size of a texel as texture coordinates, and the sides of the tiles of levels 0 and 1, texels.
        atlas: vec4f,
        environment_from_world: mat3x3f,
        /// Intensity, and the scale that brought the radiance into half-float range.
        radiance_scale: f32,
        pad_0: f32,
        pad_1: f32,
        pad_2: f32,
        /// In the world, with what the disc adds to alpha squared.
        suns: [vec4f; 4],
        /// Lux, times the intensity.
        sun_illuminance: [vec4f; 4],
    }
}

gpu_struct! {
    /// Factors of a material; textures multiply them.
    pub struct MaterialUniform {
        base_color: vec4f,
        emissive: vec3f,
        metallic: f32,
        specular_color: vec3f,
        specular: f32,
        perceptual_roughness: f32,
        dielectric_F0: f32,
        normal_scale: f32,
        occlusion_strength: f32,
        alpha_cutoff: f32,
        pad_0: f32,
        pad_1: f32,
        pad_2: f32,
        /// Strength, and the cosine and sine of the rotation.
        anisotropy: vec4f,
        /// Lazanyi's a of the metal.
        lazanyi_a: vec3f,
        pad_3: f32,
        /// Complex index of refraction of the metal.
        conductor_n: vec3f,
        pad_4: f32,
        conductor_k: vec3f,
        pad_5: f32,
        /// Two rows a texture slot: uv' = (dot(row_0.xyz, (u, v, 1)), dot(row_1.xyz, (u, v, 1))).
        uv_transforms: [vec4f; 16],
    }
}

gpu_struct! {
    /// The parameters of a Disney material that others do not have, each in [0, 1].
    pub struct DisneyUniform {
        subsurface: f32,
        specular: f32,
        specular_tint: f32,
        anisotropic: f32,
        sheen: f32,
        sheen_tint: f32,
        clearcoat: f32,
        clearcoat_gloss: f32,
    }
}

gpu_struct! {
    /// The panorama behind the scene.
    pub struct BackgroundUniform {
        /// Direction in the panorama's frame from (ndc.x, ndc.y, 1); not normalised.
        direction_from_ndc: mat3x3f,
        radiance_scale: f32,
        /// Factor before the tone map, where the target holds display light.
        exposure: f32,
        /// Of the lobe through which a blurred panorama is seen.
        perceptual_roughness: f32,
        /// That lobe, for a sun: D_GGX times the cosine times this integrates to 1.
        sun_scale: f32,
    }
}

gpu_struct! {
    /// From scene radiance to the display.
    pub struct DisplayUniform {
        /// Linear display light, and 1 when it fills what is not covered, 0 when coverage goes to alpha.
        background: vec4f,
        exposure: f32,
        pad_0: f32,
        pad_1: f32,
        pad_2: f32,
    }
}

gpu_struct! {
    /// Finished pictures to a window.
    pub struct PresentUniform {
        /// Display values behind pixels that are not covered.
        behind: vec4f,
        /// Where the right picture begins, pixels from the left.
        split_px: f32,
        /// Half the width of the line between the two.
        line_px: f32,
        pad_0: f32,
        pad_1: f32,
    }
}

gpu_struct! {
    /// A draw whose pixels are shaded in a pass of their own, which fetches the vertices by itself.
    pub struct PulledDraw {
        /// Where its triangles and vertices begin, in texels.
        first_triangle: u32,
        first_vertex: u32,
        /// Of the draw in its frame, from 1.
        number: u32,
        /// 1, or -1 where the transform mirrors: front faces are clockwise then.
        front: f32,
        /// Of its only place, as `Instance` has it.
        world_from_object: mat3x4f,
        /// What normalised device coordinates change by to the next pixel, to the right and down.
        ndc_step: vec2f,
        pad_0: f32,
        pad_1: f32,
    }
}

/// A struct's name, its WGSL declaration, the offsets of its fields, and its size.
pub type Declaration = (&'static str, &'static str, &'static [(&'static str, usize)], usize);

/// Every struct.
pub const ALL: &[Declaration] = &[
    ("FrameUniform", FrameUniform::WGSL, FrameUniform::FIELDS, size_of::<FrameUniform>()),
    ("Instance", Instance::WGSL, Instance::FIELDS, size_of::<Instance>()),
    ("Light", Light::WGSL, Light::FIELDS, size_of::<Light>()),
    ("ClusterUniform", ClusterUniform::WGSL, ClusterUniform::FIELDS, size_of::<ClusterUniform>()),
    ("EnvironmentUniform", EnvironmentUniform::WGSL, EnvironmentUniform::FIELDS, size_of::<EnvironmentUniform>()),
    ("MaterialUniform", MaterialUniform::WGSL, MaterialUniform::FIELDS, size_of::<MaterialUniform>()),
    ("DisneyUniform", DisneyUniform::WGSL, DisneyUniform::FIELDS, size_of::<DisneyUniform>()),
    ("BackgroundUniform", BackgroundUniform::WGSL, BackgroundUniform::FIELDS, size_of::<BackgroundUniform>()),
    ("PulledDraw", PulledDraw::WGSL, PulledDraw::FIELDS, size_of::<PulledDraw>()),
    ("DisplayUniform", DisplayUniform::WGSL, DisplayUniform::FIELDS, size_of::<DisplayUniform>()),
    ("PresentUniform", PresentUniform::WGSL, PresentUniform::FIELDS, size_of::<PresentUniform>()),
];

/// All of them as WGSL: the `<types>` slot.
pub fn wgsl() -> String {
    ALL.iter().map(|(_, text, _, _)| *text).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn naga_lays_every_struct_out_as_rust_does() {
        let module = naga::front::wgsl::parse_str(&wgsl()).unwrap();
        for (name, _, fields, size) in ALL {
            let (_, ty) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).unwrap();
            let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is not a struct") };
            assert_eq!(*span as usize, *size, "{name}: size");
            for (member, (field, offset)) in members.iter().zip(*fields) {
                assert_eq!((member.name.as_deref(), member.offset as usize), (Some(*field), *offset), "{name}");
            }
        }
    }
}
