#import "proof/inputs.wgsl"

// The specular lobe of a white metal times the cosine of the light, by the code that draws: F = 1, one bounce.
fn specular_lobe(perceptual_roughness: f32, n: vec3f, v: vec3f, l: vec3f) -> f32 {
    var surface: Surface;
    surface.n = n;
    surface.v = v;
    surface.base_color = vec3f(1.0);
    surface.metallic = 1.0;
    surface.perceptual_roughness = perceptual_roughness;
    return evaluate_lobes(make_lobes(surface), l).x;
}
