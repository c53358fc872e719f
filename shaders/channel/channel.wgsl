#import "surface/visible_point.wgsl"
#import "channel/asked.wgsl"
#import <channels>

// A channel of a surface in place of its radiance, wherever it covers anything at all.
fn output(v: VertexOut, front_facing: bool) -> vec4f {
    ask(v.position_in_clip.w);
    let facet = cross(dpdx(v.position_in_world), dpdy(v.position_in_world));
    let toward_viewer = direction_to_viewer(v);
    let surface = read_surface(v, front_facing, toward_viewer);
    if premultiply(vec3f(0.0), surface.alpha).w <= 0.0 {
        discard;
    }
    let facet_normal = normalize_or(select(-facet, facet, dot(facet, toward_viewer) > 0.0), toward_viewer);
    return vec4f(channel(v, surface, facet_normal, front_facing), 1.0);
}
