fn premultiply(radiance: vec3f, alpha: f32) -> vec4f {
    if alpha < material.alpha_cutoff {
        discard;
    }
    return vec4f(radiance, 1.0);
}
