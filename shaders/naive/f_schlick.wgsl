// Naive: shown beside the form in use by `specula stability`, and part of no frame.

// By pow, whose base is negative when v.h comes out one rounding above 1; WGSL leaves the result open.
fn F_Schlick_weight_pow(VoH: f32) -> f32 {
    return pow(1.0 - VoH, 5.0);
}
