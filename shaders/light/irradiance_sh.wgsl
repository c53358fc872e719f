// Irradiance / pi from spherical harmonics of degree 2 (Ramamoorthi and Hanrahan 2001, eq. 13), with the basis
// constants and the cosine lobe already in the coefficients; n is a unit vector.

// The part of degree 1.
fn irradiance_linear_sh(coefficients: array<vec4f, 9>, n: vec3f) -> vec3f {
    return (coefficients[1] * n.y + coefficients[2] * n.z + coefficients[3] * n.x).xyz;
}

// The part of degree 2.
fn irradiance_quadratic_sh(coefficients: array<vec4f, 9>, n: vec3f) -> vec3f {
    let products = coefficients[4] * (n.x * n.y) + coefficients[5] * (n.y * n.z) + coefficients[7] * (n.x * n.z);
    let squares = coefficients[6] * (3.0 * n.z * n.z - 1.0) + coefficients[8] * (n.x * n.x - n.y * n.y);
    return (products + squares).xyz;
}

// All of it. Never negative: a sun can ring below zero.
fn irradiance_over_pi_sh(coefficients: array<vec4f, 9>, n: vec3f) -> vec3f {
    let uneven = irradiance_linear_sh(coefficients, n) + irradiance_quadratic_sh(coefficients, n);
    return max(coefficients[0].xyz + uneven, vec3f(0.0));
}
