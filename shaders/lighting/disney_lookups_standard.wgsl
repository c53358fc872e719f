#import "lighting/disney_smooth.wgsl"

// What the clearcoat sees of the environment on average. GTR1 has a peak and a long tail: one tap for each, the tail's
// nearer to the normal. Numbers as in disney_smooth.wgsl.
fn clearcoat_radiance(lobes: Lobes, to_environment: mat3x3f) -> vec3f {
    let mirror = reflect(-lobes.v, lobes.n);
    let peak = 0.643 * pow(lobes.clearcoat_alpha, 0.772) * (0.477 + lobes.NoV);
    let tail = 1.859 * pow(lobes.clearcoat_alpha, 0.334) * (0.042 + lobes.NoV);
    let angle = 1.113 * pow(lobes.clearcoat_alpha, 0.4) * (1.0 - lobes.NoV);
    let sin_theta = sqrt(max(1.0 - lobes.NoV * lobes.NoV, 0.0));
    let inward = lobes.n * sin_theta - forward(lobes) * lobes.NoV;
    return mix(
        prefiltered_radiance(to_environment * (mirror * cos(angle) + inward * sin(angle)), min(sqrt(tail), 1.0)),
        prefiltered_radiance(to_environment * mirror, sqrt(peak)),
        0.508);
}
