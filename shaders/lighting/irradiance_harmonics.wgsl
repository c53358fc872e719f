#import "lighting/prefiltered.wgsl"

// Irradiance / pi on a surface, from harmonics of degree 2: a few hundredths off under lights that are small.
fn irradiance_over_pi(n: vec3f) -> vec3f {
    return irradiance_over_pi_sh(environment.irradiance_over_pi, n);
}
