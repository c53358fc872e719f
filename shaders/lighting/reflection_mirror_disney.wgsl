#import "lighting/bent_mirror.wgsl"

// What the specular lobe sees of the environment on average: the split sum (Karis 2013).
fn reflected_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let t2 = lobes.alpha_x * lobes.alpha_x;
    let b2 = lobes.alpha_y * lobes.alpha_y;
    let mirror = bent_mirror_direction((t2 - b2) / (t2 + b2), lobes.b, lobes.n, lobes.v);
    return prefiltered_radiance(to_environment * mirror, lobes.perceptual_roughness);
}
