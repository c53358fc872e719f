#import "lighting/prefiltered.wgsl"
#import <irradiance>
#import <reflection>
#import <suns>

// Radiance toward the viewer from the environment, unshadowed.
fn environment_radiance(lobes: Lobes) -> vec3f {
    let to_environment = environment.environment_from_world;
    let E_over_pi = irradiance_over_pi(to_environment * lobes.n);
    let specular = reflected_radiance(lobes, to_environment) * lobes.single_scatter;
    return specular + (lobes.diffuse + lobes.multiscatter) * E_over_pi + sun_radiance(lobes);
}
