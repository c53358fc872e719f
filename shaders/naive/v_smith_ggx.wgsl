// Naive: shown beside the form in use by `specula stability`, and part of no frame.

// Smith's Lambda by the tangent, Heitz 2014, eq. 72.
fn Lambda_GGX_tangent(alpha: f32, NoX: f32) -> f32 {
    let tan2 = (1.0 - NoX * NoX) / (NoX * NoX);
    return 0.5 * (sqrt(1.0 + alpha * alpha * tan2) - 1.0);
}

// G / (4 n.v n.l) with G = 1 / (1 + Lambda(v) + Lambda(l)): infinite times zero at the horizon.
fn V_from_G(alpha: f32, NoV: f32, NoL: f32) -> f32 {
    let G = 1.0 / (1.0 + Lambda_GGX_tangent(alpha, NoV) + Lambda_GGX_tangent(alpha, NoL));
    return G / (4.0 * NoV * NoL);
}
