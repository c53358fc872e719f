#import "lighting/disney_albedo.wgsl"
#import "lighting/prefiltered.wgsl"
#import <suns>

// Reflections that stand for a lobe that is longer than wide.
const TAPS: i32 = 15;

// The environment as the specular lobe sees it. A prefiltered lobe is round: several, as narrow as the lobe across the
// tangent, lie along it. GGX with the excess of alpha_x over alpha_y has the share (1 + c) / 2 of its slopes below
// c / sqrt(1 - c^2), and a facet counts as much as it is seen and lit.
fn specular_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let excess = max(lobes.alpha_x * lobes.alpha_x - lobes.alpha_y * lobes.alpha_y, 0.0);
    if excess == 0.0 {
        return prefiltered_radiance(to_environment * reflect(-lobes.v, lobes.n), lobes.perceptual_roughness);
    }
    let step = 2.0 / f32(TAPS);
    // Wide enough to meet its neighbours.
    let alpha = sqrt(lobes.alpha_y * lobes.alpha_y + excess * step * step * 0.25);
    // The mirror level, which holds the suns, is read to the share that `sun_radiance` leaves.
    let least_r = min(lobes.perceptual_roughness, FINEST_PERCEPTUAL_ROUGHNESS);
    var sum = vec4f(0.0);
    for (var i = 0; i < TAPS; i++) {
        let c = (f32(i) + 0.5) * step - 1.0;
        let h = normalize(lobes.n + lobes.t * (sqrt(excess / (1.0 - c * c)) * c));
        let l = reflect(-lobes.v, h);
        let weight = saturate(dot(lobes.v, h)) * G1_SmithGGX(lobes.masking, saturate(dot(lobes.n, l))) / dot(lobes.n, h);
        sum += vec4f(prefiltered_radiance(to_environment * l, clamp(sqrt(alpha), least_r, 1.0)), 1.0) * weight;
    }
    return sum.xyz / max(sum.w, 1e-12);
}

// Radiance toward the viewer from the environment, unshadowed. Exact under the same radiance from everywhere; the lobes
// of the prefiltered radiance stand in for those of the Disney BRDF.
fn environment_radiance(lobes: Lobes) -> vec3f {
    let to_environment = environment.environment_from_world;
    let along = vec2f(dot(lobes.v, lobes.t), dot(lobes.v, lobes.b));
    let cos_2phi = (along.x * along.x - along.y * along.y) / max(dot(along, along), 1e-12);
    let r = lobes.perceptual_roughness;

    let pair = E_disney_specular(r, disney.anisotropic, lobes.NoV, cos_2phi);
    let specular = specular_radiance(lobes, to_environment) * (lobes.F0 * pair.x + pair.y);

    // The GGX lobe that has half of its facets within the same angle as GTR1: alpha_GGX = sqrt(alpha_GTR1).
    let coat_r = sqrt(sqrt(lobes.clearcoat_alpha));
    let coat_radiance = prefiltered_radiance(to_environment * reflect(-lobes.v, lobes.n), coat_r);
    let coat = coat_radiance * (lobes.clearcoat * E_disney_clearcoat(disney.clearcoat_gloss, lobes.NoV));

    let albedo = E_disney_smooth(r, lobes.NoV);
    let smooth_part = lobes.diffuse * mix(albedo.x, albedo.y, lobes.subsurface) + lobes.sheen * albedo.z;
    let E_over_pi = irradiance_over_pi_sh(environment.irradiance_over_pi, to_environment * lobes.n);
    return smooth_part * E_over_pi + specular + coat + sun_radiance(lobes);
}
