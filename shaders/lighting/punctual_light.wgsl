#import "light/attenuation.wgsl"
#import "math/vectors.wgsl"
#import <lights>

// Radiance toward the viewer from one point, spot or directional light, unshadowed.
fn radiance_of_light(lobes: Lobes, position: vec3f, i: u32) -> vec3f {
    let light = lights[i];
    // A directional light is at w = 0: its position is the direction toward it.
    let toward = light.position - position * light.w;
    let l = normalize_or(toward, lobes.n);
    let falloff = select(1.0, distance_attenuation(light.inverse_range_squared, dot(toward, toward)), light.w > 0.0);
    let cone = spot_attenuation(light.spot_scale, light.spot_offset, -dot(light.direction, l));
    // What arrives first: a lobe times a strong light may be infinite where the light does not reach.
    return evaluate_lobes(lobes, l) * (light.intensity * (falloff * cone));
}
