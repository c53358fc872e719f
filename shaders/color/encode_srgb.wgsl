#import "color/srgb.wgsl"

fn encode(linear: vec3f) -> vec3f {
    return srgb_from_linear(linear);
}
