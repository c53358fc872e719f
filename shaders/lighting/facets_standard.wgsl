fn facets_of(lobes: Lobes) -> Facets {
    return Facets(lobes.shape.t, lobes.shape.alpha_t, lobes.shape.b, lobes.shape.alpha);
}

// F G2 / G1(v) of height-correlated Smith up to a factor; directions in the frame of tangent, bitangent and normal.
fn share_of_facet(lobes: Lobes, v: vec3f, l: vec3f, VoH: f32) -> vec3f {
    let alpha = vec3f(lobes.shape.alpha_t, lobes.shape.alpha, 1.0);
    let NoL = max(l.z, 0.0);
    let shadowed = NoL / max(NoL * length(alpha * v) + v.z * length(alpha * l), 1e-8);
    return reflectance(lobes.fresnel, VoH) * shadowed;
}
