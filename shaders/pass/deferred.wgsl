#import <types>
#import "lighting/frame.wgsl"
#import "math/vectors.wgsl"
#import <interface>
#import <output>
#import <seen>
#import <share>
#import "pass/fullscreen.wgsl"
#import "pass/draw_depth.wgsl"

@group(2) @binding(0) var<uniform> pulled: PulledDraw;
@group(2) @binding(1) var pulled_vertices: texture_2d<f32>;
@group(2) @binding(2) var pulled_triangles: texture_2d<u32>;

// Weights of a triangle's corners at the middle of a pixel, and what they change by to the next one.
struct Barycentrics {
    here: vec3f,
    dx: vec3f,
    dy: vec3f,
}

fn pulled_texel(index: u32) -> vec2u {
    return vec2u(index % PULLED_ROW_TEXELS, index / PULLED_ROW_TEXELS);
}

fn cross_2d(a: vec2f, b: vec2f) -> f32 {
    return a.x * b.y - a.y * b.x;
}

// Of the origin, from the corners' (x, y) in clip space, up to a factor. Corners behind the eye need no clipping: Olano
// and Greer 1997, "Triangle Scan Conversion using 2D Homogeneous Coordinates".
fn areas(a: vec2f, b: vec2f, c: vec2f) -> vec3f {
    return vec3f(cross_2d(b, c), cross_2d(c, a), cross_2d(a, b));
}

fn weights(areas: vec3f) -> vec3f {
    return areas * (1.0 / (areas.x + areas.y + areas.z));
}

// At most about as far beside the triangle as it is large: what goes on beyond is made up, and normals of triangles far smaller
// than a pixel would turn to anywhere.
fn near_triangle(weights: vec3f) -> vec3f {
    let beside = weights - 1.0 / 3.0;
    let far = max(max(abs(beside.x), abs(beside.y)), abs(beside.z));
    return 1.0 / 3.0 + beside * min(1.0, 4.0 / (3.0 * far));
}

// Two instances: pixels that are the draw's alone, and those that it shares.
@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> @builtin(position) vec4f {
    let depth = select(depth_of_draw(pulled.number), SHARED_DEPTH, instance == 1u);
    return vec4f(fullscreen_position(index), depth, 1.0);
}

// What one triangle sends to the viewer at a place of the picture, be that on the triangle or beside it.
fn shaded(corners: vec3u, place: vec2f) -> vec4f {
    let a = pulled_vertex(corners.x);
    let b = pulled_vertex(corners.y);
    let c = pulled_vertex(corners.z);
    // The place comes to the origin first: the corners are near, and their products would cancel elsewhere.
    let w = vec3f(a.position_in_clip.w, b.position_in_clip.w, c.position_in_clip.w);
    let ndc = place * pulled.ndc_step + vec2f(-1.0, 1.0);
    let p = a.position_in_clip.xy - ndc * w.x;
    let q = b.position_in_clip.xy - ndc * w.y;
    let r = c.position_in_clip.xy - ndc * w.z;
    let right = vec2f(pulled.ndc_step.x, 0.0);
    let down = vec2f(0.0, pulled.ndc_step.y);
    let here = areas(p, q, r);
    var at: Barycentrics;
    at.here = near_triangle(weights(here));
    at.dx = weights(areas(p - right * w.x, q - right * w.y, r - right * w.z)) - at.here;
    at.dy = weights(areas(p - down * w.x, q - down * w.y, r - down * w.z)) - at.here;
    let is_front = (here.x + here.y + here.z) * pulled.front > 0.0;
    return output(interpolated(a, b, c, at), is_front);
}

fn corners_of(triangle: u32) -> vec3u {
    return textureLoad(pulled_triangles, pulled_texel(pulled.first_triangle + triangle), 0).xyz;
}

// Whether two triangles have a vertex in common. Vertices are split where a surface has an edge, so it is smooth between
// them, and shading it once for both is what the pixel shows.
fn meet(a: vec3u, b: vec3u) -> bool {
    return any(a == b) || any(a == b.yzx) || any(a == b.zxy);
}

// Every group of samples that belong together is shaded once, in their middle, and counts by its number. So nothing is
// shaded beyond the edge of a surface, where textures and normals only go on by extrapolation.
@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    var corners: array<vec3u, SAMPLES>;
    var left = 0u;
    for (var i = 0u; i < SAMPLES; i++) {
        let sample_seen = seen(vec2i(position.xy), i);
        corners[i] = corners_of(sample_seen.y);
        left |= select(0u, 1u << i, sample_seen.x == pulled.number);
    }
    var sum = vec4f(0.0);
    loop {
        // The first that is left; an index that is not constant would put the array into memory.
        var chosen = corners[0];
        for (var i = 1u; i < SAMPLES; i++) {
            chosen = select(chosen, corners[i], (left & ((1u << i) - 1u)) == 0u);
        }
        var group = 0u;
        var places = vec2f(0.0);
        for (var i = 0u; i < SAMPLES; i++) {
            let is_in = meet(chosen, corners[i]) && (left & (1u << i)) != 0u;
            group |= select(0u, 1u << i, is_in);
            places += select(vec2f(0.0), SAMPLE_PLACES[i], is_in);
        }
        left &= ~group;
        // A shared pixel may have none of this draw: what was shaded is nothing then, and may be NaN.
        let middle = floor(position.xy) + places / max(f32(countOneBits(group)), 1.0);
        sum += select(vec4f(0.0), shaded(chosen, middle) * share(vec2i(position.xy), group), group != 0u);
        if left == 0u {
            break;
        }
    }
    return sum;
}
