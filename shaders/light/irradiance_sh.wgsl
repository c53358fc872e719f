// Irradiance / pi by degree of its spherical harmonics.
struct Harmonics {
    mean: vec3f,
    linear: vec3f,
    quadratic: vec3f,
}

// Ramamoorthi and Hanrahan 2001, eq. 13, with the basis constants and the cosine lobe already in the coefficients.
fn harmonics_at(coefficients: array<vec4f, 9>, n: vec3f) -> Harmonics {
    let linear = coefficients[1] * n.y + coefficients[2] * n.z + coefficients[3] * n.x;
    let products = coefficients[4] * (n.x * n.y) + coefficients[5] * (n.y * n.z) + coefficients[7] * (n.x * n.z);
    let squares = coefficients[6] * (3.0 * n.z * n.z - 1.0) + coefficients[8] * (n.x * n.x - n.y * n.y);
    return Harmonics(coefficients[0].xyz, linear.xyz, (products + squares).xyz);
}

// Irradiance / pi. Never negative: a sun can ring below zero.
fn irradiance_over_pi_sh(coefficients: array<vec4f, 9>, n: vec3f) -> vec3f {
    let at_n = harmonics_at(coefficients, n);
    return max(at_n.mean + at_n.linear + at_n.quadratic, vec3f(0.0));
}
