// What the lobes beside the specular one see of the environment on average, as in the split sum: by one lookup each.

// Half of the facets of GTR1 lie within the same angle as those of GGX with alpha_GGX = sqrt(alpha_GTR1).
fn clearcoat_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let mirror = to_environment * reflect(-lobes.v, lobes.n);
    return prefiltered_radiance(mirror, sqrt(sqrt(lobes.clearcoat_alpha)));
}

fn sheen_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    return irradiance_over_pi_sh(environment.irradiance_over_pi, to_environment * lobes.n);
}

fn diffuse_radiance(lobes: Lobes, subsurface_share: f32, to_environment: mat3x3f) -> vec3f {
    return irradiance_over_pi_sh(environment.irradiance_over_pi, to_environment * lobes.n);
}
