fn premultiply(radiance: vec3f, alpha: f32) -> vec4f {
    return vec4f(radiance, 1.0);
}
