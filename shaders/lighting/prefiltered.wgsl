#import "light/irradiance_sh.wgsl"
#import "lighting/clamp_sampler.wgsl"
#import "math/octahedral.wgsl"

@group(0) @binding(5) var<uniform> environment: EnvironmentUniform;
@group(0) @binding(6) var environment_atlas: texture_2d<f32>;

// Levels of the specular maps: 0 is the mirror image, 1 has this perceptual roughness, from there alpha doubles. Below 1
// a level is the share of level 1 in the mixture with the mirror image that is nearest to the lobe.
const FINEST_PERCEPTUAL_ROUGHNESS: f32 = 0.08838834764831845;
const LAST_LEVEL: f32 = 8.0;

fn level_of(perceptual_roughness: f32) -> f32 {
    let x = perceptual_roughness * (1.0 / FINEST_PERCEPTUAL_ROUGHNESS);
    let below = x * x * x * (6.0 + x * (3.0 * x - 8.0));
    return select(LAST_LEVEL + 2.0 * log2(perceptual_roughness), below, x < 1.0);
}

// What one level holds, at octahedral coordinates. Tiles lie as `SpecularTile::of_level` says.
fn atlas_level(level: f32, uv: vec2f) -> vec3f {
    let mirror_side = environment.atlas.z;
    let finest_side = environment.atlas.w;
    let pair = floor(0.5 * level - 0.5);
    let share = exp2(-pair);
    let side = max(share, 0.25) * finest_side;
    let column = (level - 1.0 - 2.0 * pair) * (side + 2.0);
    let row = mirror_side + 2.0 + 2.0 * finest_side * (1.0 - share) + 2.0 * pair;
    let texel = select(vec2f(column, row) + uv * side, uv * mirror_side, level < 0.5) + 1.0;
    return textureSampleLevel(environment_atlas, clamp_sampler, texel * environment.atlas.xy, 0.0).xyz;
}

// GGX-prefiltered radiance around a direction of the panorama, linear between two levels.
fn prefiltered_radiance(direction: vec3f, perceptual_roughness: f32) -> vec3f {
    let uv = octahedral_from_direction(direction);
    let level = level_of(perceptual_roughness);
    let lower = min(floor(level), LAST_LEVEL - 1.0);
    return mix(atlas_level(lower, uv), atlas_level(lower + 1.0, uv), level - lower) * environment.radiance_scale;
}
