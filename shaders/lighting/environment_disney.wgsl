#import "lighting/disney_albedo.wgsl"
#import "lighting/prefiltered.wgsl"
#import <other_lookups>
#import <reflection>
#import <suns>

// Radiance toward the viewer from the environment, unshadowed. Exact under the same radiance from everywhere; the lobes
// of the prefiltered radiance stand in for those of the Disney BRDF.
fn environment_radiance(lobes: Lobes) -> vec3f {
    let to_environment = environment.environment_from_world;
    let along = vec2f(dot(lobes.v, lobes.t), dot(lobes.v, lobes.b));
    let cos_2phi = (along.x * along.x - along.y * along.y) / max(dot(along, along), 1e-12);
    let r = lobes.perceptual_roughness;

    let pair = E_disney_specular(r, disney.anisotropic, lobes.NoV, cos_2phi);
    let specular = reflected_radiance(lobes, to_environment) * (lobes.F0 * pair.x + pair.y);

    let coat = clearcoat_radiance(lobes, to_environment)
        * (lobes.clearcoat * E_disney_clearcoat(disney.clearcoat_gloss, lobes.NoV));

    let albedo = E_disney_smooth(r, lobes.NoV);
    let burley = albedo.x * (1.0 - lobes.subsurface);
    let subsurface = albedo.y * lobes.subsurface;
    let below = diffuse_radiance(lobes, subsurface / max(burley + subsurface, 1e-6), to_environment)
        * lobes.diffuse * (burley + subsurface);
    let sheen = sheen_radiance(lobes, to_environment) * lobes.sheen * albedo.z;
    return below + sheen + specular * lobes.specular_share + coat + sun_radiance(lobes);
}
