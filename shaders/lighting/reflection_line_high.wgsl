#import "lighting/visible_facets.wgsl"

// What the specular lobe sees of the environment on average, by five taps. Numbers as in reflection_line_standard.wgsl.
fn reflected_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let line = line_of(lobes, to_environment);
    let long = line.stretch * line.stretch;
    let wider = exp(0.2711 * line.lean - 0.0262 * line.size);
    let middle = sqrt(mix(1.0275, 0.791, long)) * wider;
    let between = sqrt(mix(1.0275, 0.89, long)) * wider;
    let end = sqrt(mix(1.0275, 2.8785, long)) * wider;
    let share = exp(0.3294 * line.size);
    let tilt = exp(0.1703 * line.lean);
    let end_tilt = exp(0.3253 * line.lean);
    let place = 0.0566 * line.lean;
    let reach = exp(-0.6499 * line.size) * line.stretch;
    let near = 0.4045 * reach;
    let far = 0.7725 * reach;
    var seen = see(Seen(), lobes, line, place - far, end, 0.698 * share * share / end_tilt);
    seen = see(seen, lobes, line, place - near, between, 0.8026 * share / tilt);
    seen = see(seen, lobes, line, place, middle, 1.0);
    seen = see(seen, lobes, line, place + near, between, 0.8026 * share * tilt);
    seen = see(seen, lobes, line, place + far, end, 0.698 * share * share * end_tilt);
    return average_of(seen);
}
