#import "surface/visible_point.wgsl"

// What the target holds where a surface is seen: radiance multiplied with coverage, and coverage.
fn output(v: VertexOut, front_facing: bool) -> vec4f {
    return stored_point(visible_point(v, front_facing));
}
