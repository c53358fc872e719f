fn sun_radiance(lobes: Lobes) -> vec3f {
    return vec3f(0.0);
}
