#import <types>
#import "lighting/frame.wgsl"
#import <interface>
#import "math/vectors.wgsl"
#import <output>
#import <target>

@vertex
fn vertex(in: VertexIn) -> VertexOut {
    return vertex_out(in);
}

@fragment
fn fragment(v: VertexOut, @builtin(front_facing) front_facing: bool) -> @location(0) vec4f {
    return target_value(output(v, front_facing));
}
