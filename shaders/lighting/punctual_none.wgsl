fn radiance_of_light(lobes: Lobes, position: vec3f, i: u32) -> vec3f {
    return vec3f(0.0);
}

fn punctual_radiance(lobes: Lobes, position: vec3f) -> vec3f {
    return vec3f(0.0);
}

fn punctual_count(position: vec3f) -> u32 {
    return 0u;
}
