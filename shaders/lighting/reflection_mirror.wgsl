// What the specular lobe sees of the environment on average: the split sum (Karis 2013).
fn reflected_radiance(lobes: Lobes, to_environment: mat3x3f, sky: Harmonics) -> vec3f {
    let mirror = mirror_direction(lobes.shape, lobes.n, lobes.v);
    return prefiltered_radiance(to_environment * mirror, lobes.perceptual_roughness);
}
