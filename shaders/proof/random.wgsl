// Numbers from a counter: the same for the same seed, evaluation and draw, on every device.

var<private> random_seed: u32;
var<private> random_evaluation: u32;
var<private> random_draw: u32;

fn begin_random(seed: u32, evaluation: u32) {
    random_seed = seed;
    random_evaluation = evaluation;
    random_draw = 0u;
}

// Three to three numbers, Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", pcg3d.
fn pcg3d(counter: vec3u) -> vec3u {
    var v = counter * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> vec3u(16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

fn random_bits() -> u32 {
    random_draw += 1u;
    return pcg3d(vec3u(random_evaluation, random_draw, random_seed)).x;
}

// One of 0 to count - 1.
fn random_choice(count: u32) -> u32 {
    return (random_bits() >> 8u) % count;
}

// Even in [0, 1).
fn random_even() -> f32 {
    return f32(random_bits() >> 8u) * exp2(-24.0);
}

// A number below the smallest normal one.
fn random_denormal() -> f32 {
    return bitcast<f32>(random_bits() & 0x007fffffu);
}

// Even in its logarithm.
fn random_magnitude(smallest: f32, largest: f32) -> f32 {
    return exp2(mix(log2(smallest), log2(largest), random_even()));
}

// For parameters of [0, 1]: two in three inside, one exactly at an end, beside it, or far beyond.
fn random_unit() -> f32 {
    let inside = random_even();
    let denormal = random_denormal();
    switch random_choice(24u) {
        case 0u: { return 0.0; }
        case 1u: { return 1.0; }
        case 2u: { return 1.0 - exp2(-24.0); }
        case 3u: { return random_magnitude(1e-38, 1.0); }
        case 4u: { return denormal; }
        case 5u: { return -1.0; }
        case 6u: { return 1e30; }
        case 7u: { return -1e-7; }
        default: { return inside; }
    }
}

// For what has no upper end: 0, denormal, 1e30, or any magnitude between 1e-30 and 1e30.
fn random_positive() -> f32 {
    let denormal = random_denormal();
    let magnitude = random_magnitude(1e-30, 1e30);
    switch random_choice(8u) {
        case 0u: { return 0.0; }
        case 1u: { return 1.0; }
        case 2u: { return denormal; }
        case 3u: { return 1e30; }
        default: { return magnitude; }
    }
}

// Metres: 0, or any distance between 1e-20 and 1e20, one in two of them within a room.
fn random_distance() -> f32 {
    let far = random_magnitude(1e-20, 1e20);
    let near = random_magnitude(1e-3, 1e3);
    switch random_choice(8u) {
        case 0u: { return 0.0; }
        case 1u, 2u, 3u: { return far; }
        default: { return near; }
    }
}

// A unit vector, even over the sphere; one in eight along an axis.
fn random_direction() -> vec3f {
    let z = 2.0 * random_even() - 1.0;
    let phi = 6.2831853 * random_even();
    let radius = sqrt(max(1.0 - z * z, 0.0));
    let axis = random_choice(48u);
    if axis < 6u {
        let sign = f32(axis & 1u) * 2.0 - 1.0;
        return sign * vec3f(vec3u(axis >> 1u) == vec3u(0u, 1u, 2u));
    }
    return vec3f(radius * cos(phi), radius * sin(phi), z);
}

// A vertex vector as it arrives between vertices: a direction of length 1, shorter, next to nothing, or zero.
fn random_attribute() -> vec3f {
    let direction = random_direction();
    let length = random_magnitude(1e-38, 1.0);
    switch random_choice(8u) {
        case 0u: { return vec3f(0.0); }
        case 1u: { return direction * length; }
        default: { return direction; }
    }
}

// A unit vector that has to do with another two: equal, opposite, at the horizon of the second or just off it.
fn random_relative(a: vec3f, b: vec3f) -> vec3f {
    let any = random_direction();
    let off = random_magnitude(1e-10, 0.1) * (f32(random_choice(2u)) * 2.0 - 1.0);
    let side = cross(b, any);
    let horizon = side * inverseSqrt(max(dot(side, side), 1e-20));
    switch random_choice(12u) {
        case 0u: { return a; }
        case 1u: { return -a; }
        case 2u: { return b; }
        case 3u: { return -b; }
        case 4u: { return horizon; }
        case 5u: { return normalize(horizon + b * off); }
        case 6u: { return normalize(reflect(-a, b) + any * off); }
        default: { return any; }
    }
}
