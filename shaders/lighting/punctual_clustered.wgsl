#import "lighting/punctual_light.wgsl"
#import "lighting/clusters.wgsl"
#import <unbounded>

// Radiance toward the viewer from the lights that reach everything and those of the point's cluster.
//
// Of the latter some end before the point. They are passed over in a loop of their own, so that neighbouring pixels, which
// a processor shades together, each evaluate a light that reaches them, if not the same one.
fn punctual_radiance(lobes: Lobes, position: vec3f) -> vec3f {
    var radiance = unbounded_radiance(lobes, position);
    let cluster = cluster_at(position);
    var next = cluster_table[cluster];
    let end = cluster_table[cluster + 1u];
    loop {
        var i = 0u;
        // The square of the distance in ranges.
        var x = 1.0;
        while next < end {
            i = cluster_table[next];
            next++;
            let toward = lights[i].position - position;
            x = dot(toward, toward) * lights[i].inverse_range_squared;
            if x < 1.0 {
                break;
            }
        }
        if !(x < 1.0) {
            break;
        }
        radiance += radiance_of_light(lobes, position, i);
    }
    return radiance;
}

// How many lights are looked at.
fn punctual_count(position: vec3f) -> u32 {
    let cluster = cluster_at(position);
    return clusters.unbounded + cluster_table[cluster + 1u] - cluster_table[cluster];
}
