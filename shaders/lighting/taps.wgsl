#import "lighting/clamp_sampler.wgsl"
#import "lighting/prefiltered.wgsl"

// A few prefiltered lookups in the plane of incidence that stand for the specular lobe, as `bake::taps` lays them out.
@group(0) @binding(8) var taps_table: texture_2d<f32>;

const TAPS_COLUMNS: f32 = 17.0;
const TAPS_ROWS: f32 = 33.0;
const TAPS_TILES: f32 = 14.0;
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
    level: f32,
    normal: vec3f,
    // Where the first tile of the table is read.
    taps_uv: vec2f,
}

// What the specular lobe sees of the environment on average: irradiance stands for its wide skirt.
struct Reflection {
    // Through the taps, times their shares.
    radiance: vec3f,
    // The share that they leave to irradiance / pi.
    rest: vec3f,
    // How much more there is of irradiance's parts of degree 1 and 2.
    parts: vec2f,
}

fn plane_of_incidence(lobes: Lobes, to_environment: mat3x3f) -> Plane {
    let n = to_environment * lobes.n;
    let v = to_environment * lobes.v;
    let alpha = lobes.perceptual_roughness * lobes.perceptual_roughness;
    let twice = 2.0 * lobes.NoV;
    let across = (n * (twice * lobes.NoV - 1.0) - v * lobes.NoV) * alpha;
    let level = level_of(lobes.perceptual_roughness);
    let texel = vec2f(sqrt(lobes.NoV), level / LAST_LEVEL) * (vec2f(TAPS_COLUMNS, TAPS_ROWS) - 1.0) + 0.5;
    return Plane(n * twice - v, across, level, n, texel * (1.0 / vec2f(TAPS_COLUMNS, TAPS_ROWS * TAPS_TILES)));
}

fn taps_texel(tile: f32, plane: Plane) -> vec4f {
    return textureSampleLevel(taps_table, clamp_sampler, plane.taps_uv + vec2f(0.0, tile * (1.0 / TAPS_TILES)), 0.0);
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

// The weights of irradiance's parts, as the table has them.
fn parts(stored: vec2f) -> vec2f {
    return stored * PARTS_SCALE + PARTS_BIAS;
}

// How much of the lobe, by energy and channel, is the one with F0 = 1; the rest is the one with F0 = 0.04. The taps'
// shares are fitted for these two, and the lobe is linear in F0.
fn share_of_metal(lobes: Lobes) -> vec3f {
    let metal = lobes.split_sum.x + lobes.split_sum.y;
    let dielectric = 0.04 * lobes.split_sum.x + lobes.split_sum.y;
    let t = saturate((lobes.single_scatter - dielectric) * (1.0 / max(metal - dielectric, 1e-5)));
    return saturate(t * metal / max(lobes.single_scatter, vec3f(1e-5)));
}
