#import "lighting/visible_facets.wgsl"

// What the specular lobe sees of the environment on average, by three taps. Numbers were fitted to lobes of all kinds at
// once, under random environments whose power falls with the degree as (1 + l)^-2.
fn reflected_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let line = line_of(lobes, to_environment);
    let long = line.stretch * line.stretch;
    let wider = exp(0.3562 * line.lean - 0.0968 * line.size);
    let middle = sqrt(mix(0.8494, 1.086, long)) * wider;
    let end = sqrt(mix(0.8494, 2.5253, long)) * wider;
    let share = 0.8426 * exp(0.6981 * line.size);
    let tilt = exp(0.0896 * line.lean);
    let place = 0.1337 * line.lean;
    let reach = 0.5995 * exp(-0.7865 * line.size) * line.stretch;
    var seen = see(Seen(), lobes, line, place - reach, end, share / tilt);
    seen = see(seen, lobes, line, place, middle, 1.0);
    seen = see(seen, lobes, line, place + reach, end, share * tilt);
    return average_of(seen);
}
