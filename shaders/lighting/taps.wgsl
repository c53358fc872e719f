#import "lighting/clamp_sampler.wgsl"
#import "math/vectors.wgsl"

// A few prefiltered lookups in the plane of incidence that stand for the specular lobe, as `bake::taps` lays them out.
@group(0) @binding(8) var taps_table: texture_2d<f32>;

const TAPS_SIDE: f32 = 21.0;
const TAPS_TILES: f32 = 5.0;

fn taps_texel(tile: f32, lobes: Lobes) -> vec4f {
    let texel = vec2f(lobes.NoV, lobes.perceptual_roughness) * (TAPS_SIDE - 1.0) + 0.5;
    let uv = (texel + vec2f(0.0, tile * TAPS_SIDE)) / vec2f(TAPS_SIDE, TAPS_SIDE * TAPS_TILES);
    return textureSampleLevel(taps_table, clamp_sampler, uv, 0.0);
}

// The plane of incidence in the panorama's frame, and the lobe that is seen in it.
struct Plane {
    normal: vec3f,
    // Across the normal, to the side of the mirror direction.
    tangent: vec3f,
    // Of the view.
    cos_theta: f32,
    sin_theta: f32,
    perceptual_roughness: f32,
    alpha: f32,
}

fn plane_of_incidence(lobes: Lobes, to_environment: mat3x3f) -> Plane {
    let r = lobes.perceptual_roughness;
    let tangent = normalize_or(lobes.n * lobes.NoV - lobes.v, lobes.n);
    let sin_theta = sqrt(max(1.0 - lobes.NoV * lobes.NoV, 0.0));
    return Plane(to_environment * lobes.n, to_environment * tangent, lobes.NoV, sin_theta, r, r * r);
}

// Radiance of one tap; `offset` and `width` as they are stored. The mirror level, which holds the suns, is read to the
// same share by all taps of a lobe.
fn tap(plane: Plane, offset: f32, width: f32) -> vec3f {
    let angle = (offset * 16.0 - 8.0) * plane.alpha;
    let c = cos(angle);
    let s = sin(angle);
    let direction = plane.normal * (plane.cos_theta * c - plane.sin_theta * s)
        + plane.tangent * (plane.sin_theta * c + plane.cos_theta * s);
    let r = min(plane.perceptual_roughness * sqrt(8.0 * width), 1.0);
    return prefiltered_radiance(direction, max(r, min(plane.perceptual_roughness, 1.0 / environment.level_scale)));
}

// How much of the lobe, by energy and channel, is the one with F0 = 1; the rest is the one with F0 = 0.04. The taps'
// shares are fitted for these two, and the lobe is linear in F0.
fn share_of_metal(lobes: Lobes) -> vec3f {
    let metal = lobes.split_sum.x + lobes.split_sum.y;
    let dielectric = 0.04 * lobes.split_sum.x + lobes.split_sum.y;
    let t = saturate((lobes.single_scatter - dielectric) / max(metal - dielectric, 1e-5));
    return saturate(t * metal / max(lobes.single_scatter, vec3f(1e-5)));
}
