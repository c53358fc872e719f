#import "brdf/d_ggx_anisotropic.wgsl"
#import "math/vectors.wgsl"
#import "lighting/bent_mirror.wgsl"
#import "lighting/dfg.wgsl"
#import <visibility_anisotropic>

// How the microfacets are spread: wider along t than along b.
struct Shape {
    alpha: f32,
    alpha_t: f32,
    t: vec3f,
    // Mean of both alpha^2, and their contrast.
    mean: f32,
    b: vec3f,
    contrast: f32,
}

// KHR_materials_anisotropy: along t the spread grows to 1 with the square of the strength.
fn make_shape(surface: Surface, alpha: f32) -> Shape {
    let strength = surface.tangents.strength;
    let alpha_t = mix(alpha, 1.0, strength * strength);
    let t2 = alpha_t * alpha_t;
    let b2 = alpha * alpha;
    return Shape(alpha, alpha_t, surface.tangents.t, 0.5 * (t2 + b2), surface.tangents.b, (t2 - b2) / (t2 + b2));
}

// As seen by a light that is a disc: wider by the variance of its half vectors, a quarter of their squared radius. The
// tables of albedo stay.
fn widened(shape: Shape, spread: f32) -> Shape {
    var wider = shape;
    wider.alpha = sqrt(shape.alpha * shape.alpha + spread);
    wider.alpha_t = sqrt(shape.alpha_t * shape.alpha_t + spread);
    return wider;
}

// D averaged over the disc, over D of that shape at its middle.
fn disc_share(shape: Shape, n: vec3f, h: vec3f, VoH: f32, spread: f32) -> f32 {
    return 1.0;
}

// D V of the specular lobe.
fn D_V(shape: Shape, n: vec3f, v: vec3f, l: vec3f, h: vec3f, NoV: f32, NoL: f32) -> f32 {
    let D = D_GGX_anisotropic(shape.alpha_t, shape.alpha, shape.t, shape.b, n, h);
    return D * visibility_anisotropic(
        shape.alpha_t, shape.alpha, dot(shape.t, v), dot(shape.b, v), dot(shape.t, l), dot(shape.b, l), NoV, NoL);
}

// Where the tables of albedo are read for a direction: the perceptual roughness of isotropic facets of about the same
// albedo. Fitted to albedos by quadrature; light and view are read apart, so they can still be exchanged.
fn albedo_perceptual_roughness(shape: Shape, perceptual_roughness: f32, x: vec3f) -> f32 {
    let along = dot(shape.t, x);
    let across = dot(shape.b, x);
    let lean = 0.4 * shape.contrast * (along * along - across * across);
    return sqrt(sqrt(shape.mean * (1.0 - 0.2 * shape.contrast * shape.contrast - lean)));
}

// Averages of the tables over directions.
fn albedo_average(shape: Shape, table: vec4f) -> vec2f {
    return dfg(sqrt(sqrt(shape.mean * (1.0 - 0.2 * shape.contrast * shape.contrast))), 1.0).zw;
}

// How much of the energy lost by single scattering is given back. The albedo is known within a few hundredths only, so
// this fades with the contrast: no body may be brighter than the light that falls on it.
fn compensated_share(shape: Shape) -> f32 {
    return 1.0 - shape.contrast * shape.contrast;
}

// Where the specular lobe looks for the environment.
fn mirror_direction(shape: Shape, n: vec3f, v: vec3f) -> vec3f {
    return bent_mirror_direction(shape.contrast, shape.b, n, v);
}
