@group(0) @binding(7) var fresnel_tail_table: texture_2d<f32>;

// Directional albedo of Lazanyi's term, the lobe's integral with F = v.h (1 - v.h)^6. Stored 16 times larger, because
// the term has its maximum at 0.057.
fn fresnel_tail(perceptual_roughness: f32, cos_theta: f32) -> f32 {
    return textureSampleLevel(fresnel_tail_table, clamp_sampler, dfg_uv(perceptual_roughness, cos_theta), 0.0).x * (1.0 / 16.0);
}
