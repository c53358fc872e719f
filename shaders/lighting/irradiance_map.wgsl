#import "lighting/prefiltered.wgsl"

// Irradiance / pi on a surface: the last level of the specular maps is seen through the cosine.
fn irradiance_over_pi(n: vec3f) -> vec3f {
    return atlas_level(LAST_LEVEL, octahedral_from_direction(n)) * environment.radiance_scale;
}
