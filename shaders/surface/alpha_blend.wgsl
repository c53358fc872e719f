fn premultiply(radiance: vec3f, alpha: f32) -> vec4f {
    let coverage = saturate(alpha);
    return vec4f(radiance * coverage, coverage);
}
