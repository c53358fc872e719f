#import "lighting/prefiltered.wgsl"

// Radiance toward the viewer from the environment by the split sum (Karis 2013), unshadowed.
fn environment_radiance(lobes: Lobes) -> vec3f {
    let to_environment = environment.environment_from_world;
    let mirror = mirror_direction(lobes.shape, lobes.n, lobes.v);
    let specular = prefiltered_radiance(to_environment * mirror, lobes.perceptual_roughness) * lobes.single_scatter;
    let E_over_pi = irradiance_over_pi_sh(environment.irradiance_over_pi, to_environment * lobes.n);
    return specular + (lobes.diffuse + lobes.multiscatter) * E_over_pi;
}
