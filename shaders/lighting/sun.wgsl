// Radiance toward the viewer from one of the suns that the prefiltered maps do not hold. Smooth surfaces see them in the
// mirror level, to the share that it has in their lookup.
fn radiance_of_sun(lobes: Lobes, i: u32) -> vec3f {
    let sun = environment.suns[i];
    if dot(lobes.n, sun.xyz) <= 0.0 {
        return vec3f(0.0);
    }
    let disc = lobes_of_disc(lobes, sun.xyz, sun.w, saturate(level_of(lobes.perceptual_roughness)));
    return evaluate_lobes(disc, sun.xyz) * environment.sun_illuminance[i].xyz;
}
