#import "light/irradiance_sh.wgsl"
#import "math/vectors.wgsl"

// What the lobes without a peak see of the environment on average. Numbers were fitted to the lobes under random
// environments whose power falls with the degree as (1 + l)^-2.

// Where the plane of incidence meets the surface, on the side of the mirror direction.
fn forward(lobes: Lobes) -> vec3f {
    return normalize_or(lobes.n * lobes.NoV - lobes.v, lobes.n);
}

// The sheen grows toward the direction opposite to the viewer, as far as that is above the surface: it is as wide as GGX
// of perceptual roughness 1/2, 63 to 68 degrees from the normal.
fn sheen_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let direction = normalize(lobes.n + forward(lobes) * (1.95 + 0.6 * lobes.NoV));
    return prefiltered_radiance(to_environment * direction, 0.5);
}

// Irradiance / pi with the harmonics of degree 1 and 2 scaled, for lobes that are flatter than the cosine.
fn irradiance_scaled(direction: vec3f, degree_1: f32, degree_2: f32) -> vec3f {
    let linear = irradiance_linear_sh(environment.irradiance_over_pi, direction) * degree_1;
    let quadratic = irradiance_quadratic_sh(environment.irradiance_over_pi, direction) * degree_2;
    return max(environment.irradiance_over_pi[0].xyz + linear + quadratic, vec3f(0.0));
}

// Rough surfaces send light back to where it came from: seen from the side their lobe leans toward the viewer. The one
// of subsurface scattering is flatter than the cosine. `subsurface_share` is its share of the diffuse light.
fn diffuse_radiance(lobes: Lobes, subsurface_share: f32, to_environment: mat3x3f) -> vec3f {
    let r = lobes.perceptual_roughness;
    let aside = 1.0 - lobes.NoV;
    let direction = normalize(lobes.n - forward(lobes) * (0.28 * r * aside * aside * aside));
    let degree_1 = 0.96 - (0.04 + 0.03 * r) * aside;
    let degree_2 = 0.79 - 0.03 * r - (0.14 + 0.11 * r) * aside;
    let scales = mix(vec2f(1.0), vec2f(degree_1, degree_2), subsurface_share);
    return irradiance_scaled(to_environment * direction, scales.x, scales.y);
}
