#import "light/irradiance_sh.wgsl"
#import "lighting/clamp_sampler.wgsl"
#import "math/octahedral.wgsl"

// A few prefiltered lookups in the plane of incidence that stand for the specular lobe, as `bake::taps` lays them out.
@group(0) @binding(8) var taps_table: texture_2d<f32>;

const TAPS_COLUMNS: f32 = 21.0;
const TAPS_ROWS: f32 = 33.0;
const TAPS_TILES: f32 = 12.0;
// Places and spreads as the table has them, and weights of irradiance's parts.
const TAPS_SCALE: f32 = 8.0;
const TAPS_BIAS: f32 = -4.0;
const PARTS_SCALE: f32 = 4.0;
const PARTS_BIAS: f32 = -2.0;

// The lobe as taps follow it. Vectors in the panorama's frame.
struct Plane {
    mirror: vec3f,
    // Across it within the plane of incidence, away from the normal: alpha times the sine of the view's angle long.
    across: vec3f,
    NoV: f32,
    level: f32,
    normal: vec3f,
}

fn plane_of_incidence(lobes: Lobes, to_environment: mat3x3f) -> Plane {
    let n = to_environment * lobes.n;
    let v = to_environment * lobes.v;
    let alpha = lobes.perceptual_roughness * lobes.perceptual_roughness;
    let twice = 2.0 * lobes.NoV;
    let across = (n * (twice * lobes.NoV - 1.0) - v * lobes.NoV) * alpha;
    return Plane(n * twice - v, across, lobes.NoV, level_of(lobes.perceptual_roughness), n);
}

fn taps_texel(tile: f32, plane: Plane) -> vec4f {
    let steps = vec2f(TAPS_COLUMNS, TAPS_ROWS) - 1.0;
    let texel = vec2f(plane.NoV, plane.level / LAST_LEVEL) * steps + 0.5;
    let uv = (texel + vec2f(0.0, tile * TAPS_ROWS)) / vec2f(TAPS_COLUMNS, TAPS_ROWS * TAPS_TILES);
    return textureSampleLevel(taps_table, clamp_sampler, uv, 0.0);
}

// Two lookups of neighbouring levels, each at its own place: place, level and spread as the table has them. The mirror
// level, which holds the suns, is read to the same share by all taps of a lobe.
fn tap(plane: Plane, stored: vec3f) -> vec3f {
    let level = max(stored.y * LAST_LEVEL, min(plane.level, 1.0));
    let lower = min(floor(level), LAST_LEVEL - 1.0);
    let share = level - lower;
    let place = stored.x * TAPS_SCALE + TAPS_BIAS;
    let spread = stored.z * TAPS_SCALE + TAPS_BIAS;
    let narrow = octahedral_from_direction(plane.mirror + plane.across * (place + spread * share));
    let wide = octahedral_from_direction(plane.mirror + plane.across * (place - spread * (1.0 - share)));
    return mix(atlas_level(lower, narrow), atlas_level(lower + 1.0, wide), share) * environment.radiance_scale;
}

// The skirt of the lobe, of which `rest` is the share: parts of irradiance, the weights for F0 = 1 and 0.04 as the table
// has them.
fn skirt(plane: Plane, stored: vec4f, metal: vec3f, rest: vec3f) -> vec3f {
    let weights = stored * PARTS_SCALE + PARTS_BIAS;
    let linear = irradiance_linear_sh(environment.irradiance_over_pi, plane.normal);
    let quadratic = irradiance_quadratic_sh(environment.irradiance_over_pi, plane.normal);
    return environment.irradiance_over_pi[0].xyz * rest
        + linear * mix(vec3f(weights.z), vec3f(weights.x), metal)
        + quadratic * mix(vec3f(weights.w), vec3f(weights.y), metal);
}

// How much of the lobe, by energy and channel, is the one with F0 = 1; the rest is the one with F0 = 0.04. The taps'
// shares are fitted for these two, and the lobe is linear in F0.
fn share_of_metal(lobes: Lobes) -> vec3f {
    let metal = lobes.split_sum.x + lobes.split_sum.y;
    let dielectric = 0.04 * lobes.split_sum.x + lobes.split_sum.y;
    let t = saturate((lobes.single_scatter - dielectric) / max(metal - dielectric, 1e-5));
    return saturate(t * metal / max(lobes.single_scatter, vec3f(1e-5)));
}
