#import "light/attenuation.wgsl"

// What a point light without a range sends to a point: cd and metres to lux.
fn point_illuminance(intensity: f32, toward: vec3f) -> f32 {
    return intensity * distance_attenuation(0.0, dot(toward, toward));
}
