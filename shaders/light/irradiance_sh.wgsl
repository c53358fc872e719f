// Irradiance / pi from spherical harmonics of degree 2 (Ramamoorthi and Hanrahan 2001, eq. 13), with the basis
// constants and the cosine lobe already in the coefficients. Never negative: a sun can ring below zero.
fn irradiance_over_pi_sh(coefficients: array<vec4f, 9>, n: vec3f) -> vec3f {
    let linear = coefficients[0] + coefficients[1] * n.y + coefficients[2] * n.z + coefficients[3] * n.x;
    let products = coefficients[4] * (n.x * n.y) + coefficients[5] * (n.y * n.z) + coefficients[7] * (n.x * n.z);
    let squares = coefficients[6] * (3.0 * n.z * n.z - 1.0) + coefficients[8] * (n.x * n.x - n.y * n.y);
    return max((linear + products + squares).xyz, vec3f(0.0));
}
