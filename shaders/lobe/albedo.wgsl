// Directional albedo of the specular lobe, single and multiple scattering: E_s = F0 scale + F90 bias + F_ms (1 - E).
// `scale` and `bias` are the split-sum pair (Karis 2013) at one cosine and perceptual roughness. In [0, 1].
fn E_specular(F0: f32, F90: f32, F_ms: f32, scale: f32, bias: f32) -> f32 {
    return saturate(F0 * scale + F90 * bias + F_ms * (1.0 - scale - bias));
}
