#import <lobes>
#import <shown>
#import <punctual>
#import <environment>

// One term: of the lobes one is left, and of the two sources one is a file without light.
fn shade(surface: Surface, position: vec3f) -> vec3f {
    let lobes = shown_lobes(make_lobes(surface));
    return punctual_radiance(lobes, position) + environment_radiance(lobes) * surface.occlusion;
}
