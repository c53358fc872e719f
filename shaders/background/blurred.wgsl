#import "brdf/d_ggx.wgsl"
#import "lighting/half_vector.wgsl"
#import "lighting/prefiltered.wgsl"

// The panorama through the lobe of its prefiltered maps, and the suns that these do not hold through the same lobe, to
// the share that their mirror level, which has the suns, leaves.
fn backdrop(d: vec3f) -> vec3f {
    let r = background.perceptual_roughness;
    let in_world = d * environment.environment_from_world;
    var radiance = prefiltered_radiance(d, r);
    // All places: where no sun is, there is no illuminance.
    for (var i = 0u; i < 4u; i++) {
        let sun = environment.suns[i];
        let NoL = saturate(dot(in_world, sun.xyz));
        let D = D_GGX(min(sqrt(r * r * r * r + sun.w), 1.0), in_world, unit_half_vector(sun.xyz, in_world));
        radiance += environment.sun_illuminance[i].xyz * (D * NoL * background.sun_scale * saturate(level_of(r)));
    }
    return radiance;
}
