// Squares to a unit of texture coordinates.
const CHECKER_SQUARES: f32 = 8.0;

// How much of a pixel `width` wide around x lies in the odd ones of squares of width 1.
fn odd_share(x: f32, width: f32) -> f32 {
    let w = clamp(width, 1e-4, 2.0);
    let odd_before = odd_until(x + 0.5 * w) - odd_until(x - 0.5 * w);
    return odd_before / w;
}

// How much of all that lies between 0 and x is in odd squares.
fn odd_until(x: f32) -> f32 {
    let pairs = floor(0.5 * x);
    return pairs + max(x - 2.0 * pairs - 1.0, 0.0);
}

// A chequered pattern, filtered so that it fades to grey where squares are smaller than pixels. Red grows with u and green
// with v within each unit, so that mirrored and turned charts show.
fn checker(uv: vec2f) -> vec3f {
    let width = CHECKER_SQUARES * (abs(dpdx(uv)) + abs(dpdy(uv)));
    let place = CHECKER_SQUARES * uv;
    let odd = vec2f(odd_share(place.x, width.x), odd_share(place.y, width.y));
    let bright = odd.x * (1.0 - odd.y) + odd.y * (1.0 - odd.x);
    let square = (floor(place - CHECKER_SQUARES * floor(uv)) + 0.5) / CHECKER_SQUARES;
    return vec3f(square, 1.0 - 0.5 * (square.x + square.y)) * mix(0.35, 1.0, bright);
}

// Where there are no coordinates: grey stripes, in pixels, which no chart looks like.
fn hatched(pixel: vec2f) -> vec3f {
    let along = (pixel.x + pixel.y) / 8.0;
    return vec3f(select(0.35, 0.5, along - floor(along) < 0.5));
}
