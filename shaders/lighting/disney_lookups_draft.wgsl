#import "lighting/disney_smooth.wgsl"

// What the clearcoat sees of the environment on average, by one tap: narrower than its facets, for it is seen from the
// side. Numbers as in disney_smooth.wgsl.
fn clearcoat_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let alpha = 0.629 * pow(lobes.clearcoat_alpha, 0.523) * (0.539 + lobes.NoV);
    return prefiltered_radiance(to_environment * reflect(-lobes.v, lobes.n), sqrt(alpha));
}
