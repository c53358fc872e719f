#import <dielectric>
#import <emission>
#import <occlusion>
#import <reflecting>
#import <normal>
#import <facing>
#import <tangents>
#import <tangent>

// What a material says about one point: all that shading needs beside the lights.
struct Surface {
    // Unit shading normal on the viewer's side, and unit vector toward the viewer.
    n: vec3f,
    v: vec3f,
    tangents: Tangents,
    // Unit tangent across n where shading depends on it, else zero.
    t: vec3f,
    base_color: vec3f,
    alpha: f32,
    metallic: f32,
    perceptual_roughness: f32,
    dielectric_F0: f32,
    specular: f32,
    specular_color: vec3f,
    occlusion: f32,
    // cd/m2.
    emissive: vec3f,
}

fn read_surface(v: VertexOut, front_facing: bool, toward_viewer: vec3f) -> Surface {
    let base_color = material.base_color * base_color_texel(v) * vertex_color(v);
    let metallic_roughness = metallic_roughness_texel(v);

    var surface: Surface;
    let n = shading_normal(v, toward_viewer);
    surface.n = face_viewer(n, front_facing);
    surface.tangents = read_tangents(v, n);
    surface.v = toward_viewer;
    surface.t = shading_tangent(v, surface.n);
    // Vertex colours are floats and may be anything.
    surface.base_color = saturate(base_color.xyz);
    surface.alpha = base_color.w;
    surface.metallic = read_metallic(metallic_roughness);
    surface.perceptual_roughness = read_perceptual_roughness(metallic_roughness);
    surface.dielectric_F0 = read_dielectric_F0();
    surface.specular = read_specular(v);
    surface.specular_color = read_specular_color(v);
    surface.occlusion = read_occlusion(v, metallic_roughness);
    surface.emissive = read_emission(v);
    return surface;
}
