fn premultiply(radiance: vec3f, alpha: f32) -> vec4f {
    return vec4f(radiance * alpha, alpha);
}
