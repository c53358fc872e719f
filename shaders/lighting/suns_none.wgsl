fn radiance_of_sun(lobes: Lobes, i: u32) -> vec3f {
    return vec3f(0.0);
}

fn sun_radiance(lobes: Lobes) -> vec3f {
    return vec3f(0.0);
}
