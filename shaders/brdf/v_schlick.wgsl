// Visibility of Schlick's rational masking, G1(x) = x / (x (1 - k) + k). Schlick 1994, eq. 19.
// `k` in (0, 1], `NoV` in (0, 1], `NoL` in [0, 1].
fn V_Schlick(k: f32, NoV: f32, NoL: f32) -> f32 {
    return 0.25 / ((NoV * (1.0 - k) + k) * (NoL * (1.0 - k) + k));
}
