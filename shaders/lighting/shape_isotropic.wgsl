#import "brdf/d_ggx.wgsl"
#import <visibility>

// How the microfacets are spread: the same in all directions.
struct Shape {
    alpha: f32,
}

fn make_shape(surface: Surface, alpha: f32) -> Shape {
    return Shape(alpha);
}

// As seen by a light that is a disc.
fn widened(shape: Shape, variance: f32) -> Shape {
    return Shape(sqrt(shape.alpha * shape.alpha + variance));
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
