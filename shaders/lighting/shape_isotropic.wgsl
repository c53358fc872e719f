#import "brdf/d_ggx.wgsl"
#import <visibility>

// How the microfacets are spread: the same in all directions.
struct Shape {
    alpha: f32,
}

// Least squared cosine of half vectors in slopes, which grow without bound: where light and view both graze, in f32 they
// would be infinite, and the share 0 times that. The share is 1 long before.
const HALF_COS2_MIN: f32 = 1e-6;

fn make_shape(surface: Surface, alpha: f32) -> Shape {
    return Shape(alpha);
}

// D averaged over the half vectors of a light that is a disc, over D at its middle; `spread` is the squared radius of
// those seen along the normal. Slopes of GGX facets are the stereographic projection of an even sphere, scaled by alpha,
// so those in a disc are a spherical cap.
fn disc_share(shape: Shape, n: vec3f, h: vec3f, VoH: f32, spread: f32) -> f32 {
    let chord = n - h;
    let chord2 = dot(chord, chord);
    let sin2 = chord2 * (1.0 - 0.25 * chord2);
    let alpha2 = shape.alpha * shape.alpha;
    let middle = alpha2 + sin2 / max(1.0 - sin2, HALF_COS2_MIN);
    let radius2 = spread / VoH;
    let x = middle - radius2;
    let s = sqrt(x * x + 4.0 * alpha2 * radius2);
    // Two forms of one number, each without cancellation.
    let outside = 2.0 / (s * (s + x));
    let inside = (s - x) / (2.0 * alpha2 * radius2 * s);
    return middle * middle * select(inside, outside, x > 0.0);
}

// As seen by a light that is a disc.
fn widened(shape: Shape, spread: f32) -> Shape {
    return shape;
}

// D V of the specular lobe.
fn D_V(shape: Shape, n: vec3f, v: vec3f, l: vec3f, h: vec3f, NoV: f32, NoL: f32) -> f32 {
    return D_GGX(shape.alpha, n, h) * visibility(shape.alpha, NoV, NoL);
}

// Where the tables of albedo are read for a direction, and their averages.
fn albedo_perceptual_roughness(shape: Shape, perceptual_roughness: f32, x: vec3f) -> f32 {
    return perceptual_roughness;
}

fn albedo_average(shape: Shape, table: vec4f) -> vec2f {
    return table.zw;
}

// How much of the energy lost by single scattering is given back.
fn compensated_share(shape: Shape) -> f32 {
    return 1.0;
}

// Where the specular lobe looks for the environment.
fn mirror_direction(shape: Shape, n: vec3f, v: vec3f) -> vec3f {
    return reflect(-v, n);
}
