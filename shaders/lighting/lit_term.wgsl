#import <lobes>
#import <chosen_lobes>
#import <punctual>
#import <environment>

// One term: of the BRDF some components are left, and of the two sources one is a file without light.
fn shade(surface: Surface, position: vec3f) -> vec3f {
    let lobes = chosen_lobes(make_lobes(surface), TERM_COMPONENTS);
    return punctual_radiance(lobes, position) + environment_radiance(lobes) * surface.occlusion;
}
