#import "math/constants.wgsl"

// Lambert's diffuse BRDF for albedo 1, 1/sr.
fn Fd_Lambert() -> f32 {
    return INV_PI;
}
