#import "light/irradiance_sh.wgsl"
#import "lighting/clamp_sampler.wgsl"
#import "math/octahedral.wgsl"

@group(0) @binding(5) var<uniform> environment: EnvironmentUniform;
@group(0) @binding(6) var environment_atlas: texture_2d<f32>;

fn atlas_level(level: u32, uv: vec2f) -> vec3f {
    let tile = environment.tiles[level];
    return textureSampleLevel(environment_atlas, clamp_sampler, tile.xy + uv * tile.zw, 0.0).xyz;
}

// GGX-prefiltered radiance around a unit direction of the panorama, linear between two levels of perceptual roughness.
fn prefiltered_radiance(direction: vec3f, perceptual_roughness: f32) -> vec3f {
    let uv = octahedral_from_direction(direction);
    let level = perceptual_roughness * environment.level_scale;
    let lower = u32(min(level, environment.level_scale - 1.0));
    return mix(atlas_level(lower, uv), atlas_level(lower + 1u, uv), level - f32(lower)) * environment.radiance_scale;
}
