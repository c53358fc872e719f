#import "lighting/flat_lobes.wgsl"
#import <irradiance>
#import <reflection>
#import <suns>

// Radiance toward the viewer from the environment, unshadowed. Light without a peak is irradiance, whose parts of degree 1
// and 2 each lobe weighs otherwise; under uniform light the parts are nothing, and the albedo is exact.
fn environment_radiance(lobes: Lobes) -> vec3f {
    let plane = plane_of_incidence(lobes, environment.environment_from_world);
    let seen = reflection(plane, share_of_metal(lobes));
    let skirt = lobes.single_scatter * seen.rest;
    let multiscatter = multiscatter_parts(lobes.perceptual_roughness);
    let diffuse = coated_parts(lobes.perceptual_roughness) * lobes.coat_F90;
    let linear = lobes.single_scatter * seen.parts.x + lobes.multiscatter * multiscatter.x + lobes.diffuse * diffuse.x;
    let quadratic = lobes.single_scatter * seen.parts.y + lobes.multiscatter * multiscatter.y + lobes.diffuse * diffuse.y;
    let smooth_light = irradiance_over_pi(plane.normal) * (skirt + lobes.multiscatter + lobes.diffuse)
        + irradiance_linear_sh(environment.irradiance_over_pi, plane.normal) * linear
        + irradiance_quadratic_sh(environment.irradiance_over_pi, plane.normal) * quadratic;
    return max(seen.radiance * lobes.single_scatter + smooth_light, vec3f(0.0)) + sun_radiance(lobes);
}
