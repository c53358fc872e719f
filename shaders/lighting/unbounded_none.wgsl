fn unbounded_radiance(lobes: Lobes, position: vec3f) -> vec3f {
    return vec3f(0.0);
}
