// Radiance toward the viewer from the suns that the prefiltered maps do not hold. Smooth surfaces see them in the mirror
// level, to the share that it has in their lookup.
fn sun_radiance(lobes: Lobes) -> vec3f {
    var radiance = vec3f(0.0);
    for (var i = 0u; i < environment.sun_count; i++) {
        let sun = environment.suns[i];
        if dot(lobes.n, sun.xyz) <= 0.0 {
            continue;
        }
        let disc = lobes_of_disc(lobes, sun.w, saturate(level_of(lobes.perceptual_roughness)));
        radiance += evaluate_lobes(disc, sun.xyz) * environment.sun_illuminance[i].xyz;
    }
    return radiance;
}
