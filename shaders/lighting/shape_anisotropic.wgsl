#import "brdf/d_ggx_anisotropic.wgsl"
#import "math/vectors.wgsl"
#import <visibility_anisotropic>

// How the microfacets are spread: wider along t than along b.
struct Shape {
    alpha: f32,
    alpha_t: f32,
    t: vec3f,
    b: vec3f,
}

// KHR_materials_anisotropy: along t the spread grows to 1 with the square of the strength.
fn make_shape(surface: Surface, alpha: f32) -> Shape {
    let strength = surface.tangents.strength;
    return Shape(alpha, mix(alpha, 1.0, strength * strength), surface.tangents.t, surface.tangents.b);
}

// D V of the specular lobe.
fn D_V(shape: Shape, n: vec3f, v: vec3f, l: vec3f, h: vec3f, NoV: f32, NoL: f32) -> f32 {
    let D = D_GGX_anisotropic(shape.alpha_t, shape.alpha, shape.t, shape.b, n, h);
    return D * visibility_anisotropic(
        shape.alpha_t, shape.alpha, dot(shape.t, v), dot(shape.b, v), dot(shape.t, l), dot(shape.b, l), NoV, NoL);
}

// Where the specular lobe looks for the environment. Facets lean along t, and those that reflect toward the viewer lean
// toward it: the normal is bent to the viewer's side within the plane of t and n (after McAuley 2015), the more so the
// wider the spread along t is than along b.
fn mirror_direction(shape: Shape, n: vec3f, v: vec3f) -> vec3f {
    let leaning = normalize_or(v - shape.b * dot(shape.b, v), n);
    let bend = (shape.alpha_t - shape.alpha) / (shape.alpha_t + shape.alpha);
    return reflect(-v, normalize_or(mix(n, leaning, 0.5 * bend), n));
}
