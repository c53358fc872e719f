#import "lighting/visible_facets.wgsl"

// What the specular lobe sees of the environment on average, by one tap. Numbers as in reflection_line_standard.wgsl.
fn reflected_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let line = line_of(lobes, to_environment);
    let round = 1.2035 * exp(1.0622 * line.lean);
    // Of a long lobe one round tap can only be a compromise.
    let longer = line.stretch * line.stretch / max(1.0 - line.stretch * line.stretch, 1e-6);
    let width = sqrt(round + 0.3089 * longer);
    return average_of(see(Seen(), lobes, line, 0.2062 * line.lean, width, 1.0));
}
