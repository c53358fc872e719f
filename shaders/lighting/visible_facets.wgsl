#import "lighting/prefiltered.wgsl"
#import "math/vectors.wgsl"
#import <facets>

// The facets of a specular lobe. The slot says which, and what share of the light from each reaches the viewer.
struct Facets {
    t: vec3f,
    alpha_t: f32,
    b: vec3f,
    alpha_b: f32,
}

// Taps of a lobe that may be longer than wide. Stretched by the alphas, what a viewer sees of GGX facets is a cap of
// directions, even over its area (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps"). The taps
// lie on the line through its middle that becomes the longest axis of the lobe.
struct Line {
    // Takes directions from the frame of tangent, bitangent and normal to the panorama's.
    to_environment: mat3x3f,
    alpha: vec3f,
    v: vec3f,
    // The view in the stretched frame.
    stretched: vec3f,
    // Along the line and across it.
    along: vec2f,
    // How far the lobe is from round, in [0, 1].
    stretch: f32,
    // How far the line leans with the view, in [0, 1].
    lean: f32,
    // Of the lobe along the line, in [0, 1]: 1/2 where reflected directions turn by 2 rad from the middle to the rim.
    size: f32,
    least_r: f32,
}

// How a reflected direction changes with the facet h, times a and b: the product of two changes. Those along the plane
// of incidence count more.
fn reflected_product(v: vec3f, VoH: f32, a: vec3f, b: vec3f) -> f32 {
    return 4.0 * (VoH * VoH * dot(a, b) + dot(v, a) * dot(v, b));
}

fn line_of(lobes: Lobes, to_environment: mat3x3f) -> Line {
    let facets = facets_of(lobes);
    let tangent_frame = mat3x3f(facets.t, facets.b, lobes.n);
    var line: Line;
    line.to_environment = to_environment * tangent_frame;
    line.alpha = vec3f(facets.alpha_t, facets.alpha_b, 1.0);
    line.v = lobes.v * tangent_frame;
    line.stretched = normalize(line.alpha * line.v);

    let facet = line.alpha * (vec3f(0.0, 0.0, 1.0) + line.stretched);
    let inverse_length = inverseSqrt(dot(facet, facet));
    let h = facet * inverse_length;
    let VoH = dot(line.v, h);
    let x = vec3f(facets.alpha_t, 0.0, 0.0) - h * (h.x * facets.alpha_t);
    let y = vec3f(0.0, facets.alpha_b, 0.0) - h * (h.y * facets.alpha_b);
    let xx = reflected_product(line.v, VoH, x, x);
    let yy = reflected_product(line.v, VoH, y, y);
    let xy = reflected_product(line.v, VoH, x, y);
    let half_difference = 0.5 * (xx - yy);
    let radius = length(vec2f(half_difference, xy));
    let longest = select(
        vec2f(xy, radius - half_difference), vec2f(half_difference + radius, xy), half_difference >= 0.0);
    let along = longest * inverseSqrt(max(dot(longest, longest), 1e-30));
    let lean = dot(along, line.stretched.xy);
    line.along = select(along, -along, lean < 0.0);
    line.lean = abs(lean);
    let largest = 0.5 * (xx + yy) + radius;
    line.stretch = sqrt(saturate(2.0 * radius / largest));
    let turn = largest * (2.0 + 2.0 * line.stretched.z) * inverse_length * inverse_length;
    line.size = turn / (4.0 + turn);
    // The mirror level, which holds the suns, is read to the share that `sun_radiance` leaves.
    line.least_r = min(lobes.perceptual_roughness, FINEST_PERCEPTUAL_ROUGHNESS);
    return line;
}

struct Seen {
    radiance: vec3f,
    share: vec3f,
}

// Adds the tap at `place`, in (-1, 1), on the line: as wide as `width` times the lobe is across the line, with the share
// of its facets times `weight`.
fn see(seen: Seen, lobes: Lobes, line: Line, place: f32, width: f32, weight: f32) -> Seen {
    let cap = 1.0 + line.stretched.z;
    let rim = sqrt(cap * (2.0 - cap * place * place));
    let facet = line.alpha * (vec3f(line.along * (rim * place), 1.0 - cap * place * place) + line.stretched);
    let inverse_length = inverseSqrt(dot(facet, facet));
    let h = facet * inverse_length;
    let VoH = dot(line.v, h);
    let l = 2.0 * VoH * h - line.v;
    let step = line.alpha.xy * vec2f(-line.along.y, line.along.x) * (rim * inverse_length);
    let across = vec3f(step, 0.0) - h * dot(h.xy, step);
    let alpha = 0.5 * width * sqrt(reflected_product(line.v, VoH, across, across) * (1.0 - place * place));
    let r = clamp(sqrt(alpha), line.least_r, 1.0);
    let share = share_of_facet(lobes, line.v, l, saturate(VoH)) * weight;
    return Seen(
        seen.radiance + prefiltered_radiance(line.to_environment * l, r) * share,
        seen.share + share);
}

// Shares add up to 1, so that a white furnace stays white.
fn average_of(seen: Seen) -> vec3f {
    return seen.radiance / max(seen.share, vec3f(1e-12));
}
