#import "channel/asked.wgsl"
#import <lobes>
#import <chosen_lobes>
#import <punctual>
#import <environment>
#import <suns>

// Radiance of one source by way of the lobes that are asked for.
fn radiance_channel(surface: Surface, position: vec3f) -> vec3f {
    let lobes = chosen_lobes(make_lobes(surface), asked.z);
    switch asked.x {
        case CHANNEL_PUNCTUAL: {
            return punctual_radiance(lobes, position);
        }
        case CHANNEL_LIGHT: {
            return radiance_of_light(lobes, position, asked.y);
        }
        case CHANNEL_LIGHT_COUNT: {
            return vec3f(f32(punctual_count(position)));
        }
        case CHANNEL_SUN: {
            return radiance_of_sun(lobes, asked.y) * surface.occlusion;
        }
        default: {
            return environment_radiance(lobes) * surface.occlusion;
        }
    }
}
