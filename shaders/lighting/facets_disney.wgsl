fn facets_of(lobes: Lobes) -> Facets {
    return Facets(lobes.t, lobes.alpha_x, lobes.b, lobes.alpha_y);
}

// F G1(l): directions in the frame of tangent, bitangent and normal.
fn share_of_facet(lobes: Lobes, v: vec3f, l: vec3f, VoH: f32) -> vec3f {
    return F_Schlick(lobes.F0, 1.0, VoH) * G1_SmithGGX(lobes.masking, saturate(l.z));
}
