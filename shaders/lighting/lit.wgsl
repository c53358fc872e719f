#import <lobes>
#import <punctual>
#import <environment>

fn shade(surface: Surface, position: vec3f) -> vec3f {
    let lobes = make_lobes(surface);
    return punctual_radiance(lobes, position) + environment_radiance(lobes) * surface.occlusion + surface.emissive;
}
