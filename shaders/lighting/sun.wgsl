// Radiance toward the viewer from one of the suns that the prefiltered maps do not hold. Smooth surfaces see them in the
// mirror level, to the share that it has in their lookup.
fn radiance_of_sun(lobes: Lobes, i: u32) -> vec3f {
    let sun = environment.suns[i];
    let disc = lobes_of_disc(lobes, sun.xyz, sun.w, saturate(level_of(lobes.perceptual_roughness)));
    let seen = evaluate_lobes(disc, sun.xyz) * environment.sun_illuminance[i].xyz;
    // Not by `if`: where uniforms decide, Mesa 22.3 compiles them into the shader, and crashed on it in the deferred path.
    return select(vec3f(0.0), seen, dot(lobes.n, sun.xyz) > 0.0);
}
